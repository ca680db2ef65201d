// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/output/disk.h>

#include <cstddef>
#include <hdf5.h>
#include <memory>
#include <string>
#include <vector>

namespace Gemmule
{
/** While it lives, HDF5 prints no messages of its own: what fails is reported by an exception. */
class Hdf5Silence
{
public:
  Hdf5Silence();
  ~Hdf5Silence();
  Hdf5Silence(const Hdf5Silence &) = delete;
  Hdf5Silence &operator=(const Hdf5Silence &) = delete;

private:
  H5E_auto2_t messages = nullptr; ///< how HDF5 reported errors before
  void *messages_data = nullptr;
};

/** Does the file begin as HDF5 files do? */
bool begins_as_hdf5(const std::string &path);

/** The errno that the innermost failure of the last call of HDF5 on this thread tells of; 0 if it tells none.
 */
int system_error_of_hdf5();

/**
 * An HDF5 file that one rank reads or extends, with the few operations that the output needs. Locks that a
 * reader (a notebook, ParaView) holds do not stop it, unless HDF5_USE_FILE_LOCKING asks for that. What fails
 * throws DiskError with the path and the reason.
 *
 * Objects are named by their path in the file, such as "step_00000/points".
 */
class Hdf5File
{
public:
  enum class Mode
  {
    create, ///< a new file in place of an old one, which it replaces in close()
    modify, ///< a file that exists
    read
  };

  /**
   * @param growth number of bytes that will be added, without HDF5's own bookkeeping
   * @throws DiskError when the file cannot be opened, or the disk has no room for @p growth
   */
  Hdf5File(const std::string &path, Mode mode, std::size_t growth = 0);
  ~Hdf5File();
  Hdf5File(const Hdf5File &) = delete;
  Hdf5File &operator=(const Hdf5File &) = delete;

  /** Names of the members of the root group, in alphabetical order. */
  std::vector<std::string> members() const;
  void create_group(const std::string &name);
  void remove(const std::string &name);

  /** Attributes of the object @p owner ("/" is the file itself). */
  void set_attribute(const std::string &owner, const std::string &name, double value);
  void set_attribute(const std::string &owner, const std::string &name, int value);
  void set_attribute(const std::string &owner, const std::string &name, const std::string &value);
  bool has_attribute(const std::string &owner, const std::string &name) const;
  double number_attribute(const std::string &owner, const std::string &name) const;
  std::string text_attribute(const std::string &owner, const std::string &name) const;

  /** Write @p values, row by row, as a new dataset of rows × columns (0 columns: a list). */
  void write(const std::string &dataset, const std::vector<double> &values, std::size_t columns = 0);
  void write(const std::string &dataset, const std::vector<unsigned int> &values, std::size_t columns = 0);

  /** Number of entries of a dataset per direction. */
  std::vector<std::size_t> extent(const std::string &dataset) const;

  /** All values of a dataset, row by row, as floating point numbers. */
  std::vector<double> read(const std::string &dataset) const;

  /** Close the file and make sure that everything has been taken by the disk. A new file has its name now. */
  void close();

private:
  /** @p result of an HDF5 call; negative when it failed. */
  template <typename Result>
  Result check(Result result, const std::string &doing) const;
  /** For a call that has failed, perhaps with an errno that HDF5 tells of. */
  [[noreturn]] void fail(const std::string &doing, int system_error) const;
  void write_dataset(const std::string &dataset, const void *values, std::size_t size, std::size_t columns,
                     hid_t type);
  void write_attribute(const std::string &owner, const std::string &name, hid_t type, const void *value);

  const Hdf5Silence silence;
  const std::string path;
  const bool for_reading;
  std::unique_ptr<UnfinishedFile> unfinished; ///< of a new file
  hid_t file = H5I_INVALID_HID;
};
} // namespace Gemmule
