// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/application/output_schedule.h>
#include <gemmule/application/retry_policy.h>
#include <gemmule/application/stop_conditions.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/output/provenance.h>
#include <gemmule/output/run_log.h>
#include <gemmule/parameters/all_parameters.h>
#include <gemmule/time/step_control.h>

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
class RunResults;
class DirectoryLock;
class OutputDirectory;
class StepAttempts;
class TrialSystem;
template <int dim>
struct RunState;

/**
 * Runs one case: sets it up, then the time loop around CoupledSystem until the end, or until something stops
 * it. How a step is made is up to StepAttempts, what is written of it to RunResults and Checkpoints, and when
 * to OutputSchedule.
 */
template <int dim>
class VesicleProblem
{
public:
  /**
   * Sets up the case, or what an earlier run has left with @p resume. Throws UserError when that is
   * impossible. Collective.
   *
   * @param parameters must outlive the object
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
  void continue_from(const RunState<dim> &state);
  /** From now on steps can be made. */
  void make_attempts();
  /** run() without advice about the disk. */
  int run_steps();
  /** The message of @p error, and how to go on after it. */
  SimulationError advised(const DiskError &error) const;
  /** Writes to the log where the run ends, and why. */
  void log_end(const std::string &reason);
  void announce() const;
  /**
   * One accepted step, however many attempts that takes; what goes wrong for good is saved before it is
   * thrown.
   * @return empty, or why to stop before the step is done
   */
  std::string make_step();
  /** The row of the statistics, and what has to be warned of. */
  void report();
  void warn_of_negative_tension();
  /** Statistics, output and checkpoint of the accepted step, as far as they are due. */
  void write_results();
  /** Before the run ends with an error: what was accepted last goes to the disk. */
  void save_last_state(const std::string &reason);
  /** @return its path */
  std::string write_checkpoint();
  /** Saves the state. @return exit code */
  int stop(const std::string &reason);
  /** Seconds of wall clock of all runs so far. */
  double wall_time() const { return earlier_wall_time + wall_clock.wall_time(); }
  void print_timers();

  const AllParameters &parameters;
  const MPI_Comm communicator;
  const std::string command_line;
  StopConditions stop_conditions;
  const Provenance provenance;
  dealii::Timer wall_clock;
  double earlier_wall_time = 0.; ///< of the runs that this one continues
  bool is_resumed = false;

  const OutputSchedule schedule;
  StepControl control;
  RetryPolicy retries;

  std::unique_ptr<Checkpoints<dim>> checkpoints;
  std::unique_ptr<CoupledSystem<dim>> system;
  std::unique_ptr<OutputDirectory> directory;
  std::unique_ptr<RunLog> log;
  std::unique_ptr<RunResults<dim>> results;
  std::unique_ptr<TrialSystem> trials; ///< system, as attempts see it
  std::unique_ptr<StepAttempts> attempts;
};
} // namespace Gemmule
