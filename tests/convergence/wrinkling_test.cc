// SPDX-License-Identifier: LGPL-2.1-or-later
// Wrinkles of a membrane under negative tension: with bending rigidity their growth is that of linear theory,
// and the mesh has no say in it.
#include <cmath>
#include <gtest/gtest.h>

#include "support/coupled_run.h"

using namespace Gemmule;
using namespace Gemmule::Testing;

namespace
{
constexpr double radius = 0.5, compression = 0.1, rigidity = 1e-4, amplitude = 5e-4;

/** A circle with a small mode under the uniform tension -compression, cells of 4 / 2^level. */
AllParameters wrinkled_circle(const unsigned int mode, const unsigned int level)
{
  AllParameters parameters = small_case_with_tension(std::to_string(-compression));
  // Modes this high do not reach the walls: (R/D)^(2k) = 6e-8 for k = 6.
  parameters.domain.lower_corner = {-2., -2.};
  parameters.domain.upper_corner = {2., 2.};
  parameters.mesh.bulk_level = 4;
  parameters.mesh.membrane_level = parameters.mesh.phase_boundary_level = level;
  parameters.mesh.finest_level = level;
  parameters.membrane.level_set = "if(x^2+y^2<0.01,-0.4,sqrt(x^2+y^2)-0.5-" + std::to_string(amplitude) +
                                  "*cos(" + std::to_string(mode) + "*atan2(y,x)))";
  parameters.bending.rigidity_0 = rigidity;
  return parameters;
}

/** Mode k of the radius, and of the radial velocity, as functions of the angle. */
std::array<double, 2> modes(const CoupledSystem<2> &system, const unsigned int k)
{
  const auto membrane = sample_membrane(system);
  std::array<double, 2> sum{};
  for (unsigned int i = 0; i < membrane.points.size(); ++i)
  {
    const auto &x = membrane.points[i];
    const double r = x.norm(), weight = membrane.weights[i] * (dealii::Tensor<1, 2>(x) * membrane.normal[i]) /
                                        (r * r) * std::cos(k * std::atan2(x[1], x[0])) / dealii::numbers::PI;
    sum[0] += weight * r;
    sum[1] += weight * (membrane.velocity[i] * dealii::Tensor<1, 2>(x)) / r;
  }
  return sum;
}

/** On a circle: (|sigma| k / R - kappa_b k (k^2 - 3/2) / R^3) / 4, towards (|sigma| q - kappa_b q^3) / 4, q =
 * k/R. */
double growth_rate(const unsigned int k)
{
  return 0.25 * (compression * k / radius - rigidity * k * (k * k - 1.5) / std::pow(radius, 3));
}
} // namespace

TEST(Wrinkling, GrowsAtTheRatesOfLinearTheoryWhateverTheMesh)
{
  // The fastest wave number sqrt(|sigma| / (3 kappa_b)) = 18.3 is that of mode 9; 16 is stable.
  for (const unsigned int k : {6u, 9u, 12u, 16u})
  {
    std::array<double, 3> errors;
    for (unsigned int i = 0; i < errors.size(); ++i)
    {
      CoupledSystem<2> system(wrinkled_circle(k, 6 + i), MPI_COMM_WORLD);
      system.initialise();
      const auto mode = modes(system, k);
      errors[i] = std::abs(mode[1] / mode[0] - growth_rate(k)) / growth_rate(9);
      std::cout << "mode " << k << ", h = 1/" << (16 << i) << ": rate " << mode[1] / mode[0] << ", theory "
                << growth_rate(k) << std::endl;
    }
    EXPECT_LT(errors[1], 0.01) << "mode " << k;  // measured: at most 0.004
    EXPECT_LT(errors[2], 0.002) << "mode " << k; // measured: at most 0.0007
  }
}

TEST(Wrinkling, GrowsInTimeAsTheTheorySays)
{
  CoupledSystem<2> system(wrinkled_circle(9, 7), MPI_COMM_WORLD);
  system.initialise();
  const double initial = modes(system, 9)[0], dt = 0.1;
  for (unsigned int i = 0; i < 20; ++i)
  {
    system.try_step(dt);
    system.accept();
  }
  EXPECT_NEAR(std::log(modes(system, 9)[0] / initial) / (20 * dt), growth_rate(9), 0.05 * growth_rate(9));
}
