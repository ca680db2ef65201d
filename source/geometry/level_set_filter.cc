// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/geometry/level_set_filter.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  constexpr unsigned int n_derivatives = 2;
  // A bubble in one direction has the eigenvalue 2 omega, a product of them that for each direction: 1.5 in
  // 3D, and from 2 on sweeps would cease to be stable.
  constexpr double relaxation = 0.25;
  constexpr double largest_jump = 0.5;
  // The cubic that vanishes at the ends and in the middle, at the nodes of Gauss-Lobatto.
  constexpr std::array<double, 4> bubble = {{0., 1., -1., 0.}};

  /** Neighbors of the same size, and twice as large with the cell in each of the places along the face. */
  template <int dim>
  constexpr unsigned int n_positions_per_face = 1 + GeometryInfo<dim>::max_children_per_face;
} // namespace

template <int dim>
LevelSetFilter<dim>::LevelSetFilter(const DoFHandler<dim> &dofs, const std::vector<unsigned int> &node_to_dof)
    : dof_handler(dofs), node_to_dof(node_to_dof)
{
  for (unsigned int face = 0; face < GeometryInfo<dim>::faces_per_cell; ++face)
    for (unsigned int place = 0; place < n_positions_per_face<dim>; ++place)
    {
      const unsigned int normal = face / 2;
      FacePosition position;
      position.face = face;
      position.size_ratio = place == 0 ? 1. : 0.5;
      for (unsigned int d = 0, bit = 0; d < dim; ++d)
        if (d == normal)
          position.corner_in_neighbor[d] = face % 2 == 0 ? 1. : -position.size_ratio;
        else
          position.corner_in_neighbor[d] = place == 0 ? 0. : 0.5 * (((place - 1) >> bit++) & 1);
      jumps.push_back(make_jumps(position));
    }
}

template <int dim>
std::vector<typename LevelSetFilter<dim>::Jump> LevelSetFilter<dim>::make_jumps(const FacePosition &position)
{
  constexpr unsigned int n_points = dim == 2 ? 4 : 16;
  const unsigned int normal = position.face / 2, side = position.face % 2;
  // Nodes along the normal are this far apart in lexicographic order.
  const unsigned int stride = normal == 0 ? 1 : (normal == 1 ? 4 : 16);
  const double ratio = position.size_ratio;
  std::vector<Jump> result;
  for (unsigned int q = 0; q < n_points; ++q)
  {
    Point<dim> point;
    double share = 1.; // a node of an edge belongs to two faces
    for (unsigned int d = 0, rest = q; d < dim; ++d)
      if (d == normal)
        point[d] = side;
      else
      {
        point[d] = Basis::nodes()[rest % 4];
        share *= rest % 4 == 0 || rest % 4 == 3 ? 0.5 : 1.;
        rest /= 4;
      }
    typename Basis::Values values;
    std::array<typename Basis::Gradients, 2> gradients;
    std::array<typename Basis::Hessians, 2> hessians;
    Basis::evaluate(point, values, gradients[0], hessians[0]);
    Basis::evaluate(position.corner_in_neighbor + ratio * point, values, gradients[1], hessians[1]);

    for (unsigned int order = 1; order <= n_derivatives; ++order)
    {
      Jump jump;
      double norm_square = 0.;
      for (unsigned int cell = 0; cell < 2; ++cell)
      {
        const double scale = cell == 0 ? 1. : -std::pow(ratio, order), mass = cell == 0 ? 1. : 1. / ratio;
        std::array<double, Basis::n> functional;
        for (unsigned int i = 0; i < Basis::n; ++i)
        {
          functional[i] =
              scale * (order == 1 ? gradients[cell][i][normal] : hessians[cell][i][normal][normal]);
          if (std::abs(functional[i]) > 1e-10)
            jump.functional.push_back({cell == 1, i, functional[i]});
        }
        for (unsigned int line = 0; line < Basis::n; ++line)
          if ((line / stride) % 4 == 0)
          {
            double of_bubble = 0.;
            for (unsigned int k = 0; k < 4; ++k)
              of_bubble += functional[line + k * stride] * bubble[k];
            if (std::abs(of_bubble) < 1e-10)
              continue;
            norm_square += of_bubble * of_bubble / mass;
            for (unsigned int k = 1; k < 3; ++k)
              jump.correction.push_back({cell == 1, line + k * stride, of_bubble * bubble[k] / mass});
          }
      }
      for (Entry &entry : jump.correction)
        entry.factor *= -share * relaxation / norm_square;
      result.push_back(std::move(jump));
    }
  }
  return result;
}

