// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/model/membrane_model.h>
#include <gemmule/parameters/discretisation.h>
#include <gemmule/surface/surface_solver.h>
#include <gemmule/time/time_step.h>

#include <deal.II/base/function.h>

#include "support/ellipse_distance.h"
#include "support/surface_harness.h"

namespace Gemmule::Testing
{
/** Runs the surface equations on a membrane whose motion is given. */
class PhaseFieldRun
{
public:
  using Distance = std::function<EllipseDistance(double)>;

  PhaseFieldRun(const unsigned int level, const MembraneModel &model, Distance distance,
                SurfaceHarness::VectorField velocity)
      : harness(level), solver(harness.mesh.triangulation, model, parameters), distance(std::move(distance)),
        velocity(std::move(velocity))
  {
    solver.reinit_mesh();
  }

  /** A membrane at rest. */
  PhaseFieldRun(const unsigned int level, const MembraneModel &model, const EllipseDistance &membrane)
      : PhaseFieldRun(
            level, model, [membrane](double) { return membrane; },
            [](const Point<2> &) { return Tensor<1, 2>(); })
  {
  }

  void initialise(const SurfaceHarness::Field &concentration,
                  const SurfaceHarness::Field &total_concentration)
  {
    harness.set_membrane(distance(time));
    const ScalarFunctionFromFunctionObject<2> f(concentration), total(total_concentration);
    solver.initialise(harness.interface, f, total);
    clouds[0] = SurfaceHarness::gather(solver.cloud());
    prediction = concentration;
  }

  /** One step with the second-order formula, with backward Euler for the first one. */
  void advance(const double time_step)
  {
    time += time_step;
    harness.set_membrane(distance(time));
    SurfaceStep<2> step;
    step.time_step = time_step;
    step.bdf = TimeStep(time_step, last_step).bdf();
    step.clouds = {{&clouds[0], last_step == 0. ? nullptr : &clouds[1]}};
    const auto u = harness.vector(velocity);
    const auto f = harness.scalar(prediction);
    step.velocity = &u;
    step.predicted_concentration = &f;
    solver.advance(harness.interface, step);
    clouds[1] = std::move(clouds[0]);
    clouds[0] = SurfaceHarness::gather(solver.cloud());
    last_step = time_step;
  }

  /** Changes the mesh between two steps. */
  void refine_where(const std::function<bool(const Point<2> &)> &criterion,
                    const bool coarsen_elsewhere = false)
  {
    if (coarsen_elsewhere)
    {
      for (const auto &cell : harness.mesh.triangulation.active_cell_iterators())
        if (cell->is_locally_owned() && !criterion(cell->center()))
          cell->set_coarsen_flag();
    }
    harness.mesh.refine_where(criterion);
    solver.reinit_mesh();
  }

  Parameters::Surface parameters;
  SurfaceHarness harness;
  SurfaceSolver<2> solver;
  double time = 0.;

private:
  Distance distance;
  SurfaceHarness::VectorField velocity;
  SurfaceHarness::Field prediction; ///< a poor one, so that Newton's method has something to do
  std::array<MembraneCloud<2>, 2> clouds;
  double last_step = 0.; ///< 0: none
};
} // namespace Gemmule::Testing
