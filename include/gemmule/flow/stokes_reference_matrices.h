// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/stokes_layout.h>

#include <deal.II/lac/full_matrix.h>

#include <array>
#include <vector>

namespace Gemmule
{
namespace Parameters
{
  struct Flow;
}

/** Matrices of the jumps of normal derivatives across one face: nodes of the first cell, then those of the
 * second. */
struct GhostPenaltyMatrices
{
  /** int g1 [d_n phi][d_n phi] + g2 [d_nn phi][d_nn phi] of the Q2 velocity; times eta h^(dim-2), h the finer
   * size. */
  dealii::FullMatrix<double> velocity;
  /** int g_p [d_n psi][d_n psi] of the Q1 pressure; times -h^dim / eta. */
  dealii::FullMatrix<double> pressure;
};

/**
 * Element matrices on the unit cell, computed once: cells are cubes aligned with the axes, so that those of
 * all uncut cells and of all faces follow by scaling.
 */
template <int dim>
class StokesReferenceMatrices
{
public:
  using Layout = StokesLayout<dim>;

  explicit StokesReferenceMatrices(const Parameters::Flow &parameters);

  /** Stokes operator of a whole cell of size @p h: int 2 eta D(u):D(v) - p div v - q div u. */
  dealii::FullMatrix<double> cell(double viscosity, double h) const;

  /** @param face_number of the first cell, @param refinement as in InteriorFace */
  const GhostPenaltyMatrices &face(unsigned int face_number, unsigned int refinement) const
  {
    return faces[face_number][refinement];
  }

private:
  void integrate_cell();
  GhostPenaltyMatrices integrate_face(unsigned int face_number, unsigned int refinement,
                                      const Parameters::Flow &parameters) const;

  static constexpr unsigned int n_child_faces = dim == 2 ? 2 : 4;
  dealii::FullMatrix<double> viscous;    ///< eta = h = 1
  dealii::FullMatrix<double> divergence; ///< h = 1
  std::array<std::array<GhostPenaltyMatrices, 1 + n_child_faces>, 2 * dim> faces;
};
} // namespace Gemmule
