// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/stokes_assembler.h>
#include <gemmule/parameters/discretisation.h>
#include <gemmule/parameters/fluid.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

template <int dim>
StokesAssembler<dim>::StokesAssembler(const UnfittedStokesSpace<dim> &space, const Parameters::Fluid &fluid,
                                      const Parameters::Flow &discretisation)
    : space(space), pair(fluid.viscosity_ratio), reference(discretisation),
      cut_cell_matrix(pair, discretisation.nitsche_penalty)
{
}

template <int dim>
void StokesAssembler<dim>::add_elements(const CutGeometry<dim> &geometry, LinearSystem &system)
{
  add_cell_elements(geometry, system);
  add_face_elements(geometry, system);
}

template <int dim>
void StokesAssembler<dim>::assemble(const CutGeometry<dim> &geometry, LinearSystem &system,
                                    LinearSystem::Vector &right_side)
{
  system.zero_matrix();
  // Faces with their cells, as long as the rows of the matrix are in the cache.
  auto face = faces.begin();
  for (const StokesCellElement &cell : cells)
  {
    add_cell_matrix(cell, geometry, system, right_side);
    for (; face != faces.end() && face->face->first == cell.cell; ++face)
      add_face_matrices(*face, system, right_side);
  }
  Assert(face == faces.end(), ExcMessage("Faces must have the order of the cells."));
}

template <int dim>
void StokesAssembler<dim>::add_cell_elements(const CutGeometry<dim> &geometry, LinearSystem &system)
{
  cells.clear();
  cut_elements.clear();
  cut_indices.clear();
  for (const unsigned int cell : space.owned_cells())
  {
    const CellLocation location = geometry.location(cell);
    CondensedIndices indices;
    for (unsigned int fluid = 0; fluid < 2; ++fluid)
      if (geometry.is_active(cell, fluid))
        space.active_dofs(fluid).append(space.cell_dofs(cell), indices);
    indices.sort();
    if (location == CellLocation::cut)
      cut_indices.push_back(indices);
    cells.push_back({cell, system.add_element(std::move(indices)), location});
    if (location == CellLocation::cut)
      cut_elements.push_back(cells.back().element);
  }
  AssertDimension(cut_elements.size(), geometry.cut_cells().size());
}

template <int dim>
void StokesAssembler<dim>::add_face_elements(const CutGeometry<dim> &geometry, LinearSystem &system)
{
  faces.clear();
  std::vector<types::global_dof_index> dofs;
  const auto add_element = [&](const InteriorFace &face, const unsigned int fluid, const unsigned int begin,
                               const unsigned int end)
  {
    dofs.clear();
    for (const unsigned int cell : {face.first, face.second})
      dofs.insert(dofs.end(), space.cell_dofs(cell).begin() + begin, space.cell_dofs(cell).begin() + end);
    CondensedIndices indices;
    space.active_dofs(fluid).append(dofs, indices);
    indices.sort();
    return system.add_element(std::move(indices));
  };

  for (const InteriorFace &face : space.interior_faces())
  {
    if (geometry.location(face.first) != CellLocation::cut &&
        geometry.location(face.second) != CellLocation::cut)
      continue;
    for (unsigned int fluid = 0; fluid < 2; ++fluid)
      if (geometry.is_active(face.first, fluid) && geometry.is_active(face.second, fluid))
      {
        faces.push_back({&face, fluid, system.n_elements()});
        for (unsigned int c = 0; c < dim; ++c)
          add_element(face, fluid, Layout::velocity(c, 0), Layout::velocity(c + 1, 0));
        add_element(face, fluid, Layout::pressure(0), Layout::n);
      }
  }
}

template <int dim>
void StokesAssembler<dim>::add_cell_matrix(const StokesCellElement &cell, const CutGeometry<dim> &geometry,
                                           LinearSystem &system, LinearSystem::Vector &rhs)
{
  const FullMatrix<double> *matrix = &cut_matrix;
  if (cell.location == CellLocation::cut)
    cut_cell_matrix.compute(*geometry.find(cell.cell), cut_matrix);
  else
    matrix = &uncut_cell_matrix(cell.cell, cell.location == CellLocation::inside ? 0 : 1);
  system.add_matrix(cell.element, *matrix);
  system.add_inhomogeneity(cell.element, *matrix, rhs);
}

template <int dim>
void StokesAssembler<dim>::add_face_matrices(const FaceElement &face, LinearSystem &system,
                                             LinearSystem::Vector &rhs)
{
  const GhostPenaltyMatrices &unit = reference.face(face.face->face_number, face.face->refinement);
  const double h = space.cell_size(face.face->first);
  const double viscosity = pair.viscosity[face.fluid];
  const double velocity_factor = viscosity * std::pow(h, dim - 2);
  const double pressure_factor = -std::pow(h, dim) / viscosity;
  for (unsigned int c = 0; c <= dim; ++c)
  {
    const FullMatrix<double> &matrix = c < dim ? unit.velocity : unit.pressure;
    const double factor = c < dim ? velocity_factor : pressure_factor;
    system.add_matrix(face.first_element + c, matrix, factor);
    system.add_inhomogeneity(face.first_element + c, matrix, rhs, factor);
  }
}

template <int dim>
const FullMatrix<double> &StokesAssembler<dim>::uncut_cell_matrix(const unsigned int cell,
                                                                  const unsigned int fluid)
{
  auto &matrix = uncut_matrices[fluid][space.cell_level(cell)];
  if (matrix.empty())
    matrix = reference.cell(pair.viscosity[fluid], space.cell_size(cell));
  return matrix;
}

template class StokesAssembler<2>;
template class StokesAssembler<3>;
} // namespace Gemmule
