#include <gemmule/output/hdf5_file.h>
#include <gemmule/output/provenance.h>
#include <gemmule/version.h>

#include <deal.II/base/config.h>

#include <ctime>
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
} // namespace

std::string program_version()
{
  return std::string(GEMMULE_VERSION) + " (revision " + GEMMULE_GIT_REVISION + ")";
}

std::string library_versions()
{
  std::ostringstream text;
  text << "deal.II " << DEAL_II_PACKAGE_VERSION << ", Trilinos " << DEAL_II_TRILINOS_VERSION_MAJOR << '.'
       << DEAL_II_TRILINOS_VERSION_MINOR << '.' << DEAL_II_TRILINOS_VERSION_SUBMINOR << ", p4est "
       << DEAL_II_P4EST_VERSION_MAJOR << '.' << DEAL_II_P4EST_VERSION_MINOR << '.'
       << DEAL_II_P4EST_VERSION_SUBMINOR;
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

std::size_t Provenance::n_bytes() const
{
  std::size_t n = 0;
  for (const auto &[name, value] : all)
    n += name.size() + value.size() + 256;
  return n;
}
} // namespace Gemmule
