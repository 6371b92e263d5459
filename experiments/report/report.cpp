#include "experiments/report/report.h"

#include <cassert>
#include <map>
#include <string_view>

#include "experiments/report/page_template.h"
#include "forward/base/error.h"
#include "forward/base/file_output.h"

namespace mezzotint {

namespace {

using nlohmann::json;

std::string to_string(MessageLevel level) {
  switch (level) {
    case MessageLevel::Note:
      return "note";
    case MessageLevel::Warning:
      return "warning";
    case MessageLevel::Error:
      return "error";
  }
  return "note";
}

json key_figure_json(const KeyFigure& figure) {
  json out = figure.quantity;
  out["name"] = figure.name;
  out["state"] = to_string(figure.outcome);
  if (figure.at_most) out["at_most"] = *figure.at_most;
  if (!figure.note.empty()) out["note"] = figure.note;
  return out;
}

// Replaces {"float32": base64} by {"array": id}: a map that is shown flat and in 3-D is stored once.
void share_arrays(json& node, json& arrays, std::map<std::string, std::string>& known) {
  if (node.is_object() && node.size() == 1 && node.contains("float32")) {
    auto [entry, is_new] = known.try_emplace(node["float32"].get<std::string>(), "a" + std::to_string(known.size()));
    if (is_new) arrays[entry->second] = entry->first;
    node = {{"array", entry->second}};
  } else if (node.is_structured()) {
    for (auto& child : node) share_arrays(child, arrays, known);
  }
}

json sections_json(const std::vector<Section>& sections) {
  json out = json::array();
  for (const Section& section : sections) {
    require(!section.title.empty(), "a report's section needs a title");
    out.push_back({{"title", section.title}, {"text", section.text}, {"components", section.components}});
  }
  return out;
}

// "<" only occurs inside of JSON strings, where it may be written as an escape. So neither "</script"
// nor "<!--" can end the element, or change how its end is found.
std::string inert_text(const json& data) {
  const std::string plain = data.dump(-1, ' ', false, json::error_handler_t::replace);
  std::string text;
  text.reserve(plain.size() + 64);
  for (const char c : plain) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

std::string to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::Met:
      return "met";
    case Outcome::Missed:
      return "missed";
    case Outcome::Information:
      return "information";
  }
  return "information";
}

json to_report_json(const Report& report) {
  require(!report.title.empty(), "a report needs a title");
  json out = {{"format", "mezzotint-report"},
              {"version", 1},
              {"title", report.title},
              {"subtitle", report.subtitle},
              {"verdict", {{"state", to_string(report.verdict.outcome)}, {"sentence", report.verdict.sentence}}},
              {"key_figures", json::array()},
              {"messages", json::array()},
              {"sections", sections_json(report.sections)},
              {"provenance", report.provenance},
              {"arrays", json::object()}};
  for (const KeyFigure& figure : report.key_figures) out["key_figures"].push_back(key_figure_json(figure));
  for (const Message& message : report.messages) {
    out["messages"].push_back({{"level", to_string(message.level)}, {"text", message.text}});
  }
  std::map<std::string, std::string> known;
  share_arrays(out["sections"], out["arrays"], known);
  return out;
}

void write_report(const Report& report, const std::filesystem::path& path) {
  const json data = to_report_json(report);
  const std::string_view page = page_template();
  const std::size_t place = page.find(page_data_marker);
  assert(place != std::string_view::npos);  // the page's build checks that it is there, once
  std::string html(page.substr(0, place));
  html += "<script type=\"application/json\" id=\"report-data\">";
  html += inert_text(data);
  html += "</script>";
  html += page.substr(place + page_data_marker.size());
  write_file(path, html);
}

}  // namespace mezzotint
