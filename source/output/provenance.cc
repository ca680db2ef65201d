// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/output/hdf5_file.h>
#include <gemmule/output/provenance.h>
#include <gemmule/parameters/section.h>
#include <gemmule/version.h>

#include <deal.II/base/config.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <dmumps_c.h>
#include <hdf5.h>
#include <mpi.h>
#include <sstream>

namespace Gemmule
{
namespace
{
  std::string date_now()
  {
    const std::time_t now = std::time(nullptr);
    char text[32];
    std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
    return text;
  }

  /** "Open MPI v4.1.4" of what may be several lines. */
  std::string mpi_version()
  {
    std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
    int length = 0;
    MPI_Get_library_version(text.data(), &length);
    const std::string whole(text.data(), length);
    return whole.substr(0, whole.find_first_of(",\n"));
  }
} // namespace

std::string program_version()
{
  return std::string(GEMMULE_VERSION) + " (revision " + GEMMULE_GIT_REVISION + ")";
}

std::string library_versions()
{
  std::array<unsigned int, 3> hdf5{};
  H5get_libversion(&hdf5[0], &hdf5[1], &hdf5[2]);
  std::ostringstream text;
  text << "deal.II " << DEAL_II_PACKAGE_VERSION << ", Trilinos " << DEAL_II_TRILINOS_VERSION_MAJOR << '.'
       << DEAL_II_TRILINOS_VERSION_MINOR << '.' << DEAL_II_TRILINOS_VERSION_SUBMINOR << ", p4est "
       << DEAL_II_P4EST_VERSION_MAJOR << '.' << DEAL_II_P4EST_VERSION_MINOR << '.'
       << DEAL_II_P4EST_VERSION_SUBMINOR << ", MUMPS " << MUMPS_VERSION << ", HDF5 " << hdf5[0] << '.'
       << hdf5[1] << '.' << hdf5[2] << ", " << mpi_version();
  return text.str();
}

Provenance::Provenance(const std::string &command_line, const std::map<std::string, std::string> &parameters)
{
  std::string values;
  for (const auto &[name, value] : parameters)
    if (name != "Output directory")
      values += name + " = " + value + "\n";
  all = {{"gemmule_version", GEMMULE_VERSION},
         {"git_revision", GEMMULE_GIT_REVISION},
         {"libraries", library_versions()},
         {"command_line", command_line},
         {"date", date_now()},
         {"parameters", values}};
}

void Provenance::write(Hdf5File &file) const
{
  for (const auto &[name, value] : all)
    file.set_attribute("/", name, value);
}

void Provenance::write_resumption(Hdf5File &file, const double time) const
{
  const std::map<std::string, std::string> by_name(all.begin(), all.end());
  if (by_name.empty())
    return;
  std::string name;
  unsigned int n = 1;
  do
  {
    const std::string number = std::to_string(n++);
    name = "resumed_" + std::string(3 - std::min<std::size_t>(3, number.size()), '0') + number;
  } while (file.has_attribute("/", name));
  file.set_attribute("/", name,
                     "t = " + Parameters::to_text(time) + ", " + by_name.at("date") + ", gemmule " +
                         program_version() + ": " + by_name.at("command_line"));
}

std::size_t Provenance::n_bytes() const
{
  std::size_t n = 0;
  for (const auto &[name, value] : all)
    n += name.size() + value.size() + 256;
  return n;
}
} // namespace Gemmule
