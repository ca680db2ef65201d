// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/application/stop_conditions.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/output/provenance.h>
#include <gemmule/output/run_log.h>
#include <gemmule/output/statistics.h>
#include <gemmule/parameters/all_parameters.h>

#include <deal.II/base/timer.h>

#include <memory>
#include <mpi.h>
#include <string>
#include <vector>

namespace Gemmule
{
template <int dim>
class Checkpoints;
template <int dim>
class CoupledSystem;
template <int dim>
class FieldWriter;
template <int dim>
class InterfaceWriter;
template <int dim>
struct InterfaceSamples;
class DirectoryLock;
class DiskError;
class OutputDirectory;
class StepControl;
template <int dim>
struct RunState;

/** Runs one case: the time loop around CoupledSystem, with step control, output and checkpoints. */
template <int dim>
class VesicleProblem
{
public:
  /**
   * Sets up the case, or what an earlier run has left with @p resume. Throws UserError when that is
   * impossible. Collective.
   */
  VesicleProblem(const AllParameters &parameters, MPI_Comm communicator, const std::string &command_line,
                 bool resume);
  ~VesicleProblem();

  /** @return exit code of the program: 0 finished, 3 stopped before. Throws SimulationError. */
  int run();

private:
  /** All of the constructor. @throws DiskError besides */
  void set_up(bool resume);
  /** @param notes gets what the log has to warn of */
  void open_output(const RunState<dim> *resumed, std::unique_ptr<DirectoryLock> lock,
                   std::vector<std::string> &notes);
  void continue_from(RunState<dim> &state);
  /** run() without advice about the disk. */
  int run_steps();
  /** The message of @p error, and how to go on after it. */
  SimulationError advised(const DiskError &error) const;
  /** Writes to the log where the run ends, and why. */
  void log_end(const std::string &reason);
  std::vector<double> stops() const;
  void announce() const;
  /**
   * One accepted step, however many attempts that takes; what goes wrong for good is saved before it is
   * thrown.
   * @return empty, or why to stop before the step is done
   */
  std::string make_step();
  /** make_step() without saving. */
  std::string attempt_step();
  /** Whether a step of size @p dt that could be computed is good enough; repairs the membrane like
   * fail_step(). */
  bool accept_step(double dt);
  /** After an attempt of size @p dt that could not be computed: the next one is smaller, or from a repair on.
   */
  void fail_step(double dt, const SimulationError &error);
  /**
   * After an attempt of size @p dt at a step that was not accepted: repairs the membrane if it is the reason
   * and that is allowed. @return whether the step can be tried again from a new beginning.
   */
  bool repair_membrane(double dt);
  /** What to add to the reason of a failure if the total concentration has all but vanished; else nothing. */
  std::string end_of_the_model() const;
  void report();
  void warn_of_negative_tension();
  /** Statistics, output and checkpoint of the accepted step, as far as they are due. */
  void write_results();
  void write_output_if_due(bool at_end);
  /** Before the run ends with an error: what was accepted last goes to the disk. */
  void save_last_state(const std::string &reason);
  /** @return its path */
  std::string write_checkpoint();
  /** Saves the state. @return exit code */
  int stop(const std::string &reason);
  void print_timers();

  const AllParameters parameters;
  const MPI_Comm communicator;
  const std::string command_line;
  StopConditions stop_conditions;
  const Provenance provenance;
  dealii::Timer wall_clock;
  double earlier_wall_time = 0.; ///< of the runs that this one continues
  std::unique_ptr<OutputDirectory> directory;
  std::unique_ptr<RunLog> log;
  std::unique_ptr<CoupledSystem<dim>> system;
  std::unique_ptr<StatisticsWriter> statistics;
  std::unique_ptr<InterfaceWriter<dim>> interface_writer;
  std::unique_ptr<FieldWriter<dim>> field_writer;
  std::unique_ptr<Checkpoints<dim>> checkpoints;
  std::unique_ptr<StepControl> control;

  std::unique_ptr<InterfaceSamples<dim>> membrane; ///< of the last accepted step
  bool membrane_is_written = false;
  bool is_resumed = false;
  StatisticsRow row, previous_row;
  double error_shape = 0., error_composition = 0.;
  unsigned int n_rejected = 0;
  unsigned int n_attempts = 0; ///< at the step in work, in vain
  double last_repair = -1.;    ///< time of the last repair of the membrane, tried or done; negative: never
};

/**
 * Checks what needs more than the parameters themselves: the initial membrane. @throws UserError.
 * @return warnings. Collective.
 */
template <int dim>
std::vector<std::string> check_case(const AllParameters &parameters, MPI_Comm communicator);
} // namespace Gemmule
