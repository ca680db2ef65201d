// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <limits>
#include <mpi.h>
#include <string>
#include <vector>

namespace Gemmule
{
/**
 * What is reported of one accepted time step: the columns of statistics.csv (doc/output.md), all
 * dimensionless. Integrals over the membrane are written int_G.
 */
struct StatisticsRow
{
  double time = 0.;
  unsigned int step = 0; ///< accepted steps so far
  double time_step_size = 0.;
  unsigned long cells = 0;     ///< active cells of all ranks
  unsigned long flow_dofs = 0; ///< unknowns of the flow system
  unsigned long surface_dofs = 0;

  double centroid_x = 0.; ///< of the enclosed region
  double centroid_y = 0.;
  double area = 0.;       ///< enclosed (volume in 3D)
  double arclength = 0.;  ///< of the membrane (surface area in 3D)
  double mass_f = 0.;     ///< int_G f
  double mass_total = 0.; ///< int_G f_total

  double energy_surface = 0.;    ///< int_G gamma
  double energy_phase = 0.;      ///< (1/M) int_G g + C^2/2 |grad_s f|^2
  double energy_constraint = 0.; ///< (Lambda/2) (L - L_0)^2
  double energy_bending = 0.;
  double energy_total = 0.;
  double dissipation_viscous = 0.; ///< (Ca/2) int eta |grad u + grad u^T|^2, not negative
  double dissipation_phase = 0.;   ///< (1/(M Pe)) int_G |grad_s mu|^2, not negative

  double max_velocity = 0.;
  double tension_min = 0.;
  double tension_max = 0.;
  double f_total_min = 0.;
  double f_total_max = 0.;
  double composition_min = 0.;
  double composition_max = 0.;
  unsigned int phase_boundaries = 0; ///< sign changes of c - 1/2
  unsigned int components = 0;       ///< closed pieces of the membrane
  double curvature_max = 0.;         ///< largest |kappa|
  double deformation = 0.;           ///< (a-b)/(a+b), half axes a, b from second moments
  double area_correction = 0.;       ///< shift of the level set that makes the area exact
  unsigned int linear_iterations = 0;
  double wall_time = 0.; ///< seconds since the start, of all runs that were resumed

  double tension_negative_length = 0.; ///< length of membrane under negative tension
  double grid_scale_rigidity = 0.;     ///< numerical bending rigidity that it has got
  double energy_balance_error = 0.;    ///< dE/dt + dissipation over the step, relative to the dissipation
  double f_total_shift = 0.;           ///< shift of f_total that makes its mass exact
  double time_error_shape = 0.;        ///< estimated local error of the membrane's position
  double time_error_composition = 0.;  ///< estimated local error of the composition
};

/** Names of the columns, in the order of the file. */
std::vector<std::string> statistics_columns();

/** The row as numbers, in the order of statistics_columns(), and back: exact. */
std::vector<double> to_numbers(const StatisticsRow &row);
/** @param numbers as many as there are columns */
StatisticsRow to_statistics_row(const std::vector<double> &numbers);

/**
 * Write statistics.csv: a header line, then one row per accepted time step, with the 17 significant digits
 * that reproduce every double, on disk as soon as write() returns. Only rank 0 writes; construction and
 * write() are collective, so that a failure reaches all ranks.
 */
class StatisticsWriter
{
public:
  /**
   * @param directory existing directory of the results
   * @param resume_after_time keep the rows of an existing file up to this time, cut off what is later; by
   * default a new file is started
   *
   * @throws DiskError when the file cannot be written, UserError when the existing file has other
   * columns than this version writes
   */
  StatisticsWriter(const std::string &directory, const MPI_Comm &communicator,
                   double resume_after_time = -std::numeric_limits<double>::infinity());

  /** Append a row. @throws SimulationError when the disk does not take it */
  void write(const StatisticsRow &row);

  /** Number of rows in the file; known on rank 0. */
  std::size_t n_rows() const { return n_written; }

private:
  void start(double resume_after_time);

  const std::string path;
  const MPI_Comm communicator;
  std::size_t n_written = 0;
};
} // namespace Gemmule