template <int dim>
unsigned int LevelSetFilter<dim>::position_index(const CellIterator &cell, const unsigned int face,
                                                 const CellIterator &neighbor)
{
  unsigned int place = 0;
  if (neighbor->level() < cell->level())
  {
    const Tensor<1, dim> offset = cell->vertex(0) - neighbor->vertex(0);
    place = 1;
    for (unsigned int d = 0, bit = 0; d < dim; ++d)
      if (d != face / 2)
        place += (offset[d] > 0.25 * neighbor->extent_in_direction(0) ? 1u : 0u) << bit++;
  }
  return face * n_positions_per_face<dim> + place;
}

template <int dim>
typename LevelSetFilter<dim>::CellValues LevelSetFilter<dim>::read(const CellIterator &cell,
                                                                   const Vector &phi) const
{
  CellValues result;
  std::vector<types::global_dof_index> dofs(Basis::n);
  cell->get_dof_indices(dofs);
  for (unsigned int i = 0; i < Basis::n; ++i)
  {
    result.dofs[i] = dofs[node_to_dof[i]];
    result.phi[i] = phi(result.dofs[i]);
  }
  return result;
}

template <int dim>
std::vector<bool> LevelSetFilter<dim>::find_cut_cells(const Vector &phi,
                                                      const std::vector<bool> &candidates) const
{
  std::vector<bool> is_cut(candidates.size(), false);
  for (const auto &cell : dof_handler.active_cell_iterators())
    if (!cell->is_artificial() && candidates[cell->active_cell_index()])
    {
      const auto values = read(cell, phi).phi;
      const auto is_negative = [](const double value) { return value < 0.; };
      is_cut[cell->active_cell_index()] = std::any_of(values.begin(), values.end(), is_negative) &&
                                          !std::all_of(values.begin(), values.end(), is_negative);
    }
  return is_cut;
}

template <int dim>
void LevelSetFilter<dim>::sweep(Vector &phi, const std::vector<bool> &candidates) const
{
  const std::vector<bool> is_cut = find_cut_cells(phi, candidates);
  Vector change;
  change.reinit(phi);
  for (const auto &cell : dof_handler.active_cell_iterators())
  {
    if (!cell->is_locally_owned())
      continue;
    for (unsigned int face = 0; face < GeometryInfo<dim>::faces_per_cell; ++face)
    {
      if (cell->at_boundary(face) || cell->neighbor(face)->has_children())
        continue; // done by the smaller cells
      const CellIterator neighbor = cell->neighbor(face);
      if (neighbor->level() == cell->level() && neighbor->id() < cell->id())
        continue; // done by the other one
      if (!is_cut[cell->active_cell_index()] && !is_cut[neighbor->active_cell_index()])
        continue;
      if (!candidates[cell->active_cell_index()] || !candidates[neighbor->active_cell_index()])
        continue; // there is no accurate value to compare with
      const CellValues here = read(cell, phi), there = read(neighbor, phi);
      const double size = cell->extent_in_direction(0);
      for (const Jump &jump : jumps[position_index(cell, face, neighbor)])
      {
        double value = 0.;
        for (const Entry &entry : jump.functional)
          value += entry.factor * (entry.is_of_neighbor ? there : here).phi[entry.node];
        value /= 1. + std::pow(value / (largest_jump * size), 4);
        for (const Entry &entry : jump.correction)
          change((entry.is_of_neighbor ? there : here).dofs[entry.node]) += entry.factor * value;
      }
    }
  }
  change.compress(VectorOperation::add);
  phi.zero_out_ghost_values();
  phi += change;
}

template class LevelSetFilter<2>;
template class LevelSetFilter<3>;
} // namespace Gemmule
