#include "experiments/report/bsdf_components.h"

#include <charconv>
#include <string_view>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

// A number from the beginning of the text, which is then that much shorter.
double take_number(std::string_view& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  require(error == std::errc{}, "the provenance \"convergence\" of a BSDF must be pairs of numbers, paths:error");
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

}  // namespace

Series convergence_of(const std::string& name, const Bsdf& bsdf) {
  Series series{.name = name};
  const auto found = bsdf.provenance.find("convergence");
  std::string_view text = found == bsdf.provenance.end() ? std::string_view{} : std::string_view{found->second};
  while (!text.empty()) {
    series.x.push_back(take_number(text));
    require(text.starts_with(':'), "the provenance \"convergence\" of a BSDF must be pairs of numbers, paths:error");
    text.remove_prefix(1);
    series.y.push_back(take_number(text));
    while (text.starts_with(' ')) text.remove_prefix(1);
  }
  return series;
}

std::optional<nlohmann::json> convergence_chart(const Panel& panel, const std::vector<Series>& curves,
                                                double tolerance) {
  std::vector<Series> drawn;
  for (const Series& curve : curves)
    if (!curve.x.empty()) drawn.push_back(curve);
  if (drawn.empty()) return std::nullopt;
  ChartAxes axes{"Paths", "Relative standard error of the map", true, true};
  if (tolerance > 0.0) axes.tolerance = tolerance;
  return line_chart(panel, axes, drawn);
}

nlohmann::json energy_table(const Panel& panel, const Bsdf& bsdf) {
  const EnergyAudit& energy = bsdf.energy;
  const std::vector<std::pair<const char*, Estimate>> shares = {
      {"reflected (albedo)", energy.reflected},
      {"transmitted", energy.transmitted},
      {"absorbed", energy.absorbed},
      {"left sideways: first met a copy beyond the patch", energy.left_sideways},
      {"cut off: at the bounce cap, or lost by the tracer", energy.cut_off}};
  std::vector<TableRow> rows;
  double sum = 0.0;
  for (const auto& [name, share] : shares) {
    rows.push_back({{name, Quantity{share.value, "1", share.standard_error}}});
    sum += share.value;
  }
  rows.push_back({{"sum", Quantity{sum, "1", {}}}});
  return table(panel, {"light", "share"}, rows);
}

}  // namespace mezzotint
