// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/tensor_lagrange.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

template <int dim>
std::vector<unsigned int> lexicographic_cell_dofs(const FiniteElement<dim> &fe, const unsigned int component)
{
  std::vector<std::pair<Point<dim>, unsigned int>> nodes;
  for (unsigned int i = 0; i < fe.n_dofs_per_cell(); ++i)
  {
    const auto component_and_index = fe.system_to_component_index(i);
    if (component_and_index.first == component)
      nodes.emplace_back(fe.unit_support_point(i), i);
  }
  // Support points of FE_Q are a tensor grid: sorting by the last coordinate first is the lexicographic
  // order.
  std::sort(nodes.begin(), nodes.end(),
            [](const auto &a, const auto &b)
            {
              for (int d = dim - 1; d >= 0; --d)
                if (std::abs(a.first[d] - b.first[d]) > 1e-10)
                  return a.first[d] < b.first[d];
              return false;
            });
  std::vector<unsigned int> numbering;
  for (const auto &node : nodes)
    numbering.push_back(node.second);
  return numbering;
}

template std::vector<unsigned int> lexicographic_cell_dofs(const FiniteElement<2> &, unsigned int);
template std::vector<unsigned int> lexicographic_cell_dofs(const FiniteElement<3> &, unsigned int);
} // namespace Gemmule
