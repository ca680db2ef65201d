// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/output/checkpoint_directory.h>
#include <gemmule/output/disk.h>
#include <gemmule/output/earlier_results.h>
#include <gemmule/output/hdf5_file.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace Gemmule
{
namespace
{
  namespace fs = std::filesystem;

  /** As many as any user will look through; who has more has forgotten them. */
  constexpr unsigned int most_folders = 99;

  /** What a table of the statistics says of the progress of its run. */
  struct Progress
  {
    unsigned int n_rows = 0;
    double last_time = -1.;
  };

  Progress progress_of(const std::string &statistics)
  {
    Progress progress;
    std::ifstream file(statistics);
    std::string line;
    std::getline(file, line);
    for (; std::getline(file, line); ++progress.n_rows)
      progress.last_time = std::strtod(line.c_str(), nullptr);
    return progress;
  }

  bool has_outputs(const std::string &membrane)
  {
    try
    {
      return !Hdf5File(membrane, Hdf5File::Mode::read).members().empty();
    }
    catch (const SimulationError &)
    {
      return true;
    }
  }

  [[noreturn]] void give_up(const std::string &doing, const std::string &path, const std::error_code &error)
  {
    throw UserError("Cannot " + doing + " the results of an earlier run ('" + path + "': " + error.message() +
                    "): choose another directory with --output.");
  }

  /** Renames; a relative symbolic link still points to the same place from one folder below. */
  void move_into(const std::string &folder, const fs::path &path, std::error_code &error)
  {
    const fs::path target = fs::path(folder) / path.filename();
    const fs::path link =
        fs::is_symlink(fs::symlink_status(path, error)) ? fs::read_symlink(path, error) : "";
    if (link.empty() || link.is_absolute())
      return fs::rename(path, target, error);
    fs::create_symlink(".." / link, target, error);
    if (!error)
      fs::remove(path, error);
  }

  /** Creates a folder that did not exist. */
  std::string new_folder(const std::string &directory)
  {
    const std::string first = directory + "/earlier-run";
    std::string folder = first;
    for (unsigned int i = 2; exists(folder); ++i)
    {
      if (i > most_folders)
        throw UserError("The output directory '" + directory +
                        "' holds results that may not be replaced, and " + std::to_string(most_folders) +
                        " earlier ones in '" + first + "' to '" + folder +
                        "': remove those that are not needed, or choose another directory with --output.");
      folder = first + "-" + std::to_string(i);
    }
    std::error_code error;
    if (!fs::create_directory(folder, error))
      give_up("move", folder, error);
    return folder;
  }
} // namespace

EarlierResults::EarlierResults(const std::string &directory) : directory(directory)
{
  std::error_code ignored;
  for (const std::string &name : names_in(directory, ignored))
    if (const ResultKind kind = kind_of_result(name); kind != ResultKind::none)
      entries.push_back({name, kind, origin_of(directory + "/" + name, kind)});
}

const EarlierResults::Entry *EarlierResults::find(const std::string &name) const
{
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const Entry &entry) { return entry.name == name; });
  return found != entries.end() ? &*found : nullptr;
}

bool EarlierResults::are_of_a_run() const
{
  const Entry *const lock = find(".lock"), *const parameters = find("parameters.prm"),
                     *const log = find("log.txt");
  return (lock != nullptr && lock->origin == Origin::ours) ||
         (parameters != nullptr && parameters->origin == Origin::ours && log != nullptr &&
          log->origin != Origin::foreign);
}

std::vector<std::string> EarlierResults::foreign() const
{
  const bool of_a_run = are_of_a_run();
  std::vector<std::string> names;
  for (const Entry &entry : entries)
  {
    std::error_code error;
    // Checkpoints have room beside what else is in their folder.
    const bool has_room = of_a_run && entry.kind == ResultKind::checkpoints &&
                          fs::is_directory(directory + "/" + entry.name, error);
    if (!has_room && (entry.origin == Origin::foreign || (!of_a_run && entry.origin != Origin::nobody)))
      names.push_back(entry.name);
  }
  return names;
}

