#include "fabrication/device/layer_stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "forward/base/error.h"
#include "forward/base/random.h"

namespace mezzotint {

namespace {

// What cures by its own light in every pixel of a layer.
std::vector<std::uint8_t> own_cure(const Job& job, const PrinterProfile& profile, std::size_t index) {
  const JobLayer& layer = job.layers[index];
  const CureCurve curve = scale_exposure(profile.cure, layer.exposure_s / profile.exposure_s);
  std::array<std::uint8_t, 256> cures{};
  for (std::size_t level = 0; level < 256; ++level)
    cures[level] = gray_to_height(curve, static_cast<double>(level) / 255.0) > Length{} ? 1 : 0;
  std::vector<std::uint8_t> cured(layer.gray.size());
  std::transform(layer.gray.begin(), layer.gray.end(), cured.begin(), [&](std::uint8_t level) { return cures[level]; });
  return cured;
}

[[noreturn]] void refuse(const Job& job, std::size_t layer, std::size_t pixel, const std::string& why) {
  throw MethodError(
      fmt::format("layer {} at pixel ({}, {}): {}", layer, pixel % job.columns, pixel / job.columns, why));
}

Length step_of(const Job& job, std::size_t index) {
  return index == 0 ? job.layers[0].top : job.layers[index].top - job.layers[index - 1].top;
}

// Goes round a connected set of curing pixels (corners connect: the light's spread joins them), marks it as seen, and
// says whether one of them stands on something.
bool is_held(const Job& job, std::size_t start, std::span<const std::uint8_t> cures,
             std::span<const std::uint8_t> below, std::vector<std::uint8_t>& seen) {
  std::vector<std::size_t> front{start};
  seen[start] = 1;
  bool held = false;
  while (!front.empty()) {
    const std::size_t pixel = front.back(), x = pixel % job.columns, y = pixel / job.columns;
    front.pop_back();
    held = held || below[pixel] != 0;
    for (std::size_t row = y == 0 ? 0 : y - 1; row < std::min(y + 2, job.rows); ++row) {
      for (std::size_t column = x == 0 ? 0 : x - 1; column < std::min(x + 2, job.columns); ++column) {
        const std::size_t next = row * job.columns + column;
        if (cures[next] == 0 || seen[next] != 0) continue;
        seen[next] = 1;
        front.push_back(next);
      }
    }
  }
  return held;
}

void require_no_island(const Job& job, std::size_t index, std::span<const std::uint8_t> cures,
                       std::span<const std::uint8_t> below) {
  std::vector<std::uint8_t> seen(cures.size(), 0);
  for (std::size_t p = 0; p < cures.size(); ++p) {
    if (cures[p] == 0 || below[p] != 0 || seen[p] != 0 || is_held(job, p, cures, below, seen)) continue;
    refuse(job, index, p, "an island, which nothing holds: it would float away; support it from below");
  }
}

// A layer over the next one, pixel by pixel. `reach_um` is what the dose from all layers above cures in each.
void require_bonds(const Job& job, std::size_t index, std::span<const std::uint8_t> cures,
                   std::span<const std::uint8_t> below, std::span<const float> reach_um,
                   std::span<const float> below_reach_um) {
  const auto filled_um = static_cast<float>(step_of(job, index).um() * filled_share);
  const auto below_filled_um = static_cast<float>(step_of(job, index - 1).um() * filled_share);
  for (std::size_t p = 0; p < cures.size(); ++p) {
    if (cures[p] == 0) continue;
    if (below[p] != 0 && below_reach_um[p] < below_filled_um)
      refuse(job, index, p,
             fmt::format("cures above layer {}, which cures there but is not filled: the void between them is of no "
                         "known height; cure the lower one through, or leave it dark",
                         index - 1));
    if (below[p] == 0 && reach_um[p] < filled_um)
      refuse(job, index, p,
             "a film over a void that does not fill its layer has no height over the part; cure an overhang through");
  }
}

}  // namespace

std::vector<LayerPlace> place_layers(const Job& job, const VirtualPrinterOptions& options) {
  const RandomStream stream(options.seed, RandomPurpose::StageError);
  std::vector<LayerPlace> places;
  places.reserve(job.layers.size());
  Length height;
  for (std::size_t i = 0; i < job.layers.size(); ++i) {
    const Length error = options.stage_error * stream.normal4(i)[0];
    // The film between part and window gives way, but not to less than nothing.
    const Length least = step_of(job, i) * 0.01;
    const Length gap = std::max(step_of(job, i) + error, least);
    places.push_back({height, gap});
    height = height + gap;
  }
  return places;
}

StackLayer stack_layer(const PrinterProfile& profile, const JobLayer& layer, Length gap) {
  return {gap, layer.exposure_s / profile.exposure_s};
}

void require_height_field(const Job& job, const PrinterProfile& profile) {
  const std::size_t pixels = job.columns * job.rows, last = job.layers.size() - 1;
  DepthDose dose(profile.cure, pixels);
  std::vector<float> reach_um(pixels), below_reach_um(pixels);
  const auto descend = [&](std::size_t index) {
    dose.descend(stack_layer(profile, job.layers[index], step_of(job, index)), layer_image(job, index).values);
    dose.reach_um(below_reach_um);
  };
  descend(last);
  std::vector<std::uint8_t> cures = own_cure(job, profile, last);
  for (std::size_t i = last; i > 0; --i) {
    reach_um.swap(below_reach_um);
    descend(i - 1);
    std::vector<std::uint8_t> below = own_cure(job, profile, i - 1);
    require_bonds(job, i, cures, below, reach_um, below_reach_um);
    if (cures != below) require_no_island(job, i, cures, below);
    cures = std::move(below);
  }
}

}  // namespace mezzotint
