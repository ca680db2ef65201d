// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/base/raise_together.h>
#include <gemmule/coupling/initial_checks.h>
#include <gemmule/parameters/expression.h>
#include <gemmule/parameters/section.h>
#include <gemmule/parameters/text.h>

#include <cmath>
#include <map>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // Beside a zero, narrowed down to round-off, the expression may have this part of its largest value in the
  // cell. Continuous functions have far less, jumps and poles far more.
  constexpr double largest_remainder = 0.3;
  // In edges of the cell, how far from the zero set the mesh may have a membrane.
  constexpr double largest_stray = 0.5;
  // Places that the search for a mesh may still have to refine.
  template <int dim>
  constexpr std::size_t most_details = dim == 2 ? 2000 : 50000;
  // Sheets of opposite normals that are closer than this part of a cell are taken for a contact.
  constexpr double smallest_gap = 0.5;
  // A shape loses more than this of its area or arclength in a distance function if the mesh is too coarse
  // for it.
  constexpr double largest_loss = 0.05;
  // Expressions that end at zero or one may overshoot by round-off.
  constexpr double composition_tolerance = 1e-8;

  template <int dim>
  std::string coordinates(const Point<dim> &p)
  {
    std::string text;
    for (unsigned int d = 0; d < dim; ++d)
      text += (d == 0 ? "(" : ", ") + Parameters::short_number(p[d]);
    return text + ")";
  }

  /** A sample where two sheets of opposite normals nearly meet, if there is one. */
  template <int dim>
  const typename MembraneProjection<dim>::Sample *find_contact(const MembraneProjection<dim> &membrane)
  {
    const auto &samples = membrane.samples();
    const auto &patches = membrane.get_patches();
    double size = 0.;
    for (const auto &patch : patches)
      size = std::max(size, patch.size);
    using Key = std::array<long, dim>;
    const auto key = [&](const Point<dim> &p)
    {
      Key k;
      for (unsigned int d = 0; d < dim; ++d)
        k[d] = std::lround(std::floor(p[d] / size));
      return k;
    };
    std::map<Key, std::vector<unsigned int>> bins;
    for (unsigned int i = 0; i < samples.size(); ++i)
      bins[key(samples[i].point)].push_back(i);

    constexpr unsigned int n_neighbours = dim == 2 ? 9 : 27;
    for (const auto &sample : samples)
      for (unsigned int neighbour = 0; neighbour < n_neighbours; ++neighbour)
      {
        Key k = key(sample.point);
        for (unsigned int d = 0, rest = neighbour; d < dim; ++d, rest /= 3)
          k[d] += static_cast<long>(rest % 3) - 1;
        const auto bin = bins.find(k);
        if (bin == bins.end())
          continue;
        for (const unsigned int other : bin->second)
          if (sample.normal * samples[other].normal < -0.5 &&
              sample.point.distance(samples[other].point) <
                  smallest_gap * std::min(patches[sample.patch].size, patches[samples[other].patch].size))
            return &sample;
      }
    return nullptr;
  }
} // namespace

template <int dim>
void InitialChecks<dim>::fail_level_set(const std::string &complaint) const
{
  throw ParameterError("Membrane/Level set",
                       Parameters::in_quotes(parameters.membrane.level_set) + " " + complaint);
}

template <int dim>
void InitialChecks<dim>::walls(const Function<dim> &expression) const
{
  constexpr unsigned int n = 64;
  const auto &lower = parameters.domain.lower_corner, &upper = parameters.domain.upper_corner;
  const unsigned int n_points = dim == 2 ? n + 1 : (n + 1) * (n + 1);
  for (unsigned int wall = 0; wall < 2 * dim; ++wall)
    for (unsigned int i = 0; i < n_points; ++i)
    {
      Point<dim> p;
      for (unsigned int d = 0, rest = i; d < dim; ++d)
      {
        const bool normal = d == wall / 2;
        const double fraction = normal ? wall % 2 : static_cast<double>(rest % (n + 1)) / n;
        p[d] = lower[d] + fraction * (upper[d] - lower[d]);
        if (!normal)
          rest /= n + 1;
      }
      if (expression.value(p) <= 0.)
        fail_level_set(
            "is not positive at " + coordinates(p) +
            " on a wall of the box: the membrane would touch the wall or leave the box. Enlarge the "
            "box (Domain/Lower corner, Domain/Upper corner) or make the vesicle smaller.");
    }
}

