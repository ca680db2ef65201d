// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/output/xdmf.h>
#include <gemmule/parameters/section.h>

namespace Gemmule::Xdmf
{
std::string time(const double time)
{
  return "<Time Value=\"" + Parameters::to_text(time) + "\"/>\n";
}

std::string data_item(const std::string &extents, const std::string &dataset, const std::string &type)
{
  return "<DataItem Dimensions=\"" + extents + "\" NumberType=\"" + type + "\" Precision=\"" +
         (type == "Float" ? "8" : "4") + "\" Format=\"HDF\">" + dataset + "</DataItem>";
}

std::string attribute(const std::string &name, const std::string &kind, const std::string &item)
{
  return "<Attribute Name=\"" + name + "\" AttributeType=\"" + kind + "\" Center=\"Node\">" + item +
         "</Attribute>\n";
}

std::string time_series(const std::string &name, const std::vector<std::string> &grids)
{
  std::string text = "<?xml version=\"1.0\"?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n"
                     "<Xdmf Version=\"2.0\">\n<Domain>\n"
                     "<Grid Name=\"" +
                     name + "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (const std::string &grid : grids)
    text += grid;
  return text + "</Grid>\n</Domain>\n</Xdmf>\n";
}
} // namespace Gemmule::Xdmf
