// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/output/provenance.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <limits>
#include <mpi.h>
#include <string>
#include <vector>

namespace Gemmule
{
/**
 * The membrane at one time, as n quadrature points with the values there (all dimensionless). In 2D the
 * points are ordered along the curve. Every list holds n entries except `connectivity`.
 */
template <int dim>
struct InterfaceSamples
{
  double time = 0.;
  std::vector<dealii::Point<dim>> points;
  std::vector<double> f;                  ///< concentration of one phase
  std::vector<double> f_total;            ///< total concentration
  std::vector<double> composition;        ///< c = f / f_total
  std::vector<double> tension;            ///< sigma
  std::vector<double> chemical_potential; ///< mu
  std::vector<double> curvature;          ///< kappa = div n, positive on a circle
  std::vector<double> weights;            ///< quadrature weights: their sum is the arclength
  std::vector<dealii::Tensor<1, dim>> velocity;
  std::vector<dealii::Tensor<1, dim>> normal; ///< outward unit normal
  /** Segments between points, by their indices: closed curves in 2D. May stay empty (a cloud of points). */
  std::vector<std::array<unsigned int, 2>> connectivity;
};

/**
 * Write interface.h5, one group `step_NNNNN` (running number from 0) per output time with the attribute
 * `time` and the datasets of InterfaceSamples under their names, and interface.xdmf, which shows them in
 * ParaView (doc/output.md). The file's root carries `schema_version` and the entries of Provenance.
 *
 * The file is closed between two groups, so that it can be read while the program runs. A kill while a group
 * is written may damage it: checkpoints keep a copy.
 */
template <int dim>
class InterfaceWriter
{
public:
  /**
   * Collective.
   *
   * @param directory existing directory of the results
   * @param provenance is recorded in a new file
   * @param resume_after_time keep the groups of an existing file up to this time, delete the later ones; by
   * default a new file is started
   *
   * @throws SimulationError when the file cannot be written or, resuming, not be read
   */
  InterfaceWriter(const std::string &directory, const MPI_Comm &communicator, const Provenance &provenance,
                  double resume_after_time = -std::numeric_limits<double>::infinity());

  /**
   * Append one group. Collective; only the samples of rank 0 are used, which must be complete there.
   *
   * @throws SimulationError when the disk does not take it
   */
  void write(const InterfaceSamples<dim> &samples);

  /** Number of groups in the file; known on rank 0. */
  std::size_t n_groups() const { return entries.size(); }

private:
  /** What interface.xdmf says of one group. */
  struct Entry
  {
    std::string group;
    double time;
    std::size_t n_points;
    std::size_t n_segments;
  };

  void start(double resume_after_time);
  void create_file() const;
  void append(const InterfaceSamples<dim> &samples);
  void write_xdmf() const;

  const std::string directory;
  const MPI_Comm communicator;
  const Provenance provenance;
  std::vector<Entry> entries;
};
} // namespace Gemmule
