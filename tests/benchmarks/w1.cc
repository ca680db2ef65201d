// SPDX-License-Identifier: LGPL-2.1-or-later
// Benchmark W1 (doc/verification.md, section 6): what a given accuracy costs.
//
// The ellipse x^2 + 2 y^2 = 0.25 relaxes under the constant tension 1 in the box [-1, 1]^2 without slip, Ca =
// 1, equal viscosities. The truth is a boundary-integral solution, accurate to 1e-9. Each resolution is run
// through the same parts and the same step control as the program; output is left out, times are CPU times of
// this (single-threaded) process.
#include <gemmule/base/exceptions.h>
#include <gemmule/coupling/coupled_system.h>
#include <gemmule/geometry/region_moments.h>
#include <gemmule/mesh/box_mesh.h>
#include <gemmule/time/step_control.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/table_handler.h>
#include <deal.II/base/timer.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <sstream>

namespace
{
using namespace Gemmule;

struct Truth
{
  double time, deformation;
};
const std::vector<Truth> truth = {{0.2, 0.14922748}, {0.5, 0.12042971}, {1.0, 0.08349791}, {1.6, 0.05338238}};
constexpr double true_arclength = 2.64741065, true_x_max = 0.44352884; // at the last of these times

struct Goal
{
  double error, seconds;
};
const std::vector<Goal> goals = {{1e-3, 5.}, {1e-4, 20.}};

/** What is varied. Read from and written as LEVEL:TOLERANCE:STEP[:COURANT[:IMPLICITNESS]]. */
struct Resolution
{
  unsigned int membrane_level = 5;
  double tolerance = 1e-4;
  double largest_step = 0.1;
  double courant_number = 2.;
  double tension_implicitness = 0.4;

  static Resolution parse(const std::string &text)
  {
    Resolution r;
    std::istringstream in(text);
    char colon = ':';
    in >> r.membrane_level >> colon >> r.tolerance >> colon >> r.largest_step;
    bool good = static_cast<bool>(in);
    for (double *const value : {&r.courant_number, &r.tension_implicitness})
      if (good && in.peek() == ':')
        good = static_cast<bool>(in >> colon >> *value);
    if (!good || in.peek() != std::istringstream::traits_type::eof())
      throw UserError(
          "'" + text +
          "' is no resolution. Give LEVEL:TOLERANCE:STEP[:COURANT[:IMPLICITNESS]], such as 5:1e-4:0.1.");
    return r;
  }

