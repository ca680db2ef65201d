// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/time/time_step.h>

namespace Gemmule
{
TimeStep::TimeStep(const double size, const double size_1_back, const double size_2_back)
    : step(size), step_1_back(size_1_back), step_2_back(size_2_back),
      coefficients(size_1_back > 0. ? BdfCoefficients::second_order(size / size_1_back)
                                    : BdfCoefficients::first_order())
{
}

std::array<double, 3> TimeStep::extrapolation() const
{
  if (n_levels() < 3)
    return {{coefficients.e1, coefficients.e2, 0.}};
  const double dt = step, t1 = -step_1_back, t2 = -step_1_back - step_2_back; // with t_n = 0
  return {{(dt - t1) * (dt - t2) / (t1 * t2), dt * (dt - t2) / (t1 * (t1 - t2)),
           dt * (dt - t1) / (t2 * (t2 - t1))}};
}

double TimeStep::milne_factor() const
{
  if (n_levels() < 3)
    return 0.;
  const double dt = step, dt1 = step_1_back, dt2 = step_2_back;
  const double predictor = (dt + dt1) * (dt + dt1 + dt2),
               corrector = dt * (dt + dt1) * (dt + dt1) / (2. * dt + dt1);
  return corrector / (predictor + corrector);
}
} // namespace Gemmule
