#include "experiments/configuration/toml_table.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "experiments/configuration/suggestion.h"

namespace mezzotint {

namespace {

constexpr std::string_view set_source = "--set";

std::string type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

bool was_set_by_hand(const toml::node& node) {
  const auto& source = node.source().path;
  return source && source->starts_with(set_source);
}

std::string unit_hint(std::string_view key) {
  if (key.ends_with("_um")) return " in micrometres";
  if (key.ends_with("_nm")) return " in nanometres";
  if (key.ends_with("_deg")) return " in degrees";
  if (key.ends_with("_s")) return " in seconds";
  return "";
}

}  // namespace

TomlTable::TomlTable(const TomlFile& file) : TomlTable(file, &file.root(), "") {}

TomlTable::TomlTable(const TomlFile& file, const toml::table* table, std::string name)
    : file_(&file), table_(table), name_(std::move(name)) {}

void TomlTable::complain_at(const toml::node* node, const std::string& problem) const {
  if (node != nullptr && was_set_by_hand(*node)) throw ConfigurationError(*node->source().path + ": " + problem);
  const auto place = node != nullptr ? node->source().begin : toml::source_position{};
  const std::string where = place.line > 0 ? fmt::format("{}:{}", place.line, place.column) : "1:1";
  throw ConfigurationError(fmt::format("{}:{}: {}", file_->path().string(), where, problem));
}

void TomlTable::complain(std::string_view key, const std::string& problem) const {
  const toml::node* node = table_ != nullptr ? table_->get(key) : nullptr;
  complain_at(node != nullptr ? node : table_, problem);
}

void TomlTable::missing(std::string_view key) const {
  complain_at(table_, fmt::format("\"{}\" is missing{}", key, name_.empty() ? "" : " in [" + name_ + "]"));
}

const toml::node* TomlTable::find(std::string_view key) {
  asked_.emplace(key);
  return table_ != nullptr ? table_->get(key) : nullptr;
}

bool TomlTable::has(std::string_view key) { return find(key) != nullptr; }

double TomlTable::checked(const toml::node& node, std::string_view key, Range range) const {
  const auto value = node.value<double>();
  if (!node.is_number() || !value) {
    complain_at(&node, fmt::format("\"{}\" must be a number{}, not {}", key, unit_hint(key), type_name(node)));
  }
  // Written so that NaN fails too.
  if (!(*value >= range.low && *value <= range.high)) {
    complain_at(&node,
                fmt::format("\"{}\" = {} is out of range; it must be in [{}, {}]", key, *value, range.low, range.high));
  }
  return *value;
}

double TomlTable::number(std::string_view key, Range range, std::optional<double> fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) return fallback ? *fallback : (missing(key), 0.0);
  return checked(*node, key, range);
}

std::int64_t TomlTable::integer(std::string_view key, std::int64_t low, std::int64_t high,
                                std::optional<std::int64_t> fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) return fallback ? *fallback : (missing(key), 0);
  const auto value = node->value_exact<std::int64_t>();
  if (!value) complain_at(node, fmt::format("\"{}\" must be an integer, not {}", key, type_name(*node)));
  if (*value < low || *value > high) {
    complain_at(node, fmt::format("\"{}\" = {} is out of range; it must be in [{}, {}]", key, *value, low, high));
  }
  return *value;
}

bool TomlTable::boolean(std::string_view key, std::optional<bool> fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) return fallback ? *fallback : (missing(key), false);
  const auto value = node->value_exact<bool>();
  if (!value) complain_at(node, fmt::format("\"{}\" must be true or false, not {}", key, type_name(*node)));
  return *value;
}

std::string TomlTable::text(std::string_view key, std::optional<std::string> fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) return fallback ? *fallback : (missing(key), "");
  const auto value = node->value_exact<std::string>();
  if (!value) complain_at(node, fmt::format("\"{}\" must be a text in quotes, not {}", key, type_name(*node)));
  return *value;
}

std::string TomlTable::choice(std::string_view key, const std::vector<std::string>& choices,
                              std::optional<std::string> fallback) {
  std::string value = text(key, std::move(fallback));
  if (std::ranges::find(choices, value) == choices.end()) {
    complain(key, fmt::format("\"{}\" = \"{}\" is not known{}", key, value, suggest(value, choices)));
  }
  return value;
}

std::filesystem::path TomlTable::resolved(const toml::node& node, std::filesystem::path path) const {
  if (path.is_absolute() || was_set_by_hand(node)) return path;
  return file_->path().parent_path() / path;
}

std::filesystem::path TomlTable::file(std::string_view key) {
  std::filesystem::path path = text(key);
  return resolved(*table_->get(key), std::move(path));
}

