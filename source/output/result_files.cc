// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/output/disk.h>
#include <gemmule/output/hdf5_file.h>
#include <gemmule/output/result_files.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>

namespace Gemmule
{
namespace
{
  const std::string part = ".part", fields_prefix = "solution-", fields_suffix = ".h5";

  bool starts_with(const std::string &text, const std::string &start)
  {
    return text.compare(0, start.size(), start) == 0;
  }

  bool ends_with(const std::string &text, const std::string &end)
  {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
  }

  std::string without_part(const std::string &name)
  {
    return ends_with(name, part) ? name.substr(0, name.size() - part.size()) : name;
  }

  /** NNNNN of solution-NNNNN.h5, or nothing. */
  std::string digits_of_fields(const std::string &complete_name)
  {
    const std::size_t length = fields_prefix.size() + fields_suffix.size();
    if (complete_name.size() < length + 5 || !starts_with(complete_name, fields_prefix) ||
        !ends_with(complete_name, fields_suffix))
      return "";
    const std::string digits = complete_name.substr(fields_prefix.size(), complete_name.size() - length);
    return digits.find_first_not_of("0123456789") == std::string::npos ? digits : "";
  }

  std::string beginning_of(const std::string &path)
  {
    std::array<char, 4096> text{};
    std::ifstream file(path, std::ios::binary);
    file.read(text.data(), text.size());
    return std::string(text.data(), static_cast<std::size_t>(file.gcount()));
  }

  Origin origin_of_hdf5(const std::string &path, const std::string &beginning)
  {
    // Room that was taken and not written to.
    if (std::all_of(beginning.begin(), beginning.end(), [](const char c) { return c == '\0'; }))
      return Origin::damaged;
    if (!begins_as_hdf5(path))
      return Origin::foreign;
    try
    {
      const Hdf5File file(path, Hdf5File::Mode::read);
      // It is written last.
      return file.has_attribute("/", "gemmule_version") ? Origin::ours
             : ends_with(path, part)                    ? Origin::damaged
                                                        : Origin::foreign;
    }
    catch (const SimulationError &)
    {
      return Origin::damaged;
    }
  }

  Origin origin_of_checkpoints(const std::string &path)
  {
    std::error_code error;
    const auto names = names_in(path, error);
    if (error)
      return Origin::foreign;
    if (names.empty())
      return Origin::nobody;
    const bool has_some = std::any_of(names.begin(), names.end(),
                                      [&](const std::string &name) {
                                        return exists(path + "/" + name + "/metadata.txt") ||
                                               exists(path + "/" + name + "/state.h5");
                                      });
    return has_some ? Origin::ours : Origin::foreign;
  }

  /** Is there a line as a run writes it? */
  bool is_a_log(const std::string &text)
  {
    const std::array<const char *, 7> beginnings = {{"Gemmule ", "warning: ", "results in ", "finished: t = ",
                                                     "stopped at t = ", "stopped by ", "resumed at t = "}};
    return std::any_of(beginnings.begin(), beginnings.end(),
                       [&](const std::string &beginning) {
                         return starts_with(text, beginning) ||
                                text.find("\n" + beginning) != std::string::npos;
                       });
  }
} // namespace

ResultKind kind_of_result(const std::string &name)
{
  static const std::map<std::string, ResultKind> files = {
      {"parameters.prm", ResultKind::parameters},     {"log.txt", ResultKind::log},
      {"statistics.csv", ResultKind::statistics},     {"interface.h5", ResultKind::membrane},
      {"interface.xdmf", ResultKind::membrane_index}, {"solution.xdmf", ResultKind::fields_index},
      {"checkpoint", ResultKind::checkpoints},        {".lock", ResultKind::lock}};
  const auto found = files.find(name);
  if (found != files.end())
    return found->second;
  const std::string complete = without_part(name);
  if (!digits_of_fields(complete).empty())
    return ResultKind::fields;
  const auto of_complete = files.find(complete);
  // These have no unfinished form.
  if (of_complete == files.end() || complete == "log.txt" || complete == "checkpoint" || complete == ".lock")
    return ResultKind::none;
  return of_complete->second;
}

unsigned long number_of_fields(const std::string &name)
{
  const std::string digits = digits_of_fields(without_part(name));
  return digits.size() > 9 ? 1000000000ul : std::stoul(digits);
}

Origin origin_of(const std::string &path, const ResultKind kind)
{
  namespace fs = std::filesystem;
  if (!exists(path))
    return Origin::nobody;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (kind == ResultKind::checkpoints)
    return !error && fs::is_directory(status) ? origin_of_checkpoints(path) : Origin::foreign;
  // To read from a pipe could take for ever.
  if (error || !fs::is_regular_file(status))
    return Origin::foreign;
  const auto size = fs::file_size(path, error);
  if (error)
    return Origin::foreign;
  if (size == 0)
    return fs::is_symlink(fs::symlink_status(path, error)) ? Origin::foreign : Origin::nobody;

  const std::string text = beginning_of(path);
  if (text.empty())
    return Origin::foreign;
  bool is_ours = false;
  switch (kind)
  {
  case ResultKind::parameters:
    is_ours = starts_with(text, "# Listing of Parameters");
    break;
  case ResultKind::log:
    is_ours = is_a_log(text);
    break;
  case ResultKind::statistics:
    is_ours = starts_with(text, "time,step,time_step_size,");
    break;
  case ResultKind::membrane_index:
    is_ours = text.find("<Grid Name=\"membrane\"") != std::string::npos;
    break;
  case ResultKind::fields_index:
    is_ours = text.find("<Grid Name=\"fields\"") != std::string::npos;
    break;
  case ResultKind::lock:
    is_ours = starts_with(text, "process ");
    break;
  case ResultKind::membrane:
  case ResultKind::fields:
    return origin_of_hdf5(path, text);
  case ResultKind::checkpoints:
  case ResultKind::none:
    break;
  }
  return is_ours ? Origin::ours : Origin::foreign;
}
} // namespace Gemmule
