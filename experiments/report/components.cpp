#include "experiments/report/components.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "experiments/report/float_array.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

using nlohmann::json;

std::string to_string(Span span) {
  switch (span) {
    case Span::Full:
      return "full";
    case Span::TwoThirds:
      return "two_thirds";
    case Span::Half:
      return "half";
    case Span::Third:
      return "third";
  }
  return "full";
}

json component(const std::string& type, const Panel& panel) {
  json out = {{"type", type}, {"title", panel.title}, {"span", to_string(panel.span)}};
  if (!panel.caption.empty()) out["caption"] = panel.caption;
  if (!panel.alt.empty()) out["alt"] = panel.alt;
  return out;
}

void require_whole(const NamedMap& map) {
  require(map.grid.size() > 0 && map.mean.size() == map.grid.size(),
          "the map \"" + map.name + "\" must have one value a bin of its grid");
  require(map.standard_error.empty() || map.standard_error.size() == map.grid.size(),
          "the map \"" + map.name + "\" must have one standard error a bin, or none");
}

json map_json(const NamedMap& map) {
  require_whole(map);
  json out = {{"name", map.name},          {"width", map.grid.width},
              {"height", map.grid.height}, {"kind", map.difference ? "difference" : "value"},
              {"target", map.target},      {"values", float_array(map.mean)}};
  if (!map.standard_error.empty()) out["standard_error"] = float_array(map.standard_error);
  if (!map.note.empty()) out["note"] = map.note;
  if (map.incidence) {
    out["incidence"] = {{"theta_deg", map.incidence->theta.degrees()}, {"phi_deg", map.incidence->phi.degrees()}};
  }
  return out;
}

json map_component(const std::string& type, const Panel& panel, const std::vector<NamedMap>& maps,
                   const MapScale& scale) {
  require(!maps.empty(), "a report's \"" + type + "\" needs at least one map");
  json out = component(type, panel);
  out["unit"] = scale.unit;
  out["label"] = scale.label;
  for (const NamedMap& map : maps) out["maps"].push_back(map_json(map));
  return out;
}

float block_mean(const HeightField& field, std::size_t column, std::size_t row, std::size_t block) {
  double sum = 0.0;
  std::size_t seen = 0;
  for (std::size_t r = row; r < row + block; ++r) {
    for (std::size_t c = column; c < column + block; ++c) {
      const float height_um = field.at(c, r);
      if (std::isnan(height_um)) continue;
      sum += static_cast<double>(height_um);
      ++seen;
    }
  }
  if (2 * seen < block * block) return std::numeric_limits<float>::quiet_NaN();
  return static_cast<float>(sum / static_cast<double>(seen));
}

// A side that the block does not divide loses its last few samples.
json relief_json(const NamedRelief& relief) {
  const HeightField& field = relief.field;
  const std::size_t longest = std::max(field.columns(), field.rows());
  std::size_t block = (longest + longest_relief_side - 1) / longest_relief_side;
  block = std::max<std::size_t>(1, std::min({block, field.columns(), field.rows()}));
  const std::size_t columns = field.columns() / block, rows = field.rows() / block;
  std::vector<float> heights_um(columns * rows);
  for (std::size_t k = 0; k < heights_um.size(); ++k) {
    heights_um[k] = block_mean(field, k % columns * block, k / columns * block, block);
  }
  const auto scale = static_cast<double>(block);
  return {{"name", relief.name},
          {"columns", columns},
          {"rows", rows},
          {"block", block},
          {"pitch_x_um", field.grid().pitch_x.um() * scale},
          {"pitch_y_um", field.grid().pitch_y.um() * scale},
          {"missing_share", static_cast<double>(field.missing_count()) / static_cast<double>(field.grid().size())},
          {"heights", float_array(heights_um)}};
}

json relief_component(const std::string& type, const Panel& panel, const std::vector<NamedRelief>& reliefs) {
  require(!reliefs.empty(), "a report's \"" + type + "\" needs at least one relief");
  json out = component(type, panel);
  for (const NamedRelief& relief : reliefs) out["reliefs"].push_back(relief_json(relief));
  return out;
}

}  // namespace