std::vector<std::filesystem::path> TomlTable::files(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) missing(key);
  const toml::array* list = node->as_array();
  if (list == nullptr || list->empty())
    complain_at(node, fmt::format("\"{}\" must be a list of files, like [\"a.exr\", \"b.exr\"]", key));
  std::vector<std::filesystem::path> paths;
  for (const toml::node& element : *list) {
    const auto value = element.value_exact<std::string>();
    if (!value) complain_at(&element, fmt::format("\"{}\" holds texts in quotes, not {}", key, type_name(element)));
    paths.push_back(resolved(was_set_by_hand(*node) ? *node : element, *value));
  }
  return paths;
}

std::vector<std::array<double, 2>> TomlTable::pairs(std::string_view key, Range range,
                                                    const std::vector<std::array<double, 2>>& fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) return fallback;
  const toml::array* outer = node->as_array();
  if (outer == nullptr || outer->empty()) {
    complain_at(node, fmt::format("\"{}\" must be a list of pairs, like [[20.0, 0.0], [20.0, 90.0]]", key));
  }
  std::vector<std::array<double, 2>> values;
  for (const toml::node& element : *outer) {
    const toml::array* pair = element.as_array();
    if (pair == nullptr || pair->size() != 2) complain_at(&element, fmt::format("\"{}\" holds pairs of numbers", key));
    values.push_back({checked((*pair)[0], key, range), checked((*pair)[1], key, range)});
  }
  return values;
}

std::vector<double> TomlTable::numbers(std::string_view key, std::size_t count, Range range) {
  const toml::node* node = find(key);
  if (node == nullptr) missing(key);
  const toml::array* list = node->as_array();
  if (list == nullptr || list->size() != count)
    complain_at(node, fmt::format("\"{}\" is a list of {} numbers", key, count));
  std::vector<double> values;
  for (const toml::node& element : *list) values.push_back(checked(element, key, range));
  return values;
}

NumberOrFree TomlTable::number_or_free(std::string_view key, Range range) {
  const toml::node* node = find(key);
  if (node == nullptr) missing(key);
  if (!node->is_table()) return {.fixed = checked(*node, key, range)};
  TomlTable inner = table(key);
  const toml::node* bounds = inner.find("free");
  const toml::array* pair = bounds != nullptr ? bounds->as_array() : nullptr;
  if (pair == nullptr || pair->size() != 2) {
    complain_at(bounds != nullptr ? bounds : node,
                fmt::format("a free \"{}\" reads {{ free = [lowest, highest], start = … }}", key));
  }
  NumberOrFree result{.low = checked((*pair)[0], key, range), .high = checked((*pair)[1], key, range)};
  if (result.low >= result.high)
    complain_at(bounds, fmt::format("\"{}\": the first bound must be below the second", key));
  if (inner.has("start")) result.start = inner.number("start", {result.low, result.high});
  inner.finish();
  return result;
}

bool TomlTable::is_table(std::string_view key) const {
  return table_ != nullptr && table_->contains(key) && table_->get(key)->is_table();
}

TomlTable TomlTable::table(std::string_view key) {
  const toml::node* node = find(key);
  if (node != nullptr && !node->is_table()) {
    complain_at(node, fmt::format("\"{}\" must be a table, not {}", key, type_name(*node)));
  }
  const std::string name = name_.empty() ? std::string(key) : name_ + "." + std::string(key);
  return {*file_, node != nullptr ? node->as_table() : nullptr, name};
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
  const toml::node* node = find(key);
  std::vector<TomlTable> result;
  if (node == nullptr) return result;
  const bool is_empty_list = node->is_array() && node->as_array()->empty();
  if (!is_empty_list && !node->is_array_of_tables())
    complain_at(node, fmt::format("\"{}\" must be a list of tables", key));
  for (const toml::node& element : *node->as_array()) {
    result.push_back({*file_, element.as_table(), name_.empty() ? std::string(key) : name_ + "." + std::string(key)});
  }
  return result;
}

void TomlTable::finish() const {
  if (table_ == nullptr) return;
  for (const auto& [key, node] : *table_) {
    if (asked_.contains(key.str())) continue;
    const std::vector<std::string> known(asked_.begin(), asked_.end());
    const std::string where = name_.empty() ? "at the top of the file" : "in [" + name_ + "]";
    const std::string problem = fmt::format("unknown key \"{}\" {}{}", key.str(), where, suggest(key.str(), known));
    if (was_set_by_hand(node)) complain_at(&node, problem);
    throw ConfigurationError(fmt::format("{}:{}:{}: {}", file_->path().string(), key.source().begin.line,
                                         key.source().begin.column, problem));
  }
}

}  // namespace mezzotint
