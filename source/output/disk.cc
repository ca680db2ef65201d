// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/output/disk.h>

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <sys/stat.h>
#include <unistd.h>

namespace Gemmule
{
namespace
{
  const std::string part = ".part";

  /** With one digit, rounded up. */
  std::string megabytes(const std::size_t bytes)
  {
    std::ostringstream text;
    text << std::fixed << std::setprecision(1) << std::ceil(static_cast<double>(bytes) / 1e5) / 10.;
    return text.str();
  }

  /** Hands the content of the file over in pieces. @return errno of what failed, or 0 */
  template <typename Consumer>
  int read_in_pieces(const std::string &path, const Consumer &consume)
  {
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0)
      return errno;
    std::array<char, 65536> piece;
    int error = 0;
    for (ssize_t n = 1; n != 0 && error == 0;)
    {
      n = read(file, piece.data(), piece.size());
      if (n >= 0)
        consume(piece.data(), static_cast<std::size_t>(n));
      else if (errno != EINTR)
        error = errno;
    }
    close(file);
    return error;
  }
} // namespace

std::string complete_name(const std::string &path)
{
  const bool is_part = path.size() > part.size() && path.substr(path.size() - part.size()) == part;
  return is_part ? path.substr(0, path.size() - part.size()) : path;
}

UnfinishedFile::UnfinishedFile(const std::string &path) : target(path), unfinished(path + part)
{
  std::remove(unfinished.c_str());
}

UnfinishedFile::~UnfinishedFile()
{
  if (!is_complete)
    std::remove(unfinished.c_str());
}

void UnfinishedFile::complete(const bool durable)
{
  if (durable)
    synchronise(unfinished);
  if (std::rename(unfinished.c_str(), target.c_str()) != 0)
    throw disk_error("Cannot replace " + target, errno);
  is_complete = true;
}

int write_and_close(const int file, const std::string &text)
{
  int error = 0;
  for (std::size_t done = 0; done < text.size() && error == 0;)
  {
    const ssize_t n = write(file, text.data() + done, text.size() - done);
    if (n >= 0)
      done += static_cast<std::size_t>(n);
    else if (errno != EINTR)
      error = errno;
  }
  // Some file systems notice only now that there is no room.
  if (close(file) != 0 && error == 0 && errno != EINTR)
    error = errno;
  return error;
}

void replace_file(const std::string &path, const std::string &content, const bool durable)
{
  UnfinishedFile unfinished(path);
  const int file = open(unfinished.path().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  const int error = file < 0 ? errno : write_and_close(file, content);
  if (error != 0)
    throw disk_error("Cannot write " + path, error);
  unfinished.complete(durable);
}

void append_to_file(const std::string &path, const std::string &text, const bool create)
{
  const int file = open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | (create ? O_CREAT : 0), 0666);
  const int error = file < 0 ? errno : write_and_close(file, text);
  if (error != 0)
    throw disk_error("Cannot write to " + path, error);
}

void reserve_space(const std::string &path, const std::size_t bytes)
{
  const std::string what = "Cannot write " + complete_name(path);
  const bool is_new = !exists(path);
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0)
    throw disk_error(what, errno);
  const off_t size = lseek(file, 0, SEEK_END);
  int error = size < 0 ? errno : EINTR;
  while (error == EINTR) // by a signal, which the program notes and acts on later
    error = posix_fallocate(file, size, static_cast<off_t>(bytes));
  // What was allocated before the disk was full has to go.
  if (error != 0 && size >= 0 && ftruncate(file, size) != 0)
    error = errno;
  close(file);
  if (error == 0)
    return;
  if (is_new)
    std::remove(path.c_str());
  throw disk_error(
      is_lack_of_room(error) ? what + ", for which " + megabytes(bytes) + " MB are needed" : what, error);
}

void synchronise(const std::string &path)
{
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  // Some file systems have no such operation for directories: there is nothing to wait for, then.
  int error = 0;
  if (file < 0 || (fsync(file) != 0 && errno != EINVAL && errno != ENOTSUP))
    error = errno;
  if (file >= 0)
    close(file);
  if (error != 0)
    throw disk_error("Cannot bring " + path + " to the disk", error);
}

void copy_file(const std::string &from, const std::string &to)
{
  UnfinishedFile copy(to);
  std::ofstream file(copy.path(), std::ios::binary | std::ios::trunc);
  int error = file ? 0 : errno;
  const int reading_error = read_in_pieces(from,
                                           [&](const char *data, const std::size_t size)
                                           {
                                             if (error == 0 && !file.write(data, static_cast<long>(size)))
                                               error = errno;
                                           });
  if (reading_error != 0)
    throw disk_error("Cannot read " + from, reading_error);
  file.close();
  if (!file && error == 0)
    error = errno;
  if (!file)
    throw disk_error("Cannot write " + to, error);
  copy.complete();
}

bool exists(const std::string &path) noexcept
{
  struct stat status = {};
  return lstat(path.c_str(), &status) == 0;
}

std::vector<std::string> names_in(const std::string &directory, std::error_code &error)
{
  std::vector<std::string> names;
  std::filesystem::directory_iterator entry(directory, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error))
    names.push_back(entry->path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

Checksum Checksum::of_text(const std::string &text)
{
  boost::crc_32_type crc;
  crc.process_bytes(text.data(), text.size());
  return {text.size(), crc.checksum()};
}

Checksum Checksum::of_file(const std::string &path)
{
  boost::crc_32_type crc;
  std::uint64_t total = 0;
  const int error = read_in_pieces(path,
                                   [&](const char *data, const std::size_t size)
                                   {
                                     crc.process_bytes(data, size);
                                     total += size;
                                   });
  if (error != 0)
    throw disk_error("Cannot read " + path, error);
  return {total, crc.checksum()};
}
} // namespace Gemmule
