// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/bending_schur_complement.h>
#include <gemmule/surface/trace_forms.h>

#include <algorithm>
#include <cmath>

namespace Gemmule
{
using namespace dealii;

template <int dim>
BendingSchurComplement<dim>::BendingSchurComplement(const TraceSpace<dim> &space, const double response)
    : system(space.communicator(), true)
{
  constexpr unsigned int n = TraceSpace<dim>::Basis::n;
  begin_system(space, 2, system);
  system.zero_matrix();
  FullMatrix<double> mass(n, n), stiffness(n, n), local(2 * n, 2 * n);
  SurfacePoint<dim> point;
  for (unsigned int b = 0; b < space.active_mesh().size(); ++b)
  {
    const TraceCell<dim> &cell = space.active_mesh()[b];
    stabilised_mass_matrix(cell, mass);
    stiffness.equ(1. / cell.size, cell.normal_derivatives);
    for (unsigned int q = 0; cell.cut != nullptr && q < cell.cut->surface_points.size(); ++q)
    {
      point.reinit(*cell.cut, q);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          stiffness(i, j) +=
              cell.cut->surface_weights[q] * (point.surface_gradients[i] * point.surface_gradients[j]);
    }
    stiffness *= std::sqrt(response * cell.size);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
      {
        local(i, j) = mass(i, j);
        local(n + i, n + j) = -mass(i, j);
        local(i, n + j) = local(n + i, j) = stiffness(i, j);
      }
    system.add_matrix(b, local);
  }
  system.factorise();
  const IndexSet owned = system.numbering().locally_owned(0);
  n_owned = owned.n_elements();
  first = n_owned > 0 ? owned.nth_index_in_set(0) : 0;
}

template <int dim>
void BendingSchurComplement<dim>::apply(const double *const residual, double *const solution) const
{
  LinearSystem::Vector right_side = system.make_vector();
  for (unsigned int i = 0; i < n_owned; ++i)
    right_side(first + i) = -residual[i];
  const LinearSystem::Vector both = system.solve(std::move(right_side));
  for (unsigned int i = 0; i < n_owned; ++i)
    solution[i] = both(first + i);
}

template class BendingSchurComplement<2>;
template class BendingSchurComplement<3>;
} // namespace Gemmule
