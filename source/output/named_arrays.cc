// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/output/hdf5_file.h>
#include <gemmule/output/named_arrays.h>
#include <gemmule/output/provenance.h>

#include <deal.II/base/mpi.h>

namespace Gemmule
{
const NamedArrays::Array &NamedArrays::get(const std::string &name) const
{
  const auto found = arrays.find(name);
  if (found == arrays.end())
    throw SimulationError("The checkpoint lacks '" + name +
                          "': it was written by another version of gemmule. Resume with that version.");
  return found->second;
}

void NamedArrays::write(const std::string &path, const Provenance &provenance) const
{
  // A header each, and the data.
  std::size_t n_bytes = 0;
  for (const auto &[name, array] : arrays)
    n_bytes += array.values.size() * sizeof(double) + 1024;
  Hdf5File file(path, Hdf5File::Mode::create, n_bytes + provenance.n_bytes());
  provenance.write(file);
  for (const auto &[name, array] : arrays)
    file.write(name, array.values, array.columns);
  file.close();
}

NamedArrays NamedArrays::read(const std::string &path)
{
  const Hdf5File file(path, Hdf5File::Mode::read);
  NamedArrays result;
  for (const std::string &name : file.members())
    result.set(name, {file.read(name), file.extent(name).at(1)});
  return result;
}

void NamedArrays::broadcast(const MPI_Comm communicator)
{
  std::vector<std::string> names;
  for (const auto &[name, array] : arrays)
    names.push_back(name);
  names = dealii::Utilities::MPI::broadcast(communicator, names, 0);
  for (const std::string &name : names)
  {
    Array &array = arrays[name];
    const auto shape = dealii::Utilities::MPI::broadcast(
        communicator, std::array<std::size_t, 2>{{array.values.size(), array.columns}}, 0);
    array.values.resize(shape[0]);
    array.columns = shape[1];
    MPI_Bcast(array.values.data(), static_cast<int>(shape[0]), MPI_DOUBLE, 0, communicator);
  }
}

const NamedArrays::Array &ArrayExchange::get(const std::string &name, const std::size_t columns,
                                             const std::size_t rows) const
{
  const NamedArrays::Array &array = arrays.get(prefix + name);
  if (array.columns != columns || (rows != std::size_t(-1) && array.values.size() != rows * columns))
    throw SimulationError("In the checkpoint '" + prefix + name +
                          "' has another shape: it was written by another version of gemmule. Resume with "
                          "that version.");
  return array;
}
} // namespace Gemmule
