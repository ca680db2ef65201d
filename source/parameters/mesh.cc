// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/parameters/mesh.h>
#include <gemmule/parameters/section.h>

#include <deal.II/base/parameter_handler.h>

#include <algorithm>

namespace Gemmule::Parameters
{
void Mesh::add_parameters(dealii::ParameterHandler &prm)
{
  Section section(prm, {"Mesh"});
  const Range levels = Range::between(0, 20);
  section.add("Bulk level", bulk_level,
              "Uniform refinement of the box: its shortest edge is divided into 2^level cells.", levels);
  section.add("Membrane level", membrane_level,
              "Level of the cells that the membrane cuts: edges of 2^-level times "
              "the shortest edge of the box.",
              levels);
  section.add(
      "Phase boundary level", phase_boundary_level,
      "Level of the cut cells in which the composition lies between the two bounds below. The cell size "
      "should not exceed about three times the Cahn number.",
      levels);
  section.add(
      "Membrane layers", membrane_layers,
      "Layers of cells at the finest level on each side of the cut cells: the distance that the membrane may "
      "move before it has to be remeshed.",
      Range::between(1, 20));
  section.add(
      "Composition lower bound", composition_lower,
      "A cell belongs to a phase boundary if its composition c = f / total exceeds this (dimensionless).",
      Range::any());
  section.add(
      "Composition upper bound", composition_upper,
      "A cell belongs to a phase boundary if its composition c = f / total is below this (dimensionless).",
      Range::any());
  section.add(
      "Remeshing interval", remeshing_interval,
      "Largest number of time steps from one remeshing to the next. The mesh is also adapted whenever the "
      "membrane has used up its layers.",
      Range::at_least(1));
  section.add(
      "Largest number of cells", largest_number_of_cells,
      "When the mesh gets more cells than this, its finest level is lowered by one, with a warning and for "
      "the rest of the run, though never down to the bulk level.",
      Range::at_least(1));
  section.add("Finest level", finest_level,
              "Finest level that the criteria below may ask for. The levels given above are not limited by "
              "it. Equal to "
              "the larger one of them or below, it switches these criteria off.",
              levels);
  section.add(
      "Cells per phase boundary", cells_per_phase_boundary,
      "Cells per 10-90 % width of the composition across a phase boundary in equilibrium, which is 6.2 Cahn "
      "numbers with the quartic double well, where the composition lies between its two bounds; 0: 'Phase "
      "boundary level' alone decides (dimensionless).",
      Range::non_negative());
  section.add("Curvature tolerance", curvature_tolerance,
              "epsilon in h |kappa| <= epsilon, h being the edge of the cells and kappa the curvature of the "
              "membrane "
              "there (dimensionless); 0: no refinement by curvature.",
              Range::non_negative());
  section.add(
      "Cells per gap", cells_per_gap,
      "Cells that have to fit between two sheets of the membrane that face each other (a neck, a tip, a "
      "near-contact of one or two vesicles) and between the membrane and the wall; 0: only as many as the "
      "flow needs at the wall (dimensionless).",
      Range::non_negative());
  section.add("Flow error tolerance", flow_error_tolerance,
              "Estimated error of the flow, relative in the energy norm, that is spread evenly over the "
              "cells: those with "
              "more than their share are refined, those with much less are coarsened (dimensionless); 0: no "
              "refinement "
              "by the error of the flow.",
              Range::non_negative());
  section.add(
      "Coarsening margin", coarsening_margin,
      "Hysteresis: cells are coarsened only where the criteria would be met with all lengths smaller by this "
      "factor (dimensionless).",
      Range::between(1., 10.));
}

unsigned int Mesh::largest_level() const
{
  return std::max({finest_level, membrane_level, phase_boundary_level});
}

void Mesh::check() const
{
  Mesh copy(*this);
  dealii::ParameterHandler prm;
  copy.add_parameters(prm);

  if (membrane_level < bulk_level)
    throw ParameterError("Mesh/Membrane level",
                         "is " + std::to_string(membrane_level) +
                             ", coarser than 'Bulk level' = " + std::to_string(bulk_level) +
                             ". The levels have to satisfy Bulk level <= Membrane level <= "
                             "Phase boundary level.");
  if (phase_boundary_level < membrane_level)
    throw ParameterError(
        "Mesh/Phase boundary level",
        "is " + std::to_string(phase_boundary_level) +
            ", coarser than 'Membrane level' = " + std::to_string(membrane_level) +
            ". The levels have to satisfy Bulk level <= Membrane level <= Phase boundary level.");
  if (!(composition_lower < composition_upper))
    throw ParameterError("Mesh/Composition upper bound", "is " + to_text(composition_upper) +
                                                             ", but has to be larger than 'Composition lower "
                                                             "bound' = " +
                                                             to_text(composition_lower) +
                                                             ". Exchange them, or leave them out.");
}
} // namespace Gemmule::Parameters
