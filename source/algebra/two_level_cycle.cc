// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/two_level_cycle.h>

#include <Teuchos_ParameterList.hpp>
#include <ml_MultiLevelPreconditioner.h>

namespace Gemmule
{
using namespace dealii;

namespace
{
  Teuchos::ParameterList multigrid_settings()
  {
    Teuchos::ParameterList settings;
    ML_Epetra::SetDefaults("SA", settings);
    settings.set("ML output", 0);
    settings.set("aggregation: type", "Uncoupled");
    settings.set("aggregation: threshold", 0.02);
    settings.set("smoother: type", "Chebyshev");
    settings.set("smoother: sweeps", 3);
    settings.set("smoother: Chebyshev alpha", 10.);
    settings.set("coarse: type", "Amesos-KLU");
    settings.set("coarse: max size", 2000);
    settings.set("PDE equations", 1);
    // A single cycle would cost a fifth more iterations on large meshes, and is the smallest part of one.
    settings.set("cycle applications", 2);
    return settings;
  }
} // namespace

TwoLevelCycle::TwoLevelCycle(const Matrix &matrix, const Matrix &prolongation)
    : matrix(matrix), prolongation(prolongation), smoother(matrix.trilinos_matrix(), 3, 12.)
{
  Matrix image;
  matrix.mmult(image, prolongation);
  prolongation.Tmmult(coarse_matrix, image);
  multigrid.initialize(coarse_matrix, multigrid_settings());
}

unsigned int TwoLevelCycle::n_coarse_levels() const
{
  const auto *const hierarchy =
      dynamic_cast<const ML_Epetra::MultiLevelPreconditioner *>(&multigrid.trilinos_operator());
  return hierarchy != nullptr ? hierarchy->GetML()->ML_num_actual_levels : 1;
}

void TwoLevelCycle::apply(Epetra_MultiVector &right_side, Epetra_MultiVector &x) const
{
  const int n = x.NumVectors();
  x.PutScalar(0.);
  smoother.smooth(right_side, x, /*update_residual =*/true);

  const Epetra_CrsMatrix &prolong = prolongation.trilinos_matrix();
  Epetra_MultiVector coarse_residual(prolong.DomainMap(), n), coarse(prolong.DomainMap(), n);
  prolong.Multiply(true, right_side, coarse_residual);
  multigrid.trilinos_operator().ApplyInverse(coarse_residual, coarse);
  Epetra_MultiVector correction(x.Map(), n), product(x.Map(), n);
  prolong.Multiply(false, coarse, correction);
  x.Update(1., correction, 1.);
  matrix.trilinos_matrix().Multiply(false, correction, product);
  right_side.Update(-1., product, 1.);

  smoother.smooth(right_side, x, /*update_residual =*/false);
}
} // namespace Gemmule
