// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/geometry/cut_geometry.h>
#include <gemmule/geometry/level_set.h>

#include <deal.II/base/function.h>
#include <deal.II/distributed/tria.h>

#include <functional>
#include <vector>

namespace Gemmule
{
/**
 * The membrane as the mesh has it: the level set and the cells that its zero set cuts. All that solves
 * equations on or around the membrane takes this one object.
 *
 * A function that changes the level set leaves the cut cells as they were, until cut() is called; only
 * shift_to_volume() cuts by itself. Lengths and volumes are dimensionless.
 */
template <int dim>
class Interface
{
public:
  explicit Interface(const dealii::parallel::distributed::Triangulation<dim> &triangulation);

  /** To be called after each change of the mesh; then the level set has to be set anew. Collective. */
  void reinit_mesh() { phi.reinit_mesh(); }

  /** Level set := interpolant of a function that need not be a distance (LevelSet::interpolate). */
  void interpolate(const dealii::Function<dim> &function) { phi.interpolate(function); }

  /** Level set := signed distance from @p membrane, moved by @p offset (LevelSet::set_distance). */
  void set_distance(const MembraneProjection<dim> &membrane,
                    const std::function<double(const ClosestPoint<dim> &)> &offset = nullptr)
  {
    phi.set_distance(membrane, offset);
  }

  /** The same with the sides that a level set of that membrane tells (LevelSet::set_distance). */
  void set_distance(const MembraneProjection<dim> &membrane, const NarrowBandLevelSet<dim> &sides,
                    const double width = 0.)
  {
    phi.set_distance(membrane, sides, width);
  }

  /** Moves the membrane over a time step (LevelSet::advance). */
  void move(const MembraneMotion<dim> &motion, const NarrowBandLevelSet<dim> &old_level_set,
            const bool redistance)
  {
    phi.advance(motion, old_level_set, redistance);
  }

  /** Moves the membrane inwards by the length @p amount. */
  void shift(const double amount) { phi.shift(amount); }

  /** Sets the level set from LevelSet::gather_cells() of an earlier run (LevelSet::restore). Collective. */
  void restore(const std::vector<LevelSetCell<dim>> &cells, const bool set_everywhere)
  {
    phi.restore(cells, set_everywhere);
  }

  /** The level set far from the membrane will be set anew by the next move(), as on a new mesh. */
  void forget_far_nodes() { phi.forget_far_nodes(); }

  /**
   * Cuts the cells by the zero set of the present level set.
   * @throws SimulationError on all ranks when a rule of a cell cannot be made. Collective.
   */
  void cut();

  /**
   * Shifts the membrane along its normal until it encloses the volume (area in 2D) @p target, to 1e-12 of it,
   * and cuts the cells. Newton's method: a shift by s inwards changes the volume by -s times the measure of
   * the membrane. Where the volume by the rules of the cells jumps over the target, up to 1e-4 of it may
   * remain. Needs cut() before.
   *
   * @return the length of the shift, positive inwards; 0 if nothing had to be done
   * @throws StepBreakdown when there is no membrane, its volume is off by more than 5 %, or no shift has the
   * volume. Collective.
   */
  double shift_to_volume(double target);

  /** Is the level set that of this membrane in all cut cells (LevelSet::is_accurate_around)? Collective. */
  bool is_accurate() const { return phi.is_accurate_around(cells); }

  const LevelSet<dim> &level_set() const { return phi; }

  /** The cells as cut() has left them. The object is the same as long as the interface lives. */
  const CutGeometry<dim> &geometry() const { return cells; }

private:
  LevelSet<dim> phi;
  CutGeometry<dim> cells;
};
} // namespace Gemmule
