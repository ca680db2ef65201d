// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/linear_system.h>
#include <gemmule/geometry/membrane_snapshot.h>
#include <gemmule/surface/trace_forms.h>

namespace Gemmule
{
using namespace dealii;

template <int dim>
void begin_system(const TraceSpace<dim> &space, const unsigned int n_fields, LinearSystem &system)
{
  BlockNumbering numbering(space.communicator());
  for (unsigned int field = 0; field < n_fields; ++field)
    numbering.add_field(space.partition(), {field});
  numbering.close();
  system.begin(numbering);
  for (const auto &single : space.elements())
  {
    CondensedIndices element;
    for (unsigned int field = 0; field < n_fields; ++field)
      element.append(single, [&](const auto index) { return numbering.number(field, index); });
    element.sort();
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
  LinearSystem system(space.communicator(), true);
  begin_system(space, 1, system);
  system.zero_matrix();
  auto rhs = system.make_vector();
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
    system.add_right_side(k, local.data(), rhs);
  }
  system.factorise();
  return space.extract(system, system.solve(std::move(rhs)));
}

#define GEMMULE_INSTANTIATE(dim)                                                                             \
  template void begin_system(const TraceSpace<dim> &, unsigned int, LinearSystem &);                         \
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
