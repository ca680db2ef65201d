// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/rank_zero.h>
#include <gemmule/output/disk.h>
#include <gemmule/output/hdf5_file.h>
#include <gemmule/output/interface_output.h>
#include <gemmule/output/xdmf.h>

#include <deal.II/base/exceptions.h>

#include <cmath>
#include <iomanip>
#include <sstream>

namespace Gemmule
{
namespace
{
  /** Of interface.h5; raised when something is renamed or changes its meaning. */
  constexpr int schema_version = 1;

  const std::string file_name = "interface.h5";
  const std::string group_prefix = "step_";

  std::string group_name(const std::size_t number)
  {
    std::ostringstream name;
    name << group_prefix << std::setw(5) << std::setfill('0') << number;
    return name.str();
  }

  /** The components of all vectors, one after the other. */
  template <int dim>
  std::vector<double> flatten(const std::vector<dealii::Tensor<1, dim>> &vectors)
  {
    std::vector<double> components;
    components.reserve(vectors.size() * dim);
    for (const auto &vector : vectors)
      components.insert(components.end(), vector.begin_raw(), vector.end_raw());
    return components;
  }

  template <int dim>
  std::vector<double> flatten(const std::vector<dealii::Point<dim>> &points)
  {
    return flatten(std::vector<dealii::Tensor<1, dim>>(points.begin(), points.end()));
  }

  template <int dim>
  using ScalarMember = std::vector<double> InterfaceSamples<dim>::*;

  /** The scalar datasets, by name, in the order of the contract; both files are written from this list. */
  template <int dim>
  std::vector<std::pair<std::string, ScalarMember<dim>>> scalars()
  {
    using Samples = InterfaceSamples<dim>;
    return {{"f", &Samples::f},
            {"f_total", &Samples::f_total},
            {"composition", &Samples::composition},
            {"tension", &Samples::tension},
            {"chemical_potential", &Samples::chemical_potential},
            {"curvature", &Samples::curvature},
            {"weights", &Samples::weights}};
  }

  template <int dim>
  using VectorMember = std::vector<dealii::Tensor<1, dim>> InterfaceSamples<dim>::*;

  template <int dim>
  std::vector<std::pair<std::string, VectorMember<dim>>> vectors()
  {
    return {{"velocity", &InterfaceSamples<dim>::velocity}, {"normal", &InterfaceSamples<dim>::normal}};
  }

  /** Reference to a dataset of interface.h5. */
  std::string data_item(const std::string &extents, const std::string &dataset,
                        const std::string &type = "Float")
  {
    return Xdmf::data_item(extents, file_name + ":/" + dataset, type);
  }

