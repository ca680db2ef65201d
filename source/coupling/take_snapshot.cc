// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/coupling/take_snapshot.h>

namespace Gemmule
{
using namespace dealii;

namespace
{
  /** Q2 nodal values as Q3 nodal values of the same polynomial. */
  template <int dim, typename T>
  std::array<T, TensorLagrange<dim, 3>::n> raise_degree(const std::array<T, TensorLagrange<dim, 2>::n> &u)
  {
    using Table = std::array<typename TensorLagrange<dim, 2>::Values, TensorLagrange<dim, 3>::n>;
    static const Table table = []
    {
      Table t;
      for (unsigned int i = 0; i < t.size(); ++i)
        TensorLagrange<dim, 2>::evaluate(TensorLagrange<dim, 3>::node(i), t[i]);
      return t;
    }();
    std::array<T, TensorLagrange<dim, 3>::n> raised{};
    for (unsigned int i = 0; i < raised.size(); ++i)
      for (unsigned int j = 0; j < u.size(); ++j)
        raised[i] += table[i][j] * u[j];
    return raised;
  }
} // namespace

template <int dim>
std::vector<TransportedFields<dim>> fields_without_past(const StokesSolver<dim> &flow)
{
  std::vector<TransportedFields<dim>> fields(flow.membrane_velocity().size());
  for (unsigned int c = 0; c < fields.size(); ++c)
    fields[c].velocity_1_back = raise_degree<dim>(flow.membrane_velocity()[c].nodal);
  return fields;
}

template <int dim>
MembraneSnapshot<dim> take_snapshot(const double time, const Point<dim> &origin,
                                    const LevelOnMesh<dim> &level,
                                    const std::vector<TransportedFields<dim>> &transported)
{
  const CutGeometry<dim> &geometry = level.interface.geometry();
  const auto &velocity = level.flow.solver().membrane_velocity();
  std::vector<MembraneFields<dim>> fields(geometry.cut_cells().size());
  AssertDimension(transported.size(), fields.size());
  for (unsigned int c = 0; c < fields.size(); ++c)
  {
    fields[c].velocity = raise_degree<dim>(velocity[c].nodal);
    fields[c].displacement = transported[c].displacement;
    fields[c].velocity_1_back = transported[c].velocity_1_back;
    if (level.flow.has_tension_velocity())
      fields[c].tension_velocity = raise_degree<dim>(level.flow.tension_velocity()[c].nodal);
    if (level.surface != nullptr)
    {
      fields[c].concentration = raise_degree<dim>(level.surface->concentration()[c]);
      fields[c].total_concentration = raise_degree<dim>(level.surface->total_concentration()[c]);
      fields[c].chemical_potential = raise_degree<dim>(level.surface->chemical_potential()[c]);
      fields[c].concentration_1_back = transported[c].concentration_1_back;
      fields[c].concentration_2_back = transported[c].concentration_2_back;
    }
  }
  const MPI_Comm communicator = level.interface.level_set().get_dof_handler().get_communicator();
  MembraneSnapshot<dim> snapshot;
  snapshot.time = time;
  snapshot.origin = origin;
  snapshot.patches = gather_patches(geometry.cut_cells(), fields, communicator);
  snapshot.narrow_band = level.interface.level_set().gather_narrow_band();
  snapshot.cloud =
      gather_cloud(level.surface != nullptr ? level.surface->cloud() : bare_cloud(geometry), communicator);
  return snapshot;
}

#define GEMMULE_INSTANTIATE(dim)                                                                             \
  template std::vector<TransportedFields<dim>> fields_without_past(const StokesSolver<dim> &);               \
  template MembraneSnapshot<dim> take_snapshot(double, const Point<dim> &, const LevelOnMesh<dim> &,         \
                                               const std::vector<TransportedFields<dim>> &);
GEMMULE_INSTANTIATE(2)
GEMMULE_INSTANTIATE(3)
#undef GEMMULE_INSTANTIATE
} // namespace Gemmule
