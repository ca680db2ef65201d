// SPDX-License-Identifier: LGPL-2.1-or-later
// The whole time step respects the symmetries of the model that the mesh has as well.
#include <cmath>
#include <gtest/gtest.h>

#include "support/coupled_run.h"

using namespace Gemmule;
using namespace Gemmule::Testing;

namespace
{
using dealii::Point;

/** A case with phases, viscosity contrast and imposed flow, so that nothing is symmetric by accident. */
AllParameters general_case()
{
  AllParameters parameters = small_case();
  parameters.membrane.level_set = "(x-0.07)^2+2*(y+0.11)^2+0.4*x*y-0.25";
  set_two_phases(parameters, "x-0.1+0.3*y");
  parameters.fluid.viscosity_ratio = 3.;
  parameters.domain.boundary_velocity = "0.4*y; 0.1*x";
  return parameters;
}

void expect_near(const StatisticsRow &a, const StatisticsRow &b, const double tolerance)
{
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.flow_dofs, b.flow_dofs);
  EXPECT_EQ(a.surface_dofs, b.surface_dofs);
  EXPECT_EQ(a.phase_boundaries, b.phase_boundaries);
  EXPECT_EQ(a.components, b.components);
  const auto compare = [&](double StatisticsRow::*figure, const char *name)
  { EXPECT_NEAR(a.*figure, b.*figure, tolerance * std::max(1., std::abs(b.*figure))) << name; };
  compare(&StatisticsRow::area, "area");
  compare(&StatisticsRow::arclength, "arclength");
  compare(&StatisticsRow::mass_f, "mass_f");
  compare(&StatisticsRow::mass_total, "mass_total");
  compare(&StatisticsRow::energy_surface, "energy_surface");
  compare(&StatisticsRow::energy_phase, "energy_phase");
  compare(&StatisticsRow::dissipation_viscous, "dissipation_viscous");
  compare(&StatisticsRow::dissipation_phase, "dissipation_phase");
  compare(&StatisticsRow::max_velocity, "max_velocity");
  compare(&StatisticsRow::tension_min, "tension_min");
  compare(&StatisticsRow::tension_max, "tension_max");
  compare(&StatisticsRow::f_total_min, "f_total_min");
  compare(&StatisticsRow::f_total_max, "f_total_max");
  compare(&StatisticsRow::composition_min, "composition_min");
  compare(&StatisticsRow::composition_max, "composition_max");
}

constexpr unsigned int n_steps = 8;
constexpr double dt = 0.01;
} // namespace

TEST(CoupledSymmetry, MirrorImageStaysMirrorImage)
{
  // Everything is even in y: the membrane, its phases and the imposed flow.
  AllParameters parameters = small_case();
  parameters.membrane.level_set = "(x-0.07)^2+2*y^2-0.25";
  set_two_phases(parameters, "x-0.1+0.3*y^2");
  parameters.domain.boundary_velocity = "0.3*x; -0.3*y";
  CoupledSystem<2> system(parameters, MPI_COMM_WORLD);
  system.initialise();
  run_steps(system, n_steps, dt);
  const auto membrane = sample_membrane(system);
  const auto row = make_statistics(system, membrane);
  EXPECT_NEAR(row.centroid_y, 0., 1e-9);
  EXPECT_GT(std::abs(row.centroid_x - 0.07), 1e-4) << "nothing has moved";

  double worst_distance = 0., worst_f = 0., worst_tension = 0., worst_velocity = 0.;
  for (unsigned int i = 0; i < membrane.points.size(); ++i)
  {
    const Point<2> image(membrane.points[i][0], -membrane.points[i][1]);
    unsigned int partner = 0;
    for (unsigned int j = 1; j < membrane.points.size(); ++j)
      if (image.distance_square(membrane.points[j]) < image.distance_square(membrane.points[partner]))
        partner = j;
    worst_distance = std::max(worst_distance, image.distance(membrane.points[partner]));
    worst_f = std::max(worst_f, std::abs(membrane.f[i] - membrane.f[partner]));
    worst_tension = std::max(worst_tension, std::abs(membrane.tension[i] - membrane.tension[partner]));
    worst_velocity =
        std::max(worst_velocity, std::abs(membrane.velocity[i][0] - membrane.velocity[partner][0]) +
                                     std::abs(membrane.velocity[i][1] + membrane.velocity[partner][1]));
  }
  EXPECT_LT(worst_distance, 1e-8);
  EXPECT_LT(worst_f, 1e-7);
  EXPECT_LT(worst_tension, 1e-6);
  EXPECT_LT(worst_velocity, 1e-6);
}

TEST(CoupledSymmetry, TranslationByACoarseCellChangesNothing)
{
  // The box and all that is in it are moved by (2, -2), an edge of the coarse cell in both directions.
  AllParameters here = general_case();
  AllParameters there = here;
  there.domain.lower_corner = {1., -3.};
  there.domain.upper_corner = {3., -1.};
  there.membrane.level_set = "(x-2.07)^2+2*(y+2.11)^2+0.4*(x-2)*(y+2)-0.25";
  set_two_phases(there, "(x-2)-0.1+0.3*(y+2)");
  there.domain.boundary_velocity = "0.4*(y+2); 0.1*(x-2)";
  const auto a = run_case(here, n_steps, dt), b = run_case(there, n_steps, dt);
  EXPECT_NEAR(b.back().centroid_x - 2., a.back().centroid_x, 1e-9);
  EXPECT_NEAR(b.back().centroid_y + 2., a.back().centroid_y, 1e-9);
  EXPECT_NEAR(b.back().deformation, a.back().deformation, 1e-9);
  expect_near(b.back(), a.back(), 1e-8);
}

TEST(CoupledSymmetry, RotationByARightAngleChangesNothing)
{
  // (x, y) -> (-y, x): functions of the point take (y, -x), vectors turn.
  AllParameters rotated = general_case();
  rotated.membrane.level_set = "(y-0.07)^2+2*(-x+0.11)^2+0.4*y*(-x)-0.25";
  set_two_phases(rotated, "y-0.1+0.3*(-x)");
  rotated.domain.boundary_velocity = "-0.1*y; 0.4*(-x)";
  const auto a = run_case(general_case(), n_steps, dt), b = run_case(rotated, n_steps, dt);
  EXPECT_NEAR(b.back().centroid_x, -a.back().centroid_y, 1e-9);
  EXPECT_NEAR(b.back().centroid_y, a.back().centroid_x, 1e-9);
  EXPECT_NEAR(b.back().deformation, -a.back().deformation, 1e-9);
  expect_near(b.back(), a.back(), 1e-8);
}
