#include "experiments/gamut/gamut_axes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace mezzotint {

AlphaAxes axes_of(const GamutFindings& findings) {
  double low = findings.map.formula.floor_alpha, high_x = low, high_y = low;
  const auto reach = [&](const AlphaPair& alpha) {
    low = std::min(low, alpha.y);
    high_x = std::max(high_x, alpha.x);
    high_y = std::max(high_y, alpha.y);
  };
  for (const GamutRegion& region : findings.map.regions)
    for (const AlphaPair& alpha : region.outline()) reach(alpha);
  for (const AskedTarget& target : findings.targets) reach(target.alpha);
  low = std::max(low, 1e-4) / 1.35;
  return {low, 1.25 * high_x, low, 1.25 * high_y};
}

std::vector<double> ticks(double low, double high) {
  std::vector<double> list;
  for (double power = std::pow(10.0, std::floor(std::log10(low))); power <= high; power *= 10.0)
    for (const double digit : {1.0, 2.0, 5.0})
      if (digit * power >= low && digit * power <= high) list.push_back(digit * power);
  return list;
}

// Okabe and Ito's palette, its yellow left out.
std::string colour_of(const std::string& kind) {
  constexpr std::array<const char*, 7> colours = {"#0072b2", "#56b4e9", "#009e73", "#d55e00",
                                                  "#cc79a7", "#e69f00", "#7f7f7f"};
  const auto& names = gamut_kind_names();
  const auto found = std::ranges::find(names, kind);
  return colours.at(static_cast<std::size_t>(found - names.begin()) % colours.size());
}

}  // namespace mezzotint
