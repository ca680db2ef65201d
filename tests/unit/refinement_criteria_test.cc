// SPDX-License-Identifier: LGPL-2.1-or-later
// Which levels the criteria ask for, on shapes whose curvatures and distances are known.
#include <gemmule/mesh/curvature_criterion.h>
#include <gemmule/mesh/flow_error_criterion.h>
#include <gemmule/mesh/gap_criterion.h>
#include <gemmule/mesh/phase_boundary_criterion.h>
#include <gemmule/mesh/refinement_criteria.h>
#include <gemmule/mesh/wall_criterion.h>

#include <deal.II/base/numbers.h>

#include <cmath>
#include <gtest/gtest.h>
#include <random>

using namespace Gemmule;
using namespace dealii;

namespace
{
/** The box [-1, 1]^dim: cells of level l have the size 2^(1-l). */
template <int dim>
RefinementContext<dim> context()
{
  RefinementContext<dim> c;
  c.parameters.bulk_level = 3;
  c.parameters.membrane_level = 4;
  c.parameters.phase_boundary_level = 4;
  c.parameters.finest_level = 10;
  for (unsigned int d = 0; d < dim; ++d)
  {
    c.box.lower[d] = -1.;
    c.box.upper[d] = 1.;
  }
  c.box.coarse_size = 2.;
  return c;
}

template <int dim>
MembraneSample<dim> sample(const Point<dim> &point, const Tensor<1, dim> &normal = {})
{
  MembraneSample<dim> s;
  s.point = point;
  s.normal = normal;
  return s;
}

/** Largest cells that satisfy a condition size <= limit. */
unsigned int expected_level(const double limit)
{
  return static_cast<unsigned int>(std::max(0., std::ceil(std::log2(2. / limit) - 1e-9)));
}

/** Two horizontal sheets at y = -+ width/2, with spacing @p spacing, normals away from each other or towards.
 */
std::vector<MembraneSample<2>> two_sheets(const double width, const double spacing, const bool outside)
{
  std::vector<MembraneSample<2>> samples;
  for (double x = -0.5; x < 0.5; x += spacing)
    for (const double side : {-1., 1.})
      // shifted against one another: no sample has another one straight opposite
      samples.push_back(sample(Point<2>(x + (side > 0. ? 0.4 * spacing : 0.), side * 0.5 * width),
                               Tensor<1, 2>({0., outside ? -side : side})));
  return samples;
}

std::vector<MembraneSample<2>> circle(const Point<2> &center, const double radius, const unsigned int n)
{
  std::vector<MembraneSample<2>> samples;
  for (unsigned int i = 0; i < n; ++i)
  {
    const double angle = 2. * numbers::PI * i / n;
    const Tensor<1, 2> normal({std::cos(angle), std::sin(angle)});
    samples.push_back(sample<2>(center + radius * normal, normal));
    samples.back().curvature = 1. / radius;
  }
  return samples;
}
} // namespace

TEST(RefinementCriteria, CurvatureTimesCellSizeIsWithinTheTolerance)
{
  auto c = context<2>();
  for (const double tolerance : {0.5, 0.2, 1.})
  {
    c.parameters.curvature_tolerance = tolerance;
    const CurvatureCriterion<2> criterion(c);
    for (const double curvature : {0.01, 0.1, 1., 2.1, -4., 17., 100.})
    {
      MembraneSample<2> s;
      s.curvature = curvature;
      const unsigned int level = criterion.level(s, 1.);
      EXPECT_EQ(level, expected_level(tolerance / std::abs(curvature))) << curvature;
      EXPECT_LE(c.box.cell_size(level) * std::abs(curvature), tolerance * 1.0001);
      EXPECT_GE(criterion.level(s, 1.25), level);
    }
  }
}

TEST(RefinementCriteria, CurvatureIsKeptWithAMarginBeforeItIsCoarsened)
{
  const CurvatureCriterion<2> criterion(context<2>()); // tolerance 0.5
  MembraneSample<2> s;
  // Level 5 has h = 1/16, enough for curvatures up to 8.
  for (const double curvature : {7.9, 6.5})
  {
    s.curvature = curvature;
    EXPECT_EQ(criterion.level(s, 1.), 5u);
    EXPECT_EQ(criterion.level(s, 1.25), 6u) << "level 6 would be kept";
  }
  s.curvature = 6.3;
  EXPECT_EQ(criterion.level(s, 1.25), 5u) << "level 6 would be left";
}

