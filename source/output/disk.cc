#include <gemmule/output/disk.h>
#include <gemmule/parameters/errors.h>

#include <cstdio>
#include <fcntl.h>
#include <fstream>
#include <unistd.h>

namespace Gemmule
{
void replace_file(const std::string &path, const std::string &content)
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
  if (std::rename(unfinished.c_str(), path.c_str()) != 0)
    throw SimulationError("Cannot replace " + path + ": check that the directory and the file are writable.");
}

void reserve_space(const std::string &path, const std::size_t bytes)
{
  const int file = open(path.c_str(), O_RDWR | O_CREAT, 0666);
  const off_t size = file < 0 ? -1 : lseek(file, 0, SEEK_END);
  const bool has_room = size >= 0 && posix_fallocate(file, size, static_cast<off_t>(bytes)) == 0;
  // What was allocated before the disk was full has to go; if that fails too there is nothing left to try.
  const bool is_restored = has_room || size < 0 || ftruncate(file, size) == 0;
  if (file >= 0)
    close(file);
  if (!has_room || !is_restored)
    throw SimulationError("Cannot write " + path + ": is the disk full (" +
                          std::to_string(bytes / 1048576 + 1) +
                          " MB are needed), or the file write-protected? Make room and go on with --resume.");
}
} // namespace Gemmule
