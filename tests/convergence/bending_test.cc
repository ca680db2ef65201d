// SPDX-License-Identifier: LGPL-2.1-or-later
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

double varying_composition(const Point<2> &p)
{
  return 0.5 + 0.4 * std::sin(2. * p[0] + p[1]);
}

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
    // the alternative, for comparison: projection of div n of the level set
    const auto &cells = run.harness.geometry.cut_cells();
    const auto projected = project<2>(
        run.bending.trace_space(),
        [&](const unsigned int k, const unsigned int q, const Point<2> &)
        {
          const auto phi = evaluate_polynomial<2, 3, 2>(cells[k].level_set, cells[k].surface_points[q]);
          const auto n = cells[k].normals[q];
          return (trace(phi.hessian) - n * (phi.hessian * n)) / (phi.gradient.norm() * cells[k].size);
        });
    const double alternative =
        run.harness.l2_error(projected, [&](const Point<2> &x) { return exact.curvature(x); });
    EXPECT_LT(errors[i], 0.5 * alternative);
  }
  for (unsigned int i = 1; i < 3; ++i)
    EXPECT_GT(std::log2(errors[i - 1] / errors[i]), 2.2) << errors[i - 1] << ' ' << errors[i];
  EXPECT_LT(errors[2], 3e-4);
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
      }
    }
    for (const auto &error : errors)
    {
      EXPECT_GT(std::log2(error[0] / error[2]) / 2., 2.5) << error[0] << ' ' << error[1] << ' ' << error[2];
      EXPECT_LT(error[2], 2e-5);
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
      bending.compute_curvature(flow.interface);
      bending.compute_moment(nullptr, nullptr);
      flow.set_tension([](const Point<2> &) { return 0.; });
      flow.solve(dealii::Functions::ZeroFunction<2>(2),
                 {std::make_shared<BendingForce<2>>(bending, flow.fluid.capillary_number)});
      speeds[i] = flow.error([](const Point<2> &) { return Tensor<1, 2>(); });
    }
    // The interpolated circle has kinks of order h^3 at the faces: a curvature error of order h^2 as short as
    // a cell, and velocities of order h.
    EXPECT_GT(std::log2(speeds[0] / speeds[3]) / 3., 1.1) << speeds[0] << ' ' << speeds[3];
    EXPECT_LT(speeds[3], 2.5e-3) << "in units of rigidity / R^3 = 11";
  }
}

namespace
{
/** Bending energy of the spheroid with semi-axes a (twice) and c, rigidity 1. */
double spheroid_energy(const double a, const double c, const double spontaneous)
{
  constexpr unsigned int n = 2000;
  double sum = 0.;
  for (unsigned int i = 0; i < n; ++i)
  {
    const double t = dealii::numbers::PI * (i + 0.5) / n;
    const double q = std::hypot(a * std::cos(t), c * std::sin(t));
    const double curvature = a * c / (q * q * q) + c / (a * q) - spontaneous;
    sum += dealii::numbers::PI / n * 2. * dealii::numbers::PI * a * std::sin(t) * q * 0.5 * curvature *
           curvature;
  }
  return sum;
}
} // namespace

TEST(ParallelBending, ForceIsTheVariationOfTheEnergyInThreeDimensions)
{
  const double a = 0.6, c = 0.45, spontaneous = 1., s = 1e-4;
  // Displacements that keep it a spheroid, and what they do to its energy.
  const std::array<Tensor<1, 3>, 2> directions = {{Point<3>(1. / a, 1. / a, 0.), Point<3>(0., 0., 1. / c)}};
  const std::array<double, 2> exact = {
      {(spheroid_energy(a + s, c, spontaneous) - spheroid_energy(a - s, c, spontaneous)) / (2. * s),
       (spheroid_energy(a, c + s, spontaneous) - spheroid_energy(a, c - s, spontaneous)) / (2. * s)}};
  std::array<std::array<double, 2>, 2> errors;
  for (unsigned int i = 0; i < 2; ++i)
  {
    LevelSetMesh<3> mesh(2);
    for (unsigned int r = 0; r < 1 + i; ++r)
      mesh.refine_where([](const Point<3> &p) { return std::abs(p.norm() - 0.5) < 0.5; });
    Interface<3> interface(mesh.triangulation);
    interface.reinit_mesh();
    interface.interpolate(ScalarFunctionFromFunctionObject<3>(
        [=](const Point<3> &p)
        {
          const double r = std::sqrt((p[0] * p[0] + p[1] * p[1]) / (a * a) + p[2] * p[2] / (c * c));
          return 0.5 * (r * r - 1.) /
                 std::sqrt((p[0] * p[0] + p[1] * p[1]) / std::pow(a, 4) + p[2] * p[2] / std::pow(c, 4) +
                           1e-2);
        }));
    interface.cut();
    const CutGeometry<3> &geometry = interface.geometry();
    Parameters::Bending parameters;
    parameters.rigidity_0 = 1.;
    parameters.spontaneous_curvature_0 = spontaneous;
    const BendingModel model(parameters);
    MembraneBending<3> bending(mesh.triangulation, model);
    bending.reinit_mesh();
    bending.compute_curvature(interface);
    bending.compute_moment(nullptr, nullptr);
    InterfaceVelocity<3> interface_velocity;
    interface_velocity.reinit(geometry);
    for (unsigned int k = 0; k < 2; ++k)
    {
      std::vector<MembraneVelocity<3>> velocity(geometry.cut_cells().size());
      for (unsigned int cell = 0; cell < velocity.size(); ++cell)
      {
        velocity[cell].cell_size = geometry.cut_cells()[cell].size;
        for (unsigned int node = 0; node < velocity[cell].nodal.size(); ++node)
        {
          const auto x = geometry.cut_cells()[cell].physical(TensorLagrange<3, 2>::node(node));
          for (unsigned int d = 0; d < 3; ++d)
            velocity[cell].nodal[node][d] = directions[k][d] * x[d];
        }
      }
      const double value = dealii::Utilities::MPI::sum(
          BendingForce<3>(bending, 1.).power(interface_velocity, velocity), MPI_COMM_WORLD);
      errors[i][k] = std::abs(value / exact[k] - 1.);
    }
  }
  for (unsigned int k = 0; k < 2; ++k)
  {
    EXPECT_LT(errors[1][k], 2e-2) << exact[k];
    EXPECT_LT(errors[1][k], 0.5 * errors[0][k]) << errors[0][k];
  }
}