TEST(RefinementCriteria, CellsPerPhaseBoundaryWidth)
{
  auto c = context<2>();
  c.phase_boundary_width = 6.2 * 0.02;
  MembraneSample<2> mixed, pure, without;
  mixed.composition = 0.5;
  pure.composition = 0.99;
  for (const double n : {2., 4., 8., 16.})
  {
    c.parameters.cells_per_phase_boundary = n;
    const PhaseBoundaryCriterion<2> criterion(c);
    const unsigned int level = criterion.level(mixed, 1.);
    EXPECT_EQ(level, std::max(4u, expected_level(c.phase_boundary_width / n)));
    EXPECT_LE(n * c.box.cell_size(level), c.phase_boundary_width);
    EXPECT_EQ(criterion.level(pure, 1.), 0u);
    EXPECT_EQ(criterion.level(without, 1.), 0u);
  }
  c.parameters.cells_per_phase_boundary = 0.;
  EXPECT_EQ(PhaseBoundaryCriterion<2>(c).level(mixed, 1.), 4u) << "the fixed level alone";
  // hysteresis in the bounds
  const PhaseBoundaryCriterion<2> criterion(c);
  mixed.composition = 0.957;
  EXPECT_EQ(criterion.level(mixed, 1.), 0u);
  EXPECT_EQ(criterion.level(mixed, 1.25), 4u);
}

TEST(RefinementCriteria, CellsBetweenTwoSheets)
{
  for (const bool outside : {false, true})
    for (const double cells : {2., 4., 6.})
      for (const double width : {0.3, 0.11, 0.052, 0.021, 0.0101})
      {
        auto c = context<2>();
        c.parameters.cells_per_gap = cells;
        const auto samples = two_sheets(width, 0.007, outside);
        GapCriterion<2> criterion(c);
        criterion.prepare(samples);
        // the levels up to that of the membrane are not this criterion's business; it is off by the thinning
        const unsigned int wanted = expected_level(width / cells);
        for (const auto &s : samples)
          if (std::abs(s.point[0]) < 0.4)
          {
            const unsigned int level = criterion.level(s, 1.);
            EXPECT_EQ(std::max(level, c.parameters.membrane_level),
                      std::max(wanted, c.parameters.membrane_level))
                << "width " << width << ", cells " << cells << " at " << s.point;
          }
      }
}

TEST(RefinementCriteria, SheetsInThreeDimensions)
{
  auto c = context<3>();
  std::vector<MembraneSample<3>> samples;
  const double width = 0.11;
  for (double x = -0.3; x < 0.3; x += 0.02)
    for (double y = -0.3; y < 0.3; y += 0.02)
      for (const double side : {-1., 1.})
        samples.push_back(sample(Point<3>(x, y, 0.5 * side * width), Tensor<1, 3>({0., 0., side})));
  GapCriterion<3> criterion(c);
  criterion.prepare(samples);
  for (const auto &s : samples)
    EXPECT_EQ(criterion.level(s, 1.), expected_level(width / 4.));
}

TEST(RefinementCriteria, NeighboursAlongACurveAreNoGap)
{
  // A circle is as thick as its diameter, however dense its samples are.
  auto c = context<2>();
  const auto samples = circle(Point<2>(0.1, 0.2), 0.3, 3000);
  GapCriterion<2> criterion(c);
  criterion.prepare(samples);
  for (const auto &s : samples)
    EXPECT_LE(criterion.level(s, 1.), c.parameters.membrane_level);
  // A small one is thin.
  const auto small = circle(Point<2>(0.1, 0.2), 0.02, 300);
  criterion.prepare(small);
  for (const auto &s : small)
    EXPECT_NEAR(criterion.level(s, 1.), expected_level(0.04 / 4.), 1.);
}

TEST(RefinementCriteria, NearContactOfTwoCirclesIsResolvedWhereTheyAreNear)
{
  const double distance = 0.03, radius = 0.3;
  auto samples = circle(Point<2>(-radius - 0.5 * distance, 0.), radius, 1200);
  for (const auto &s : circle(Point<2>(radius + 0.5 * distance, 0.), radius, 1300))
    samples.push_back(s);
  const auto c = context<2>();
  GapCriterion<2> criterion(c);
  criterion.prepare(samples);
  for (const auto &s : samples)
  {
    const unsigned int level = criterion.level(s, 1.);
    // the distance of horizontally opposite points
    const double y = s.point[1], facing = s.point[0] * s.normal[0];
    if (facing < 0. && std::abs(y) < 0.01)
    {
      EXPECT_EQ(level, expected_level(distance / 4.)) << s.point;
    }
    if (facing > 0. || std::abs(y) > 0.25)
    {
      EXPECT_LE(level, c.parameters.membrane_level) << s.point;
    }
  }
}

