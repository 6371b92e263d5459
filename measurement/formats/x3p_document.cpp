#include "measurement/formats/x3p_document.h"

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "forward/base/error.h"
#include "measurement/formats/parsers.h"
#include "measurement/formats/text_values.h"

namespace mezzotint {

namespace {

std::string_view local_name(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

// Some writers give every element the namespace's prefix, some the root only.
pugi::xml_node child(const pugi::xml_node& node, std::string_view name) {
  return node.find_child([&](const pugi::xml_node& candidate) { return local_name(candidate) == name; });
}

/// Looks up elements by their path below the root, and complains with it.
class Elements {
public:
  Elements(const std::filesystem::path& path, pugi::xml_node root) : path_(path), root_(root) {}

  [[nodiscard]] pugi::xml_node find(std::string_view element_path) const {
    pugi::xml_node node = root_;
    while (node && !element_path.empty()) {
      const std::size_t slash = element_path.find('/');
      node = child(node, element_path.substr(0, slash));
      element_path = slash == std::string_view::npos ? std::string_view{} : element_path.substr(slash + 1);
    }
    return node;
  }
  [[nodiscard]] std::string_view text(std::string_view element_path) const {
    return trimmed(find(element_path).text().get());
  }
  [[nodiscard]] double number(std::string_view element_path) const {
    const auto value = to_number(text(element_path));
    if (!value || !std::isfinite(*value)) fail(element_path, "a number");
    return *value;
  }
  [[nodiscard]] std::uint64_t count(std::string_view element_path) const {
    const auto value = to_count(text(element_path));
    if (!value) fail(element_path, "a whole number");
    return *value;
  }
  [[noreturn]] void fail(std::string_view element_path, std::string_view wanted) const {
    const std::string found =
        find(element_path) ? fmt::format("is \"{}\"", clean_text(text(element_path))) : "is missing";
    throw FileError(path_, place(element_path), fmt::format("{}; {} belongs there", found, wanted));
  }
  [[nodiscard]] static std::string place(std::string_view element_path) {
    return fmt::format("main.xml, {}", element_path);
  }

private:
  const std::filesystem::path& path_;
  pugi::xml_node root_;
};

double lateral_pitch(const Elements& elements, std::string_view axis) {
  const std::string type = fmt::format("Record1/Axes/{}/AxisType", axis);
  if (elements.text(type) != "I") elements.fail(type, "I (an evenly spaced axis)");
  return elements.number(fmt::format("Record1/Axes/{}/Increment", axis));
}

X3pHeightAxis height_axis(const Elements& elements) {
  X3pHeightAxis axis;
  const std::string_view axis_type = elements.text("Record1/Axes/CZ/AxisType");
  if (axis_type != "A" && axis_type != "I")
    elements.fail("Record1/Axes/CZ/AxisType", "A (absolute) or I (incremental)");
  const std::string_view data_type = elements.text("Record1/Axes/CZ/DataType");
  if (data_type.size() != 1 || std::string_view("ILFD").find(data_type[0]) == std::string_view::npos) {
    elements.fail("Record1/Axes/CZ/DataType", "I (int16), L (int32), F (float32) or D (float64)");
  }
  axis.data_type = data_type[0];
  // Floats of an absolute axis are metres; everything else counts increments.
  if (axis_type == "I" || data_type == "I" || data_type == "L") {
    axis.increment = elements.number("Record1/Axes/CZ/Increment");
    if (elements.find("Record1/Axes/CZ/Offset")) axis.offset = elements.number("Record1/Axes/CZ/Offset");
  }
  return axis;
}

PromisedGrid promised_grid(const Elements& elements) {
  if (elements.text("Record1/FeatureType") != "SUR") elements.fail("Record1/FeatureType", "SUR (a surface)");
  if (elements.count("Record3/MatrixDimension/SizeZ") != 1) {
    elements.fail("Record3/MatrixDimension/SizeZ", "1 (a single layer)");
  }
  return {elements.count("Record3/MatrixDimension/SizeX"), elements.count("Record3/MatrixDimension/SizeY"),
          lateral_pitch(elements, "CX"), lateral_pitch(elements, "CY")};
}

// Writers on Windows have been seen to write backslashes.
std::string member_name(std::string_view link) {
  std::string name(link);
  for (char& c : name) c = c == '\\' ? '/' : c;
  if (name.starts_with("./")) name.erase(0, 2);
  return name;
}

double datum_value(const std::filesystem::path& path, const pugi::xml_node& datum, std::size_t index) {
  const std::string_view text = trimmed(datum.text().get());
  if (text.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto value = to_number(text);
  if (!value) {
    throw FileError(
        path, Elements::place(fmt::format("Record3/DataList/Datum {}", index)),
        fmt::format("is \"{}\"; one number, or nothing for a missing point, belongs there", clean_text(text)));
  }
  return *value;
}

std::vector<double> read_data_list(const std::filesystem::path& path, const pugi::xml_node& list,
                                   const PromisedGrid& grid) {
  std::vector<double> values;  // grows with the elements that are there, not with the promise
  for (const pugi::xml_node& datum : list.children()) {
    if (local_name(datum) == "Datum") values.push_back(datum_value(path, datum, values.size() + 1));
  }
  const Grid checked = checked_grid(path, Elements::place("Record3/MatrixDimension"), grid);
  if (values.size() != checked.size()) {
    throw FileError(path, Elements::place("Record3/DataList"),
                    fmt::format("holds {} values; {} × {} points need {}", values.size(), checked.columns, checked.rows,
                                checked.size()));
  }
  return values;
}

std::map<std::string, std::string> provenance_of(const Elements& elements) {
  constexpr std::pair<std::string_view, std::string_view> entries[] = {
      {"date", "Record2/Date"},
      {"creator", "Record2/Creator"},
      {"manufacturer", "Record2/Instrument/Manufacturer"},
      {"model", "Record2/Instrument/Model"},
      {"serial", "Record2/Instrument/Serial"},
      {"version", "Record2/Instrument/Version"},
      {"calibration date", "Record2/CalibrationDate"},
      {"probing", "Record2/ProbingSystem/Type"},
      {"probe", "Record2/ProbingSystem/Identification"},
      {"comment", "Record2/Comment"}};
  std::map<std::string, std::string> provenance;
  for (const auto& [name, element] : entries) {
    const std::string value = clean_text(elements.text(element));
    if (!value.empty()) provenance[std::string(name)] = value;
  }
  return provenance;
}

// The axes may be rotated in space; heights over the plane do not change by it.
bool is_rotated(const Elements& elements) {
  for (int row = 1; row <= 3; ++row) {
    for (int column = 1; column <= 3; ++column) {
      const auto value = to_number(elements.text(fmt::format("Record1/Axes/Rotation/r{}{}", row, column)));
      if (value && *value != (row == column ? 1.0 : 0.0)) return true;
    }
  }
  return false;
}

pugi::xml_node parse_root(const std::filesystem::path& path, pugi::xml_document& document,
                          std::span<const std::byte> xml) {
  const pugi::xml_parse_result result = document.load_buffer(xml.data(), xml.size());
  if (!result) {
    throw FileError(path, fmt::format("main.xml, byte {}", result.offset),
                    fmt::format("is no XML: {}", result.description()));
  }
  const pugi::xml_node root = document.document_element();
  if (local_name(root) != "ISO5436_2") {
    throw FileError(path, "main.xml",
                    fmt::format("the root is \"{}\"; ISO5436_2 belongs there", clean_text(root.name())));
  }
  return root;
}

}  // namespace

// Source   ISO 25178-72:2017 (formerly ISO 5436-2), Annex A.
X3pDocument parse_x3p_document(const std::filesystem::path& path, std::span<const std::byte> xml) {
  pugi::xml_document tree;
  const Elements elements(path, parse_root(path, tree, xml));
  X3pDocument document;
  document.grid = promised_grid(elements);
  document.height_axis = height_axis(elements);
  document.provenance = provenance_of(elements);
  if (is_rotated(elements)) add_assumption(document.assumption, "the axes' rotation is not applied");
  if (const pugi::xml_node list = elements.find("Record3/DataList")) {
    document.values = read_data_list(path, list, document.grid);
    return document;
  }
  document.data_link = member_name(elements.text("Record3/DataLink/PointDataLink"));
  if (document.data_link.empty())
    elements.fail("Record3/DataLink/PointDataLink", "a DataList, or the name of a member,");
  document.data_md5 = elements.text("Record3/DataLink/MD5ChecksumPointData");
  document.valid_link = member_name(elements.text("Record3/DataLink/ValidPointsLink"));
  document.valid_md5 = elements.text("Record3/DataLink/MD5ChecksumValidPoints");
  return document;
}

}  // namespace mezzotint
