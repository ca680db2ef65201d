// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

namespace Gemmule
{
/** What the files in the output directory of a run are, by their names (doc/output.md). */
enum class ResultKind
{
  none, ///< no name of a run
  parameters,
  log,
  statistics,
  membrane,       ///< interface.h5
  membrane_index, ///< interface.xdmf
  fields,         ///< solution-NNNNN.h5
  fields_index,   ///< solution.xdmf
  checkpoints,    ///< the folder checkpoint
  lock
};

/** What a run calls by this name; unfinished files (".part") are of the kind of the complete ones. */
ResultKind kind_of_result(const std::string &name);

/** N of solution-NNNNN.h5; for names of the kind ResultKind::fields. */
unsigned long number_of_fields(const std::string &name);

/** Who has written a file that has a name of ours. */
enum class Origin
{
  nobody,  ///< it does not exist, or is empty: nothing can be lost
  ours,    ///< a run of gemmule
  damaged, ///< perhaps a run of gemmule: an HDF5 file that cannot be read, or is unfinished
  foreign  ///< somebody else; also links to nothing, folders in the place of files and such
};

/**
 * Looks into the file @p path of the given kind: parameters, log, tables and XDMF files are known by how they
 * begin, HDF5 files by the attribute `gemmule_version`, the folder of checkpoints by its numbered folders.
 * Never throws; what cannot be read is foreign.
 */
Origin origin_of(const std::string &path, ResultKind kind);
} // namespace Gemmule
