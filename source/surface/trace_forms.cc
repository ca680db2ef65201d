// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/element_system.h>
#include <gemmule/geometry/membrane_snapshot.h>
#include <gemmule/surface/trace_forms.h>

namespace Gemmule
{
using namespace dealii;

template <int dim>
void begin_system(const TraceSpace<dim> &space, const unsigned int n_fields, ElementSystem &system)
{
  const unsigned int n = space.n_unknowns();
  system.begin(n_fields * n);
  for (const auto &single : space.elements())
  {
    CondensedIndices element;
    for (unsigned int field = 0; field < n_fields; ++field)
    {
      for (const auto index : single.indices)
        element.indices.push_back(field * n + index);
      const unsigned int first_entry = element.entries.size();
      for (const auto &[position, weight] : single.entries)
        element.entries.emplace_back(field * single.indices.size() + position, weight);
      for (unsigned int i = 0; i < single.n_local(); ++i)
      {
        element.row_start.push_back(first_entry + single.row_start[i + 1]);
        element.inhomogeneities.push_back(single.inhomogeneities[i]);
      }
    }
    system.add_element(std::move(element));
  }
  system.finish_elements();
}

template <int dim>
void stabilised_mass_matrix(const TraceCell<dim> &cell, FullMatrix<double> &matrix)
{
  matrix.equ(cell.size, cell.normal_derivatives);
  if (!cell.cut)
    return;
  typename TraceSpace<dim>::Basis::Values values;
  for (unsigned int q = 0; q < cell.cut->surface_points.size(); ++q)
  {
    TraceSpace<dim>::Basis::evaluate(cell.cut->surface_points[q], values);
    for (unsigned int i = 0; i < values.size(); ++i)
      for (unsigned int j = 0; j < values.size(); ++j)
        matrix(i, j) += cell.cut->surface_weights[q] * values[i] * values[j];
  }
}

template <int dim>
void add_history(const TraceCell<dim> &cell, const SurfaceStep<dim> &step,
                 std::vector<double> MembraneCloud<dim>::*const density, double *const local)
{
  using Basis = typename TraceSpace<dim>::Basis;
  typename Basis::Values values;
  for (unsigned int level = 0; level < 2; ++level)
    if (step.clouds[level])
    {
      const auto &cloud = *step.clouds[level];
      const double factor = (level == 0 ? step.bdf.a1 : step.bdf.a2) / step.time_step;
      for (const auto &point : cell.cloud_points[level])
      {
        Basis::evaluate(point.unit, values);
        const double amount = factor * cloud.weights[point.index] * (cloud.*density)[point.index];
        for (unsigned int i = 0; i < Basis::n; ++i)
          local[i] -= amount * values[i];
      }
    }
}

template <int dim>
TraceField<dim> project(const TraceSpace<dim> &space,
                        const std::function<double(unsigned int, unsigned int, const Point<dim> &)> &function)
{
  constexpr unsigned int n = TraceSpace<dim>::Basis::n;
  ElementSystem system(space.communicator(), true);
  begin_system(space, 1, system);
  system.zero_matrix();
  std::vector<double> rhs(space.n_unknowns(), 0.);
  FullMatrix<double> matrix(n, n);
  std::array<double, n> local;
  SurfacePoint<dim> point;
  for (unsigned int k = 0; k < space.active_mesh().size(); ++k)
  {
    const auto &cell = space.active_mesh()[k];
    stabilised_mass_matrix(cell, matrix);
    local.fill(0.);
    if (cell.cut)
      for (unsigned int q = 0; q < cell.cut->surface_points.size(); ++q)
      {
        point.reinit(*cell.cut, q);
        const double value = function(cell.cut_index, q, cell.cut->physical(cell.cut->surface_points[q]));
        for (unsigned int i = 0; i < n; ++i)
          local[i] += cell.cut->surface_weights[q] * point.values[i] * value;
      }
    system.add_matrix(k, matrix);
    system.add_rhs(k, local.data(), rhs);
  }
  system.factorise();
  system.solve(rhs);
  return space.extract(rhs);
}

#define GEMMULE_INSTANTIATE(dim)                                                                             \
  template void begin_system(const TraceSpace<dim> &, unsigned int, ElementSystem &);                        \
  template void stabilised_mass_matrix(const TraceCell<dim> &, FullMatrix<double> &);                        \
  template void add_history(const TraceCell<dim> &, const SurfaceStep<dim> &,                                \
                            std::vector<double> MembraneCloud<dim>::*, double *);                            \
  template TraceField<dim> project(                                                                          \
      const TraceSpace<dim> &,                                                                               \
      const std::function<double(unsigned int, unsigned int, const Point<dim> &)> &);
GEMMULE_INSTANTIATE(2)
GEMMULE_INSTANTIATE(3)
#undef GEMMULE_INSTANTIATE
} // namespace Gemmule
