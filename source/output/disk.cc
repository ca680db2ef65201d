#include <gemmule/output/disk.h>
#include <gemmule/parameters/errors.h>

#include <array>
#include <boost/crc.hpp>
#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <fstream>
#include <unistd.h>

namespace Gemmule
{
void replace_file(const std::string &path, const std::string &content, const bool durable)
{
  const std::string unfinished = path + ".part";
  {
    std::ofstream file(unfinished, std::ios::binary);
    file << content;
    file.close();
    if (!file)
    {
      std::remove(unfinished.c_str());
      throw SimulationError("Cannot write " + path +
                            ": is the disk full, or the directory write-protected? Make room and go on with "
                            "--resume.");
    }
  }
  if (durable)
    synchronise(unfinished);
  if (std::rename(unfinished.c_str(), path.c_str()) != 0)
    throw SimulationError("Cannot replace " + path + ": check that the directory and the file are writable.");
}

void reserve_space(const std::string &path, const std::size_t bytes)
{
  const int file = open(path.c_str(), O_RDWR | O_CREAT, 0666);
  const off_t size = file < 0 ? -1 : lseek(file, 0, SEEK_END);
  int error = EINTR;
  while (size >= 0 && error == EINTR) // by a signal, which the program notes and acts on later
    error = posix_fallocate(file, size, static_cast<off_t>(bytes));
  const bool has_room = size >= 0 && error == 0;
  // What was allocated before the disk was full has to go; if that fails too there is nothing left to try.
  const bool is_restored = has_room || size < 0 || ftruncate(file, size) == 0;
  if (file >= 0)
    close(file);
  if (!has_room || !is_restored)
    throw SimulationError("Cannot write " + path + ": is the disk full (" +
                          std::to_string(bytes / 1048576 + 1) +
                          " MB are needed), or the file write-protected? Make room and go on with --resume.");
}

void synchronise(const std::string &path)
{
  const int file = open(path.c_str(), O_RDONLY);
  // Some file systems have no such operation for directories: there is nothing to wait for, then.
  const bool is_on_disk = file >= 0 && (fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP);
  if (file >= 0)
    close(file);
  if (!is_on_disk)
    throw SimulationError("Cannot bring " + path +
                          " to the disk: is it full or failing? Make room and go on with --resume.");
}

namespace
{
  /** Hands the content of the file over in pieces. */
  template <typename Consumer>
  void read_in_pieces(const std::string &path, const Consumer &consume)
  {
    std::ifstream file(path, std::ios::binary);
    std::array<char, 65536> piece;
    while (file)
    {
      file.read(piece.data(), piece.size());
      consume(piece.data(), static_cast<std::size_t>(file.gcount()));
    }
    if (!file.eof())
      throw SimulationError("Cannot read " + path + ": the file is missing or damaged, or may not be read.");
  }
} // namespace

void copy_file(const std::string &from, const std::string &to)
{
  std::ofstream copy(to, std::ios::binary | std::ios::trunc);
  try
  {
    read_in_pieces(from, [&](const char *data, const std::size_t size)
                   { copy.write(data, static_cast<long>(size)); });
  }
  catch (const SimulationError &)
  {
    copy.close();
    std::remove(to.c_str());
    throw;
  }
  copy.close();
  if (!copy)
  {
    std::remove(to.c_str());
    throw SimulationError("Cannot write " + to +
                          ": is the disk full, or the directory write-protected? Make room and go on with "
                          "--resume.");
  }
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
  read_in_pieces(path,
                 [&](const char *data, const std::size_t size)
                 {
                   crc.process_bytes(data, size);
                   total += size;
                 });
  return {total, crc.checksum()};
}
} // namespace Gemmule
