#pragma once

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
   * The level set on the way to the membrane: it has to cross zero somewhere, and to be finite where it was
   * evaluated. Collective.
   * @param n_crossed cells of this rank in which it has both signs
   * @param n_negative cells of this rank at whose centre it is negative
   * @param not_finite message about a point of this rank where it is not finite; empty if there is none
   */
  void level_set(unsigned int n_crossed, unsigned int n_negative, const std::string &not_finite,
                 MPI_Comm communicator) const;

  /** Projection onto the zero set of the interpolated level set: there has to be one, and a normal to it. */
  MembraneProjection<dim> project(const std::vector<MembranePatch<dim>> &patches,
                                  const dealii::Point<dim> &origin) const;

  /**
   * The zero set of the interpolated level set: the expression has to vanish on it, not to jump from one sign
   * to the other or to have a pole there, and two sheets of it may not be closer than half a cell.
   */
  void membrane(const dealii::Function<dim> &expression, const MembraneProjection<dim> &membrane) const;

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
  const AllParameters &parameters;
};
} // namespace Gemmule
