// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/extra_field.h>

#include <algorithm>

namespace Gemmule
{
using namespace dealii;

template <int dim>
void ExtraField<dim>::add_elements(const std::vector<CondensedIndices> &flow_elements, LinearSystem &system)
{
  elements.clear();
  const auto &numbering = system.numbering();
  for (unsigned int b = 0; b < trace_space->active_mesh().size(); ++b)
  {
    const TraceCell<dim> &cell = trace_space->active_mesh()[b];
    CondensedIndices element;
    if (cell.cut)
      element = flow_elements[cell.cut_index];
    element.append(trace_space->elements()[b],
                   [&](const auto index) { return numbering.number(field, index); });
    element.sort();
    elements.push_back(system.add_element(std::move(element)));
  }
}

template <int dim>
void ExtraField<dim>::add_to(LinearSystem::Vector &right_side, const LinearSystem &system,
                             const LinearSystem::Vector &values) const
{
  for (const auto index : values.locally_owned_elements())
    right_side(system.numbering().number(field, index)) += values(index);
}

template <int dim>
TraceField<dim> ExtraField<dim>::extract(const LinearSystem &system,
                                         const LinearSystem::Vector &solution) const
{
  TraceField<dim> values(trace_space->geometry().cut_cells().size());
  std::array<double, n_flow + n> local;
  for (unsigned int b = 0; b < elements.size(); ++b)
    if (const TraceCell<dim> &cell = trace_space->active_mesh()[b]; cell.cut)
    {
      system.gather(elements[b], solution, local.data());
      std::copy_n(local.begin() + n_flow, n, values[cell.cut_index].begin());
    }
  return values;
}

template class ExtraField<2>;
template class ExtraField<3>;
} // namespace Gemmule
