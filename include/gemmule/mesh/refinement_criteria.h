#pragma once

#include <gemmule/parameters/mesh.h>

#include <deal.II/base/point.h>

#include <memory>
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
};

/**
 * Says which refinement level the membrane needs at a point. Criteria combine by the maximum. A new one is a
 * class here and a line in make_refinement_criteria().
 */
template <int dim>
class RefinementCriterion
{
public:
  virtual ~RefinementCriterion() = default;
  virtual unsigned int level(const MembraneSample<dim> &sample) const = 0;
};

/** The same level everywhere on the membrane. */
template <int dim>
class MembraneCriterion : public RefinementCriterion<dim>
{
public:
  explicit MembraneCriterion(const Parameters::Mesh &parameters);
  unsigned int level(const MembraneSample<dim> &sample) const override;

private:
  unsigned int membrane_level;
};

/** A finer level where the composition lies between the two phases. */
template <int dim>
class PhaseBoundaryCriterion : public RefinementCriterion<dim>
{
public:
  explicit PhaseBoundaryCriterion(const Parameters::Mesh &parameters);
  unsigned int level(const MembraneSample<dim> &sample) const override;

private:
  unsigned int phase_boundary_level;
  double lower, upper;
};

template <int dim>
std::vector<std::unique_ptr<RefinementCriterion<dim>>>
make_refinement_criteria(const Parameters::Mesh &parameters);
} // namespace Gemmule
