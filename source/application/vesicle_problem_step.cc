// SPDX-License-Identifier: LGPL-2.1-or-later
// The steps of VesicleProblem, with all that can go wrong in them.
#include <gemmule/application/run_results.h>
#include <gemmule/application/step_attempts.h>
#include <gemmule/application/vesicle_problem.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/coupling/coupled_system.h>

namespace Gemmule
{
namespace
{
  // Concentrations are relative to one; the composition f / total loses its meaning long before zero.
  constexpr double vanishing_concentration = 0.1;

  /** A coupled system, as StepAttempts sees it. */
  template <int dim>
  class CoupledTrials : public TrialSystem
  {
  public:
    CoupledTrials(CoupledSystem<dim> &system, const RunResults<dim> &results, const double courant_number)
        : system(system), results(results), courant_number(courant_number)
    {
    }

    double longest_step() const override { return system.time_step_limits().longest_step(courant_number); }
    StepErrors try_step(const double dt) override { return system.try_step(dt); }
    bool mesh_is_new() const override { return system.mesh_is_new(); }
    void accept() override { system.accept(); }
    bool membrane_is_resolved() const override { return system.membrane_is_resolved(); }
    RepairReport repair_membrane() override { return system.repair_membrane(); }

    std::string explanation_of_failure() const override
    {
      const double smallest = results.row().f_total_min;
      if (system.get_surface() == nullptr || smallest > vanishing_concentration)
        return "";
      return " The total concentration has fallen to " + rounded(smallest) +
             " on a part of the membrane: the model ends where it reaches zero. Choose another "
             "'Membrane/Regularisation "
             "of the total concentration/Model', such as 'compressibility', or a larger coefficient "
             "(doc/model.md).";
    }

  private:
    CoupledSystem<dim> &system;
    const RunResults<dim> &results;
    const double courant_number;
  };
} // namespace

template <int dim>
void VesicleProblem<dim>::make_attempts()
{
  const auto &options = parameters.time_stepping;
  trials = std::make_unique<CoupledTrials<dim>>(*system, *results, options.interface_courant_number);
  attempts = std::make_unique<StepAttempts>(*trials, control, retries, *log, options.tolerance);
}

template <int dim>
std::string VesicleProblem<dim>::make_step()
{
  try
  {
    return attempts->make_step(results->row().step + 1, [&] { return stop_conditions.reason_to_stop(); });
  }
  catch (const SimulationError &error)
  {
    save_last_state(error.what());
    throw;
  }
  catch (const ParameterError &error)
  {
    // An expression of t that makes no sense any more. All ranks find it together, and no smaller step
    // helps.
    const std::string reason = parameters.located(error).what();
    save_last_state(reason);
    throw SimulationError(reason);
  }
  catch (const std::exception &error)
  {
    // Of what kind it may be, it need not have happened on all ranks, and not where the state is whole: what
    // there is to go on with is the last checkpoint.
    log_end(error.what());
    throw;
  }
}

template void VesicleProblem<2>::make_attempts();
template std::string VesicleProblem<2>::make_step();
} // namespace Gemmule
