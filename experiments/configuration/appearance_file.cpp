#include "experiments/configuration/appearance_file.h"

#include <fmt/format.h>

#include "experiments/configuration/label_image.h"
#include "experiments/configuration/pattern_table.h"

namespace mezzotint {

namespace {

constexpr const char* no_pattern = "none";

Eigen::Vector3d read_axis(TomlTable& table, std::string_view key, const Eigen::Vector3d& fallback) {
  if (!table.has(key)) return fallback;
  const std::vector<double> numbers = table.numbers(key, 3, {-1e6, 1e6});
  Eigen::Vector3d axis(numbers[0], numbers[1], numbers[2]);
  if (!(axis.norm() > 0.0)) table.complain(key, fmt::format("\"{}\" has no length; [0, 0, 1] points up", key));
  return axis;
}

FieldGuide read_field(TomlTable table) {
  FieldGuide field;
  const std::string follow = table.choice("follow", {"axis", "curvature", "nothing"}, "axis");
  field.kind = follow == "axis"        ? FieldGuide::Kind::Axis
               : follow == "curvature" ? FieldGuide::Kind::Curvature
                                       : FieldGuide::Kind::None;
  if (field.kind == FieldGuide::Kind::Axis) field.axis = read_axis(table, "axis", field.axis);
  if (field.kind != FieldGuide::Kind::None) {
    field.turn = Angle::from_degrees(table.number("turn_deg", {-360.0, 360.0}, 0.0));
    field.smoothing = Length::from_mm(table.number("smoothing_mm", {0.0, 1000.0}, field.smoothing.mm()));
  }
  table.finish();
  return field;
}

ProjectedLabels read_picture(TomlTable table) {
  ProjectedLabels picture;
  picture.axis = read_axis(table, "axis", picture.axis);
  picture.pixel = Length::from_um(table.number("pixel_um", {0.1, 1e5}, picture.pixel.um()));
  const auto corner = [&table](std::string_view key) -> std::optional<Length> {
    if (!table.has(key)) return {};
    return Length::from_mm(table.number(key, {-1e4, 1e4}));
  };
  picture.corner_x = corner("corner_x_mm");
  picture.corner_y = corner("corner_y_mm");
  PatternRegions labels;
  try {
    read_label_image(table.file("labels"), labels);
  } catch (const FileError& error) {
    table.complain("labels", error.what());
  }
  picture.columns = labels.columns;
  picture.rows = labels.rows;
  picture.labels = std::move(labels.labels);
  table.finish();
  return picture;
}

std::optional<Pattern> read_pattern_or_none(TomlTable table) {
  if (table.has("kind") && table.text("kind") == no_pattern) {
    table.finish();
    return {};
  }
  return read_pattern(std::move(table), true, PatternUse::Synthesis).pattern;
}

AppearanceRegion read_region(TomlTable table, bool has_picture) {
  AppearanceRegion region;
  if (table.has("group")) {
    region.group = table.text("group");
    if (table.has("label")) table.complain("label", "a region has a \"label\" of the picture or a \"group\", not both");
  } else if (!has_picture) {
    table.complain("label", "without a [picture] a region needs a \"group\" of faces");
  } else {
    region.label = static_cast<int>(table.integer("label", 0, 255));
  }
  if (!table.has("kind"))
    table.complain("kind", "a region needs the \"kind\" of its pattern, or \"none\" for a smooth surface");
  region.pattern = read_pattern_or_none(std::move(table));
  return region;
}

}  // namespace

Appearance read_appearance(const std::filesystem::path& path, const std::vector<std::string>& settings) {
  const TomlFile file(path, settings);
  TomlTable root(file);
  Appearance appearance;
  TomlTable surface = root.table("surface");
  appearance.crease = Angle::from_degrees(surface.number("crease_deg", {1.0, 180.0}, appearance.crease.degrees()));
  surface.finish();
  appearance.field = read_field(root.table("field"));
  if (root.has("pattern")) appearance.pattern = read_pattern_or_none(root.table("pattern"));
  if (root.has("picture")) appearance.picture = read_picture(root.table("picture"));
  if (root.has("region")) {
    for (TomlTable& region : root.tables("region"))
      appearance.regions.push_back(read_region(std::move(region), appearance.picture.has_value()));
  }
  root.finish();
  if (!appearance.pattern && appearance.regions.empty())
    root.complain("pattern", "an appearance needs a [pattern], or [[region]] tables with patterns of their own");
  if (appearance.picture && appearance.regions.empty())
    root.complain("picture", "a [picture] needs [[region]] tables that say what its labels mean");
  return appearance;
}

}  // namespace mezzotint
