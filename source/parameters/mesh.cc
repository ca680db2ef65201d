#include <gemmule/parameters/errors.h>
#include <gemmule/parameters/mesh.h>
#include <gemmule/parameters/section.h>

#include <deal.II/base/parameter_handler.h>

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
