// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/parameters/domain.h>
#include <gemmule/parameters/section.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/point.h>

#include <cmath>

namespace Gemmule::Parameters
{
namespace
{
  constexpr double smallest_edge = 1e-6, largest_edge = 1e6, largest_aspect_ratio = 1000.;

  template <int dim>
  dealii::Point<dim> to_point(const std::vector<double> &values)
  {
    AssertDimension(values.size(), dim);
    dealii::Point<dim> point;
    for (unsigned int d = 0; d < dim; ++d)
      point[d] = values[d];
    return point;
  }
} // namespace

void Domain::add_parameters(dealii::ParameterHandler &prm)
{
  Section section(prm, {"Domain"});
  section.add("Lower corner", lower_corner,
              "Smallest coordinates of the box, one number per direction (dimensionless length).",
              Range::any(), 2);
  section.add(
      "Upper corner", upper_corner,
      "Largest coordinates of the box, one number per direction (dimensionless length). The cells are "
      "cubes, so each edge of the box has to be a multiple of the shortest one.",
      Range::any(), 2);
  section.add(
      "Boundary velocity", boundary_velocity,
      "Velocity of the fluid at the walls (dimensionless), one expression in x, y(, z) and t per "
      "direction, separated by semicolons; for example '0.5*y; 0' for a shear flow. Its net flux through "
      "the walls has to vanish.",
      "expressions separated by semicolons");
}

void Domain::check() const
{
  Domain copy(*this);
  dealii::ParameterHandler prm;
  copy.add_parameters(prm);

  if (lower_corner.size() != upper_corner.size())
    throw ParameterError("Domain/Upper corner", "has " + std::to_string(upper_corner.size()) +
                                                    " numbers, but 'Lower corner' has " +
                                                    std::to_string(lower_corner.size()) + ".");
  for (unsigned int d = 0; d < lower_corner.size(); ++d)
    if (!(upper_corner[d] > lower_corner[d]))
      throw ParameterError("Domain/Upper corner",
                           "each number has to be larger than that of 'Lower corner', but " +
                               to_text(upper_corner[d]) + " <= " + to_text(lower_corner[d]) +
                               ". Move one of the corners.");
  for (unsigned int d = 0; d < lower_corner.size(); ++d)
  {
    // Coordinates must tell the nodes of the finest cells apart, and powers of their sizes must be numbers.
    const double edge = upper_corner[d] - lower_corner[d];
    const double coordinate = std::max(std::abs(lower_corner[d]), std::abs(upper_corner[d]));
    if (!(edge >= smallest_edge && edge <= largest_edge && edge >= 1e-4 * coordinate))
      throw ParameterError("Domain/Upper corner",
                           "edge " + std::to_string(d + 1) + " of the box is " + to_text(edge) + ", from " +
                               to_text(lower_corner[d]) + " to " + to_text(upper_corner[d]) +
                               ". Lengths are in units of the vesicle's: choose an edge between " +
                               to_text(smallest_edge) + " and " + to_text(largest_edge) +
                               " that is not tiny against the coordinates.");
  }
  for (unsigned int d = 0; d < lower_corner.size(); ++d)
  {
    const double ratio = (upper_corner[d] - lower_corner[d]) / shortest_edge();
    if (std::abs(ratio - std::round(ratio)) > 1e-6 * ratio)
      throw ParameterError(
          "Domain/Upper corner",
          "the cells are cubes, so each edge of the box has to be a multiple of the shortest "
          "one, but edge " +
              std::to_string(d + 1) + " is " + to_text(upper_corner[d] - lower_corner[d]) +
              " and the shortest " + to_text(shortest_edge()) + ". Move one of the corners.");
    if (ratio > largest_aspect_ratio)
      throw ParameterError("Domain/Upper corner", "edge " + std::to_string(d + 1) + " of the box is " +
                                                      to_text(std::round(ratio)) +
                                                      " times as long as the shortest one; at most " +
                                                      to_text(largest_aspect_ratio) +
                                                      " times is possible. Move one of the corners.");
  }
}

double Domain::shortest_edge() const
{
  double shortest = std::numeric_limits<double>::max();
  for (unsigned int d = 0; d < lower_corner.size(); ++d)
    shortest = std::min(shortest, upper_corner[d] - lower_corner[d]);
  return shortest;
}

double Domain::cell_size(const unsigned int level) const
{
  return std::ldexp(shortest_edge(), -static_cast<int>(level));
}

std::vector<unsigned int> Domain::coarse_cells() const
{
  std::vector<unsigned int> cells;
  for (unsigned int d = 0; d < lower_corner.size(); ++d)
    cells.push_back(std::lround((upper_corner[d] - lower_corner[d]) / shortest_edge()));
  return cells;
}

template <int dim>
dealii::Point<dim> Domain::lower() const
{
  return to_point<dim>(lower_corner);
}

template <int dim>
dealii::Point<dim> Domain::upper() const
{
  return to_point<dim>(upper_corner);
}

template dealii::Point<2> Domain::lower<2>() const;
template dealii::Point<3> Domain::lower<3>() const;
template dealii::Point<2> Domain::upper<2>() const;
template dealii::Point<3> Domain::upper<3>() const;
} // namespace Gemmule::Parameters
