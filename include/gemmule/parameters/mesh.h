// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace dealii
{
class ParameterHandler;
}

namespace Gemmule::Parameters
{
/** Section "Mesh": levels of refinement and when to remesh (doc/method.md, "Adaptivity"). */
struct Mesh
{
  /** Uniform refinement of the box: its shortest edge is divided into 2^level cells. */
  unsigned int bulk_level = 3;
  /** Level of the cells that the membrane cuts. */
  unsigned int membrane_level = 6;
  /** Level of the cut cells where the composition is between the two bounds. */
  unsigned int phase_boundary_level = 7;
  /** Layers of cells at the finest level on each side of the cut cells. */
  unsigned int membrane_layers = 2;
  double composition_lower = 0.05;
  double composition_upper = 0.95;
  /** Time steps from one remeshing to the next, at most. */
  unsigned int remeshing_interval = 10;
  unsigned int largest_number_of_cells = 200000;
  /** Limit of what the criteria below may ask for; the levels above are not limited by it. */
  unsigned int finest_level = 8;
  /** Cells per 10-90 % width of the composition across a phase boundary in equilibrium; 0: none. */
  double cells_per_phase_boundary = 0.;
  /** epsilon in h |kappa| <= epsilon; 0: none. */
  double curvature_tolerance = 0.5;
  /** Cells between two sheets of the membrane, and between membrane and wall; 0: none. */
  double cells_per_gap = 4.;
  /** Relative error of the flow in the energy norm; 0: none. */
  double flow_error_tolerance = 0.;
  /** Cells are coarsened where they are finer than needed by more than this factor. */
  double coarsening_margin = 1.25;

  /** The finest level that any criterion can ask for. */
  unsigned int largest_level() const;

  void add_parameters(dealii::ParameterHandler &prm);
  /** @throws ParameterError unless bulk <= membrane <= phase boundary level and lower < upper bound */
  void check() const;
};
} // namespace Gemmule::Parameters
