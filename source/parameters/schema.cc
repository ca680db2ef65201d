// SPDX-License-Identifier: LGPL-2.1-or-later
// Boost's JSON parser includes a deprecated header of Boost's own, which says so unless told that we know.
#define BOOST_BIND_GLOBAL_PLACEHOLDERS

#include <gemmule/parameters/schema.h>

#include <deal.II/base/parameter_handler.h>

#include <boost/property_tree/json_parser.hpp>
#include <functional>
#include <sstream>

namespace Gemmule::Parameters
{
Schema::Schema(const dealii::ParameterHandler &prm)
{
  // ParameterHandler does not let us see its entries, but it prints them in a form that can be read back.
  std::stringstream stream;
  prm.print_parameters(stream, dealii::ParameterHandler::JSON);
  boost::property_tree::ptree tree;
  boost::property_tree::read_json(stream, tree);

  std::function<void(const boost::property_tree::ptree &, const std::string &)> collect =
      [&](const boost::property_tree::ptree &node, const std::string &section)
  {
    all_sections.push_back(section);
    for (const auto &[name, child] : node)
      if (const auto value = child.get_optional<std::string>("value"))
        all_entries[join(section, name)] = {*value, child.get<std::string>("pattern_description")};
      else
        collect(child, join(section, name));
  };
  collect(tree, "");
}

std::string Schema::join(const std::string &section, const std::string &name)
{
  return section.empty() ? name : section + "/" + name;
}

std::pair<std::string, std::string> Schema::split(const std::string &path)
{
  const std::string::size_type slash = path.rfind('/');
  if (slash == std::string::npos)
    return {"", path};
  return {path.substr(0, slash), path.substr(slash + 1)};
}

std::vector<std::string> Schema::keys(const std::string &section) const
{
  std::vector<std::string> found;
  for (const auto &[path, entry] : all_entries)
    if (split(path).first == section)
      found.push_back(split(path).second);
  return found;
}

std::vector<std::string> Schema::subsections(const std::string &section) const
{
  std::vector<std::string> found;
  for (const std::string &path : all_sections)
    if (!path.empty() && split(path).first == section)
      found.push_back(split(path).second);
  std::sort(found.begin(), found.end());
  return found;
}

bool Schema::has_section(const std::string &section) const
{
  return std::find(all_sections.begin(), all_sections.end(), section) != all_sections.end();
}

std::vector<std::string> Schema::holders_of_key(const std::string &key) const
{
  std::vector<std::string> found;
  for (const auto &[path, entry] : all_entries)
    if (split(path).second == key)
      found.push_back(split(path).first);
  return found;
}

std::vector<std::string> Schema::holders_of_section(const std::string &name) const
{
  std::vector<std::string> found;
  for (const std::string &path : all_sections)
    if (!path.empty() && split(path).second == name)
      found.push_back(split(path).first);
  return found;
}
} // namespace Gemmule::Parameters
