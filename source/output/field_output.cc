// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/arrival.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/base/rank_zero.h>
#include <gemmule/output/disk.h>
#include <gemmule/output/field_output.h>
#include <gemmule/output/hdf5_file.h>
#include <gemmule/output/xdmf.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>

#include <cstdio>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <memory>
#include <regex>
#include <sstream>

namespace Gemmule
{
namespace
{
  std::string file_name(const std::size_t number)
  {
    std::ostringstream name;
    name << "solution-" << std::setw(5) << std::setfill('0') << number << ".h5";
    return name.str();
  }

  /** What solution.xdmf has to say of an existing file. */
  template <int dim>
  std::string grid_of(const Hdf5File &file, const std::string &name)
  {
    const std::string n_points = std::to_string(file.extent("nodes")[0]);
    const std::string n_cells = std::to_string(file.extent("cells")[0]);
    const unsigned int n_vertices = dealii::GeometryInfo<dim>::vertices_per_cell;
    std::string grid = "<Grid Name=\"" + name + "\" GridType=\"Uniform\">\n" +
                       Xdmf::time(file.number_attribute("/", "time")) + "<Geometry GeometryType=\"" +
                       (dim == 2 ? "XY" : "XYZ") + "\">" +
                       Xdmf::data_item(n_points + " " + std::to_string(dim), name + ":/nodes") +
                       "</Geometry>\n<Topology TopologyType=\"" +
                       (dim == 2 ? "Quadrilateral" : "Hexahedron") + "\" NumberOfElements=\"" + n_cells +
                       "\">" +
                       Xdmf::data_item(n_cells + " " + std::to_string(n_vertices), name + ":/cells", "UInt") +
                       "</Topology>\n";
    for (const std::string &field : file.members())
      if (field != "nodes" && field != "cells")
      {
        const std::vector<std::size_t> extent = file.extent(field);
        const std::size_t n_components = extent.size() > 1 ? extent[1] : 1;
        grid += Xdmf::attribute(
            field, n_components > 1 ? "Vector" : "Scalar",
            Xdmf::data_item(n_points + " " + std::to_string(n_components), name + ":/" + field));
      }
    return grid + "</Grid>\n";
  }

  /** Bytes that this rank contributes to a file, with some more for HDF5 itself. */
  template <int dim>
  std::size_t n_bytes_here(const dealii::DataOutBase::DataOutFilter &filter)
  {
    // Where there are no cells their number is not set.
    if (filter.n_nodes() == 0)
      return 0;
    std::size_t numbers_per_node = dim;
    for (unsigned int set = 0; set < filter.n_data_sets(); ++set)
      numbers_per_node += filter.get_data_set_dim(set);
    return filter.n_nodes() * numbers_per_node * sizeof(double) +
           filter.n_cells() * dealii::GeometryInfo<dim>::vertices_per_cell * sizeof(unsigned int) + 65536;
  }
} // namespace

template <int dim>
FieldWriter<dim>::FieldWriter(const std::string &directory, const MPI_Comm &communicator,
                              const Provenance &provenance, const unsigned int n_earlier_files)
    : directory(directory), communicator(communicator), provenance(provenance), n_written(n_earlier_files)
{
  on_rank_zero(communicator,
               [&]()
               {
                 remove_later_files();
                 list_earlier_files();
                 if (n_written > 0)
                   write_xdmf();
               });
}

template <int dim>
void FieldWriter<dim>::list(const std::string &name)
{
  grids.push_back(grid_of<dim>(Hdf5File(directory + "/" + name, Hdf5File::Mode::read), name));
}

template <int dim>
void FieldWriter<dim>::write_xdmf() const
{
  replace_file(directory + "/solution.xdmf", Xdmf::time_series("fields", grids));
}

template <int dim>
void FieldWriter<dim>::remove_later_files() const
{
  const std::regex pattern("solution-([0-9]{5,9})\\.h5");
  std::vector<std::filesystem::path> later;
  std::smatch match;
  std::error_code error; // a directory that is missing is found out when something is written
  for (const auto &entry : std::filesystem::directory_iterator(directory, error))
    if (const std::string name = entry.path().filename().string(); std::regex_match(name, match, pattern))
      if (std::stoul(match[1]) >= n_written)
        later.push_back(entry.path());
  for (const auto &path : later)
    std::filesystem::remove(path, error);
}

template <int dim>
void FieldWriter<dim>::list_earlier_files()
{
  for (unsigned int number = 0; number < n_written; ++number)
    try
    {
      const std::string name = file_name(number);
      if (std::filesystem::exists(directory + "/" + name))
        list(name);
    }
    catch (const SimulationError &)
    {
      // Damaged, or not to be read just now: it stays where it is, and is not listed.
    }
}

template <int dim>
void FieldWriter<dim>::write(const dealii::DataOutInterface<dim, dim> &data, const double time)
{
  const std::string name = file_name(n_written);
  // Only what is complete has the name of an output.
  std::unique_ptr<UnfinishedFile> unfinished;
  const std::string path = directory + "/" + name + ".part";
  if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    unfinished = std::make_unique<UnfinishedFile>(directory + "/" + name);

  dealii::DataOutBase::DataOutFilter filter(
      // Neighbours disagree on what belongs to a cell, so each keeps its own vertices.
      dealii::DataOutBase::DataOutFilterFlags(/*filter_duplicate_vertices =*/false,
                                              /*xdmf_hdf5_output =*/true));
  data.write_filtered_data(filter);
  const std::size_t n_bytes = dealii::Utilities::MPI::sum(n_bytes_here<dim>(filter), communicator);
  on_rank_zero(communicator, [&]() { reserve_space(path, n_bytes); });

  write_cells(data, filter, path, n_bytes);

  on_rank_zero(communicator,
               [&]()
               {
                 Hdf5File file(path, Hdf5File::Mode::modify, provenance.n_bytes());
                 provenance.write(file);
                 file.set_attribute("/", "time", time);
                 file.close();
                 // Checkpoints count on it.
                 unfinished->complete(/*durable =*/true);
                 list(name);
                 write_xdmf();
               });
  ++n_written;
}

template <int dim>
void FieldWriter<dim>::write_cells(const dealii::DataOutInterface<dim, dim> &data,
                                   const dealii::DataOutBase::DataOutFilter &cells, const std::string &path,
                                   const std::size_t n_bytes) const
{
  // A rank without cells knows neither the number nor the names of the fields, and in deal.II 9.4 takes part
  // in writing with numbers that are not set: only those with cells write.
  const bool has_cells = cells.n_nodes() > 0;
  MPI_Comm writers = MPI_COMM_NULL;
  MPI_Comm_split(communicator, has_cells ? 0 : MPI_UNDEFINED, /*key =*/0, &writers);
  bool failed_here = false;
  try
  {
    const Hdf5Silence silence;
    if (has_cells)
      data.write_hdf5_parallel(cells, path, writers);
  }
  catch (const std::exception &)
  {
    failed_here = true;
  }
  // One that has failed in the middle leaves the others waiting for it within HDF5.
  const double patience = failed_here ? 10. : std::numeric_limits<double>::infinity();
  const bool all_are_here = all_processes_arrive(communicator, patience);
  if (all_are_here && writers != MPI_COMM_NULL)
    MPI_Comm_free(&writers);
  if (!all_are_here || dealii::Utilities::MPI::logical_or(failed_here, communicator))
    throw disk_error("Cannot write " + complete_name(path), likely_error_of_writing(path, n_bytes));
}

template class FieldWriter<2>;
template class FieldWriter<3>;
} // namespace Gemmule