TEST(RefinementCriteria, GapIsWithinOneTimeLevel)
{
  // A finger that moves across itself: where it is and where it will be have no gap between them.
  const double width = 0.06;
  auto samples = two_sheets(width, 0.004, false);
  const unsigned int n = samples.size();
  for (const double travel : {0.01, 0.05, 0.06})
  {
    samples.resize(n);
    for (unsigned int i = 0; i < n; ++i)
    {
      samples.push_back(samples[i]);
      samples.back().point[1] += travel;
      samples.back().time_level = 1;
    }
    GapCriterion<2> criterion(context<2>());
    criterion.prepare(samples);
    for (const auto &s : samples)
      EXPECT_EQ(criterion.level(s, 1.), expected_level(width / 4.));
  }
}

TEST(RefinementCriteria, WorkOfTheGapCriterionIsProportionalToTheSamples)
{
  // Samples that are far denser than the cells, as a locally refined mesh leaves them, are thinned: what is
  // seen of a gap does not depend on their number, nor does the number of those that one is compared with.
  const auto c = context<2>();
  for (const double spacing : {0.004, 0.001, 0.00025})
  {
    const auto samples = two_sheets(0.052, spacing, true);
    GapCriterion<2> criterion(c);
    criterion.prepare(samples);
    for (unsigned int i = samples.size() / 3; i < samples.size() / 2; i += 17)
      EXPECT_EQ(criterion.level(samples[i], 1.), expected_level(0.052 / 4.));
    // 8 small cubes along each of two sheets, and one more where a sheet crosses their boundary
    EXPECT_LE(criterion.largest_bin(), 2u * 2u * 9u);
    EXPECT_GE(criterion.largest_bin(), 8u);
  }
}

TEST(RefinementCriteria, CellsBetweenMembraneAndWall)
{
  auto c = context<2>();
  for (const double cells : {0., 4.})
  {
    c.parameters.cells_per_gap = cells;
    const WallCriterion<2> criterion(c);
    for (const double distance : {0.9, 0.2, 0.05, 0.003})
      for (const auto &p : {Point<2>(1. - distance, 0.1), Point<2>(0.1, -1. + distance)})
        EXPECT_EQ(criterion.level(sample(p), 1.), expected_level(distance / std::max(cells, 1.5)));
    EXPECT_GT(criterion.level(sample(Point<2>(1.1, 0.)), 1.), 20u) << "outside the box: as fine as possible";
  }
}

TEST(RefinementCriteria, ErrorOfTheFlowIsSpreadEvenly)
{
  auto c = context<2>();
  c.parameters.flow_error_tolerance = 0.1;
  FlowErrorCriterion<2> criterion(c);
  std::vector<CellSample<2>> cells(400);
  for (auto &cell : cells)
    cell.level = 5;
  criterion.prepare(cells);
  const double share = 0.1 / 20.; // 400 cells with this error have 0.1 together
  const auto level = [&](const double error, const double margin)
  {
    cells[0].error = error;
    return criterion.level(cells[0], margin);
  };
  EXPECT_EQ(level(1.01 * share, 1.), 6u);
  EXPECT_EQ(level(0.99 * share, 1.), 5u);
  EXPECT_EQ(level(0.13 * share, 1.), 5u);
  EXPECT_EQ(level(0.11 * share, 1.), 4u) << "the parent has eight times the error";
  EXPECT_EQ(level(0.11 * share, 1.25), 5u);
  EXPECT_EQ(level(0.09 * share, 1.25), 4u);
}

TEST(RefinementCriteria, EachCanBeSwitchedOff)
{
  auto c = context<2>();
  c.parameters.cells_per_gap = c.parameters.curvature_tolerance = 0.;
  auto thin = two_sheets(0.02, 0.007, false);
  for (auto &s : thin)
    s.curvature = 50.;
  for (const auto &criterion : make_membrane_criteria(c))
  {
    criterion->prepare(thin);
    for (const auto &s : thin)
      EXPECT_LE(criterion->level(s, 1.), c.parameters.membrane_level);
  }
  EXPECT_TRUE(make_cell_criteria(c).empty());
  const auto n_off = make_membrane_criteria(c).size();
  c.parameters.cells_per_gap = 4.;
  c.parameters.curvature_tolerance = 0.5;
  c.parameters.flow_error_tolerance = 0.1;
  EXPECT_EQ(make_membrane_criteria(c).size(), n_off + 2);
  EXPECT_EQ(make_cell_criteria(c).size(), 1u);
}
