#include "forward/optics/bsdf_warnings.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include <fmt/format.h>

namespace mezzotint {

namespace {

// Light in rim bins is right as a whole; above this share the shape of the lobe is lost.
constexpr double worrying_rim_share = 0.2;
constexpr double worth_looking_at = 1e-3;

double light(const std::vector<double>& areas, const DirectionMap& map) {
  double sum = 0.0;
  for (std::size_t k = 0; k < areas.size(); ++k) sum += areas[k] * map[k];
  return sum;
}

double rim_share(const DirectionGrid& grid, const std::vector<double>& areas, const DirectionMap& map) {
  const double whole = 4.0 / static_cast<double>(grid.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < areas.size(); ++k) {
    if (areas[k] < whole * (1.0 - 1e-9)) sum += areas[k] * map[k];
  }
  return sum / light(areas, map);
}

double effective_bins(const std::vector<double>& areas, const MapEstimate& map) {
  double products = 0.0;
  for (std::size_t k = 0; k < areas.size(); ++k) products += areas[k] * map.half_a[k] * areas[k] * map.half_b[k];
  // Two halves that share no bin are noise and tell nothing.
  return products > 0.0 ? light(areas, map.half_a) * light(areas, map.half_b) / products : 1e300;
}

// The θ that the innermost corner of a bin on the rim can have.
double rim_begins_deg(const DirectionGrid& grid) {
  const double diagonal =
      2.0 * std::hypot(1.0 / static_cast<double>(grid.width), 1.0 / static_cast<double>(grid.height));
  return std::asin(std::max(0.0, 1.0 - diagonal)) * 180.0 / std::numbers::pi;
}

void look_at(const char* kind, const DirectionGrid& grid, const MapEstimate& map, std::vector<std::string>& warnings) {
  const std::vector<double> areas = projected_solid_angles(grid);
  if (map.mean.size() != areas.size() || light(areas, map.mean) < worth_looking_at) return;
  const double rim = rim_share(grid, areas, map.mean);
  if (rim > worrying_rim_share) {
    warnings.push_back(
        fmt::format("{:.0f} % of the {} light lies in bins that the horizon cuts: at {} × {} bins the map tells no "
                    "angles apart from about {:.0f}° to 90°; use more bins (--resolution)",
                    100.0 * rim, kind, grid.width, grid.height, rim_begins_deg(grid)));
  }
  const double bins = effective_bins(areas, map);
  if (bins < 4.0 * std::numbers::pi) {
    warnings.push_back(
        fmt::format("the {} light fills {:.1f} bins only: the lobe is narrower than a bin of {:.2g}°, so that neither "
                    "its peak nor its width can be read from the map; use more bins (--resolution)",
                    kind, bins, 2.0 / static_cast<double>(grid.width) * 180.0 / std::numbers::pi));
  }
}

}  // namespace

void add_warnings(Bsdf& bsdf, const std::vector<std::string>& sentences) {
  std::vector<std::string> all = warnings_of(bsdf.provenance);
  for (const std::string& sentence : sentences) {
    if (std::find(all.begin(), all.end(), sentence) != all.end()) continue;
    all.push_back(sentence);
    std::string& text = bsdf.provenance["warnings"];
    text += (text.empty() ? "" : "\n") + sentence;
  }
}

std::vector<std::string> warnings_of(const Provenance& provenance) {
  std::vector<std::string> sentences;
  const auto found = provenance.find("warnings");
  if (found == provenance.end()) return sentences;
  std::istringstream text(found->second);
  for (std::string line; std::getline(text, line);) sentences.push_back(line);
  return sentences;
}

std::vector<std::string> map_warnings(const Bsdf& bsdf) {
  std::vector<std::string> warnings;
  look_at("reflected", bsdf.grid, bsdf.reflection, warnings);
  look_at("transmitted", bsdf.grid, bsdf.transmission, warnings);
  return warnings;
}

}  // namespace mezzotint
