// Curvature, bending force and the motion that follows, against exact values.
#include <gemmule/surface/trace_forms.h>

#include <gtest/gtest.h>

#include "support/bending_on_curve.h"
#include "support/flow_on_circle.h"

using namespace Gemmule;
using namespace Gemmule::Testing;

namespace
{
using dealii::Point;
using dealii::Tensor;

const Point<2> centre(0.021, -0.013);
constexpr double a = 0.7, b = 0.45;

Parameters::Bending two_phases()
{
  Parameters::Bending parameters;
  parameters.rigidity_0 = 0.5;
  parameters.rigidity_1 = 1.5;
  parameters.spontaneous_curvature_0 = 1.;
  parameters.spontaneous_curvature_1 = -2.;
  return parameters;
}

double varying_composition(const Point<2> &p) { return 0.5 + 0.4 * std::sin(2. * p[0] + p[1]); }

/** Displacements with tangential and normal parts, and one that is far from a rigid motion everywhere. */
const std::array<SurfaceHarness::VectorField, 3> test_fields = {
    {[](const Point<2> &p) { return Point<2>(std::sin(2. * p[0] + p[1]), std::cos(p[0] - 3. * p[1])); },
     [](const Point<2> &p) { return Point<2>(p[0] * p[0] * p[1], std::exp(p[1])); },
     [](const Point<2> &p)
     { return Point<2>(std::cos(4. * p[0]) * p[1], std::sin(3. * p[0]) * std::cos(2. * p[1])); }}};
} // namespace

TEST(ParallelBending, CurvatureOfAnEllipseConverges)
{
  std::array<double, 3> errors;
  for (unsigned int i = 0; i < 3; ++i)
  {
    BendingOnCurve run(4 + i, two_phases());
    const ParametricBending exact(centre, a, b, run.model, varying_composition);
    run.set_membrane(EllipseDistance(centre, a, b));
    errors[i] = run.curvature_error([&](const Point<2> &x) { return exact.curvature(x); });
    RecordProperty("error" + std::to_string(i), std::to_string(errors[i]));
    std::cout << "curvature, level " << 4 + i << ": " << errors[i];
    {
      // the alternative: projection of div n of the level set
      const auto &cells = run.harness.geometry.cut_cells();
      const auto projected = project<2>(
          run.bending.trace_space(),
          [&](const unsigned int k, const unsigned int q, const Point<2> &)
          {
            const auto phi = evaluate_polynomial<2, 3, 2>(cells[k].level_set, cells[k].surface_points[q]);
            const auto n = cells[k].normals[q];
            return (trace(phi.hessian) - n * (phi.hessian * n)) / (phi.gradient.norm() * cells[k].size);
          });
      std::cout << "  projected div n: "
                << run.harness.l2_error(projected, [&](const Point<2> &x) { return exact.curvature(x); })
                << std::endl;
    }
  }
  for (unsigned int i = 1; i < 3; ++i)
    EXPECT_GT(std::log2(errors[i - 1] / errors[i]), 1.5) << errors[i - 1] << ' ' << errors[i];
}

TEST(ParallelBending, ForceIsTheVariationOfTheEnergy)
{
  for (const bool refine : {false, true})
  {
    std::array<std::array<double, 3>, 3> errors;
    for (unsigned int i = 0; i < 3; ++i)
    {
      // hanging nodes on the membrane in the second sweep
      BendingOnCurve run(4 + i, two_phases(),
                         refine ? [](const Point<2> &p) { return p[0] > 0.1; }
                                : std::function<bool(const Point<2> &)>());
      const ParametricBending exact(centre, a, b, run.model, varying_composition);
      run.set_membrane(EllipseDistance(centre, a, b));
      run.set_composition(varying_composition);
      for (unsigned int v = 0; v < test_fields.size(); ++v)
      {
        const double value = exact.variation(test_fields[v]);
        errors[v][i] = std::abs(run.variation(test_fields[v]) - value) / std::abs(value);
        std::cout << "variation, level " << 4 + i << ", field " << v << ": " << value << ", relative error "
                  << errors[v][i] << std::endl;
      }
    }
    for (const auto &error : errors)
    {
      EXPECT_GT(std::log2(error[0] / error[2]) / 2., 1.5) << error[0] << ' ' << error[1] << ' ' << error[2];
      EXPECT_LT(error[2], 2e-3);
    }
  }
}

TEST(ParallelBending, EnergyOfAnEllipse)
{
  BendingOnCurve run(5, two_phases());
  const ParametricBending exact(centre, a, b, run.model, varying_composition);
  run.set_membrane(EllipseDistance(centre, a, b));
  run.set_composition(varying_composition);
  const double value = exact.energy(0., test_fields[0]);
  EXPECT_NEAR(run.bending.energy(), value, 1e-4 * value);
}

TEST(ParallelBending, CircleOfSpontaneousCurvatureIsFreeOfForce)
{
  // and without spontaneous curvature the force is a pressure: either way nothing moves
  for (const double spontaneous : {1. / FlowOnCircle<2>::radius, 0.})
  {
    std::array<double, 4> speeds;
    for (unsigned int i = 0; i < speeds.size(); ++i)
    {
      FlowOnCircle<2> flow(3 + i, centre);
      Parameters::Bending parameters;
      parameters.rigidity_0 = 1.;
      parameters.spontaneous_curvature_0 = spontaneous;
      const BendingModel model(parameters);
      MembraneBending<2> bending(flow.mesh.triangulation, model);
      bending.reinit_mesh();
      bending.compute_curvature(flow.geometry, flow.mesh.dof_handler, flow.mesh.level_set);
      bending.compute_moment(nullptr, nullptr);
      flow.set_tension([](const Point<2> &) { return 0.; });
      flow.solver.prepare(flow.geometry, dealii::Functions::ZeroFunction<2>(2));
      const BendingForce<2> force(bending, flow.geometry);
      flow.solver.solve(flow.tension, nullptr, &force);
      speeds[i] = flow.error([](const Point<2> &) { return Tensor<1, 2>(); });
      std::cout << "circle, kappa_0 = " << spontaneous << ", level " << 3 + i << ": speed on the membrane (L2) "
                << speeds[i] << ", largest " << flow.solver.max_velocity() << std::endl;
    }
    EXPECT_GT(std::log2(speeds[0] / speeds[3]) / 3., 1.5) << speeds[0] << ' ' << speeds[3];
    EXPECT_LT(speeds[3], 1e-3);
  }
}
