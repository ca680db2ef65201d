// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/output/disk_error.h>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

namespace Gemmule
{
SystemReason explain(const int system_error)
{
  switch (system_error)
  {
  case 0:
    return {"the system gives no reason", "Check the disk and the permissions"};
  case ENOSPC:
    return {"the disk is full", "Make room"};
  case EDQUOT:
    return {"the quota on the disk is used up", "Make room, or ask for a larger quota"};
  case EFBIG:
    return {"the file would be larger than files may be here",
            "Raise the limit ('ulimit -f', or that of the file system)"};
  case EACCES:
  case EPERM:
    return {"permission is denied", "Change the permissions of the file and its directory"};
  case EROFS:
    return {"the file system is read-only", "Have it made writable"};
  case ENOENT:
    return {"the file or its directory does not exist", "Put it back if it has been moved"};
  case ENOTDIR:
    return {"a part of its path is no directory", "Move away what is in the place of the directory"};
  case EISDIR:
    return {"there is a directory of this name", "Rename that directory"};
  case ELOOP:
    return {"its path is a loop of symbolic links", "Remove the loop"};
  case ENAMETOOLONG:
    return {"its path is too long", "Choose a shorter one"};
  case EAGAIN:
  case EBUSY:
  case EDEADLK:
    return {"another program has locked it",
            "Close it there, or set the environment variable HDF5_USE_FILE_LOCKING to FALSE"};
  case ENOLCK:
  case ENOSYS:
    return {"its file system has no locks", "Set the environment variable HDF5_USE_FILE_LOCKING to FALSE"};
  case EMFILE:
  case ENFILE:
    return {"too many files are open", "Raise the limit ('ulimit -n'), or close other programs"};
  case EIO:
    return {"the disk reports an error of the device", "Have the disk checked"};
  case ESTALE:
    return {"the file server has lost the file", "Check the connection to the file server"};
  case EPIPE:
    return {"its reader has gone", "Keep the reader open"};
  default:
    return {std::string("the system reports '") + std::strerror(system_error) + "'", "Remove the cause"};
  }
}

bool is_lack_of_room(const int system_error)
{
  return system_error == ENOSPC || system_error == EDQUOT || system_error == EFBIG;
}

DiskError disk_error(const std::string &what, const int system_error)
{
  const SystemReason why = explain(system_error);
  return DiskError(what + ": " + why.reason + ". " + why.remedy + ".");
}

int likely_error_of_writing(const std::string &path, const std::size_t bytes)
{
  const auto last_slash = path.rfind('/');
  const std::string directory = last_slash == std::string::npos ? "." : path.substr(0, last_slash + 1);
  struct stat file = {}, parent = {};
  if (stat(directory.c_str(), &parent) != 0)
    return errno;
  const bool exists = stat(path.c_str(), &file) == 0;
  if (!exists && errno != ENOENT)
    return errno;
  if (exists && S_ISDIR(file.st_mode))
    return EISDIR;
  const int permissions = exists ? W_OK : W_OK | X_OK;
  if (faccessat(AT_FDCWD, (exists ? path : directory).c_str(), permissions, AT_EACCESS) != 0)
    return errno;

  const std::size_t size_after = (exists ? static_cast<std::size_t>(file.st_size) : 0) + bytes;
  rlimit limit = {};
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && size_after > limit.rlim_cur)
    return EFBIG;
  struct statvfs disk = {};
  if (statvfs(directory.c_str(), &disk) != 0)
    return errno;
  // Where it is unknown how much is needed: less than a block is none.
  if (static_cast<std::size_t>(disk.f_bavail) * disk.f_frsize < bytes || disk.f_bavail == 0)
    return ENOSPC;
  return 0;
}
} // namespace Gemmule