template <int dim>
void InitialChecks<dim>::number_of_cells(const std::size_t n_cells, const unsigned int level) const
{
  const auto &mesh = parameters.mesh;
  if (n_cells > mesh.largest_number_of_cells)
    throw ParameterError("Mesh/Membrane level", "is " + std::to_string(mesh.membrane_level) +
                                                    ": already at level " + std::to_string(level) +
                                                    " the mesh has " + std::to_string(n_cells) +
                                                    " cells, more than 'Mesh/Largest number of cells' = " +
                                                    std::to_string(mesh.largest_number_of_cells) +
                                                    ". Choose a lower level, or allow more cells.");
}

template <int dim>
void InitialChecks<dim>::found(const FoundMembrane<dim> &membrane, const bool is_negative,
                               const MPI_Comm communicator) const
{
  raise_together("Membrane/Level set", membrane.not_finite, communicator);
  if (membrane.level_with_too_many_cells > 0)
    number_of_cells(membrane.n_cells_of_that_level, membrane.level_with_too_many_cells);
  if (membrane.roots.empty())
    fail_level_set(std::string("has no zero in the box that the finest cells would resolve: it is ") +
                   (is_negative ? "negative" : "positive") +
                   " everywhere. Give a function that is negative inside the vesicle and positive outside, "
                   "for example x^2+2*y^2-0.25, or a finer 'Mesh/Finest level' if the vesicle is tiny.");
  for (const auto &root : membrane.roots)
    if (!(std::abs(root.remainder) <= largest_remainder * root.largest_value))
      fail_level_set("changes its sign without passing through zero near " + coordinates(root.point()) +
                     ": it has the value " + Parameters::short_number(root.remainder) +
                     " there. Give a continuous function without jumps and poles, for example "
                     "x^2+2*y^2-0.25.");
}

template <int dim>
void InitialChecks<dim>::fail_detail(const Point<dim> &place, const double cell_size) const
{
  fail_level_set("has a detail near " + coordinates(place) +
                 " that the mesh does not resolve, since its cells there have edges of " +
                 Parameters::to_text(cell_size) +
                 ": a vesicle, a filament or a gap is smaller. Leave the detail out, or raise "
                 "'Mesh/Membrane level', or 'Mesh/Finest level' with 'Mesh/Curvature tolerance' and "
                 "'Mesh/Cells per gap'.");
}

template <int dim>
void InitialChecks<dim>::number_of_details(const std::vector<LostPart<dim>> &lost) const
{
  if (lost.size() <= most_details<dim>)
    return;
  fail_level_set("has details that cells with edges of " +
                 Parameters::to_text(parameters.domain.cell_size(lost.front().level)) +
                 " do not resolve in " + std::to_string(lost.size()) + " places, one of them near " +
                 coordinates(lost.front().point()) +
                 ". Give a smoother function, or a finer 'Mesh/Membrane level'.");
}

template <int dim>
void InitialChecks<dim>::nothing_lost(const std::vector<LostPart<dim>> &lost) const
{
  for (const auto &part : lost)
    if (part.is_whole)
      fail_detail(part.point(), parameters.domain.cell_size(part.level));
}

template <int dim>
void InitialChecks<dim>::on_mesh(const MembraneProjection<dim> *const membrane) const
{
  if (membrane == nullptr)
    fail_level_set("has no membrane on the mesh: what it describes is smaller than a cell. Leave it out, or "
                   "give a finer "
                   "'Mesh/Membrane level'.");
}

