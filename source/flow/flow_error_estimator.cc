// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/flow_error_estimator.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/grid/grid_tools.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  template <int dim>
  using Local = typename StokesSolution<dim>::Local;
  template <int dim>
  using Both = std::array<Local<dim>, 2>;

  /** Derivatives of the flow of one fluid at one point, in unit coordinates. */
  template <int dim>
  struct FlowDerivatives
  {
    Tensor<2, dim> gradient;        ///< [component][direction]
    Tensor<1, dim> laplacian;       ///< Delta u
    Tensor<1, dim> gradient_of_div; ///< grad div u
    double pressure = 0.;
    Tensor<1, dim> pressure_gradient;
  };

  template <int dim>
  FlowDerivatives<dim> derivatives(const Local<dim> &values, const Point<dim> &p)
  {
    using Layout = StokesLayout<dim>;
    FlowDerivatives<dim> result;
    std::array<double, Layout::n_velocity_nodes> component;
    for (unsigned int c = 0; c < dim; ++c)
    {
      std::copy_n(values.begin() + Layout::velocity(c, 0), component.size(), component.begin());
      const auto u = evaluate_polynomial<dim, 2, 2>(component, p);
      result.gradient[c] = u.gradient;
      result.laplacian[c] = trace(u.hessian);
      for (unsigned int d = 0; d < dim; ++d)
        result.gradient_of_div[d] += u.hessian[c][d];
    }
    std::array<double, Layout::n_pressure_nodes> pressure;
    std::copy_n(values.begin() + Layout::pressure(0), pressure.size(), pressure.begin());
    const auto q = evaluate_polynomial<dim, 1, 1>(pressure, p);
    result.pressure = q.value;
    result.pressure_gradient = q.gradient;
    return result;
  }

  /** T n of a fluid, in a cell of size h. */
  template <int dim>
  Tensor<1, dim> traction(const FlowDerivatives<dim> &flow, const double viscosity, const double h,
                          const unsigned int direction)
  {
    Tensor<1, dim> t;
    for (unsigned int c = 0; c < dim; ++c)
      t[c] = viscosity / h * (flow.gradient[c][direction] + flow.gradient[direction][c]);
    t[direction] -= flow.pressure;
    return t;
  }

  /** Values of all owned and ghost cells by active_cell_index. */
  template <int dim>
  std::vector<Both<dim>> values_with_ghosts(const UnfittedStokesSpace<dim> &space,
                                            const StokesAssembler<dim> &assembler,
                                            const StokesSolution<dim> &solution)
  {
    const auto &triangulation = space.mesh();
    std::vector<Both<dim>> values(triangulation.n_active_cells());
    const auto &cells = assembler.cell_elements();
    for (unsigned int k = 0; k < cells.size(); ++k)
      values[cells[k].cell] = solution.cell_values(k);
    if (Utilities::MPI::n_mpi_processes(space.communicator()) > 1)
    {
      using Cell = typename Triangulation<dim>::active_cell_iterator;
      GridTools::exchange_cell_data_to_ghosts<std::vector<double>, Triangulation<dim>>(
          triangulation,
          [&](const Cell &cell)
          {
            const auto &both = values[cell->active_cell_index()];
            std::vector<double> data(both[0].begin(), both[0].end());
            data.insert(data.end(), both[1].begin(), both[1].end());
            return data;
          },
          [&](const Cell &cell, const std::vector<double> &data)
          {
            auto &both = values[cell->active_cell_index()];
            std::copy_n(data.begin(), both[0].size(), both[0].begin());
            std::copy_n(data.begin() + both[0].size(), both[1].size(), both[1].begin());
          });
    }
    return values;
  }

  /** Nodal values of all owned and ghost cells by active_cell_index, and the viscosities of the fluids. */
  template <int dim>
  struct Flow
  {
    std::vector<Both<dim>> values;
    std::array<double, 2> viscosity;
  };

  struct CellShare
  {
    double error = 0.;       ///< residual, divergence and jump of the velocity at the membrane
    double norm_square = 0.; ///< of the flow, in the energy norm
  };

  template <int dim>
  CellShare cell_share(const Flow<dim> &flow, const CutGeometry<dim> &geometry, const unsigned int index,
                       const double h)
  {
    using Layout = StokesLayout<dim>;
    static const QGauss<dim> quadrature(3);
    const auto &viscosity = flow.viscosity;
    const Both<dim> &values = flow.values[index];
    CellShare share;
    const auto add = [&](const unsigned int fluid, const Point<dim> &p, const double weight)
    {
      const double eta = viscosity[fluid];
      const auto u = derivatives<dim>(values[fluid], p);
      const Tensor<1, dim> residual =
          eta / (h * h) * (u.laplacian + u.gradient_of_div) - u.pressure_gradient / h;
      const double divergence = trace(u.gradient) / h;
      share.error += weight * (h * h / (4. * eta) * residual.norm_square() + eta * divergence * divergence);
      share.norm_square +=
          weight * eta / (h * h) *
          (scalar_product(u.gradient, u.gradient) + scalar_product(u.gradient, transpose(u.gradient)));
    };
    if (geometry.location(index) != CellLocation::cut)
    {
      const unsigned int fluid = geometry.location(index) == CellLocation::inside ? 0 : 1;
      for (unsigned int q = 0; q < quadrature.size(); ++q)
        add(fluid, quadrature.point(q), quadrature.weight(q) * std::pow(h, dim));
      return share;
    }

    const CutCell<dim> &cut = *geometry.find(index);
    for (unsigned int fluid = 0; fluid < 2; ++fluid)
      for (unsigned int q = 0; q < cut.bulk_points[fluid].size(); ++q)
        add(fluid, cut.bulk_points[fluid][q], cut.bulk_weights[fluid][q]);
    const double eta = 2. * viscosity[0] * viscosity[1] / (viscosity[0] + viscosity[1]);
    typename Layout::VelocityBasis::Values phi;
    for (unsigned int q = 0; q < cut.surface_points.size(); ++q)
    {
      Layout::VelocityBasis::evaluate(cut.surface_points[q], phi);
      for (unsigned int c = 0; c < dim; ++c)
      {
        double jump = 0.;
        for (unsigned int i = 0; i < phi.size(); ++i)
          jump += phi[i] * (values[1][Layout::velocity(c, i)] - values[0][Layout::velocity(c, i)]);
        share.error += cut.surface_weights[q] * eta / h * jump * jump;
      }
    }
    return share;
  }

  /** Jump of the traction across the face between cells of sizes @p h and @p h_second. */
  template <int dim>
  double face_share(const Flow<dim> &flow, const CutGeometry<dim> &geometry, const InteriorFace &face,
                    const double h, const double h_second)
  {
    static const QGauss<dim - 1> quadrature(4);
    const unsigned int direction = face.face_number / 2;
    const auto first = geometry.location(face.first), second = geometry.location(face.second);
    // Of two cut cells at least one is owned, and knows on which side of the membrane a point of the face is.
    const CutCell<dim> *cut = nullptr;
    if (first == CellLocation::cut && second == CellLocation::cut)
      cut = geometry.find(face.first) != nullptr ? geometry.find(face.first) : geometry.find(face.second);
    double integral = 0.;
    for (unsigned int q = 0; q < quadrature.size(); ++q)
    {
      const auto p = on_both_sides<dim>(face.face_number, face.refinement, quadrature.point(q));
      unsigned int fluid =
          first == CellLocation::cut ? second == CellLocation::outside : first == CellLocation::outside;
      if (cut != nullptr)
        fluid = CutCell<dim>::LevelSetBasis::value(cut->level_set,
                                                   p[cut->active_cell_index == face.first ? 0 : 1]) >= 0.;
      const double eta = flow.viscosity[fluid];
      const Tensor<1, dim> jump =
          traction(derivatives<dim>(flow.values[face.first][fluid], p[0]), eta, h, direction) -
          traction(derivatives<dim>(flow.values[face.second][fluid], p[1]), eta, h_second, direction);
      integral += quadrature.weight(q) * std::pow(h, dim - 1) * h / (4. * eta) * jump.norm_square();
    }
    return integral;
  }
} // namespace

