// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/application/checkpoints.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/base/rank_zero.h>
#include <gemmule/output/named_arrays.h>
#include <gemmule/parameters/section.h>

#include <deal.II/base/mpi.h>

#include <sstream>

namespace Gemmule
{
namespace
{
  /** Of the whole checkpoint; raised when an older program could not read it, or not continue from it. */
  const std::string schema_version = "6";

  /** The last row of the statistics is in the state: a program with other columns cannot continue from it. */
  std::string n_statistics_columns()
  {
    return std::to_string(statistics_columns().size());
  }

  const std::string state_file = CheckpointDirectory::state_file,
                    parameter_file = CheckpointDirectory::parameter_file,
                    interface_file = CheckpointDirectory::membrane_file;

  /** Has it the form of those of this version? */
  bool is_readable(const CheckpointDirectory::Metadata &metadata)
  {
    const auto has = [&](const std::string &name, const std::string &value)
    {
      const auto entry = metadata.find(name);
      return entry != metadata.end() && entry->second == value;
    };
    return has("schema_version", schema_version) && has("statistics_columns", n_statistics_columns());
  }

  bool may_change(const std::string &name)
  {
    const auto is_in_section = [&](const std::string &section)
    { return name.compare(0, section.size() + 1, section + "/") == 0; };
    return name == "End time" || name == "Output directory" || is_in_section("Output") ||
           is_in_section("Checkpoint");
  }