template <int dim>
void InitialChecks<dim>::membrane(const ZeroSetDistance<dim> &distance,
                                  const MembraneProjection<dim> &membrane) const
{
  const auto &patches = membrane.get_patches();
  for (const auto &sample : membrane.samples())
    if (std::abs(distance.value(sample.point)) > largest_stray * patches[sample.patch].size)
      fail_detail(sample.point, patches[sample.patch].size);
  const auto *const contact = find_contact(membrane);
  if (contact == nullptr)
    return;
  // Two sides of something small, or two sheets?
  const double size = patches[contact->patch].size;
  if (distance.curvature(contact->point) * size > 1.)
    fail_detail(contact->point, size);
  fail_level_set("describes a membrane that touches or crosses itself, or comes closer to itself than half "
                 "a cell, near " +
                 coordinates(contact->point) +
                 ". Give a shape of one or several closed curves that stay apart, or a finer "
                 "'Mesh/Membrane level'.");
}

template <int dim>
void InitialChecks<dim>::distance(const double area, const double new_area, const double arclength,
                                  const double new_arclength) const
{
  const double loss = std::max(std::abs(new_area / area - 1.), std::abs(new_arclength / arclength - 1.));
  if (!(loss <= largest_loss))
    fail_level_set(
        "describes a shape that the mesh does not resolve: making the level set a distance changes its "
        "area or its arclength by more than 5 %. Choose a finer 'Mesh/Membrane level', a shape without "
        "corners and fine details, and a function that passes through zero with a slope.");
}

template <int dim>
void InitialChecks<dim>::concentrations(const Function<dim> &concentration,
                                        const Function<dim> &total_concentration,
                                        const std::vector<Point<dim>> &points) const
{
  const std::string f = "Membrane/Initial concentration", total = "Membrane/Initial total concentration";
  check_finite(concentration, points, f);
  check_finite(total_concentration, points, total);
  for (const Point<dim> &p : points)
  {
    const double sum = total_concentration.value(p);
    if (sum <= 0.)
      throw ParameterError(total, Parameters::in_quotes(parameters.membrane.initial_total_concentration) +
                                      " is not positive at " + coordinates(p) +
                                      " on the membrane. Give an expression that is positive there.");
    const double composition = concentration.value(p) / sum;
    if (!(composition >= -composition_tolerance && composition <= 1. + composition_tolerance))
      throw ParameterError(f, Parameters::in_quotes(parameters.membrane.initial_concentration) +
                                  " makes the composition (concentration / total concentration) " +
                                  Parameters::short_number(composition) + " at " + coordinates(p) +
                                  " on the membrane. Give an expression between 0 and 'Initial total "
                                  "concentration'.");
  }
}

template <int dim>
void InitialChecks<dim>::flow(const double largest_velocity) const
{
  const auto &p = parameters;
  const std::string where =
      "Look at Domain/Boundary velocity = " + p.domain.boundary_velocity +
      ", Fluid/Capillary number = " + Parameters::to_text(p.fluid.capillary_number) +
      ", Fluid/Viscosity ratio = " + Parameters::to_text(p.fluid.viscosity_ratio) +
      ", the tension (Membrane) and the penalties (Flow discretisation, Arclength constraint)";
  if (!std::isfinite(largest_velocity))
    throw UserError(
        "the initial flow has no finite velocity: a parameter is too large or too small to compute "
        "with. " +
        where + ".");
  const double cell_size = p.domain.cell_size(p.mesh.membrane_level);
  const double smallest_step = p.time_stepping.smallest_step;
  if (p.time_stepping.adaptive && largest_velocity * smallest_step > cell_size)
    throw UserError("the initial flow is too fast to compute with: at its largest speed, " +
                    Parameters::short_number(largest_velocity) +
                    ", the fluid crosses a cell of the membrane (" + Parameters::to_text(cell_size) +
                    ") within 'Time stepping/Smallest time step' = " + Parameters::to_text(smallest_step) +
                    ". " + where + ".");
}

template class InitialChecks<2>;
template class InitialChecks<3>;
} // namespace Gemmule
