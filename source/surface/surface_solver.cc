// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/geometry/interface.h>
#include <gemmule/geometry/membrane_snapshot.h>
#include <gemmule/geometry/membrane_transport.h>
#include <gemmule/model/membrane_model.h>
#include <gemmule/parameters/discretisation.h>
#include <gemmule/surface/surface_solver.h>
#include <gemmule/surface/trace_forms.h>

namespace Gemmule
{
using namespace dealii;

template <int dim>
SurfaceSolver<dim>::SurfaceSolver(const Triangulation<dim> &triangulation, const MembraneModel &model,
                                  const Parameters::Surface &parameters)
    : model(model), space(triangulation),
      transport(TotalConcentration<dim>::create(model, parameters, triangulation.get_communicator())),
      phases(model, parameters, triangulation.get_communicator())
{
}

template <int dim>
void SurfaceSolver<dim>::reinit_mesh()
{
  space.reinit_mesh();
}

template <int dim>
void SurfaceSolver<dim>::initialise(const Interface<dim> &interface, const Function<dim> &concentration,
                                    const Function<dim> &total_concentration,
                                    const MembranePointValues *const curvature)
{
  space.prepare(interface, {{nullptr, nullptr}});
  const auto projection = [&](const Function<dim> &function)
  {
    return project<dim>(space,
                        [&](unsigned int, unsigned int, const Point<dim> &x) { return function.value(x); });
  };
  total = projection(total_concentration);
  phases.initialise(space, projection(concentration), total, curvature);
  compute_diagnostics();
}

template <int dim>
void SurfaceSolver<dim>::advance(const Interface<dim> &interface, const SurfaceStep<dim> &step)
{
  AssertThrow(step.clouds[0] && (step.bdf.order() == 1 || step.clouds[1]),
              ExcMessage("A step needs as many earlier membranes as its order."));
  AssertThrow(step.velocity && step.predicted_concentration &&
                  step.velocity->size() == interface.geometry().cut_cells().size() &&
                  step.predicted_concentration->size() == interface.geometry().cut_cells().size(),
              ExcMessage("Velocity and predicted concentration must be given on every cut cell."));
  space.prepare(interface, step.clouds);
  total = transport->advance(space, step);
  phases.advance(space, step, total);
  compute_diagnostics();
}

template <int dim>
void SurfaceSolver<dim>::compute_diagnostics()
{
  figures = compute_surface_diagnostics(model, space.geometry(), phases.concentration(), total,
                                        phases.chemical_potential(), space.communicator());
}

template <int dim>
MembranePointValues SurfaceSolver<dim>::tension(const MembranePointValues *const curvature) const
{
  const auto &cells = space.geometry().cut_cells();
  MembranePointValues sigma(cells.size());
  SurfacePoint<dim> point;
  for (unsigned int k = 0; k < cells.size(); ++k)
    for (unsigned int q = 0; q < cells[k].surface_points.size(); ++q)
    {
      point.reinit(cells[k], q);
      const auto &f = phases.concentration()[k];
      const double value = point.value(f), total_value = point.value(total[k]),
                   potential = point.value(phases.chemical_potential()[k]),
                   gradient_square = point.surface_gradient(f).norm_square();
      sigma[k].push_back(
          curvature != nullptr
              ? model.tension(value, total_value, potential, gradient_square, (*curvature)[k][q])
              : model.tension(value, total_value, potential, gradient_square));
    }
  return sigma;
}

template <int dim>
MembraneCloud<dim> SurfaceSolver<dim>::cloud() const
{
  const auto &cells = space.geometry().cut_cells();
  MembraneCloud<dim> cloud = bare_cloud(space.geometry());
  for (unsigned int k = 0, i = 0; k < cells.size(); ++k)
    for (const auto &p : cells[k].surface_points)
    {
      cloud.concentration[i] = TensorLagrange<dim, 2>::value(phases.concentration()[k], p);
      cloud.total_concentration[i++] = TensorLagrange<dim, 2>::value(total[k], p);
    }
  return cloud;
}

template class SurfaceSolver<2>;
template class SurfaceSolver<3>;
} // namespace Gemmule
