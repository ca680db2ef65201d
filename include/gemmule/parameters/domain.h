// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace dealii
{
class ParameterHandler;
template <int dim, typename Number>
class Point;
} // namespace dealii

namespace Gemmule::Parameters
{
/** Section "Domain": the box that holds the fluids and the velocity at its walls. */
struct Domain
{
  /** Corners of the box, one number per direction (dimensionless lengths). */
  std::vector<double> lower_corner = {-1., -1.};
  std::vector<double> upper_corner = {1., 1.};
  /** u_infinity(x, y(, z), t) on the walls, components separated by ";". The default is "0; 0". */
  std::string boundary_velocity = "0; 0";

  void add_parameters(dealii::ParameterHandler &prm);
  /** @throws ParameterError unless upper > lower and the edges are multiples of the shortest one */
  void check() const;

  /** Number of cubes of the coarse mesh in each direction: edge divided by the shortest edge. */
  std::vector<unsigned int> coarse_cells() const;
  /** Length of the shortest edge. */
  double shortest_edge() const;
  /** Edge of the cells of a level of the mesh. */
  double cell_size(unsigned int level) const;
  /** The corners as points; the number of values has to be dim. */
  template <int dim>
  dealii::Point<dim, double> lower() const;
  template <int dim>
  dealii::Point<dim, double> upper() const;
};
} // namespace Gemmule::Parameters
