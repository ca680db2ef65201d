// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/parameters/all_parameters.h>
#include <gemmule/parameters/directory_name.h>
#include <gemmule/parameters/expression.h>
#include <gemmule/parameters/parameter_file.h>
#include <gemmule/parameters/section.h>
#include <gemmule/parameters/strict_parser.h>

#include <deal.II/base/function.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/point.h>

#include <cmath>
#include <ostream>
#include <sstream>

namespace Gemmule::Parameters
{
namespace
{
  void declare_top_level(AllParameters &parameters, dealii::ParameterHandler &prm)
  {
    Section section(prm, {});
    section.add("Dimension", parameters.dimension, "Number of space dimensions.", Range::between(2, 3));
    section.add("End time", parameters.end_time, "Simulated time at which the run ends (dimensionless time).",
                Range::positive());
    section.add("Output directory", parameters.output_directory,
                "Directory for all results, relative to the working directory; it is created if need be.",
                "the name of a directory");
  }

  /** Vertices of a lattice on the box, so coarse that it costs nothing and so odd that it holds the centre.
   */
  template <int dim>
  std::vector<dealii::Point<dim>> sample_points(const Domain &domain, const bool only_walls)
  {
    constexpr unsigned int n = 9;
    const dealii::Point<dim> lower = domain.lower<dim>(), upper = domain.upper<dim>();
    unsigned int n_points = 1;
    for (unsigned int d = 0; d < dim; ++d)
      n_points *= n;

    std::vector<dealii::Point<dim>> points;
    for (unsigned int index = 0; index < n_points; ++index)
    {
      dealii::Point<dim> point;
      bool on_wall = false;
      for (unsigned int d = 0, rest = index; d < dim; ++d, rest /= n)
      {
        const unsigned int i = rest % n;
        on_wall = on_wall || i == 0 || i == n - 1;
        point[d] = lower[d] + (upper[d] - lower[d]) * i / (n - 1.);
      }
      if (on_wall || !only_walls)
        points.push_back(point);
    }
    return points;
  }

  template <int dim>
  void check_expressions(const AllParameters &p)
  {
    const std::string velocity = "Domain/Boundary velocity", level_set = "Membrane/Level set";
    check_finite(*make_function<dim>(p.domain.boundary_velocity, dim, velocity),
                 sample_points<dim>(p.domain, true), velocity);
    check_finite(*make_function<dim>(p.membrane.level_set, 1, level_set, false),
                 sample_points<dim>(p.domain, false), level_set);
    // These matter on the membrane only, and where that is is not known here.
    make_function<dim>(p.membrane.prescribed_tension, 1, "Membrane/Prescribed tension");
    make_function<dim>(p.membrane.initial_concentration, 1, "Membrane/Initial concentration", false);
    make_function<dim>(p.membrane.initial_total_concentration, 1, "Membrane/Initial total concentration",
                       false);
  }

  /** The box alone must not have more cells than the mesh may have. */
  void check_number_of_cells(const AllParameters &p)
  {
    double n_cells = std::pow(2., p.dimension * static_cast<double>(p.mesh.bulk_level));
    for (const unsigned int n : p.domain.coarse_cells())
      n_cells *= n;
    if (n_cells > p.mesh.largest_number_of_cells)
      throw ParameterError("Mesh/Bulk level", "is " + std::to_string(p.mesh.bulk_level) +
                                                  ": the box then has " + to_text(n_cells) +
                                                  " cells, more than 'Mesh/Largest number of cells' = " +
                                                  std::to_string(p.mesh.largest_number_of_cells) +
                                                  ". Choose a lower level, or allow more cells.");
  }

  /** Each output is a time at which a step has to end; a slip in the interval must not ask for billions. */
  void check_number_of_outputs(const AllParameters &p)
  {
    constexpr double most = 1e6;
    for (const auto &[name, interval] : {std::pair<std::string, double>("Field", p.output.field_interval),
                                         {"Interface", p.output.interface_interval}})
      if (interval > 0. && p.end_time / interval > most)
        throw ParameterError("Output/" + name + " output interval",
                             "is " + to_text(interval) + ": more than " + to_text(most) +
                                 " outputs until 'End time' = " + to_text(p.end_time) +
                                 ". Choose a longer interval, or 0 for none.");
  }

