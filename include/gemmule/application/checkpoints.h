// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/application/output_schedule.h>
#include <gemmule/application/run_state.h>
#include <gemmule/output/checkpoint_directory.h>
#include <gemmule/output/provenance.h>
#include <gemmule/parameters/all_parameters.h>

#include <deal.II/base/timer.h>

#include <mpi.h>

namespace Gemmule
{
/**
 * Names and values of the parameters in which a run differs from the one that wrote a checkpoint, although
 * they have to be the same, as "Section/Key: 'old' in the checkpoint, 'new' now".
 *
 * What may change: 'End time', 'Output directory' and all of the sections 'Output' and 'Checkpoint', which
 * say how long a run is and what it writes, but not what it computes.
 */
std::vector<std::string> changed_fixed_parameters(const AllParameters &of_checkpoint,
                                                  const AllParameters &present);

/** Is there a checkpoint below this directory of results that is whole, and that this version can continue?
 */
bool can_be_resumed(const std::string &results);

/**
 * Writes the state of a run to checkpoints and reads it again (doc/checkpoints.md). Rank 0 does so for all.
 * All functions but the constructor are collective.
 */
template <int dim>
class Checkpoints
{
public:
  /** @param parameters must outlive the object */
  Checkpoints(const AllParameters &parameters, MPI_Comm communicator);

  /**
   * State of the newest checkpoint that is whole.
   *
   * @param notes gets a line on every newer one that is not
   * Throws UserError when there is none, its fixed parameters are not those of this run, or it lies after
   * the end.
   */
  RunState<dim> load(std::vector<std::string> &notes);

  /**
   * Puts interface.h5 back as it was when the checkpoint that load() took was written: a run that is killed
   * while it writes may leave it damaged.
   */
  void restore_results();

  /** Is it time for the next one, after accepted step @p step? */
  bool is_due(unsigned int step) const;

  /**
   * What to do once the reason is removed that results could not be written: a sentence to follow the message
   * of a DiskError. Not collective: what one rank sees.
   */
  std::string how_to_go_on() const;

  /**
   * Writes one. Throws DiskError when the disk does not take it; earlier ones are then as they were.
   * @return its path
   */
  std::string write(RunState<dim> &state, const Provenance &provenance);

private:
  void write_files(RunState<dim> &state, const Provenance &provenance);

  const AllParameters &parameters;
  const MPI_Comm communicator;
  CheckpointDirectory directory;
  CheckpointSchedule schedule;
  dealii::Timer since_last;
  std::string loaded_path, last_path;
  std::vector<unsigned int> damaged;
};
} // namespace Gemmule