NamedMap named_map(std::string name, const DirectionGrid& grid, const MapEstimate& map,
                   const DirectionAngles& incidence) {
  NamedMap out;
  out.name = std::move(name);
  out.grid = grid;
  out.mean = map.mean;
  out.standard_error = map.standard_error;
  out.incidence = incidence;
  return out;
}

NamedMap difference_map(std::string name, const NamedMap& a, const NamedMap& b) {
  require_whole(a);
  require_whole(b);
  require(a.grid == b.grid, "the difference of \"" + a.name + "\" and \"" + b.name + "\" needs maps on the same grid");
  NamedMap out;
  out.name = std::move(name);
  out.grid = a.grid;
  out.incidence = a.incidence;
  out.difference = true;
  const auto error_of = [](const NamedMap& map, std::size_t k) {
    return map.standard_error.empty() ? 0.0 : map.standard_error[k];
  };
  for (std::size_t k = 0; k < a.mean.size(); ++k) {
    out.mean.push_back(a.mean[k] - b.mean[k]);
    out.standard_error.push_back(std::hypot(error_of(a, k), error_of(b, k)));
  }
  return out;
}

json direction_maps(const Panel& panel, const std::vector<NamedMap>& maps, const MapScale& scale) {
  json out = map_component("direction_maps", panel, maps, scale);
  out["difference_label"] = scale.difference_label;
  out["scale"] = scale.logarithmic ? "log" : "linear";
  return out;
}

json lobe_viewer(const Panel& panel, const std::vector<NamedMap>& maps, const MapScale& scale) {
  return map_component("lobe_viewer", panel, maps, scale);
}

json relief_maps(const Panel& panel, const std::vector<NamedRelief>& reliefs) {
  return relief_component("relief_maps", panel, reliefs);
}

json relief_viewer(const Panel& panel, const std::vector<NamedRelief>& reliefs) {
  return relief_component("relief_viewer", panel, reliefs);
}

json plane_maps(const Panel& panel, const std::vector<PlaneMap>& maps, const PlaneQuantity& quantity) {
  require(!maps.empty(), "the maps \"" + panel.title + "\" need one at least");
  json out = component("relief_maps", panel);
  out["quantity"] = {{"label", quantity.label},
                     {"symbol", quantity.symbol},
                     {"unit", quantity.unit},
                     {"step_unit", quantity.step_unit},
                     {"centred", true}};
  if (!quantity.outline.empty()) out["quantity"]["outline"] = quantity.outline;
  for (const PlaneMap& map : maps) {
    require(map.columns * map.rows == map.values.size() && !map.values.empty(),
            "the map \"" + map.name + "\" must have one value a place of its grid");
    json entry = {{"name", map.name},         {"columns", map.columns},
                  {"rows", map.rows},         {"block", 1},
                  {"pitch_x_um", map.step_x}, {"pitch_y_um", map.step_y},
                  {"missing_share", 0.0},     {"heights", float_array(map.values)}};
    if (!map.outline.empty()) entry["outline"] = map.outline;
    out["reliefs"].push_back(std::move(entry));
  }
  return out;
}

json table(const Panel& panel, const std::vector<std::string>& columns, const std::vector<TableRow>& rows) {
  require(!columns.empty(), "a report's table needs at least one column");
  json out = component("table", panel);
  out["columns"] = columns;
  out["rows"] = json::array();
  for (const TableRow& row : rows) {
    require(row.cells.size() == columns.size(),
            "every row of the table \"" + panel.title + "\" must have " + std::to_string(columns.size()) + " cells");
    json entry = {{"cells", row.cells}};
    if (row.outcome != Outcome::Information) entry["state"] = to_string(row.outcome);
    out["rows"].push_back(std::move(entry));
  }
  return out;
}

json vega_lite_chart(const Panel& panel, json specification) {
  json out = component("chart", panel);
  out["spec"] = std::move(specification);
  return out;
}

json messages(const std::vector<Message>& list) {
  constexpr const char* levels[] = {"note", "warning", "error"};
  json out = {{"type", "messages"}, {"messages", json::array()}};
  for (const Message& message : list) {
    out["messages"].push_back({{"level", levels[static_cast<int>(message.level)]}, {"text", message.text}});
  }
  return out;
}

}  // namespace mezzotint
