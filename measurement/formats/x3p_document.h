#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "measurement/formats/height_assembly.h"

namespace mezzotint {

/// The z axis of an X3P file: height = value · increment + offset, in metres.
struct X3pHeightAxis {
  char data_type = 'D';  ///< I: int16, L: int32, F: float32, D: float64
  double increment = 1.0;
  double offset = 0.0;
};

/// What main.xml says.
struct X3pDocument {
  PromisedGrid grid;
  X3pHeightAxis height_axis;
  std::string data_link, data_md5;    ///< empty link: the values stand in `values`
  std::string valid_link, valid_md5;  ///< empty link: all points are valid
  std::vector<double> values;         ///< from the DataList, NaN where a datum is empty
  std::map<std::string, std::string> provenance;
  std::string assumption;
};

/// @throws FileError with the element's path.
[[nodiscard]] X3pDocument parse_x3p_document(const std::filesystem::path& path, std::span<const std::byte> xml);

}  // namespace mezzotint
