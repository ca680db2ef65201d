// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace Gemmule
{
/**
 * What the files for ParaView have in common. They refer to numbers in HDF5 files; both give the same text
 * for the same time.
 */
namespace Xdmf
{
  /** `<Time .../>` with the shortest text that reads back as exactly the same number. */
  std::string time(double time);

  /**
   * Reference to a dataset.
   *
   * @param extents separated by spaces
   * @param dataset in the form file.h5:/name
   * @param type Float (double precision) or UInt
   */
  std::string data_item(const std::string &extents, const std::string &dataset,
                        const std::string &type = "Float");

  /** `<Attribute .../>`: values at the points. @param kind Scalar or Vector */
  std::string attribute(const std::string &name, const std::string &kind, const std::string &item);

  /** A whole file. @param grids one `<Grid>` per time */
  std::string time_series(const std::string &name, const std::vector<std::string> &grids);
} // namespace Xdmf
} // namespace Gemmule
