#include "experiments/command_line/json_words.h"

#include <fmt/format.h>

namespace mezzotint {

namespace {

std::string value_in_words(const nlohmann::ordered_json& value) {
  if (value.is_object() && value.contains("value")) {
    std::string text = fmt::format("{:.6g}", value["value"].is_number() ? value["value"].get<double>() : 0.0);
    if (value.contains("standard_error") && value["standard_error"].is_number()) {
      text += fmt::format(" ± {:.2g}", value["standard_error"].get<double>());
    }
    return value["unit"] == "1" ? text : text + " " + value["unit"].get<std::string>();
  }
  return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

std::string in_words(const nlohmann::ordered_json& json) {
  std::string text;
  for (const auto& [key, value] : json.items()) {
    const bool is_list = value.is_object() && !value.contains("value");
    if (!is_list) {
      if (value_in_words(value).empty()) continue;
      text += fmt::format("{:<18} {}\n", key, value_in_words(value));
      continue;
    }
    for (const auto& [name, entry] : value.items()) text += fmt::format("  {:<22} {}\n", name, value_in_words(entry));
  }
  if (!text.empty()) text.pop_back();
  return text;
}

}  // namespace mezzotint
