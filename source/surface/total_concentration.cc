// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/model/membrane_model.h>
#include <gemmule/parameters/discretisation.h>
#include <gemmule/surface/conservative_transport.h>
#include <gemmule/surface/smoothed_update.h>
#include <gemmule/surface/total_concentration.h>

namespace Gemmule
{
template <int dim>
std::unique_ptr<TotalConcentration<dim>>
TotalConcentration<dim>::create(const MembraneModel &model, const Parameters::Surface &parameters,
                                const MPI_Comm communicator)
{
  const auto &choice = model.regularisation();
  switch (choice.model)
  {
  case Parameters::RegularisationModel::update_smoothing:
    return std::make_unique<SmoothedUpdate<dim>>(choice.smoothing_coefficient,
                                                 parameters.normal_stabilisation, communicator);
  case Parameters::RegularisationModel::diffusion:
    return std::make_unique<ConservativeTransport<dim>>(choice.diffusion_coefficient,
                                                        parameters.normal_stabilisation, communicator);
  case Parameters::RegularisationModel::compressibility: // acts through the tension
  case Parameters::RegularisationModel::none:
    break;
  }
  return std::make_unique<ConservativeTransport<dim>>(0., parameters.normal_stabilisation, communicator);
}

template class TotalConcentration<2>;
template class TotalConcentration<3>;
} // namespace Gemmule