bool EarlierResults::hold_results() const
{
  return std::any_of(entries.begin(), entries.end(),
                     [&](const Entry &entry)
                     {
                       if (entry.origin != Origin::ours)
                         return entry.origin == Origin::damaged;
                       const std::string path = directory + "/" + entry.name;
                       return entry.kind == ResultKind::fields || entry.kind == ResultKind::checkpoints ||
                              (entry.kind == ResultKind::statistics && progress_of(path).n_rows > 0) ||
                              (entry.kind == ResultKind::membrane && has_outputs(path));
                     });
}

std::string EarlierResults::reason_to_keep() const
{
  if (!hold_results())
    return "";
  if (std::any_of(entries.begin(), entries.end(),
                  [](const Entry &entry) { return entry.origin == Origin::damaged; }))
    return "has damaged files";
  std::vector<std::string> complaints;
  const auto checkpoint = CheckpointDirectory(directory).newest_good(complaints);
  if (!checkpoint || !complaints.empty())
    return "lacks its last checkpoint";
  const auto value_of = [&](const std::string &name)
  {
    const auto found = checkpoint->metadata.find(name);
    return found != checkpoint->metadata.end() ? found->second : std::string();
  };
  // A run that was extended has rows after the end that it had once.
  const double end = std::strtod(value_of("time").c_str(), nullptr);
  const double last_time = progress_of(directory + "/statistics.csv").last_time;
  const bool is_finished =
      value_of("finished") == "yes" && last_time <= end + 1e-9 * std::max(1., std::abs(end));
  return is_finished ? "" : "had not finished";
}

bool EarlierResults::end_before_first_checkpoint() const
{
  if (!are_of_a_run() || progress_of(directory + "/statistics.csv").n_rows > 1)
    return false;
  const CheckpointDirectory checkpoints(directory);
  const auto numbers = checkpoints.numbers();
  return std::none_of(numbers.begin(), numbers.end(),
                      [&](const unsigned int number) { return checkpoints.is_complete(number); });
}

void EarlierResults::remove() const
{
  std::error_code error;
  for (const Entry &entry : entries)
  {
    // Those that are overwritten mark the directory as that of a run.
    const bool is_mark =
        entry.origin == Origin::ours && (entry.name == "parameters.prm" || entry.name == "log.txt");
    const bool stays = entry.kind == ResultKind::lock || entry.kind == ResultKind::checkpoints || is_mark;
    const std::string path = directory + "/" + entry.name;
    if (!stays && (entry.origin == Origin::ours || entry.origin == Origin::nobody) &&
        !fs::remove(path, error) && error)
      give_up("remove", path, error);
  }
  CheckpointDirectory(directory).remove_all();
}

std::string EarlierResults::move_aside() const
{
  std::vector<std::string> ignored;
  return move([](const Entry &entry)
              { return entry.kind != ResultKind::lock && entry.origin != Origin::foreign; },
              ignored);
}

std::string EarlierResults::move_foreign_aside(const unsigned int n_field_files,
                                               std::vector<std::string> &names) const
{
  return move(
      [&](const Entry &entry)
      {
        switch (entry.kind)
        {
        case ResultKind::lock:
        case ResultKind::checkpoints:
        case ResultKind::statistics: // they are refused where they are read
          return false;
        case ResultKind::fields:
          return number_of_fields(entry.name) >= n_field_files &&
                 (entry.origin == Origin::foreign ||
                  (entry.origin == Origin::damaged && entry.name == complete_name(entry.name)));
        default:
          return entry.origin == Origin::foreign;
        }
      },
      names);
}

std::string EarlierResults::move(const std::function<bool(const Entry &)> &is_wanted,
                                 std::vector<std::string> &names) const
{
  names.clear();
  for (const Entry &entry : entries)
    if (is_wanted(entry))
      names.push_back(entry.name);
  if (names.empty())
    return "";
  const std::string folder = new_folder(directory);
  std::error_code error, ignored;
  for (auto name = names.begin(); name != names.end(); ++name)
  {
    move_into(folder, directory + "/" + *name, error);
    if (!error)
      continue;
    for (auto moved = names.begin(); moved != name; ++moved)
      fs::rename(folder + "/" + *moved, directory + "/" + *moved, ignored);
    fs::remove(folder, ignored);
    give_up("move", directory + "/" + *name, error);
  }
  return folder;
}
} // namespace Gemmule
