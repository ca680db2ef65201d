// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/gather.h>
#include <gemmule/mesh/membrane_search.h>
#include <gemmule/parameters/expression.h>

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <optional>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // So many undecided cubes of one level are halved on the word of the bounds alone. A membrane that the mesh
  // can have leaves fewer.
  constexpr std::size_t most_undecided_cubes = 100000;
  // The same below the level of the membrane, where only those are left in which a closed part could hide.
  constexpr std::size_t most_hiding_places = 20000;

  // Intervals per direction of the samples: in cubes that hold a graph, where samples alone decide, and in
  // the smallest cubes.
  constexpr unsigned int few_samples = 2, deciding_samples = 4;
  template <int dim>
  constexpr unsigned int many_samples = dim == 2 ? 8 : 4;

  // Of the direction of the gradient in a cube, FunctionBounds::variation_of_direction().
  constexpr double largest_variation = 0.3;

  // Half-width, in edges of the cube, to which a change of sign is narrowed down.
  constexpr double root_tolerance = 1e-13;
  constexpr std::size_t most_root_iterations = 200;

  template <int dim>
  unsigned int power(const unsigned int n)
  {
    return dim == 2 ? n * n : n * n * n;
  }
} // namespace

template <int dim>
struct MembraneSearch<dim>::Samples
{
  unsigned int n;
  std::vector<Point<dim>> points;
  std::vector<double> values;

  using Neighbours = std::pair<unsigned int, unsigned int>;

  /** Indices of all neighbours on the lattice of which the first is negative and the second is not. */
  std::vector<Neighbours> sign_changes() const
  {
    std::vector<Neighbours> found;
    for (unsigned int i = 0; i < points.size(); ++i)
      for (unsigned int d = 0, stride = 1; d < dim; ++d, stride *= n + 1)
        if ((i / stride) % (n + 1) < n && (values[i] < 0.) != (values[i + stride] < 0.))
          found.push_back(values[i] < 0. ? Neighbours(i, i + stride) : Neighbours(i + stride, i));
    return found;
  }

  /** Those that are nearest to the centre. */
  std::vector<Neighbours> central_sign_change() const
  {
    const Point<dim> center = points.front() + 0.5 * (points.back() - points.front());
    const auto distance = [&](const Neighbours &pair)
    { return center.distance(points[pair.first] + 0.5 * (points[pair.second] - points[pair.first])); };
    const std::vector<Neighbours> all = sign_changes();
    if (all.empty())
      return all;
    return {*std::min_element(all.begin(), all.end(),
                              [&](const Neighbours &a, const Neighbours &b)
                              { return distance(a) < distance(b); })};
  }
};

template <int dim>
MembraneSearch<dim>::MembraneSearch(const Function<dim> &function, Bounds bounds, const BoxLattice<dim> &box,
                                    const Levels &levels, const std::size_t largest_number_of_cells)
    : function(function), bounds(std::move(bounds)), box(box), levels(levels),
      largest_number_of_cells(largest_number_of_cells)
{
}

template <int dim>
typename MembraneSearch<dim>::Samples MembraneSearch<dim>::sample(const Point<dim> &corner, const double size,
                                                                  const unsigned int n) const
{
  Samples samples;
  samples.n = n;
  for (unsigned int i = 0; i < power<dim>(n + 1); ++i)
  {
    Point<dim> p = corner;
    for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n + 1)
      p[d] += size * (rest % (n + 1)) / n;
    samples.points.push_back(p);
    samples.values.push_back(function.value(p));
  }
  return samples;
}

