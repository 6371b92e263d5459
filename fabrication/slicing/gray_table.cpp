#include "fabrication/slicing/gray_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "forward/base/error.h"

namespace mezzotint {

GrayTable GrayTable::linear() {
  std::vector<Yield> yields;
  yields.reserve(256);
  for (int level = 0; level < 256; ++level) yields.push_back({level / 255.0, static_cast<std::uint8_t>(level)});
  return GrayTable(yields);
}

GrayTable GrayTable::through_cure(const PrinterProfile& profile, Length layer) {
  require_valid(profile);
  require(profile.gray_levels <= 256,
          fmt::format("a job holds 8-bit pictures; the {} gray levels of the printer do not fit", profile.gray_levels));
  require(layer > Length{}, "a layer needs a thickness above 0");
  std::vector<Yield> yields = {{0.0, 0}};
  for (int i = 1; i < profile.gray_levels; ++i) {
    const double gray = static_cast<double>(i) / (profile.gray_levels - 1);
    const double share = gray_to_height(profile.cure, gray) / layer;
    if (share > 0.0) yields.push_back({share, static_cast<std::uint8_t>(std::lround(255.0 * gray))});
  }
  require(yields.size() > 1, "no gray level of the printer cures anything; raise cure.alpha_um");
  return GrayTable(yields);
}

GrayTable::GrayTable(const std::vector<Yield>& yields) {
  entries_.push_back({0.0, yields[0].level});
  for (std::size_t i = 1; i < yields.size(); ++i) {
    const double middle = 0.5 * (yields[i - 1].coverage + yields[i].coverage);
    if (middle <= 1.0) entries_.push_back({middle, yields[i].level});
  }
  std::size_t entry = 0;
  for (std::size_t bin = 0; bin < start_.size(); ++bin) {
    const double begin = static_cast<double>(bin) / double{bins};
    while (entry + 1 < entries_.size() && begin >= entries_[entry + 1].from) ++entry;
    start_[bin] = static_cast<std::uint16_t>(entry);
  }
  const double last = yields.back().coverage, before = yields[yields.size() - 2].coverage;
  largest_ = std::min(last, 1.0);
  saturation_ = last + 0.5 * (last - before);
}

}  // namespace mezzotint
