// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/condensed_indices.h>

#include <deal.II/lac/full_matrix.h>

#include <vector>

namespace Gemmule
{
/**
 * The matrix T^T local T of one element row by row, where CondensedIndices is T.
 *
 * Most unknowns are one local dof, with the weight one. So T is kept by unknowns: the first of the dofs of
 * each, and a list of the few others, which come from hanging nodes and from dofs that two cells share.
 */
class ElementCondensation
{
public:
  void reinit(const CondensedIndices &element);

  unsigned int n() const { return first_dof.size(); }

  /** Row @p row of @p factor times the matrix, its entries from @p begin on; valid until the next call. */
  const double *row(const dealii::FullMatrix<double> &local, double factor, unsigned int row,
                    unsigned int begin);

private:
  struct Entry
  {
    unsigned int unknown, dof;
    double weight;
  };

  /** Position in others of the first that belongs to an unknown >= @p unknown. */
  std::vector<Entry>::const_iterator others_from(unsigned int unknown) const;

  std::vector<unsigned int> first_dof; ///< by unknown
  std::vector<double> first_weight;    ///< of that dof
  std::vector<Entry> others;           ///< ascending by unknown, then by dof
  std::vector<double> sum, result;
};
} // namespace Gemmule
