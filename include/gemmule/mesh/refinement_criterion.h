// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/mesh/box_lattice.h>
#include <gemmule/parameters/mesh.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <optional>
#include <vector>

namespace Gemmule
{
/** What a refinement criterion may ask of a point of the membrane. */
template <int dim>
struct MembraneSample
{
  dealii::Point<dim> point;
  double curvature = 0.;             ///< div n
  std::optional<double> composition; ///< c = f / f-bar, where there are phases
  dealii::Tensor<1, dim> normal;     ///< outward; zero where it is not known
  /** The membrane may be sampled where it is (0) and where it will be (1): no point of the one has a distance
   * from the other. */
  unsigned int time_level = 0;
};

/**
 * What a refinement criterion may ask of a cell of the mesh on which the flow was solved. Plain numbers,
 * without reference to a mesh: they travel between ranks, and stay valid while the mesh changes.
 */
template <int dim>
struct CellSample
{
  std::array<double, dim> center;
  unsigned int level;
  double
      error; ///< estimated error of the flow in this cell, in units of the norm of the flow in the whole box
};

/** What criteria are made from. */
template <int dim>
struct RefinementContext
{
  Parameters::Mesh parameters;
  BoxLattice<dim> box;
  /** 10-90 % width of the composition across a phase boundary in equilibrium (length); 0 without phases. */
  double phase_boundary_width = 0.;
};

/**
 * Says which refinement level the membrane needs at a point. Criteria combine by the maximum. A new one is a
 * class and a line in make_membrane_criteria() (doc/extending.md).
 */
template <int dim>
class MembraneRefinement
{
public:
  virtual ~MembraneRefinement() = default;

  /** Called with all samples before level() is: for criteria that look at more than one of them. */
  virtual void prepare(const std::vector<MembraneSample<dim>> &) {}

  /**
   * @param margin at least one: the level that is needed when all lengths are to be resolved this many times
   * better. Cells are coarsened only where they are finer than needed with a margin, which is the hysteresis.
   * @return 0 if the criterion needs nothing here
   */
  virtual unsigned int level(const MembraneSample<dim> &sample, double margin) const = 0;
};

/** Says which level a cell needs, wherever it lies; combined with all other criteria by the maximum. */
template <int dim>
class CellRefinement
{
public:
  virtual ~CellRefinement() = default;

  virtual void prepare(const std::vector<CellSample<dim>> &) {}

  /** One more than the level of the sample to refine it, the same to keep it, less to allow coarsening. */
  virtual unsigned int level(const CellSample<dim> &sample, double margin) const = 0;
};
} // namespace Gemmule
