// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/coupling/step_errors.h>
#include <gemmule/time/bdf.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  /** Part of the difference between predictor and BDF2 that is the error of BDF2; 0: no three old levels. */
  double milne_factor(const StepSizes &steps)
  {
    if (steps.preceding == 0.)
      return 0.;
    const double dt = steps.current, dt1 = steps.previous, dt2 = steps.preceding;
    const double predictor = (dt + dt1) * (dt + dt1 + dt2),
                 corrector = dt * (dt + dt1) * (dt + dt1) / (2. * dt + dt1);
    return corrector / (predictor + corrector);
  }

  BdfCoefficients bdf_coefficients(const StepSizes &steps)
  {
    return steps.previous > 0. ? BdfCoefficients::second_order(steps.current / steps.previous)
                               : BdfCoefficients::first_order();
  }
} // namespace

template <int dim>
CutCellScalar<dim> predict_concentration(const std::vector<TransportedFields<dim>> &transported,
                                         const StepSizes &steps)
{
  const double dt = steps.current;
  // weights of the newest value, the one before, and the one before that
  std::array<double, 3> weights;
  if (steps.preceding > 0.)
  {
    const double t1 = -steps.previous, t2 = -steps.previous - steps.preceding;
    weights = {{(dt - t1) * (dt - t2) / (t1 * t2), dt * (dt - t2) / (t1 * (t1 - t2)),
                dt * (dt - t1) / (t2 * (t2 - t1))}};
  }
  else
  {
    const BdfCoefficients bdf = bdf_coefficients(steps);
    weights = {{bdf.e1, bdf.e2, 0.}};
  }
  CutCellScalar<dim> predicted(transported.size());
  for (unsigned int c = 0; c < transported.size(); ++c)
    for (unsigned int i = 0; i < MembraneFields<dim>::n; ++i)
    {
      predicted[c][i] = weights[0] * transported[c].concentration[i];
      // the fields of levels that do not exist are not set
      if (steps.previous > 0.)
        predicted[c][i] += weights[1] * transported[c].previous_concentration[i];
      if (steps.preceding > 0.)
        predicted[c][i] += weights[2] * transported[c].preceding_concentration[i];
    }
  return predicted;
}

template <int dim>
StepErrors estimate_step_errors(const CutGeometry<dim> &geometry, const StokesSolver<dim> &flow,
                                const SurfaceSolver<dim> *surface,
                                const std::vector<TransportedFields<dim>> &transported,
                                const CutCellScalar<dim> &predicted_concentration, const StepSizes &steps,
                                const MPI_Comm communicator)
{
  const double implicit_weight = steps.current / bdf_coefficients(steps).a0;
  const double milne = milne_factor(steps);
  StepErrors errors;
  bool finite = true;
  for (unsigned int c = 0; c < geometry.cut_cells().size(); ++c)
    for (const auto &q : geometry.cut_cells()[c].surface_points)
    {
      const Tensor<1, dim> u = flow.membrane_velocity()[c].value(q);
      const Tensor<1, dim> extrapolated = TensorLagrange<dim, 3>::value(transported[c].advecting_velocity, q);
      const double shape_error = implicit_weight * (u - extrapolated).norm();
      finite = finite && std::isfinite(shape_error);
      errors.shape = std::max(errors.shape, shape_error);
      if (surface != nullptr)
      {
        const double f = TensorLagrange<dim, 2>::value(surface->concentration()[c], q);
        finite = finite && std::isfinite(f);
        if (milne > 0.)
          errors.composition =
              std::max(errors.composition,
                       milne * std::abs(f - TensorLagrange<dim, 3>::value(predicted_concentration[c], q)));
      }
    }
  if (Utilities::MPI::min(static_cast<unsigned int>(finite), communicator) == 0)
    throw StepBreakdown("the solution is not a finite number.");
  errors.shape = Utilities::MPI::max(errors.shape, communicator);
  errors.composition = Utilities::MPI::max(errors.composition, communicator);
  return errors;
}

template CutCellScalar<2> predict_concentration(const std::vector<TransportedFields<2>> &, const StepSizes &);
template CutCellScalar<3> predict_concentration(const std::vector<TransportedFields<3>> &, const StepSizes &);
template StepErrors estimate_step_errors(const CutGeometry<2> &, const StokesSolver<2> &,
                                         const SurfaceSolver<2> *, const std::vector<TransportedFields<2>> &,
                                         const CutCellScalar<2> &, const StepSizes &, MPI_Comm);
template StepErrors estimate_step_errors(const CutGeometry<3> &, const StokesSolver<3> &,
                                         const SurfaceSolver<3> *, const std::vector<TransportedFields<3>> &,
                                         const CutCellScalar<3> &, const StepSizes &, MPI_Comm);
} // namespace Gemmule
