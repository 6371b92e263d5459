#include "fabrication/device/layer_stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "forward/base/error.h"
#include "forward/base/random.h"

namespace mezzotint {

namespace {

// Which of the 256 gray levels cure at all, and which fill the layer.
struct LevelTable {
  std::array<bool, 256> cures{};
  std::array<bool, 256> fills{};
};

LevelTable level_table(const PrinterProfile& profile, const JobLayer& layer, Length gap) {
  const CureCurve curve = profile_of_layer(profile, layer, gap).cure;
  LevelTable table;
  for (std::size_t level = 0; level < 256; ++level) {
    const Length height = gray_to_height(curve, static_cast<double>(level) / 255.0);
    table.cures[level] = height > Length{};
    table.fills[level] = height >= gap * filled_share;
  }
  return table;
}

Length step_of(const Job& job, std::size_t index) {
  return index == 0 ? job.layers[0].top : job.layers[index].top - job.layers[index - 1].top;
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

PrinterProfile profile_of_layer(const PrinterProfile& profile, const JobLayer& layer, Length gap) {
  PrinterProfile adapted = profile;
  adapted.layer = gap;
  if (layer.exposure_s != profile.exposure_s) {
    adapted.cure = scale_exposure(profile.cure, layer.exposure_s / profile.exposure_s);
  }
  return adapted;
}

void require_no_overhang(const Job& job, const PrinterProfile& profile) {
  for (std::size_t i = 1; i < job.layers.size(); ++i) {
    const LevelTable below = level_table(profile, job.layers[i - 1], step_of(job, i - 1));
    const LevelTable here = level_table(profile, job.layers[i], step_of(job, i));
    for (std::size_t p = 0; p < job.layers[i].gray.size(); ++p) {
      if (!here.cures[job.layers[i].gray[p]] || below.fills[job.layers[i - 1].gray[p]]) continue;
      throw MethodError(fmt::format(
          "layer {} cures at pixel ({}, {}) above a void in layer {}; the virtual printer knows no overhangs: "
          "every layer but the last must be cured through wherever the next one cures",
          i, p % job.columns, p / job.columns, i - 1));
    }
  }
}

}  // namespace mezzotint
