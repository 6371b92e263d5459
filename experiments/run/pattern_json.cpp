#include "experiments/run/pattern_json.h"

#include "forward/pattern/pattern_parameters.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

// A picture of labels, as runs: how many pixels, of which label.
Json labels_to_json(const PatternRegions& regions) {
  Json runs = Json::array();
  for (std::size_t first = 0; first < regions.labels.size();) {
    std::size_t end = first;
    while (end < regions.labels.size() && regions.labels[end] == regions.labels[first]) ++end;
    runs.push_back({end - first, regions.labels[first]});
    first = end;
  }
  return {{"source", regions.source}, {"columns", regions.columns}, {"rows", regions.rows}, {"runs", runs}};
}
void labels_from_json(const Json& json, PatternRegions& regions) {
  regions.source = json.at("source");
  regions.columns = json.at("columns");
  regions.rows = json.at("rows");
  for (const Json& run : json.at("runs")) {
    regions.labels.insert(regions.labels.end(), run.at(0).get<std::size_t>(), run.at(1).get<std::uint8_t>());
  }
}

Json parts_to_json(const std::vector<PatternPart>& parts) {
  Json list = Json::array();
  for (const PatternPart& part : parts) {
    list.push_back(pattern_to_json(part.pattern));
    list.back()["label"] = part.label;
  }
  return list;
}
template <typename Kind>
void parts_from_json(const Json& json, Kind& kind) {
  if constexpr (requires { kind.parts; }) {
    for (const Json& part : json.at("parts")) kind.parts.push_back({pattern_from_json(part), part.at("label")});
  }
}

}  // namespace

Json pattern_to_json(const Pattern& pattern) {
  Json json = {{"kind", kind_name(pattern)}};
  for (const auto& parameter : pattern_parameters(pattern)) {
    json[parameter.name] = get_parameter(pattern, parameter.name);
  }
  if (const auto random = randomness(pattern)) {
    json["seed"] = random->seed;
    json["hash"] = random->hash == CellHash::Slides ? "slides" : "integer";
  }
  if (const auto* lines = std::get_if<LineIntegralConvolution>(&pattern)) {
    json["singularities"] = Json::array();
    for (const Singularity& point : lines->singularities) {
      json["singularities"].push_back({point.place.x.um(), point.place.y.um(), point.index});
    }
  }
  if (const auto* parts = parts_of(pattern)) json["parts"] = parts_to_json(*parts);
  if (const auto* regions = std::get_if<PatternRegions>(&pattern)) json["labels"] = labels_to_json(*regions);
  return json;
}
Pattern pattern_from_json(const Json& json) {
  Pattern pattern = default_pattern(json.at("kind").get<std::string>());
  for (const auto& parameter : pattern_parameters(pattern)) {
    set_parameter(pattern, parameter.name, json.at(parameter.name));
  }
  if (randomness(pattern)) {
    set_randomness(pattern, {json.at("seed"), json.at("hash") == "slides" ? CellHash::Slides : CellHash::Integer});
  }
  if (auto* lines = std::get_if<LineIntegralConvolution>(&pattern)) {
    for (const Json& point : json.at("singularities")) {
      lines->singularities.push_back({{Length::from_um(point.at(0)), Length::from_um(point.at(1))}, point.at(2)});
    }
  }
  std::visit([&json](auto& kind) { parts_from_json(json, kind); }, pattern);
  if (auto* regions = std::get_if<PatternRegions>(&pattern)) labels_from_json(json.at("labels"), *regions);
  return pattern;
}

}  // namespace mezzotint
