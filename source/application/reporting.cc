// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/application/reporting.h>
#include <gemmule/base/gather.h>
#include <gemmule/geometry/curve_order.h>
#include <gemmule/geometry/level_set_curvature.h>
#include <gemmule/geometry/region_moments.h>

#include <deal.II/numerics/data_out.h>

#include <algorithm>
#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // Points that carry less than this part of the membrane are left out: their order along the curve is
  // round-off.
  constexpr double smallest_weight = 1e-12;

  /** One quadrature point, as it travels between ranks. */
  template <int dim>
  struct PlainSample
  {
    double point[dim], velocity[dim], normal[dim];
    double f, f_total, chemical_potential, tension, curvature, weight;
  };

  template <int dim>
  std::vector<PlainSample<dim>> local_samples(const CoupledSystem<dim> &system)
  {
    using Q2 = TensorLagrange<dim, 2>;
    const auto *const surface = system.get_surface();
    const auto &cut_cells = system.get_geometry().cut_cells();
    const double threshold = smallest_weight * system.get_geometry().measure();
    const MembranePointValues tension = system.get_membrane_flow().tension();
    std::vector<PlainSample<dim>> samples;
    for (unsigned int c = 0; c < cut_cells.size(); ++c)
    {
      const auto &cell = cut_cells[c];
      for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
      {
        if (cell.surface_weights[q] < threshold)
          continue;
        const Point<dim> &unit = cell.surface_points[q];
        const Point<dim> x = cell.physical(unit);
        const Tensor<1, dim> u = system.get_flow().membrane_velocity()[c].value(unit);
        PlainSample<dim> s{};
        for (unsigned int d = 0; d < dim; ++d)
        {
          s.point[d] = x[d];
          s.velocity[d] = u[d];
          s.normal[d] = cell.normals[q][d];
        }
        if (surface != nullptr)
        {
          s.f = Q2::value(surface->concentration()[c], unit);
          s.f_total = Q2::value(surface->total_concentration()[c], unit);
          s.chemical_potential = Q2::value(surface->chemical_potential()[c], unit);
        }
        s.tension = tension[c][q];
        s.weight = cell.surface_weights[q];
        if (const auto *const bending = system.get_bending())
          s.curvature = bending->curvature()[c][q];
        else
          s.curvature = level_set_curvature(evaluate_polynomial<dim, 3, 2>(cell.level_set, unit), cell.size);
        samples.push_back(s);
      }
    }
    return samples;
  }

  /** The order of the points along the curves, and the segments between them. */
  struct CurveConnectivity
  {
    std::vector<unsigned int> order;
    std::vector<std::array<unsigned int, 2>> segments;
  };

  template <int dim>
  CurveConnectivity connect(const std::vector<Point<dim>> &points, const std::vector<Tensor<1, dim>> &normals,
                            const std::vector<double> &weights)
  {
    CurveConnectivity connectivity;
    if constexpr (dim == 2)
      for (const auto &curve : order_closed_curves(points, normals, weights))
      {
        const unsigned int first = connectivity.order.size();
        for (unsigned int k = 0; k < curve.size(); ++k)
          connectivity.segments.push_back(
              {{first + k, first + static_cast<unsigned int>((k + 1) % curve.size())}});
        connectivity.order.insert(connectivity.order.end(), curve.begin(), curve.end());
      }
    else
      for (unsigned int i = 0; i < points.size(); ++i)
        connectivity.order.push_back(i);
    return connectivity;
  }
} // namespace

template <int dim>
InterfaceSamples<dim> sample_membrane(const CoupledSystem<dim> &system)
{
  auto all = gather_plain(local_samples(system), system.mesh().get_communicator());
  // the same order on any number of ranks
  std::sort(all.begin(), all.end(),
            [](const auto &a, const auto &b)
            { return std::lexicographical_compare(a.point, a.point + dim, b.point, b.point + dim); });
  std::vector<Point<dim>> points(all.size());
  std::vector<Tensor<1, dim>> normals(all.size());
  std::vector<double> weights(all.size());
  for (unsigned int i = 0; i < all.size(); ++i)
  {
    for (unsigned int d = 0; d < dim; ++d)
    {
      points[i][d] = all[i].point[d];
      normals[i][d] = all[i].normal[d];
    }
    weights[i] = all[i].weight;
  }
  auto connectivity = connect(points, normals, weights);

  InterfaceSamples<dim> samples;
  samples.time = system.computed_time();
  samples.connectivity = std::move(connectivity.segments);
  for (const unsigned int i : connectivity.order)
  {
    const auto &s = all[i];
    samples.points.push_back(points[i]);
    samples.normal.push_back(normals[i]);
    Tensor<1, dim> velocity;
    for (unsigned int d = 0; d < dim; ++d)
      velocity[d] = s.velocity[d];
    samples.velocity.push_back(velocity);
    samples.f.push_back(s.f);
    samples.f_total.push_back(s.f_total);
    samples.composition.push_back(s.f_total != 0. ? s.f / s.f_total : 0.);
    samples.tension.push_back(s.tension);
    samples.chemical_potential.push_back(s.chemical_potential);
    samples.curvature.push_back(s.curvature);
    samples.weights.push_back(s.weight);
  }
  return samples;
}

