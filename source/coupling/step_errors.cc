// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/coupling/step_errors.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

template <int dim>
CutCellScalar<dim> predict_concentration(const std::vector<TransportedFields<dim>> &transported,
                                         const TimeStep &step)
{
  const std::array<double, 3> weights = step.extrapolation();
  CutCellScalar<dim> predicted(transported.size());
  for (unsigned int c = 0; c < transported.size(); ++c)
    for (unsigned int i = 0; i < MembraneFields<dim>::n; ++i)
    {
      predicted[c][i] = weights[0] * transported[c].concentration_1_back[i];
      // the fields of levels that do not exist are not set
      if (step.n_levels() > 1)
        predicted[c][i] += weights[1] * transported[c].concentration_2_back[i];
      if (step.n_levels() > 2)
        predicted[c][i] += weights[2] * transported[c].concentration_3_back[i];
    }
  return predicted;
}

template <int dim>
StepErrors estimate_step_errors(const CutGeometry<dim> &geometry, const StokesSolver<dim> &flow,
                                const SurfaceSolver<dim> *surface,
                                const std::vector<TransportedFields<dim>> &transported,
                                const CutCellScalar<dim> &predicted_concentration, const TimeStep &step,
                                const MPI_Comm communicator)
{
  const double implicit_weight = step.size() / step.bdf().a0;
  const double milne = step.milne_factor();
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

template CutCellScalar<2> predict_concentration(const std::vector<TransportedFields<2>> &, const TimeStep &);
template CutCellScalar<3> predict_concentration(const std::vector<TransportedFields<3>> &, const TimeStep &);
template StepErrors estimate_step_errors(const CutGeometry<2> &, const StokesSolver<2> &,
                                         const SurfaceSolver<2> *, const std::vector<TransportedFields<2>> &,
                                         const CutCellScalar<2> &, const TimeStep &, MPI_Comm);
template StepErrors estimate_step_errors(const CutGeometry<3> &, const StokesSolver<3> &,
                                         const SurfaceSolver<3> *, const std::vector<TransportedFields<3>> &,
                                         const CutCellScalar<3> &, const TimeStep &, MPI_Comm);
} // namespace Gemmule