  std::string text() const
  {
    std::ostringstream out;
    out << membrane_level << ':' << tolerance << ':' << largest_step << ':' << courant_number << ':'
        << tension_implicitness;
    return out.str();
  }
};

AllParameters make_case(const Resolution &resolution)
{
  AllParameters p;
  p.end_time = truth.back().time;
  p.membrane.level_set = "x^2+2*y^2-0.25";
  p.membrane.tension_model = Parameters::TensionModel::prescribed;
  p.membrane.prescribed_tension = "1";
  p.mesh.membrane_level = p.mesh.phase_boundary_level = resolution.membrane_level;
  p.time_stepping.tolerance = resolution.tolerance;
  p.time_stepping.largest_step = resolution.largest_step;
  p.time_stepping.interface_courant_number = resolution.courant_number;
  p.time_stepping.tension_implicitness = resolution.tension_implicitness;
  p.check();
  return p;
}

struct Measurement
{
  double deformation_error = 0., arclength_error = 0., x_max_error = 0., area_drift = 0.;
  unsigned int n_unknowns = 0, n_steps = 0, n_rejected = 0;
  double stepping_seconds = 0., total_seconds = 0.;
  std::map<std::string, double> seconds_by_stage;
};

/** Where the membrane crosses the positive x axis: by symmetry its largest x. */
double x_max(const CoupledSystem<2> &system)
{
  const auto &cells = system.get_geometry().cut_cells();
  const auto patches =
      gather_patches(cells, std::vector<MembraneFields<2>>(cells.size()), system.mesh().get_communicator());
  const auto corner = system.get_parameters().domain.lower<2>();
  return MembraneProjection<2>(patches, corner).project(dealii::Point<2>(true_x_max, 0.)).point[0];
}

/** One accepted step, as VesicleProblem makes it. */
void make_step(CoupledSystem<2> &system, StepControl &control, Measurement &measurement)
{
  const auto &options = system.get_parameters().time_stepping;
  while (true)
  {
    const double dt =
        control.propose(system.time_step_limits().longest_step(options.interface_courant_number));
    try
    {
      const auto errors = system.try_step(dt);
      if (control.judge(std::max(errors.shape, errors.composition) / options.tolerance))
        break;
    }
    catch (const SimulationError &error)
    {
      control.fail(error.what());
    }
    ++measurement.n_rejected;
  }
  system.accept();
  ++measurement.n_steps;
}

Measurement run(const Resolution &resolution)
{
  const auto relative = [](const double value, const double exact) { return std::abs(value / exact - 1.); };
  Measurement m;
  dealii::Timer total, stepping;
  stepping.stop();
  stepping.reset();

  CoupledSystem<2> system(make_case(resolution), MPI_COMM_WORLD);
  system.initialise();
  const double initial_area = system.get_geometry().enclosed_volume();
  std::vector<double> stops;
  for (const auto &entry : truth)
    stops.push_back(entry.time);
  StepControl control(system.get_parameters().time_stepping, 0., stops);
  while (!control.finished())
  {
    stepping.start();
    make_step(system, control, m);
    stepping.stop();

    m.area_drift = std::max(m.area_drift, relative(system.get_geometry().enclosed_volume(), initial_area));
    m.n_unknowns = std::max<unsigned int>(m.n_unknowns, system.get_flow().n_unknowns());
    for (const auto &entry : truth)
      if (entry.time == control.time())
        m.deformation_error =
            std::max(m.deformation_error,
                     relative(compute_region_moments(system.mesh(), system.get_geometry()).deformation(),
                              entry.deformation));
  }
  m.arclength_error = relative(system.get_geometry().measure(), true_arclength);
  m.x_max_error = relative(x_max(system), true_x_max);
  m.stepping_seconds = stepping.cpu_time();
  m.total_seconds = total.cpu_time();
  m.seconds_by_stage = system.timer().get_summary_data(dealii::TimerOutput::total_cpu_time);
  return m;
}

void add_row(const Resolution &resolution, const Measurement &m, dealii::TableHandler &table)
{
  table.add_value("resolution", resolution.text());
  for (const auto &[name, value] : {std::pair<const char *, double>{"deformation", m.deformation_error},
                                    {"arclength", m.arclength_error},
                                    {"x max", m.x_max_error},
                                    {"area drift", m.area_drift}})
  {
    table.add_value(name, value);
    table.set_precision(name, 2);
    table.set_scientific(name, true);
  }
  table.add_value("unknowns", m.n_unknowns);
  table.add_value("steps", m.n_steps);
  table.add_value("rejected", m.n_rejected);
  for (const auto &[name, value] :
       {std::pair<const char *, double>{"stepping/s", m.stepping_seconds}, {"total/s", m.total_seconds}})
  {
    table.add_value(name, value);
    table.set_precision(name, 2);
  }
}

void add_stages(const Resolution &resolution, const Measurement &m, dealii::TableHandler &table)
{
  table.start_new_row();
  table.set_auto_fill_mode(true);
  table.add_value("resolution", resolution.text());
  for (const auto &[stage, seconds] : m.seconds_by_stage)
  {
    // The table puts a space between columns, which the names hold too.
    std::string name = stage;
    std::replace(name.begin(), name.end(), ' ', '_');
    table.add_value(name, seconds);
    table.set_precision(name, 3);
  }
}

/** Says for each goal what the cheapest resolution that is accurate enough takes. @return whether all are met
 */
bool print_goals(const std::vector<Resolution> &resolutions, const std::vector<Measurement> &measurements)
{
  bool all_met = true;
  for (const auto &goal : goals)
  {
    const Measurement *cheapest = nullptr;
    for (const auto &m : measurements)
      if (m.deformation_error <= goal.error &&
          (cheapest == nullptr || m.total_seconds < cheapest->total_seconds))
        cheapest = &m;
    std::cout << "error " << goal.error << " within " << goal.seconds << " s: ";
    if (cheapest == nullptr)
      std::cout << "not reached\n";
    else
      std::cout << cheapest->total_seconds << " s (" << resolutions[cheapest - measurements.data()].text()
                << ")\n";
    all_met = all_met && cheapest != nullptr && cheapest->total_seconds <= goal.seconds;
  }
  return all_met;
}
} // namespace

int main(int argc, char **argv)
{
  // PETSc, which deal.II may contain, would complain about options that it does not know.
  int n_arguments = 1;
  dealii::Utilities::MPI::MPI_InitFinalize mpi(n_arguments, argv, 1);
  CLI::App app("Benchmark W1: accuracy and CPU time for an ellipse that relaxes under constant tension.");
  // Explicit coupling has the smaller error constant, and at these accuracies the steps are short anyway.
  std::vector<std::string> texts = {"4:1e-4:0.1",       "5:1e-4:0.1",       "5:1e-5:0.1",
                                    "5:1e-5:0.1:0.6:0", "6:1e-5:0.1:0.6:0", "6:1e-6:0.1:0.6:0"};
  bool require_goals = false;
  app.add_option("resolutions", texts, "LEVEL:TOLERANCE:STEP[:COURANT[:IMPLICITNESS]] ...")
      ->capture_default_str();
  app.add_flag("--require-goals", require_goals, "Exit with code 1 unless the goals are met");
  CLI11_PARSE(app, argc, argv);
  if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
  {
    std::cerr << "The benchmark measures one process: start it without mpirun.\n";
    return 1;
  }

  try
  {
    std::vector<Resolution> resolutions;
    for (const auto &text : texts)
      resolutions.push_back(Resolution::parse(text));
    std::vector<Measurement> measurements;
    dealii::TableHandler results, stages;
    for (const auto &resolution : resolutions)
    {
      measurements.push_back(run(resolution));
      add_row(resolution, measurements.back(), results);
      add_stages(resolution, measurements.back(), stages);
      std::cerr << resolution.text() << ": " << measurements.back().deformation_error << " in "
                << measurements.back().total_seconds << " s\n";
    }
    std::cout << "Resolution: level:tolerance:largest step:capillary Courant number:tension implicitness.\n"
                 "Largest relative errors of the deformation over t = 0.2, 0.5, 1, 1.6, of arclength and x "
                 "max at t = 1.6.\n\n";
    results.write_text(std::cout, dealii::TableHandler::org_mode_table);
    std::cout << "\nCPU seconds by stage:\n\n";
    stages.write_text(std::cout, dealii::TableHandler::org_mode_table);
    std::cout << '\n';
    const bool met = print_goals(resolutions, measurements);
    return require_goals && !met ? 1 : 0;
  }
  catch (const std::exception &error)
  {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
}
