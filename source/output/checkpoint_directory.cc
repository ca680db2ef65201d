// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/output/checkpoint_directory.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace Gemmule
{
namespace
{
  constexpr const char *metadata_name = CheckpointDirectory::metadata_file;
  const std::string file_prefix = "file ";
  const std::string last_line_prefix = "checksum of the lines above = ";

  std::string hexadecimal(const std::uint32_t number)
  {
    std::ostringstream text;
    text << std::hex << std::setw(8) << std::setfill('0') << number;
    return text.str();
  }

  std::string to_text(const Checksum &checksum)
  {
    return std::to_string(checksum.size) + " bytes, CRC-32 " + hexadecimal(checksum.crc);
  }

  std::string content_of(const std::string &path)
  {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
} // namespace

CheckpointDirectory::CheckpointDirectory(const std::string &results) : directory(results + "/checkpoint") {}

std::string CheckpointDirectory::path_of(const unsigned int number) const
{
  std::ostringstream name;
  name << directory << "/" << std::setw(5) << std::setfill('0') << number;
  return name.str();
}

std::vector<unsigned int> CheckpointDirectory::numbers() const
{
  std::vector<unsigned int> found;
  std::error_code error;
  for (const std::string &name : names_in(directory, error))
  {
    const bool is_number =
        name.size() >= 5 && name.size() <= 9 && name.find_first_not_of("0123456789") == std::string::npos;
    std::error_code ignored;
    if (is_number && std::filesystem::is_directory(directory + "/" + name, ignored))
      found.push_back(static_cast<unsigned int>(std::stoul(name)));
  }
  std::sort(found.begin(), found.end());
  return found;
}

bool CheckpointDirectory::is_complete(const unsigned int number) const
{
  return exists(path_of(number) + "/" + metadata_name);
}

bool CheckpointDirectory::has_complete() const
{
  const std::vector<unsigned int> all = numbers();
  return std::any_of(all.begin(), all.end(),
                     [this](const unsigned int number) { return is_complete(number); });
}

CheckpointDirectory::Metadata CheckpointDirectory::read(const unsigned int number) const
{
  const std::string path = path_of(number);
  if (!is_complete(number))
    throw SimulationError("it is incomplete: the run ended while it was written.");
  const std::string text = content_of(path + "/" + metadata_name);
  const std::string::size_type last_line = text.rfind(last_line_prefix);
  if (last_line == std::string::npos ||
      text.substr(last_line) !=
          last_line_prefix + hexadecimal(Checksum::of_text(text.substr(0, last_line)).crc) + "\n")
    throw SimulationError(std::string(metadata_name) + " is damaged.");

  Metadata metadata;
  std::istringstream lines(text.substr(0, last_line));
  for (std::string line; std::getline(lines, line);)
  {
    const std::string::size_type equals = line.find(" = ");
    if (line[0] == '#' || equals == std::string::npos)
      continue;
    const std::string name = line.substr(0, equals), value = line.substr(equals + 3);
    if (name.compare(0, file_prefix.size(), file_prefix) != 0)
    {
      metadata[name] = value;
      continue;
    }
    const std::string file = name.substr(file_prefix.size());
    if (!exists(path + "/" + file))
      throw SimulationError(file + " is missing.");
    const std::string present = to_text(Checksum::of_file(path + "/" + file));
    if (present != value)
      throw SimulationError(file + " is damaged: it has " + present + ", written were " + value + ".");
  }
  return metadata;
}

std::optional<CheckpointDirectory::Checkpoint>
CheckpointDirectory::newest_good(std::vector<std::string> &complaints) const
{
  const std::vector<unsigned int> all = numbers();
  for (auto number = all.rbegin(); number != all.rend(); ++number)
    try
    {
      return Checkpoint{*number, path_of(*number), read(*number)};
    }
    catch (const std::exception &error)
    {
      complaints.push_back(path_of(*number) + " cannot be used: " + error.what());
    }
  return {};
}

std::string CheckpointDirectory::begin()
{
  const std::vector<unsigned int> existing = numbers();
  in_work = existing.empty() ? 1 : existing.back() + 1;
  std::error_code error;
  std::filesystem::create_directories(path_of(*in_work), error);
  if (error)
    throw disk_error("Cannot create " + path_of(*in_work), error.value());
  return path_of(*in_work);
}

void CheckpointDirectory::complete(const Metadata &metadata, const unsigned int number_kept,
                                   const std::vector<unsigned int> &damaged)
{
  const std::string path = path_of(in_work.value());
  std::ostringstream text;
  text << "# Written last: a checkpoint without this file is not complete.\n";
  for (const auto &[name, value] : metadata)
    text << name << " = " << value << '\n';
  std::error_code error;
  for (const std::string &file : names_in(path, error))
  {
    synchronise(path + "/" + file);
    text << file_prefix << file << " = " << to_text(Checksum::of_file(path + "/" + file)) << '\n';
  }
  if (error)
    throw disk_error("Cannot read " + path, error.value());
  const Checksum of_lines_above = Checksum::of_text(text.str());
  text << last_line_prefix << hexadecimal(of_lines_above.crc) << '\n';

  replace_file(path + "/" + metadata_name, text.str(), /*durable =*/true);
  synchronise(path);
  synchronise(directory);
  synchronise(directory + "/.."); // which has had no entry for it before the first one

  std::vector<unsigned int> complete_ones, others;
  for (const unsigned int number : numbers())
  {
    const bool is_good =
        is_complete(number) && std::find(damaged.begin(), damaged.end(), number) == damaged.end();
    (is_good ? complete_ones : others).push_back(number);
  }
  const std::size_t n_old = complete_ones.size() - std::min<std::size_t>(number_kept, complete_ones.size());
  others.insert(others.end(), complete_ones.begin(), complete_ones.begin() + n_old);
  for (const unsigned int number : others)
    remove(number);
  in_work.reset();
}

void CheckpointDirectory::remove(const unsigned int number) const noexcept
{
  std::error_code ignored;
  const std::string path = path_of(number);
  // The metadata first: a kill in between leaves one that is incomplete, not one that looks damaged. What
  // cannot be removed only takes space.
  std::filesystem::remove(path + "/" + metadata_name, ignored);
  for (const char *const name : {metadata_file, state_file, parameter_file, membrane_file})
    for (const char *const suffix : {"", ".part"})
      std::filesystem::remove(path + "/" + name + suffix, ignored);
  std::filesystem::remove(path, ignored);
}

void CheckpointDirectory::remove_all() const noexcept
{
  for (const unsigned int number : numbers())
    remove(number);
  std::error_code ignored;
  // Where it is a link, somebody wants the checkpoints to be elsewhere.
  if (!std::filesystem::is_symlink(directory, ignored))
    std::filesystem::remove(directory, ignored);
}

void CheckpointDirectory::abandon() noexcept
{
  if (in_work)
    remove(*in_work);
  in_work.reset();
}
} // namespace Gemmule
