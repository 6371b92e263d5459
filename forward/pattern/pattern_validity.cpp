#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/pattern/pattern_parameters.h"
#include "forward/pattern/pattern_tree.h"

namespace mezzotint {

namespace {

constexpr int most_levels = 8;
constexpr int most_patterns = 512;
constexpr std::size_t most_parts = 16;
constexpr std::size_t most_label_pixels = std::size_t{1} << 26U;

void require_parts(std::size_t count, std::size_t least, std::size_t most, const char* kind) {
  const std::string wanted = least == most ? fmt::format("{}", most) : fmt::format("{} to {}", least, most);
  require(count >= least && count <= most,
          fmt::format("a pattern of kind \"{}\" has {} parts, not {}", kind, wanted, count));
}

template <typename Kind>
void check(const Kind&) {}
void check(const LineIntegralConvolution& lines) {
  require(lines.singularities.size() <= 64, "a line field has at most 64 singularities");
  for (const Singularity& point : lines.singularities) {
    require(std::isfinite(point.place.x.um()) && std::isfinite(point.place.y.um()),
            "a singularity's place must be finite");
    require(std::abs(point.index) <= 4.0 && 2.0 * point.index == std::round(2.0 * point.index),
            fmt::format("the index of a singularity is a multiple of 0.5 in [-4, 4], not {:g}", point.index));
  }
}
void check(const PatternSum& sum) { require_parts(sum.parts.size(), 2, most_parts, "sum"); }
void check(const PatternProduct& product) { require_parts(product.parts.size(), 2, most_parts, "product"); }
void check(const TurnedPattern& turned) { require_parts(turned.parts.size(), 1, 1, "rotate"); }
void check(const MaskedPattern& masked) { require_parts(masked.parts.size(), 3, 3, "mask"); }
void check(const PatternRegions& regions) {
  require_parts(regions.parts.size(), 1, 256, "regions");
  require(regions.columns > 0 && regions.rows > 0 && regions.columns <= most_label_pixels / regions.rows &&
              regions.labels.size() == regions.columns * regions.rows,
          "the picture of regions needs a label for each of its pixels, and at most 2^26 of them");
  std::array<int, 256> parts_with{};
  for (const PatternPart& part : regions.parts) {
    require(part.label >= 0 && part.label <= 255, fmt::format("a label is in [0, 255], not {}", part.label));
    require(++parts_with.at(static_cast<std::size_t>(part.label)) == 1,
            fmt::format("two parts have the label {}", part.label));
  }
  const auto orphan =
      std::ranges::find_if(regions.labels, [&](std::uint8_t label) { return parts_with.at(label) == 0; });
  if (orphan == regions.labels.end()) return;
  throw InvalidInput(fmt::format("no part has the label {}, which pixel {} of {} has; give it one", int{*orphan},
                                 orphan - regions.labels.begin(),
                                 regions.source.empty() ? "the picture" : regions.source));
}

void check_numbers(const Pattern& pattern) {
  for (const PatternParameter& parameter : pattern_parameters(pattern)) {
    const double value = get_parameter(pattern, parameter.name);
    // A full turn more is still a direction.
    const bool angle = parameter.name.ends_with("_deg");
    require(angle ? std::isfinite(value) : value >= parameter.lowest && value <= parameter.highest,
            fmt::format("the pattern's {} must be in [{:g}, {:g}], not {:g}", parameter.name, parameter.lowest,
                        parameter.highest, value));
  }
}

// Counts the patterns; every one costs a drawing of the whole grid.
void check_tree(const Pattern& pattern, int level, int& count) {
  require(level <= most_levels, fmt::format("patterns stand within patterns more than {} levels deep", most_levels));
  require(++count <= most_patterns, fmt::format("a composition has at most {} patterns", most_patterns));
  std::visit([](const auto& kind) { check(kind); }, pattern);
  check_numbers(pattern);
  if (const auto* parts = parts_of(pattern)) {
    for (const PatternPart& part : *parts) check_tree(part.pattern, level + 1, count);
  }
}

}  // namespace

void require_valid(const Pattern& pattern) {
  int count = 0;
  check_tree(pattern, 1, count);
}

}  // namespace mezzotint