  /** What depends on the dimension and was not given follows it. */
  void adapt_to_dimension(AllParameters &p)
  {
    const auto is_default = [&](const std::string &key) { return p.places.count("Domain/" + key) == 0; };
    if (is_default("Lower corner"))
      p.domain.lower_corner.resize(p.dimension, p.domain.lower_corner.back());
    if (is_default("Upper corner"))
      p.domain.upper_corner.resize(p.dimension, p.domain.upper_corner.back());
    if (is_default("Boundary velocity") && p.domain.boundary_velocity == Domain().boundary_velocity)
      p.domain.boundary_velocity = p.dimension == 2 ? "0; 0" : "0; 0; 0";
  }
} // namespace

void AllParameters::add_parameters(dealii::ParameterHandler &prm)
{
  declare_top_level(*this, prm);
  domain.add_parameters(prm);
  fluid.add_parameters(prm);
  membrane.add_parameters(prm);
  regularisation.add_parameters(prm);
  bending.add_parameters(prm);
  arclength.add_parameters(prm);
  mesh.add_parameters(prm);
  flow.add_parameters(prm);
  surface.add_parameters(prm);
  time_stepping.add_parameters(prm);
  output.add_parameters(prm);
  checkpoint.add_parameters(prm);
}

void AllParameters::check() const
{
  AllParameters copy(*this);
  dealii::ParameterHandler prm;
  declare_top_level(copy, prm);
  if (const std::string flaw = flaw_of_directory_name(output_directory); !flaw.empty())
    throw ParameterError("Output directory", flaw);

  domain.check();
  fluid.check();
  membrane.check();
  regularisation.check();
  bending.check();
  arclength.check();
  mesh.check();
  flow.check();
  surface.check();
  time_stepping.check();
  output.check();
  checkpoint.check();

  const std::string numbers = " numbers, but 'Dimension' is " + std::to_string(dimension) +
                              ". Give one number per direction, separated by commas.";
  if (domain.lower_corner.size() != dimension)
    throw ParameterError("Domain/Lower corner",
                         "has " + std::to_string(domain.lower_corner.size()) + numbers);
  if (domain.upper_corner.size() != dimension)
    throw ParameterError("Domain/Upper corner",
                         "has " + std::to_string(domain.upper_corner.size()) + numbers);
  for (const double time : output.output_times)
    if (time > end_time)
      throw ParameterError("Output/Output times", "the time " + to_text(time) + " lies after 'End time' = " +
                                                      to_text(end_time) + ". Remove it, or compute longer.");
  check_number_of_outputs(*this);
  check_number_of_cells(*this);
  if (dimension == 2)
    check_expressions<2>(*this);
  else
    check_expressions<3>(*this);
}

void AllParameters::parse(const std::string &file, const std::vector<std::string> &overrides)
{
  parse_text(file, file.empty() ? "" : read_parameter_file(file), overrides);
}

void AllParameters::parse_text(const std::string &file, const std::string &text,
                               const std::vector<std::string> &overrides)
{
  // Into a copy, so that a failure leaves this object as it was.
  AllParameters result(*this);
  dealii::ParameterHandler prm;
  result.add_parameters(prm);
  StrictParser parser(prm);
  parser.parse_text(file, text);
  for (const std::string &assignment : overrides)
    parser.parse_override(assignment);
  result.parameter_file = file;
  result.places = parser.places();
  adapt_to_dimension(result);
  try
  {
    result.check();
  }
  catch (const ParameterError &error)
  {
    throw result.located(error);
  }
  *this = result;
}

UserError AllParameters::located(const ParameterError &error) const
{
  const auto place = places.find(error.parameter);
  if (place != places.end())
    return UserError(place->second + ": " + error.what());
  return UserError((parameter_file.empty() ? "" : parameter_file + ": ") + error.parameter +
                   " (default value): " + error.complaint);
}

void AllParameters::print(std::ostream &out) const
{
  AllParameters present(*this), defaults;
  dealii::ParameterHandler prm_present, prm;
  present.add_parameters(prm_present);
  defaults.add_parameters(prm);

  // Only what differs is set, so that the printed file shows the default next to it.
  const Schema schema(prm);
  const Schema schema_present(prm_present);
  for (const auto &[path, entry] : schema_present.entries())
  {
    if (entry.value == schema.entries().at(path).value)
      continue;
    unsigned int depth = 0;
    const auto [sections, key] = Schema::split(path);
    std::istringstream stream(sections);
    for (std::string name; std::getline(stream, name, '/'); ++depth)
      prm.enter_subsection(name);
    prm.set(key, entry.value);
    for (; depth > 0; --depth)
      prm.leave_subsection();
  }
  prm.print_parameters(out,
                       static_cast<dealii::ParameterHandler::OutputStyle>(
                           dealii::ParameterHandler::PRM | dealii::ParameterHandler::KeepDeclarationOrder));
}

std::map<std::string, std::string> AllParameters::values() const
{
  AllParameters copy(*this);
  dealii::ParameterHandler prm;
  copy.add_parameters(prm);
  const Schema schema(prm);
  std::map<std::string, std::string> values;
  for (const auto &[name, entry] : schema.entries())
    values[name] = entry.value;
  return values;
}
} // namespace Gemmule::Parameters