  /**
   * Reference to a list of vectors as ParaView takes them. XDMF knows vectors of three components only: in 2D
   * a zero is joined to the two of the dataset.
   */
  template <int dim>
  std::string vector_item(const std::string &n_points, const std::string &dataset)
  {
    const std::string item = data_item(n_points + " " + std::to_string(dim), dataset);
    if (dim == 3)
      return item;
    const auto component = [&](const unsigned int c)
    {
      return "<DataItem ItemType=\"HyperSlab\" Dimensions=\"" + n_points +
             " 1\"><DataItem Dimensions=\"3 2\" Format=\"XML\">0 " + std::to_string(c) + " 1 1 " + n_points +
             " 1</DataItem>" + item + "</DataItem>";
    };
    return "<DataItem ItemType=\"Function\" Function=\"JOIN($0, $1, 0*$0)\" Dimensions=\"" + n_points +
           " 3\">" + component(0) + component(1) + "</DataItem>";
  }
} // namespace

template <int dim>
InterfaceWriter<dim>::InterfaceWriter(const std::string &directory, const MPI_Comm &communicator,
                                      const Provenance &provenance, const double resume_after_time)
    : directory(directory), communicator(communicator), provenance(provenance)
{
  on_rank_zero(communicator, [&]() { start(resume_after_time); });
}

template <int dim>
void InterfaceWriter<dim>::start(const double resume_after_time)
{
  if (!std::isfinite(resume_after_time) || !exists(directory + "/" + file_name))
  {
    create_file();
    write_xdmf();
    return;
  }

  const double limit = resume_after_time + 1e-12 * std::max(1., std::abs(resume_after_time));
  Hdf5File file(directory + "/" + file_name, Hdf5File::Mode::modify);
  for (const std::string &group : file.members())
  {
    if (group.compare(0, group_prefix.size(), group_prefix) != 0)
      continue;
    // The attribute is written last: a group without it is what a kill has left of an output.
    const bool is_complete = file.has_attribute(group, "time");
    const double time = is_complete ? file.number_attribute(group, "time") : 0.;
    if (is_complete && time <= limit)
      entries.push_back(
          {group, time, file.extent(group + "/points")[0], file.extent(group + "/connectivity")[0]});
    else
      file.remove(group);
  }
  provenance.write_resumption(file, resume_after_time);
  file.close();
  write_xdmf();
}

template <int dim>
void InterfaceWriter<dim>::create_file() const
{
  Hdf5File file(directory + "/" + file_name, Hdf5File::Mode::create, provenance.n_bytes());
  file.set_attribute("/", "schema_version", schema_version);
  provenance.write(file);
  file.close();
}

template <int dim>
void InterfaceWriter<dim>::write(const InterfaceSamples<dim> &samples)
{
  on_rank_zero(communicator, [&]() { append(samples); });
}

template <int dim>
void InterfaceWriter<dim>::append(const InterfaceSamples<dim> &samples)
{
  const std::size_t n_points = samples.points.size();
  const std::string group = group_name(entries.size());
  const std::size_t numbers_per_point = scalars<dim>().size() + (1 + vectors<dim>().size()) * dim;
  const std::size_t n_bytes =
      n_points * numbers_per_point * sizeof(double) + samples.connectivity.size() * 2 * sizeof(unsigned int);
  Hdf5File file(directory + "/" + file_name, Hdf5File::Mode::modify, n_bytes);
  file.create_group(group);
  file.write(group + "/points", flatten(samples.points), dim);
  for (const auto &[name, member] : scalars<dim>())
  {
    AssertDimension((samples.*member).size(), n_points);
    file.write(group + "/" + name, samples.*member);
  }
  for (const auto &[name, member] : vectors<dim>())
  {
    AssertDimension((samples.*member).size(), n_points);
    file.write(group + "/" + name, flatten(samples.*member), dim);
  }
  std::vector<unsigned int> segments;
  for (const auto &segment : samples.connectivity)
    segments.insert(segments.end(), segment.begin(), segment.end());
  file.write(group + "/connectivity", segments, 2);
  file.set_attribute(group, "time", samples.time);
  file.close();

  entries.push_back({group, samples.time, n_points, samples.connectivity.size()});
  write_xdmf();
}

template <int dim>
void InterfaceWriter<dim>::write_xdmf() const
{
  std::vector<std::string> grids;
  for (const Entry &entry : entries)
  {
    const std::string points = std::to_string(entry.n_points);
    const std::string segments = std::to_string(entry.n_segments);
    std::string grid = "<Grid Name=\"" + entry.group + "\" GridType=\"Uniform\">\n" + Xdmf::time(entry.time) +
                       "<Geometry GeometryType=\"" + (dim == 2 ? "XY" : "XYZ") + "\">" +
                       data_item(points + " " + std::to_string(dim), entry.group + "/points") +
                       "</Geometry>\n";
    if (entry.n_segments > 0)
      grid += "<Topology TopologyType=\"Polyline\" NodesPerElement=\"2\" NumberOfElements=\"" + segments +
              "\">" + data_item(segments + " 2", entry.group + "/connectivity", "UInt") + "</Topology>\n";
    else
      grid += "<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"" + points + "\"/>\n";
    for (const auto &scalar : scalars<dim>())
      grid += Xdmf::attribute(scalar.first, "Scalar", data_item(points, entry.group + "/" + scalar.first));
    for (const auto &vector : vectors<dim>())
      grid +=
          Xdmf::attribute(vector.first, "Vector", vector_item<dim>(points, entry.group + "/" + vector.first));
    grids.push_back(grid + "</Grid>\n");
  }
  replace_file(directory + "/interface.xdmf", Xdmf::time_series("membrane", grids));
}

template class InterfaceWriter<2>;
template class InterfaceWriter<3>;
} // namespace Gemmule