template <int dim>
void MembraneSearch<dim>::add_root(const Samples &samples, const std::pair<unsigned int, unsigned int> &pair,
                                   const double spacing, FoundMembrane<dim> &result) const
{
  const Point<dim> inside = samples.points[pair.first];
  const Tensor<1, dim> way = samples.points[pair.second] - inside;
  const auto value = [&](const double t) { return function.value(inside + t * way); };
  double left = 0., right = 1.;
  if (samples.values[pair.second] > 0.)
  {
    std::uintmax_t n_iterations = most_root_iterations;
    std::tie(left, right) = boost::math::tools::toms748_solve(
        value, 0., 1., samples.values[pair.first], samples.values[pair.second],
        [](const double a, const double b) { return std::abs(b - a) < root_tolerance; }, n_iterations);
  }
  else // zero itself
    left = 1.;

  MembraneRoot<dim> root;
  root.spacing = spacing;
  for (unsigned int d = 0; d < dim; ++d)
    root.coordinates[d] = (inside + 0.5 * (left + right) * way)[d];
  const double values[2] = {value(left), value(right)};
  root.remainder = std::abs(values[0]) < std::abs(values[1]) ? values[0] : values[1];
  root.largest_value = 0.;
  for (const double sampled : samples.values)
    root.largest_value = std::max(root.largest_value, std::abs(sampled));
  result.roots.push_back(root);
}

template <int dim>
void MembraneSearch<dim>::visit(const Cubes &cubes, const unsigned int level, const bool samples_decide,
                                Cubes &next, FoundMembrane<dim> &result) const
{
  const CubeLattice<dim> lattice = box.of_level(level);
  const double size = lattice.size;
  for (const auto &cube : cubes)
  {
    const Point<dim> lower = lattice.corner(cube);
    const auto bound = bounds(lower, size);
    if (bound.excludes_zero())
      continue;
    const bool is_last =
        level >= levels.membrane && (bound.is_monotone() || samples_decide || level == levels.finest);
    // Where the zero set is hardly curved one point of it will do.
    const bool is_flat = bound.is_monotone() && bound.variation_of_direction() < largest_variation;
    if (is_last || samples_decide || !bound.is_defined)
    {
      const bool only_one = is_flat || samples_decide;
      const Samples samples = sample(lower, size,
                                     is_flat          ? few_samples
                                     : samples_decide ? deciding_samples
                                                      : many_samples<dim>);
      if (const std::string complaint = not_finite_complaint(function, samples.points); !complaint.empty())
      {
        result.not_finite = complaint;
        return;
      }
      const auto sign_changes = only_one ? samples.central_sign_change() : samples.sign_changes();
      if (is_last)
        for (const auto &pair : sign_changes)
          add_root(samples, pair, size, result);
      if (samples_decide && sign_changes.empty())
        continue;
    }
    if (is_last)
      continue;
    for (unsigned int child = 0; child < GeometryInfo<dim>::max_children_per_cell; ++child)
      next.push_back(child_position<dim>(cube, child));
  }
}

template <int dim>
FoundMembrane<dim> MembraneSearch<dim>::search(Cubes cubes, const MPI_Comm communicator) const
{
  FoundMembrane<dim> result;
  bool samples_decide = false;
  for (unsigned int level = levels.coarsest; level <= levels.finest; ++level)
  {
    Cubes next;
    if (result.not_finite.empty())
      visit(cubes, level, samples_decide, next, result);
    cubes = std::move(next);
    const std::size_t n_left = Utilities::MPI::sum(cubes.size(), communicator);
    if (n_left == 0)
      break;
    if (samples_decide && n_left > largest_number_of_cells * GeometryInfo<dim>::max_children_per_cell)
    {
      result.level_with_too_many_cells = level;
      result.n_cells_of_that_level = n_left / GeometryInfo<dim>::max_children_per_cell;
      break;
    }
    if (!samples_decide && n_left > (level < levels.membrane ? most_undecided_cubes : most_hiding_places))
    {
      samples_decide = true;
      const double spacing = box.cell_size(level + 1) / deciding_samples;
      if (spacing > box.cell_size(levels.finest))
        result.blind_size = spacing;
    }
  }
  result.roots = gather_plain(result.roots, communicator);
  return result;
}

template class MembraneSearch<2>;
template class MembraneSearch<3>;
} // namespace Gemmule
