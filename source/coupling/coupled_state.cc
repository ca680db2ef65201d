// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/coupling/coupled_state.h>
#include <gemmule/output/named_arrays.h>

namespace Gemmule
{
namespace
{
  template <int dim>
  void exchange_patches(ArrayExchange &archive, std::vector<MembranePatch<dim>> &patches)
  {
    using Fields = MembraneFields<dim>;
    using Patch = MembranePatch<dim>;
    archive.member(
        "corner", patches, [](Patch & p) -> auto & { return p.corner; });
    archive.member(
        "size", patches, [](Patch & p) -> auto & { return p.size; });
    archive.member(
        "level_set", patches, [](Patch & p) -> auto & { return p.level_set; });

    const auto field = [&](const std::string &name, auto Fields::*member)
    {
      archive.member(
          name, patches, [member](Patch & p) -> auto & { return p.fields.*member; });
    };
    field("velocity", &Fields::velocity);
    field("displacement", &Fields::displacement);
    field("previous_velocity", &Fields::velocity_1_back);
    field("tension_velocity", &Fields::tension_velocity);
    field("previous_concentration", &Fields::concentration_1_back);
    field("preceding_concentration", &Fields::concentration_2_back);
    field("concentration", &Fields::concentration);
    field("total_concentration", &Fields::total_concentration);
    field("chemical_potential", &Fields::chemical_potential);
    static_assert(sizeof(Fields) == sizeof(double) * Fields::n * (4 * dim + 5),
                  "MembraneFields has a new field: give it a line above, then count it here");
  }

  template <int dim>
  void exchange_level_set(ArrayExchange &archive, std::vector<LevelSetCell<dim>> &cells)
  {
    using Cell = LevelSetCell<dim>;
    archive.member(
        "corner", cells, [](Cell & c) -> auto & { return c.corner; });
    archive.member(
        "size", cells, [](Cell & c) -> auto & { return c.size; });
    archive.member(
        "level_set", cells, [](Cell & c) -> auto & { return c.level_set; });
  }

  template <int dim>
  void exchange_snapshot(ArrayExchange &archive, MembraneSnapshot<dim> &snapshot)
  {
    archive("time", snapshot.time);
    for (unsigned int d = 0; d < dim; ++d)
      archive("origin" + std::to_string(d), snapshot.origin[d]);
    archive.scope("patches", [&] { exchange_patches(archive, snapshot.patches); });
    archive.scope("band", [&] { exchange_level_set(archive, snapshot.narrow_band); });
    archive.scope("cloud",
                  [&]
                  {
                    archive("points", snapshot.cloud.points);
                    archive("normals", snapshot.cloud.normals);
                    archive("weights", snapshot.cloud.weights);
                    archive("concentration", snapshot.cloud.concentration);
                    archive("total_concentration", snapshot.cloud.total_concentration);
                  });
  }

  template <int dim>
  void exchange_flow_samples(ArrayExchange &archive, std::vector<CellSample<dim>> &samples)
  {
    using Sample = CellSample<dim>;
    archive.member(
        "center", samples, [](Sample & s) -> auto & { return s.center; });
    archive.member(
        "error", samples, [](Sample & s) -> auto & { return s.error; });
    std::vector<double> levels;
    for (const auto &sample : samples)
      levels.push_back(sample.level);
    archive("level", levels);
    for (unsigned int i = 0; i < samples.size(); ++i)
      samples[i].level = static_cast<unsigned int>(levels[i]);
  }
} // namespace

template <int dim>
void exchange(ArrayExchange &archive, CoupledState<dim> &state)
{
  // The names in the files are older than those of the members.
  archive.scope("current", [&] { exchange_snapshot(archive, state.levels.level_n); });
  archive.scope("previous", [&] { exchange_snapshot(archive, state.levels.level_n_minus_1); });
  archive("dt_previous", state.levels.step_to_n);
  archive("dt_preceding", state.levels.step_to_n_minus_1);
  static_assert(sizeof(state.levels) == 2 * sizeof(MembraneSnapshot<dim>) + 4 * sizeof(double),
                "AcceptedLevels has a new member: give it a line here, then count it");
  archive("area_0", state.reference.area);
  archive("arclength_0", state.reference.arclength);
  archive("capillary_limit", state.levels.limits.capillary);
  archive("displacement_limit", state.levels.limits.displacement);
  archive("grid_scale_rigidity", state.grid_scale_rigidity);
  archive.integers("mesh", state.mesh);
  archive("steps_since_remeshing", state.mesh_policy.steps_since_remeshing);
  archive("lowered_levels", state.lowered_levels);
  archive.integers("membrane_cells", state.membrane_cells);
  archive("n_steps_on_mesh", state.mesh_policy.n_steps_on_mesh);
  static_assert(sizeof(state.mesh_policy) == 2 * sizeof(unsigned int) + sizeof(std::vector<double>),
                "MeshPolicyMemory has a new member: give it a line here, then count it");
  static_assert(sizeof(state.reference) == 2 * sizeof(double),
                "ReferenceMeasures has a new member: give it a line here, then count it");
  archive.scope("flow_samples", [&] { exchange_flow_samples(archive, state.mesh_policy.flow_samples); });
  archive.scope("box", [&] { exchange_level_set(archive, state.level_set); });
  archive("level_set_is_set_everywhere", state.level_set_is_set_everywhere);
}

template void exchange(ArrayExchange &, CoupledState<2> &);
template void exchange(ArrayExchange &, CoupledState<3> &);
} // namespace Gemmule
