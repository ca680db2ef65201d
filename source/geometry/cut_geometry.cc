// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/geometry/cell_level_set.h>
#include <gemmule/geometry/cut_geometry.h>
#include <gemmule/geometry/cut_quadrature.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/non_matching/quadrature_generator.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  /** Bounds a cubic polynomial on the unit cell by its Bernstein coefficients. */
  template <int dim>
  class BernsteinBounds
  {
  public:
    BernsteinBounds() : to_bernstein(4, 4)
    {
      FullMatrix<double> bernstein_at_nodes(4, 4);
      constexpr auto t = TensorLagrange<dim, 3>::nodes();
      for (unsigned int i = 0; i < 4; ++i)
      {
        const double x = t[i], y = 1. - x;
        bernstein_at_nodes(i, 0) = y * y * y;
        bernstein_at_nodes(i, 1) = 3. * x * y * y;
        bernstein_at_nodes(i, 2) = 3. * x * x * y;
        bernstein_at_nodes(i, 3) = x * x * x;
      }
      to_bernstein.invert(bernstein_at_nodes);
    }

    /** Smallest and largest coefficient. */
    std::pair<double, double> operator()(typename TensorLagrange<dim, 3>::Values u) const
    {
      for (unsigned int d = 0, stride = 1; d < dim; ++d, stride *= 4)
        for (unsigned int i = 0; i < u.size(); ++i)
          if ((i / stride) % 4 == 0)
          {
            std::array<double, 4> line;
            for (unsigned int k = 0; k < 4; ++k)
            {
              line[k] = 0.;
              for (unsigned int l = 0; l < 4; ++l)
                line[k] += to_bernstein(k, l) * u[i + l * stride];
            }
            for (unsigned int k = 0; k < 4; ++k)
              u[i + k * stride] = line[k];
          }
      const auto bounds = std::minmax_element(u.begin(), u.end());
      return {*bounds.first, *bounds.second};
    }

  private:
    FullMatrix<double> to_bernstein;
  };

  /** The cell with the rules of @p generator, which are for the cell of size one, as is @p unit_level_set. */
  template <int dim>
  CutCell<dim> make_cut_cell(const typename DoFHandler<dim>::active_cell_iterator &cell,
                             const CellLevelSet<dim> &unit_level_set,
                             const NonMatching::QuadratureGenerator<dim> &generator)
  {
    const double h = cell->extent_in_direction(0);
    const auto &inside = generator.get_inside_quadrature();
    const auto &outside = generator.get_outside_quadrature();
    const auto &surface = generator.get_surface_quadrature();
    CutCell<dim> cut;
    cut.active_cell_index = cell->active_cell_index();
    cut.corner = cell->vertex(0);
    cut.size = h;
    cut.bulk_points = {{inside.get_points(), outside.get_points()}};
    cut.bulk_weights = {{inside.get_weights(), outside.get_weights()}};
    for (auto &weights : cut.bulk_weights)
      for (double &weight : weights)
        weight *= std::pow(h, dim);
    cut.surface_points = surface.get_points();
    cut.surface_weights = surface.get_weights();
    for (double &weight : cut.surface_weights)
      weight *= std::pow(h, dim - 1);
    for (const Point<dim> &point : cut.surface_points)
    {
      const auto gradient = unit_level_set.gradient(point);
      cut.normals.push_back(gradient / gradient.norm());
    }
    return cut;
  }
} // namespace

template <int dim>
CutGeometry<dim>::CutGeometry(const unsigned int n_gauss_points) : n_gauss_points(n_gauss_points)
{
}

template <int dim>
void CutGeometry<dim>::reinit(const DoFHandler<dim> &dof_handler, const Vector &level_set)
{
  const auto &triangulation = dof_handler.get_triangulation();
  locations.assign(triangulation.n_active_cells(), CellLocation::outside);
  cut_cell_of.assign(triangulation.n_active_cells(), -1);
  cells.clear();

  static const BernsteinBounds<dim> bernstein_bounds;
  const auto node_to_dof = lexicographic_cell_dofs(dof_handler.get_fe());
  const hp::QCollection<1> gauss{QGauss<1>(n_gauss_points)};
  NonMatching::QuadratureGenerator<dim> generator(gauss);
  const BoundingBox<dim> box = unit_box<dim>();

  CellLevelSet<dim> cell_level_set;
  std::vector<types::global_dof_index> dofs(dof_handler.get_fe().n_dofs_per_cell());
  double local_measure = 0., local_volume = 0.;
  bool is_resolved = true;
  for (const auto &cell : dof_handler.active_cell_iterators())
  {
    if (cell->is_artificial())
      continue;
    const unsigned int index = cell->active_cell_index();
    const double h = cell->extent_in_direction(0);
    cell->get_dof_indices(dofs);
    for (unsigned int i = 0; i < cell_level_set.nodal.size(); ++i)
      cell_level_set.nodal[i] = off_zero(level_set(dofs[node_to_dof[i]]), h);

    const auto bounds = bernstein_bounds(cell_level_set.nodal);
    if (bounds.first > 0. || bounds.second < 0.)
      locations[index] = bounds.first > 0. ? CellLocation::outside : CellLocation::inside;
    else
    {
      // The rules are for unit-size polynomials: scale, so that the generator's tolerances are relative to h.
      const auto nodal = cell_level_set.nodal;
      for (auto &value : cell_level_set.nodal)
        value /= h;
      if (!generate_cut_quadrature(generator, cell_level_set, box))
      {
        is_resolved = false; // the other ranks have to know before anything is thrown
        continue;
      }
      if (generator.get_surface_quadrature().size() == 0)
        locations[index] =
            generator.get_inside_quadrature().size() > 0 ? CellLocation::inside : CellLocation::outside;
      else
      {
        locations[index] = CellLocation::cut;
        if (cell->is_locally_owned())
        {
          cut_cell_of[index] = cells.size();
          cells.push_back(make_cut_cell<dim>(cell, cell_level_set, generator));
          CutCell<dim> &cut = cells.back();
          cut.level_set = nodal;
          for (const double weight : cut.surface_weights)
            local_measure += weight;
          for (const double weight : cut.bulk_weights[0])
            local_volume += weight;
        }
      }
    }
    if (cell->is_locally_owned() && locations[index] == CellLocation::inside)
      local_volume += std::pow(h, dim);
  }
  const MPI_Comm communicator = dof_handler.get_communicator();
  if (Utilities::MPI::min(static_cast<int>(is_resolved), communicator) == 0)
    throw StepBreakdown("The membrane is torn: its shape within a cell cannot be resolved.");
  total_measure = Utilities::MPI::sum(local_measure, communicator);
  total_enclosed_volume = Utilities::MPI::sum(local_volume, communicator);
}

template class CutGeometry<2>;
template class CutGeometry<3>;
} // namespace Gemmule
