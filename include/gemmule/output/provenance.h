// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace Gemmule
{
class Hdf5File;

/** Version of the program and revision of its source, "0.1.0 (revision a1b2c3d)". */
std::string program_version();

/** Versions of the libraries that it was built with, "deal.II 9.4.1, Trilinos ...". */
std::string library_versions();

/** Which program made a result, from what, and when: for the log and for every HDF5 file. */
class Provenance
{
public:
  Provenance() = default;

  /** With the present date.
   * @param parameters all values by full name; those that name places on this host are left out */
  Provenance(const std::string &command_line, const std::map<std::string, std::string> &parameters);

  /** Name and value: gemmule_version, git_revision, libraries, command_line, date (UTC), parameters. Empty
   * for an object that was made without arguments. */
  const std::vector<std::pair<std::string, std::string>> &entries() const { return all; }

  /** Sets the entries as attributes of the file, which must not have them yet. */
  void write(Hdf5File &file) const;

  /**
   * Adds an attribute resumed_001 (002 and so on) to a file that an earlier run has begun: time of the state,
   * date, version with revision and command line of the run that goes on with it.
   */
  void write_resumption(Hdf5File &file, double time) const;

  /** Room that write() needs in the file. */
  std::size_t n_bytes() const;

private:
  std::vector<std::pair<std::string, std::string>> all;
};
} // namespace Gemmule
