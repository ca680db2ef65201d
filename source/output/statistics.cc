// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/base/rank_zero.h>
#include <gemmule/output/disk.h>
#include <gemmule/output/statistics.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>

namespace Gemmule
{
namespace
{
  struct Column
  {
    const char *name;
    std::function<void(const StatisticsRow &, std::ostream &)> print;
    std::function<double(const StatisticsRow &)> get;
    std::function<void(StatisticsRow &, double)> set;
  };

  template <typename Number>
  Column column(const char *name, Number StatisticsRow::*member)
  {
    return {name, [member](const StatisticsRow &row, std::ostream &out) { out << row.*member; },
            [member](const StatisticsRow &row) { return static_cast<double>(row.*member); },
            [member](StatisticsRow &row, const double value) { row.*member = static_cast<Number>(value); }};
  }

  /** The one list of columns; new ones go to its end, users' scripts read the others by position or name. */
  const std::vector<Column> &columns()
  {
    using Row = StatisticsRow;
    static const std::vector<Column> list = {
        column("time", &Row::time),
        column("step", &Row::step),
        column("time_step_size", &Row::time_step_size),
        column("cells", &Row::cells),
        column("flow_dofs", &Row::flow_dofs),
        column("surface_dofs", &Row::surface_dofs),
        column("centroid_x", &Row::centroid_x),
        column("centroid_y", &Row::centroid_y),
        column("area", &Row::area),
        column("arclength", &Row::arclength),
        column("mass_f", &Row::mass_f),
        column("mass_total", &Row::mass_total),
        column("energy_surface", &Row::energy_surface),
        column("energy_phase", &Row::energy_phase),
        column("energy_constraint", &Row::energy_constraint),
        column("energy_bending", &Row::energy_bending),
        column("energy_total", &Row::energy_total),
        column("dissipation_viscous", &Row::dissipation_viscous),
        column("dissipation_phase", &Row::dissipation_phase),
        column("max_velocity", &Row::max_velocity),
        column("tension_min", &Row::tension_min),
        column("tension_max", &Row::tension_max),
        column("f_total_min", &Row::f_total_min),
        column("f_total_max", &Row::f_total_max),
        column("composition_min", &Row::composition_min),
        column("composition_max", &Row::composition_max),
        column("phase_boundaries", &Row::phase_boundaries),
        column("components", &Row::components),
        column("curvature_max", &Row::curvature_max),
        column("deformation", &Row::deformation),
        column("area_correction", &Row::area_correction),
        column("linear_iterations", &Row::linear_iterations),
        column("wall_time", &Row::wall_time),
        column("tension_negative_length", &Row::tension_negative_length),
        column("grid_scale_rigidity", &Row::grid_scale_rigidity),
        column("energy_balance_error", &Row::energy_balance_error),
        column("f_total_shift", &Row::f_total_shift),
        column("time_error_shape", &Row::time_error_shape),
        column("time_error_composition", &Row::time_error_composition),
    };
    return list;
  }

  std::string header_line()
  {
    std::string line;
    for (const std::string &name : statistics_columns())
      line += (line.empty() ? "" : ",") + name;
    return line;
  }

  /** The complete rows of @p in up to @p last_time; a kill while writing may have left half a row. */
  std::string rows_up_to(std::istream &in, const double last_time)
  {
    // The time of the checkpoint went through no text, that of the row through 17 digits: the same double.
    // The tolerance is for checkpoints of other makers.
    const double limit = last_time + 1e-12 * std::max(1., std::abs(last_time));
    const auto n_separators = static_cast<std::ptrdiff_t>(columns().size()) - 1;

    std::string rows;
    for (std::string line; std::getline(in, line) && !in.eof();)
    {
      std::istringstream start_of_line(line);
      double time = 0.;
      if (std::count(line.begin(), line.end(), ',') == n_separators && (start_of_line >> time) &&
          time <= limit)
        rows += line + '\n';
    }
    return rows;
  }
} // namespace

std::vector<std::string> statistics_columns()
{
  std::vector<std::string> names;
  for (const Column &column : columns())
    names.emplace_back(column.name);
  return names;
}

std::vector<double> to_numbers(const StatisticsRow &row)
{
  std::vector<double> numbers;
  for (const Column &column : columns())
    numbers.push_back(column.get(row));
  return numbers;
}

StatisticsRow to_statistics_row(const std::vector<double> &numbers)
{
  AssertThrow(numbers.size() == columns().size(), dealii::ExcMessage("One number per column is needed."));
  StatisticsRow row;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    columns()[i].set(row, numbers[i]);
  return row;
}

StatisticsWriter::StatisticsWriter(const std::string &directory, const MPI_Comm &communicator,
                                   const double resume_after_time)
    : path(directory + "/statistics.csv"), communicator(communicator)
{
  on_rank_zero(communicator, [&]() { start(resume_after_time); });
}

void StatisticsWriter::start(const double resume_after_time)
{
  std::string kept_rows;
  if (std::isfinite(resume_after_time) && exists(path))
  {
    std::ifstream earlier(path);
    if (!earlier)
      throw disk_error("Cannot read " + path, errno);
    std::string header;
    std::getline(earlier, header);
    if (header != header_line())
      throw UserError(path + " has other columns than this version of gemmule writes: move it away to go on, "
                             "or resume with the version that began the run.");
    kept_rows = rows_up_to(earlier, resume_after_time);
    n_written = std::count(kept_rows.begin(), kept_rows.end(), '\n');
  }
  // A checkpoint counts on these rows.
  replace_file(path, header_line() + '\n' + kept_rows, /*durable =*/true);
}

void StatisticsWriter::write(const StatisticsRow &row)
{
  on_rank_zero(communicator,
               [&]()
               {
                 std::ostringstream line;
                 line.precision(std::numeric_limits<double>::max_digits10);
                 const char *separator = "";
                 for (const Column &column : columns())
                 {
                   line << separator;
                   column.print(row, line);
                   separator = ",";
                 }
                 line << '\n';
                 // Rows without their header would be of no use.
                 append_to_file(path, line.str(), /*create =*/false);
                 ++n_written;
               });
}
} // namespace Gemmule