template <int dim>
StatisticsRow make_statistics(const CoupledSystem<dim> &system, const InterfaceSamples<dim> &membrane)
{
  StatisticsRow row;
  const auto &flow = system.get_flow();
  const auto &geometry = system.get_geometry();
  row.time = system.computed_time();
  row.cells = system.mesh().n_global_active_cells();
  row.flow_dofs = flow.n_unknowns();
  row.linear_iterations = flow.linear_solver_report().iterations;

  const auto moments = compute_region_moments<dim>(system.mesh(), geometry);
  row.centroid_x = moments.centroid[0];
  row.centroid_y = moments.centroid[1];
  row.area = moments.volume;
  row.deformation = moments.deformation();
  row.arclength = geometry.measure();
  row.area_correction = system.area_correction();

  for (unsigned int i = 0; i < membrane.points.size(); ++i)
  {
    if (membrane.tension[i] < 0.)
      row.tension_negative_length += membrane.weights[i];
    row.curvature_max = std::max(row.curvature_max, std::abs(membrane.curvature[i]));
  }
  const auto tension = std::minmax_element(membrane.tension.begin(), membrane.tension.end());
  row.tension_min = *tension.first;
  row.tension_max = *tension.second;

  // A closed curve ends with the segment that leads back to an earlier point.
  for (const auto &segment : membrane.connectivity)
  {
    row.components += segment[1] <= segment[0];
    row.phase_boundaries +=
        (membrane.composition[segment[0]] < 0.5) != (membrane.composition[segment[1]] < 0.5);
  }

  if (const auto *const surface = system.get_surface())
  {
    const auto &d = surface->diagnostics();
    row.surface_dofs = surface->n_unknowns();
    row.mass_f = d.mass_f;
    row.mass_total = d.mass_total;
    row.energy_surface = d.energy_surface;
    row.energy_phase = d.energy_phase;
    row.dissipation_phase = d.dissipation_phase;
    row.f_total_min = d.total_concentration_min;
    row.f_total_max = d.total_concentration_max;
    row.composition_min = d.composition_min;
    row.composition_max = d.composition_max;
    row.f_total_shift = surface->last_mass_shift();
  }
  else
    row.energy_surface = system.get_membrane_flow().tension_energy(system.get_geometry());
  const auto &arclength = system.get_parameters().arclength;
  if (arclength.model == Parameters::ArclengthModel::penalty)
    row.energy_constraint =
        0.5 * arclength.penalty * std::pow(row.arclength - system.reference_arclength(), 2);
  if (const auto *const bending = system.get_bending())
  {
    row.energy_bending = bending->energy();
    row.grid_scale_rigidity = bending->largest_numerical_rigidity();
  }
  row.energy_total = row.energy_surface + row.energy_phase + row.energy_constraint + row.energy_bending;
  row.dissipation_viscous = flow.viscous_dissipation();
  row.max_velocity = flow.max_velocity();
  return row;
}

template <int dim>
void write_fields(const CoupledSystem<dim> &system, const double time, FieldWriter<dim> &writer)
{
  const auto &dof_handler = system.get_flow().dof_handler();
  typename StokesSolver<dim>::Vector velocity_and_pressure;
  system.get_flow().interpolate(velocity_and_pressure);
  velocity_and_pressure.update_ghost_values();

  DataOut<dim> data_out;
  std::vector<std::string> names(dim, "velocity");
  names.push_back("pressure");
  std::vector<DataComponentInterpretation::DataComponentInterpretation> interpretation(
      dim, DataComponentInterpretation::component_is_part_of_vector);
  interpretation.push_back(DataComponentInterpretation::component_is_scalar);
  data_out.add_data_vector(dof_handler, velocity_and_pressure, names, interpretation);
  data_out.add_data_vector(system.get_level_set().get_dof_handler(), system.get_level_set().values(),
                           "level_set");
  Vector<float> level(system.mesh().n_active_cells()), subdomain(system.mesh().n_active_cells());
  for (const auto &cell : system.mesh().active_cell_iterators())
    if (cell->is_locally_owned())
    {
      level[cell->active_cell_index()] = cell->level();
      subdomain[cell->active_cell_index()] = cell->subdomain_id();
    }
  data_out.add_data_vector(level, "level");
  data_out.add_data_vector(subdomain, "subdomain");
  data_out.build_patches();
  writer.write(data_out, time);
}

#define GEMMULE_INSTANTIATE(dim)                                                                             \
  template InterfaceSamples<dim> sample_membrane(const CoupledSystem<dim> &);                                \
  template StatisticsRow make_statistics(const CoupledSystem<dim> &, const InterfaceSamples<dim> &);         \
  template void write_fields(const CoupledSystem<dim> &, double, FieldWriter<dim> &);
GEMMULE_INSTANTIATE(2)
GEMMULE_INSTANTIATE(3)
#undef GEMMULE_INSTANTIATE
} // namespace Gemmule