template <int dim>
FlowErrorEstimate
FlowErrorEstimator<dim>::estimate(const UnfittedStokesSpace<dim> &space, const CutGeometry<dim> &geometry,
                                  const StokesAssembler<dim> &assembler, const StokesSolution<dim> &solution)
{
  const auto &triangulation = space.mesh();
  // Shares by global number of the cell: faces between ranks add to cells of both.
  LinearAlgebra::distributed::Vector<double> shares(
      triangulation.global_active_cell_index_partitioner().lock());
  std::vector<types::global_cell_index> number(triangulation.n_active_cells());
  for (const auto &cell : triangulation.active_cell_iterators())
    if (!cell->is_artificial())
      number[cell->active_cell_index()] = cell->global_active_cell_index();

  const Flow<dim> flow{values_with_ghosts(space, assembler, solution), assembler.fluids().viscosity};
  double norm_square = 0.;
  for (const unsigned int index : space.owned_cells())
  {
    const CellShare share = cell_share(flow, geometry, index, space.cell_size(index));
    shares(number[index]) += share.error;
    norm_square += share.norm_square;
  }
  for (const InteriorFace &face : space.interior_faces())
  {
    const double integral =
        face_share(flow, geometry, face, space.cell_size(face.first), space.cell_size(face.second));
    shares(number[face.first]) += 0.5 * integral;
    shares(number[face.second]) += 0.5 * integral;
  }
  shares.compress(VectorOperation::add);

  FlowErrorEstimate result;
  for (const unsigned int index : space.owned_cells())
    result.squares.push_back(shares(number[index]));
  result.norm_square = Utilities::MPI::sum(norm_square, space.communicator());
  return result;
}

template class FlowErrorEstimator<2>;
template class FlowErrorEstimator<3>;
} // namespace Gemmule
