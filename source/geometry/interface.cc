// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/geometry/interface.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // The volume is corrected to this relative accuracy: round-off of its quadrature.
  constexpr double volume_tolerance = 1e-12;
  // A step that is wrong by more than this part of the volume has lost the membrane, and is no case for a
  // correction.
  constexpr double largest_volume_error = 0.05;
  // The volume by the rules of the cut cells jumps where the division of a cell changes, by some 1e-6 on a
  // coarse mesh. Where the volume that is wanted lies in such a jump no shift has it; the next step,
  // elsewhere, makes up for it.
  constexpr double largest_remaining_volume_error = 1e-4;
  constexpr unsigned int largest_number_of_shifts = 8;
} // namespace

template <int dim>
Interface<dim>::Interface(const parallel::distributed::Triangulation<dim> &triangulation) : phi(triangulation)
{
}

template <int dim>
void Interface<dim>::cut()
{
  cells.reinit(phi.get_dof_handler(), phi.values());
}

template <int dim>
double Interface<dim>::shift_to_volume(const double target)
{
  double total_shift = 0.;
  for (unsigned int i = 0; i < largest_number_of_shifts; ++i)
  {
    const double excess = cells.enclosed_volume() - target;
    if (cells.measure() == 0.)
      throw StepBreakdown("The membrane has vanished: no cell of the mesh is cut by it any more.");
    if (std::abs(excess) < volume_tolerance * target)
      break;
    if (std::abs(excess) > largest_volume_error * target)
      throw StepBreakdown(
          "The enclosed area changes by more than 5 % in one time step: the step is too long.");
    const double amount = excess / cells.measure();
    phi.shift(amount);
    total_shift += amount;
    cut();
  }
  if (total_shift != 0. &&
      std::abs(cells.enclosed_volume() - target) > largest_remaining_volume_error * target)
    throw StepBreakdown("The enclosed area cannot be made that of the beginning: the step is too long.");
  return total_shift;
}

template class Interface<2>;
template class Interface<3>;
} // namespace Gemmule
