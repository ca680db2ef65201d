#pragma once

#include <gemmule/output/provenance.h>

#include <deal.II/base/data_out_base.h>

#include <limits>
#include <mpi.h>
#include <string>
#include <vector>

namespace Gemmule
{
/**
 * Write the fields of the box: solution-NNNNN.h5 per output time (running number from 0; attributes `time`
 * and the entries of Provenance) and one solution.xdmf, which ParaView opens as a time series (design section
 * 4).
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
   * @param resume_after_time go on after the existing files up to this time, remove the later ones; by
   * default start with number 0
   */
  FieldWriter(const std::string &directory, const MPI_Comm &communicator, const Provenance &provenance,
              double resume_after_time = -std::numeric_limits<double>::infinity());

  /**
   * Write the patches that @p data was built with; for example a DataOut<dim> after build_patches().
   * Collective.
   *
   * @throws SimulationError when the disk does not take it
   */
  void write(const dealii::DataOutInterface<dim, dim> &data, double time);

  /** Number of files so far. */
  unsigned int n_files() const { return n_written; }

private:
  void find_earlier_files(double resume_after_time);

  const std::string directory;
  const MPI_Comm communicator;
  const Provenance provenance;
  unsigned int n_written = 0;
  std::vector<dealii::XDMFEntry> entries; ///< on rank 0
};
} // namespace Gemmule
