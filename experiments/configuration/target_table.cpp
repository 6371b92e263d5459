#include "experiments/configuration/target_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "experiments/configuration/label_image.h"

namespace mezzotint {

namespace {

constexpr Range alpha_range{1e-3, 2.0};
constexpr Range direction_range{-360.0, 360.0};
constexpr Range projected_range{-1.0, 1.0};
constexpr Range size_range{1e-3, 1.0};

void refuse_together(TomlTable& table, std::initializer_list<const char*> keys, const char* reason) {
  for (const char* key : keys) {
    if (table.has(key)) table.complain(key, fmt::format("\"{}\" {}", key, reason));
  }
}

template <class Lobe>
Lobe read_lobe(TomlTable& table) {
  refuse_together(table, {"ratio", "mean_alpha"},
                  "is for the kind \"anisotropy\"; \"alpha_x\" and \"alpha_y\" say the same and more");
  Lobe lobe;
  lobe.alpha_x = table.number("alpha_x", alpha_range);
  lobe.alpha_y = table.number("alpha_y", alpha_range);
  lobe.rotation = Angle::from_degrees(table.number("rotation_deg", direction_range, 0.0));
  if (lobe.alpha_x < lobe.alpha_y) {
    table.complain("alpha_y",
                   "\"alpha_x\" is that of the steeper axis and must not be below \"alpha_y\"; swap them and "
                   "turn \"rotation_deg\" by 90");
  }
  return lobe;
}

WantedAnisotropy read_anisotropy(TomlTable& table) {
  refuse_together(table, {"alpha_x", "alpha_y", "rotation_deg"},
                  "is for the kinds \"beckmann\" and \"ggx\"; \"ratio\" and \"mean_alpha\" leave the direction open");
  return {table.number("ratio", {1.0, 100.0}), table.number("mean_alpha", alpha_range)};
}

WantedScan read_scan(TomlTable& table) {
  WantedScan wanted;
  wanted.scan = table.file("scan");
  wanted.outliers = table.number("outliers", {0.0, 100.0}, wanted.outliers);
  if (wanted.outliers > 0.0 && wanted.outliers < 1.0) {
    table.complain("outliers", "\"outliers\" is a number of standard deviations: 0 for none, or from 1 to 100");
  }
  return wanted;
}

WantedMaps read_maps(TomlTable& table) {
  WantedMaps wanted{table.files("files")};
  for (std::size_t i = 0; i < wanted.files.size(); ++i) {
    if (std::count(wanted.files.begin(), wanted.files.end(), wanted.files[i]) > 1)
      table.complain("files", fmt::format("\"{}\" stands in the list twice", wanted.files[i].string()));
  }
  return wanted;
}

WantedMeasurement read_measurement_target(TomlTable& table) {
  WantedMeasurement wanted;
  wanted.file = table.file("file");
  if (table.has("channel")) wanted.channel.name = table.text("channel");
  if (table.has("wavelength_nm"))
    wanted.channel.wavelength = Length::from_nm(table.number("wavelength_nm", {1.0, 1e6}));
  if (!wanted.channel.name.empty() && wanted.channel.wavelength) {
    table.complain("wavelength_nm",
                   "a colour is chosen by \"channel\" or by \"wavelength_nm\", not by both; without "
                   "either it is luminance");
  }
  wanted.most_missing = table.number("most_missing", {0.0, 0.9}, wanted.most_missing);
  wanted.any_brightness = table.boolean("any_brightness", wanted.any_brightness);
  return wanted;
}

std::vector<DirectionAngles> read_incidences(TomlTable& table) {
  std::vector<DirectionAngles> incidences;
  for (const auto& [theta, phi] : table.pairs("incidence_deg", direction_range, {{0.0, 0.0}})) {
    if (theta < 0.0 || theta > 89.0)
      table.complain("incidence_deg", "the first angle of a pair is from the normal, in [0, 89]");
    incidences.push_back({Angle::from_degrees(theta), Angle::from_degrees(phi)});
  }
  return incidences;
}

// How far a shape reaches from its middle, and where that lies: beyond 1 is below the horizon.
void require_above_the_horizon(TomlTable& table, const WantedPainting& painting, double reach) {
  for (const DirectionAngles& light : painting.incidences) {
    const Direction direction = to_direction(light);
    const double middle = std::hypot(painting.centre_x - direction.x(), painting.centre_y - direction.y());
    if (middle + reach <= 1.0) continue;
    table.complain("shape",
                   fmt::format("for light at ({:.4g}°, {:.4g}°) the shape reaches {:.3g} from the middle of the disc "
                               "of directions; beyond 1 it is below the horizon",
                               light.theta.degrees(), light.phi.degrees(), middle + reach));
  }
}

// A Gaussian spot is cut where it has lost 95 % of its light.
constexpr double reach_of_a_spot = 2.45;

double read_shape(TomlTable& table, const std::string& shape, WantedPainting& painting) {
  if (shape == "square") {
    const SquareShape square{table.number("half_width", size_range)};
    painting.lobe = square;
    return std::sqrt(2.0) * square.half_width;
  }
  if (shape == "ring") {
    const RingShape ring{table.number("radius", size_range), table.number("width", size_range, 0.1)};
    painting.lobe = ring;
    if (ring.width > 2.0 * ring.radius)
      table.complain("width", "a ring is at most twice as wide as its radius; a disc is a \"tilt\" or a picture");
    return ring.radius + 0.5 * ring.width;
  }
  if (shape == "two_lobes") {
    const TwoLobesShape lobes{table.number("distance", size_range), table.number("width", size_range, 0.05)};
    painting.lobe = lobes;
    return lobes.distance + reach_of_a_spot * lobes.width;
  }
  const TiltShape tilt{table.number("width", size_range, 0.1)};
  painting.lobe = tilt;
  if (painting.centre_x == 0.0 && painting.centre_y == 0.0)
    table.complain("shape", "a tilted lobe lies off the mirrored direction; give \"centre_x\" or \"centre_y\"");
  return reach_of_a_spot * tilt.width;
}

LobePicture read_picture(TomlTable& table) {
  const std::string encoding = table.choice("encoding", {"srgb", "linear"}, "srgb");
  try {
    return read_lobe_picture(table.file("image"), encoding == "linear");
  } catch (const FileError& error) {
    table.complain("image", error.what());
  }
}

WantedPainting read_painting(TomlTable& table) {
  WantedPainting painting;
  const bool is_picture = table.has("image");
  if (is_picture == table.has("shape"))
    table.complain(is_picture ? "shape" : "kind", "a painted lobe has an \"image\" or a \"shape\", one of the two");
  painting.incidences = read_incidences(table);
  if (table.has("albedo")) painting.albedo = table.number("albedo", {1e-6, 1.0});
  if (is_picture) {
    painting.lobe = read_picture(table);
    return painting;
  }
  painting.centre_x = table.number("centre_x", projected_range, 0.0);
  painting.centre_y = table.number("centre_y", projected_range, 0.0);
  painting.rotation = Angle::from_degrees(table.number("rotation_deg", direction_range, 0.0));
  const std::string shape = table.choice("shape", {"square", "ring", "two_lobes", "tilt"});
  require_above_the_horizon(table, painting, read_shape(table, shape, painting));
  return painting;
}

TargetSpecification read_any_target(TomlTable& table, bool in_a_region);

// Every gray value of the picture has one target, and every target a gray value.
void require_one_target_a_label(const TomlTable& table, const WantedRegions& wanted) {
  std::array<std::size_t, 256> pixels{}, targets{};
  for (const std::uint8_t label : wanted.picture.labels) ++pixels[label];
  for (const TargetRegion& region : wanted.regions) ++targets[static_cast<std::size_t>(region.label)];
  std::string present;
  for (std::size_t label = 0; label < pixels.size(); ++label) {
    if (pixels[label] > 0) present += (present.empty() ? "" : ", ") + std::to_string(label);
  }
  for (std::size_t label = 0; label < pixels.size(); ++label) {
    if (targets[label] > 1) table.complain("region", fmt::format("two regions have the label {}", label));
    if (pixels[label] > 0 && targets[label] == 0) {
      table.complain("labels", fmt::format("{} pixels of the picture have the gray value {}, and no region has that "
                                           "label; its gray values are {}",
                                           pixels[label], label, present));
    }
    if (pixels[label] == 0 && targets[label] > 0) {
      table.complain("region", fmt::format("a region has the label {}, which no pixel of the picture has; its gray "
                                           "values are {}",
                                           label, present));
    }
  }
}

WantedRegions read_regions(TomlTable& table) {
  WantedRegions wanted;
  try {
    read_label_image(table.file("labels"), wanted.picture);
  } catch (const FileError& error) {
    table.complain("labels", error.what());
  }
  wanted.picture.pixel = Length::from_um(table.number("pixel_um", {0.1, 1e5}, wanted.picture.pixel.um()));
  wanted.picture.corner.x = Length::from_um(table.number("corner_x_um", {-1e6, 1e6}, 0.0));
  wanted.picture.corner.y = Length::from_um(table.number("corner_y_um", {-1e6, 1e6}, 0.0));
  for (TomlTable& region : table.tables("region")) {
    const auto label = static_cast<int>(region.integer("label", 0, 255));
    wanted.regions.push_back({label, read_any_target(region, true)});
  }
  require_one_target_a_label(table, wanted);
  return wanted;
}

TargetSpecification read_any_target(TomlTable& table, bool in_a_region) {
  std::vector<std::string> kinds = {"beckmann", "ggx", "anisotropy", "scan", "bsdf", "measured", "image"};
  if (!in_a_region) kinds.emplace_back("regions");
  TargetSpecification target;
  target.kind = table.choice("kind", kinds);
  if (target.kind == "beckmann") target.wanted = read_lobe<BeckmannLobe>(table);
  if (target.kind == "ggx") target.wanted = read_lobe<GgxLobe>(table);
  if (target.kind == "anisotropy") target.wanted = read_anisotropy(table);
  if (target.kind == "scan") target.wanted = read_scan(table);
  if (target.kind == "bsdf") target.wanted = read_maps(table);
  if (target.kind == "measured") target.wanted = read_measurement_target(table);
  if (target.kind == "image") target.wanted = read_painting(table);
  if (target.kind == "regions") target.wanted = read_regions(table);
  if (table.has("tolerance")) target.tolerance = table.number("tolerance", {1e-6, 10.0});
  target.rotation_tolerance = Angle::from_degrees(table.number("rotation_tolerance_deg", {1e-3, 90.0}, 2.0));
  table.finish();
  return target;
}

}  // namespace

TargetSpecification read_target(TomlTable table) { return read_any_target(table, false); }

bool is_lobe_alone(const TargetSpecification& target) {
  if (const auto* regions = std::get_if<WantedRegions>(&target.wanted)) {
    return std::ranges::any_of(regions->regions,
                               [](const TargetRegion& region) { return is_lobe_alone(region.target); });
  }
  return std::holds_alternative<GgxLobe>(target.wanted) || std::holds_alternative<WantedMaps>(target.wanted) ||
         std::holds_alternative<WantedMeasurement>(target.wanted) ||
         std::holds_alternative<WantedPainting>(target.wanted);
}

std::vector<std::filesystem::path> files_of(const TargetSpecification& target) {
  if (const auto* scan = std::get_if<WantedScan>(&target.wanted)) return {scan->scan};
  if (const auto* maps = std::get_if<WantedMaps>(&target.wanted)) return maps->files;
  if (const auto* measured = std::get_if<WantedMeasurement>(&target.wanted)) return {measured->file};
  std::vector<std::filesystem::path> files;
  if (const auto* painting = std::get_if<WantedPainting>(&target.wanted)) {
    if (const auto* picture = std::get_if<LobePicture>(&painting->lobe)) files.push_back(picture->source);
  }
  if (const auto* regions = std::get_if<WantedRegions>(&target.wanted)) {
    files.emplace_back(regions->picture.source);
    for (const TargetRegion& region : regions->regions) {
      const auto own = files_of(region.target);
      files.insert(files.end(), own.begin(), own.end());
    }
  }
  return files;
}

}  // namespace mezzotint
