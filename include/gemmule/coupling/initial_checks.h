// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/coupling/lost_parts.h>
#include <gemmule/geometry/membrane_projection.h>
#include <gemmule/parameters/all_parameters.h>

#include <deal.II/base/function.h>
#include <deal.II/base/mpi.h>

namespace Gemmule
{
/**
 * What can be wrong with the expressions of the initial state once there is a mesh: the text that a user has
 * written may be finite and of the right signs at the points that the parser looks at, and still not
 * describe a membrane. The functions look at data that every rank has (those that do not are marked as
 * collective), and throw a ParameterError on all ranks.
 */
template <int dim>
class InitialChecks
{
public:
  explicit InitialChecks(const AllParameters &parameters) : parameters(parameters) {}

  /** @p n_cells of the mesh when it is refined to @p level, on the way to that of the membrane. */
  void number_of_cells(std::size_t n_cells, unsigned int level) const;

  /**
   * What the search for the membrane has found: it has to have found something, no jump or pole, and no point
   * where the level set is not finite. @p is_negative what the sign is where it found nothing. Collective.
   */
  void found(const FoundMembrane<dim> &membrane, bool is_negative, MPI_Comm communicator) const;

  /** A shape that is inaccurate in very many cells has waves that no mesh will resolve. */
  void number_of_details(const std::vector<LostPart<dim>> &lost) const;

  /** No vesicle, filament or gap may be too small for the finest cells. */
  void nothing_lost(const std::vector<LostPart<dim>> &lost) const;

  /** The interpolated level set has to have a zero set. @p membrane projection onto it; nullptr: none */
  void on_mesh(const MembraneProjection<dim> *membrane) const;

  /**
   * The zero set on the mesh: nothing may be in it that is not near the zero set of the expression, and two
   * sheets of it may not be closer than half a cell.
   */
  void membrane(const ZeroSetDistance<dim> &distance, const MembraneProjection<dim> &membrane) const;

  /** The level set on a lattice of points on the walls of the box: it has to be positive there. */
  void walls(const dealii::Function<dim> &expression) const;

  /** What the level set encloses before and after it was made a distance: a resolved shape keeps it. */
  void distance(double area, double new_area, double arclength, double new_arclength) const;

  /**
   * Concentration and total concentration at points of the membrane: finite, the total positive, the
   * composition between zero and one.
   */
  void concentrations(const dealii::Function<dim> &concentration,
                      const dealii::Function<dim> &total_concentration,
                      const std::vector<dealii::Point<dim>> &points) const;

  /**
   * The largest speed of the first flow has to be a number, and one with which the fluid does not cross a
   * cell of the membrane's level within the smallest time step.
   */
  void flow(double largest_velocity) const;

  /** "Membrane/Level set: ..." with the expression. */
  [[noreturn]] void fail_level_set(const std::string &complaint) const;

private:
  [[noreturn]] void fail_detail(const dealii::Point<dim> &place, double cell_size) const;

  const AllParameters &parameters;
};
} // namespace Gemmule