  void check_fixed_parameters(const std::string &checkpoint, const AllParameters &present)
  {
    AllParameters of_checkpoint;
    // Where the results were is of no importance, and may be a name that is refused today.
    of_checkpoint.parse(checkpoint + "/" + parameter_file, {"Output directory=."});
    const std::vector<std::string> changes = changed_fixed_parameters(of_checkpoint, present);
    if (changes.empty())
      return;
    std::string message = "--resume: the run in " + checkpoint + " was computed with other parameters:";
    for (unsigned int i = 0; i < changes.size(); ++i)
      message += (i == 0 ? " " : "; ") + changes[i];
    throw UserError(message + ". Only 'End time', 'Output directory' and the sections 'Output' and "
                              "'Checkpoint' may change. Set these back, or start a new run with another "
                              "--output.");
  }
} // namespace

std::vector<std::string> changed_fixed_parameters(const AllParameters &of_checkpoint,
                                                  const AllParameters &present)
{
  const auto before = of_checkpoint.values(), now = present.values();
  std::vector<std::string> changes;
  for (const auto &[name, value] : now)
    if (!may_change(name) && before.at(name) != value)
      changes.push_back(name + ": '" + before.at(name) + "' in the checkpoint, '" + value + "' now");
  return changes;
}

bool can_be_resumed(const std::string &results)
{
  std::vector<std::string> ignored;
  const auto checkpoint = CheckpointDirectory(results).newest_good(ignored);
  return checkpoint && is_readable(checkpoint->metadata);
}

template <int dim>
Checkpoints<dim>::Checkpoints(const AllParameters &parameters, const MPI_Comm communicator)
    : parameters(parameters), communicator(communicator), directory(parameters.output_directory),
      schedule(parameters.checkpoint)
{
}

template <int dim>
RunState<dim> Checkpoints<dim>::load(std::vector<std::string> &notes)
{
  NamedArrays arrays;
  on_rank_zero(
      communicator,
      [&]()
      {
        const auto checkpoint = directory.newest_good(notes);
        if (!checkpoint)
        {
          std::string message = "--resume: there is no " + std::string(notes.empty() ? "" : "usable ") +
                                "checkpoint in '" + parameters.output_directory + "'.";
          for (const std::string &note : notes)
            message += " " + note;
          throw UserError(message +
                          (notes.empty() ? " Leave out --resume to begin a new run, or name"
                                         : " Restore one from a copy, or leave out --resume to "
                                           "begin anew (the results are kept in a folder "
                                           "'earlier-run' there), or name") +
                          " the right directory with --output.");
        }
        if (!is_readable(checkpoint->metadata))
          throw UserError("--resume: " + checkpoint->path +
                          " was written by another version of gemmule, in a form that this one does not "
                          "read. Resume with that version, or begin a new run in another directory with "
                          "--output and without --resume.");
        check_fixed_parameters(checkpoint->path, parameters);
        for (const unsigned int number : directory.numbers())
          if (number > checkpoint->number)
            damaged.push_back(number);
        arrays = NamedArrays::read(checkpoint->path + "/" + state_file);
        loaded_path = checkpoint->path;
        const std::string revision = program_version();
        const auto earlier = checkpoint->metadata.find("program_version");
        if (earlier != checkpoint->metadata.end() && earlier->second != revision)
          notes.push_back("the checkpoint is of gemmule " + earlier->second + ", this is " + revision +
                          ": the continuation may differ from an uninterrupted run.");
      });
  notes = dealii::Utilities::MPI::broadcast(communicator, notes, 0);
  loaded_path = dealii::Utilities::MPI::broadcast(communicator, loaded_path, 0);
  arrays.broadcast(communicator);

  RunState<dim> state;
  ArrayExchange archive = ArrayExchange::unpacking(arrays);
  exchange(archive, state);
  if (state.row.time > parameters.end_time)
    throw UserError("--resume: the checkpoint " + loaded_path +
                    " is of t = " + Parameters::to_text(state.row.time) + ", but 'End time' is " +
                    Parameters::to_text(parameters.end_time) + ". Choose a later end.");
  schedule.is_written(state.row.step);
  last_path = loaded_path;
  return state;
}

template <int dim>
void Checkpoints<dim>::restore_results()
{
  on_rank_zero(
      communicator, [&]()
      { copy_file(loaded_path + "/" + interface_file, parameters.output_directory + "/" + interface_file); });
}

template <int dim>
bool Checkpoints<dim>::is_due(const unsigned int step) const
{
  // The clock of one rank decides for all.
  return dealii::Utilities::MPI::broadcast(communicator, schedule.is_due(step, since_last.wall_time()), 0);
}

template <int dim>
std::string Checkpoints<dim>::write(RunState<dim> &state, const Provenance &provenance)
{
  on_rank_zero(communicator, [&]() { write_files(state, provenance); });
  schedule.is_written(state.row.step);
  since_last.restart();
  return dealii::Utilities::MPI::broadcast(communicator, last_path, 0);
}

template <int dim>
std::string Checkpoints<dim>::how_to_go_on() const
{
  if (!exists(parameters.output_directory))
    return " The output directory has been moved or removed while the run was at work: put it back and go on "
           "with --resume, or repeat the command.";
  return directory.has_complete() ? " Then go on with --resume." : " Then repeat the command.";
}

template <int dim>
void Checkpoints<dim>::write_files(RunState<dim> &state, const Provenance &provenance)
{
  try
  {
    const std::string path = directory.begin();
    ArrayExchange archive = ArrayExchange::packing();
    exchange(archive, state);
    archive.result().write(path + "/" + state_file, provenance);
    copy_file(parameters.output_directory + "/" + interface_file, path + "/" + interface_file);
    std::ostringstream values;
    parameters.print(values);
    replace_file(path + "/" + parameter_file, values.str());
    // The rows that the state follows on.
    synchronise(parameters.output_directory + "/statistics.csv");

    CheckpointDirectory::Metadata metadata;
    metadata["schema_version"] = schema_version;
    metadata["statistics_columns"] = n_statistics_columns();
    metadata["program_version"] = program_version();
    metadata["time"] = Parameters::to_text(state.row.time);
    metadata["finished"] = state.row.time >= parameters.end_time ? "yes" : "no";
    metadata["step"] = std::to_string(state.row.step);
    for (const auto &[name, value] : provenance.entries())
      if (value.find('\n') == std::string::npos)
        metadata[name] = value;
    directory.complete(metadata, parameters.checkpoint.number_kept, damaged);
    damaged.clear();
    last_path = path;
  }
  catch (...)
  {
    // Make room at once: the message asks for it.
    directory.abandon();
    throw;
  }
}

template class Checkpoints<2>;
template class Checkpoints<3>;
} // namespace Gemmule
