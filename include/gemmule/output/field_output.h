// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/output/provenance.h>

#include <deal.II/base/data_out_base.h>

#include <mpi.h>
#include <string>
#include <vector>

namespace Gemmule
{
/**
 * Write the fields of the box: solution-NNNNN.h5 per output time (running number from 0; attributes `time`
 * and the entries of Provenance) and one solution.xdmf, which ParaView opens as a time series
 * (doc/output.md).
 */
template <int dim>
class FieldWriter
{
public:
  /**
   * Collective.
   *
   * @param directory existing directory of the results
   * @param provenance is recorded in every file
   * @param n_earlier_files go on after as many files of an earlier run. They stay as they are, those that can
   * be read are listed in solution.xdmf; later ones are removed.
   */
  FieldWriter(const std::string &directory, const MPI_Comm &communicator, const Provenance &provenance,
              unsigned int n_earlier_files = 0);

  /**
   * Write the patches that @p data was built with; for example a DataOut<dim> after build_patches().
   * Collective.
   *
   * @throws SimulationError when the disk does not take it
   */
  void write(const dealii::DataOutInterface<dim, dim> &data, double time);

  /** Number of files so far. */
  unsigned int n_files() const { return n_written; }

  /** Number of those that solution.xdmf lists; known on rank 0. */
  std::size_t n_listed() const { return grids.size(); }

private:
  void write_cells(const dealii::DataOutInterface<dim, dim> &data,
                   const dealii::DataOutBase::DataOutFilter &cells, const std::string &path,
                   std::size_t n_bytes) const;
  void list(const std::string &file_name);
  void write_xdmf() const;
  void remove_later_files() const;
  void list_earlier_files();

  const std::string directory;
  const MPI_Comm communicator;
  const Provenance provenance;
  unsigned int n_written = 0;
  std::vector<std::string> grids; ///< what solution.xdmf says of each file; on rank 0
};
} // namespace Gemmule
