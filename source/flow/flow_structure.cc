// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/flow_structure.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <algorithm>
#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  using Index = FlowStructure::Index;
  using PressureWeights = std::vector<std::pair<Index, double>>;

  template <int dim>
  class StructureFinder
  {
  public:
    using Layout = StokesLayout<dim>;

    StructureFinder(const UnfittedStokesSpace<dim> &space, const CutGeometry<dim> &geometry,
                    const FluidPair &fluids, const LinearSystem &system, FlowStructure &structure)
        : space(space), geometry(geometry), fluids(fluids), system(system),
          owned(system.numbering().locally_owned()), structure(structure)
    {
    }

    void find()
    {
      structure.n_components = dim;
      find_nodes();
      find_prolongation();
      find_pressure_mass();
    }

  private:
    using Node = std::array<Index, dim>;

    /** action(cell, fluid, i, number) for all velocity unknowns of the first component that this rank owns;
     * often several times for each. */
    template <typename Action>
    void for_owned_nodes(const Action &action) const
    {
      for (const unsigned int cell : space.owned_cells())
        for (unsigned int fluid = 0; fluid < 2; ++fluid)
          for (unsigned int i = 0; i < Layout::n_velocity_nodes; ++i)
          {
            const Index number =
                space.active_dofs(fluid).number(space.cell_dofs(cell)[Layout::velocity(0, i)]);
            if (number != dealii::numbers::invalid_dof_index && owned.is_element(number))
              action(cell, fluid, i, number);
          }
    }

    void find_nodes()
    {
      for_owned_nodes(
          [&](const unsigned int cell, const unsigned int fluid, const unsigned int i, Index)
          {
            Node node;
            for (unsigned int c = 0; c < dim; ++c)
              node[c] = space.active_dofs(fluid).number(space.cell_dofs(cell)[Layout::velocity(c, i)]);
            nodes.push_back(node);
          });
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      AssertThrow(nodes.size() * dim == system.numbering().locally_owned(velocity_block).n_elements(),
                  ExcMessage("A velocity unknown lacks a partner in another component."));
      for (const auto &node : nodes)
        structure.node_unknowns.insert(structure.node_unknowns.end(), node.begin(), node.end());
      structure.owned_nodes = own_range(nodes.size());
    }

    /** This rank's range of a numbering of its own, rank by rank. */
    IndexSet own_range(const unsigned int n) const
    {
      const MPI_Comm communicator = space.communicator();
      return UnknownPartition(std::vector<Index>(1, n), communicator)
          .owned(Utilities::MPI::this_mpi_process(communicator));
    }

    /** Pressure unknowns at the walls that this rank owns or meets, ascending. */
    std::vector<Index> wall_pressures() const
    {
      std::vector<Index> at_walls;
      for (const auto &cell : space.dof_handler().active_cell_iterators())
        if (!cell->is_artificial() && cell->at_boundary())
          for (const unsigned int face : cell->face_indices())
            if (cell->at_boundary(face))
              for (unsigned int v = 0; v < GeometryInfo<dim>::vertices_per_face; ++v)
              {
                const unsigned int j = GeometryInfo<dim>::face_to_cell_vertices(face, v);
                const auto dof = space.cell_dofs(cell->active_cell_index())[Layout::pressure(j)];
                for (unsigned int fluid = 0; fluid < 2; ++fluid)
                  if (const Index number = space.active_dofs(fluid).number(dof);
                      number != dealii::numbers::invalid_dof_index)
                    at_walls.push_back(number);
              }
      std::sort(at_walls.begin(), at_walls.end());
      return at_walls;
    }

    /** The linear function through the vertices of a cell at node @p i, by the pressure unknowns. */
    PressureWeights interpolate(const unsigned int cell, const unsigned int fluid, const unsigned int i) const
    {
      typename Layout::PressureBasis::Values values;
      Layout::PressureBasis::evaluate(Layout::VelocityBasis::node(i), values);
      // The others need not be active: the cell may have the node for the sake of a hanging one alone.
      std::vector<types::global_dof_index> dofs;
      std::vector<double> weights;
      for (unsigned int j = 0; j < Layout::n_pressure_nodes; ++j)
        if (std::abs(values[j]) > 1e-12)
        {
          dofs.push_back(space.cell_dofs(cell)[Layout::pressure(j)]);
          weights.push_back(values[j]);
        }
      CondensedIndices condensed;
      space.active_dofs(fluid).append(dofs, condensed);
      PressureWeights result;
      for (unsigned int l = 0; l < weights.size(); ++l)
        for (unsigned int k = condensed.row_start[l]; k < condensed.row_start[l + 1]; ++k)
          result.emplace_back(condensed.indices[condensed.entries[k].first],
                              weights[l] * condensed.entries[k].second);
      return result;
    }

    void find_prolongation()
    {
      std::vector<PressureWeights> rows(nodes.size());
      std::vector<Index> ghosts;
      for_owned_nodes(
          [&](const unsigned int cell, const unsigned int fluid, const unsigned int i, const Index number)
          {
            auto &row = rows[std::lower_bound(nodes.begin(), nodes.end(), number,
                                              [](const Node &node, const Index n) { return node[0] < n; }) -
                             nodes.begin()];
            if (!row.empty())
              return;
            row = interpolate(cell, fluid, i);
            for (const auto &entry : row)
              if (!owned.is_element(entry.first))
                ghosts.push_back(entry.first);
          });

      // Which vertices have a column, and which, their owners know.
      std::sort(ghosts.begin(), ghosts.end());
      ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
      IndexSet ghost_set(owned.size());
      ghost_set.add_indices(ghosts.begin(), ghosts.end());
      LinearAlgebra::distributed::Vector<double> column(owned, ghost_set, space.communicator());
      const auto at_walls = wall_pressures();
      std::vector<Index> with_column;
      for (const auto number : system.numbering().locally_owned(pressure_block))
        if (!std::binary_search(at_walls.begin(), at_walls.end(), number))
          with_column.push_back(number);
      const IndexSet owned_columns = own_range(with_column.size());
      column = -1.;
      for (unsigned int k = 0; k < with_column.size(); ++k)
        column(with_column[k]) = owned_columns.nth_index_in_set(k);
      column.update_ghost_values();

      TrilinosWrappers::SparsityPattern pattern(structure.owned_nodes, owned_columns, space.communicator());
      const auto for_all_entries = [&](const auto &action)
      {
        for (unsigned int k = 0; k < rows.size(); ++k)
          for (const auto &[number, weight] : rows[k])
            if (column(number) >= 0.)
              action(structure.owned_nodes.nth_index_in_set(k), static_cast<Index>(column(number)), weight);
      };
      for_all_entries([&](const Index row, const Index vertex, double) { pattern.add(row, vertex); });
      pattern.compress();
      structure.prolongation.reinit(pattern);
      for_all_entries([&](const Index row, const Index vertex, const double weight)
                      { structure.prolongation.add(row, vertex, weight); });
      structure.prolongation.compress(VectorOperation::add);
    }

    /** int psi_i psi_j over the part of the cell that the fluid occupies. */
    void local_mass(const unsigned int cell, const unsigned int fluid, FullMatrix<double> &mass) const
    {
      mass = 0.;
      typename Layout::PressureBasis::Values psi;
      const auto add = [&](const Point<dim> &point, const double weight)
      {
        Layout::PressureBasis::evaluate(point, psi);
        for (unsigned int i = 0; i < psi.size(); ++i)
          for (unsigned int j = 0; j < psi.size(); ++j)
            mass(i, j) += weight * psi[i] * psi[j];
      };
      if (geometry.location(cell) == CellLocation::cut)
      {
        const CutCell<dim> &cut = *geometry.find(cell);
        for (unsigned int q = 0; q < cut.bulk_points[fluid].size(); ++q)
          add(cut.bulk_points[fluid][q], cut.bulk_weights[fluid][q]);
      }
      else
        for (unsigned int q = 0; q < quadrature.size(); ++q)
          add(quadrature.point(q), quadrature.weight(q) * std::pow(space.cell_size(cell), dim));
    }

    void find_pressure_mass()
    {
      const auto &partitioner = system.matrix().partitioner();
      std::vector<CondensedIndices> elements;
      for_fluids_of_cells(
          [&](const unsigned int cell, const unsigned int fluid)
          {
            const auto begin = space.cell_dofs(cell).begin() + Layout::pressure(0);
            CondensedIndices element;
            space.active_dofs(fluid).append({begin, begin + Layout::n_pressure_nodes}, element);
            for (auto &index : element.indices)
              index = partitioner->global_to_local(index);
            element.sort();
            elements.push_back(std::move(element));
          });
      structure.pressure_mass.reinit(partitioner, elements);

      unsigned int e = 0;
      FullMatrix<double> mass(Layout::n_pressure_nodes);
      for_fluids_of_cells(
          [&](const unsigned int cell, const unsigned int fluid)
          {
            local_mass(cell, fluid, mass);
            mass /= fluids.viscosity[fluid];
            structure.pressure_mass.add(elements[e++], mass);
          });
    }

    template <typename Action>
    void for_fluids_of_cells(const Action &action) const
    {
      for (const unsigned int cell : space.owned_cells())
        for (unsigned int fluid = 0; fluid < 2; ++fluid)
          if (geometry.is_active(cell, fluid))
            action(cell, fluid);
    }

    const UnfittedStokesSpace<dim> &space;
    const CutGeometry<dim> &geometry;
    const FluidPair &fluids;
    const LinearSystem &system;
    const IndexSet owned;
    const QGauss<dim> quadrature{2};
    std::vector<Node> nodes; ///< owned ones, ascending
    FlowStructure &structure;
  };
} // namespace

template <int dim>
std::unique_ptr<FlowStructure> find_flow_structure(const UnfittedStokesSpace<dim> &space,
                                                   const CutGeometry<dim> &geometry, const FluidPair &fluids,
                                                   const LinearSystem &system)
{
  auto structure = std::make_unique<FlowStructure>();
  StructureFinder<dim>(space, geometry, fluids, system, *structure).find();
  return structure;
}

template std::unique_ptr<FlowStructure> find_flow_structure(const UnfittedStokesSpace<2> &,
                                                            const CutGeometry<2> &, const FluidPair &,
                                                            const LinearSystem &);
template std::unique_ptr<FlowStructure> find_flow_structure(const UnfittedStokesSpace<3> &,
                                                            const CutGeometry<3> &, const FluidPair &,
                                                            const LinearSystem &);
} // namespace Gemmule
