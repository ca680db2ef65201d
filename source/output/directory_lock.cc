// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/output/directory_lock.h>

#include <array>
#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace Gemmule
{
namespace
{
  const std::string beginning = "process ";

  std::string path_in(const std::string &directory)
  {
    return directory + "/.lock";
  }

  /** @return descriptor, or negative */
  int open_lock(const std::string &directory, const int flags)
  {
    // Nobody's file elsewhere shall be written to through a link, and none wait for the other end of a pipe.
    const int common = O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
    const int file = open(path_in(directory).c_str(), O_RDWR | common | flags, 0666);
    // That of another user can be locked as well.
    return file < 0 && errno == EACCES ? open(path_in(directory).c_str(), O_RDONLY | common) : file;
  }

  /** What the holder of the lock has written about itself; it may not have come to that yet. */
  std::string content_of(const int file)
  {
    std::array<char, 400> text;
    const ssize_t n = pread(file, text.data(), text.size(), 0);
    return n > 0 ? std::string(text.data(), n) : "";
  }

  std::string this_process()
  {
    std::array<char, 256> host{};
    if (gethostname(host.data(), host.size() - 1) != 0)
      host[0] = '\0';
    return beginning + std::to_string(getpid()) + (host[0] != '\0' ? std::string(" on ") + host.data() : "");
  }
} // namespace

std::unique_ptr<DirectoryLock> DirectoryLock::acquire(const std::string &directory)
{
  const int file = open_lock(directory, O_CREAT);
  // Whether the directory can be written to is checked elsewhere, with a message of its own.
  return std::unique_ptr<DirectoryLock>(new DirectoryLock(directory, file));
}

std::unique_ptr<DirectoryLock> DirectoryLock::acquire_existing(const std::string &directory)
{
  const int file = open_lock(directory, 0);
  if (file < 0)
    return nullptr;
  return std::unique_ptr<DirectoryLock>(new DirectoryLock(directory, file));
}

DirectoryLock::DirectoryLock(const std::string &directory, const int file) : file(file)
{
  if (file < 0)
    return;
  if (flock(file, LOCK_EX | LOCK_NB) != 0)
  {
    // Any other failure: a file system that has no locks.
    if (errno != EWOULDBLOCK)
      return;
    const std::string holder = content_of(file);
    close(file);
    throw UserError("Another run of gemmule is writing to the output directory '" + directory + "'" +
                    (holder.empty() ? "" : " (" + holder + ")") +
                    ". Wait until it has ended, stop it, or choose another directory with --output or the "
                    "parameter 'Output directory'.");
  }
  // What others have written into a file of this name stays.
  const std::string before = content_of(file);
  if (!before.empty() && before.compare(0, beginning.size(), beginning) != 0)
    return;
  // A full disk is no reason to stop here: the text only makes the message above clearer.
  const std::string text = this_process();
  if (ftruncate(file, 0) != 0 || pwrite(file, text.data(), text.size(), 0) < 0)
    return;
}

DirectoryLock::~DirectoryLock()
{
  if (file >= 0)
    close(file);
}
} // namespace Gemmule
