#include <gemmule/algebra/arrival.h>
#include <gemmule/output/disk.h>
#include <gemmule/output/field_output.h>
#include <gemmule/output/hdf5_file.h>
#include <gemmule/output/rank_zero.h>
#include <gemmule/parameters/errors.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>

#include <cstdio>
#include <filesystem>
#include <iomanip>
#include <limits>
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
  dealii::XDMFEntry read_entry(const Hdf5File &file, const std::string &name)
  {
    dealii::XDMFEntry entry(name, name, file.number_attribute("/", "time"), file.extent("nodes")[0],
                            file.extent("cells")[0], dim, dim);
    for (const std::string &field : file.members())
      if (field != "nodes" && field != "cells")
      {
        const std::vector<std::size_t> extent = file.extent(field);
        entry.add_attribute(field, extent.size() > 1 ? extent[1] : 1);
      }
    return entry;
  }

  /** Bytes that this rank contributes to a file, with some more for HDF5 itself. */
  template <int dim>
  std::size_t n_bytes_here(const dealii::DataOutBase::DataOutFilter &filter)
  {
    std::size_t numbers_per_node = dim;
    for (unsigned int set = 0; set < filter.n_data_sets(); ++set)
      numbers_per_node += filter.get_data_set_dim(set);
    return filter.n_nodes() * numbers_per_node * sizeof(double) +
           filter.n_cells() * dealii::GeometryInfo<dim>::vertices_per_cell * sizeof(unsigned int) + 65536;
  }

  template <int dim>
  std::string xdmf_text(const std::vector<dealii::XDMFEntry> &entries)
  {
    std::string text = "<?xml version=\"1.0\" ?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n"
                       "<Xdmf Version=\"2.0\">\n<Domain>\n"
                       "<Grid Name=\"fields\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
    for (const dealii::XDMFEntry &entry : entries)
      text += entry.get_xdmf_content(1, dealii::ReferenceCells::get_hypercube<dim>());
    return text + "</Grid>\n</Domain>\n</Xdmf>\n";
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
                   replace_file(directory + "/solution.xdmf", xdmf_text<dim>(entries));
               });
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
        entries.push_back(read_entry<dim>(Hdf5File(directory + "/" + name, Hdf5File::Mode::read), name));
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
  const std::string path = directory + "/" + name;

  dealii::DataOutBase::DataOutFilter filter(
      // Neighbours disagree on what belongs to a cell, so each keeps its own vertices.
      dealii::DataOutBase::DataOutFilterFlags(/*filter_duplicate_vertices =*/false,
                                              /*xdmf_hdf5_output =*/true));
  data.write_filtered_data(filter);
  const std::size_t n_bytes = dealii::Utilities::MPI::sum(n_bytes_here<dim>(filter), communicator);
  on_rank_zero(communicator, [&]() { reserve_space(path, n_bytes); });

  bool failed_here = false;
  try
  {
    const Hdf5Silence silence;
    data.write_hdf5_parallel(filter, path, communicator);
  }
  catch (const std::exception &)
  {
    failed_here = true;
  }
  // One that has failed in the middle leaves the others waiting for it within HDF5.
  const double patience = failed_here ? 10. : std::numeric_limits<double>::infinity();
  if (!all_processes_arrive(communicator, patience) ||
      dealii::Utilities::MPI::logical_or(failed_here, communicator))
    throw SimulationError("Cannot write " + path +
                          ": is the disk full, or the directory write-protected? Make room and go on with "
                          "--resume.");

  const dealii::XDMFEntry entry = data.create_xdmf_entry(filter, name, time, communicator);
  on_rank_zero(communicator,
               [&]()
               {
                 Hdf5File file(path, Hdf5File::Mode::modify, provenance.n_bytes());
                 provenance.write(file);
                 file.set_attribute("/", "time", time);
                 file.close();
                 // Checkpoints count on it.
                 synchronise(path);
                 entries.push_back(entry);
                 replace_file(directory + "/solution.xdmf", xdmf_text<dim>(entries));
               });
  ++n_written;
}

template class FieldWriter<2>;
template class FieldWriter<3>;
} // namespace Gemmule
