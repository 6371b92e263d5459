#include "measurement/formats/sidecar.h"

#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "measurement/formats/text_values.h"

namespace mezzotint {

namespace {

constexpr std::uintmax_t largest_sidecar_bytes = 1 << 20;

class Entries {
public:
  Entries(const std::filesystem::path& path, const toml::table& table) : path_(path), table_(table) {}

  [[noreturn]] void fail(const toml::node& node, const std::string& problem) const {
    const auto place = node.source().begin;
    throw FileError(path_, fmt::format("{}:{}", place.line, place.column), problem);
  }
  void take(const char* key, std::optional<double>& value) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) return;
    value = node->value<double>();
    if (!value || !std::isfinite(*value)) fail(*node, fmt::format("{} must be a number", key));
  }
  void take(const char* key, bool& value) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) return;
    const auto given = node->value_exact<bool>();
    if (!given) fail(*node, fmt::format("{} must be true or false", key));
    value = *given;
  }
  void take(const char* key, std::string& value) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) return;
    const auto given = node->value_exact<std::string>();
    if (!given) fail(*node, fmt::format("{} must be text", key));
    value = clean_text(*given);
  }
  void require_known(std::initializer_list<std::string_view> known) const {
    for (const auto& [key, node] : table_) {
      bool found = false;
      for (const std::string_view name : known) found = found || key.str() == name;
      if (!found) {
        std::string list;
        for (const std::string_view name : known) list += (list.empty() ? "" : ", ") + std::string(name);
        fail(node, fmt::format("unknown key \"{}\"; the keys are {}", clean_text(key.str()), list));
      }
    }
  }

private:
  const std::filesystem::path& path_;
  const toml::table& table_;
};

toml::table parse_toml(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  try {
    return toml::parse(text, std::string_view("sidecar"));
  } catch (const toml::parse_error& error) {
    const auto place = error.source().begin;
    throw FileError(path, fmt::format("{}:{}", place.line, place.column),
                    fmt::format("is not valid TOML: {}", clean_text(error.description())));
  }
}

void take_missing_gray(const Entries& entries, const toml::table& table, Sidecar& sidecar) {
  constexpr std::int64_t white = 65535;
  const toml::node* node = table.get("missing_gray");
  if (node == nullptr) return;
  const auto gray = node->value_exact<std::int64_t>();
  if (!gray || *gray < 0 || *gray > white) entries.fail(*node, "missing_gray must be a gray level, 0 to 65535");
  sidecar.missing_gray = static_cast<unsigned>(*gray);
}

void take_first_row(const Entries& entries, const toml::table& table, Sidecar& sidecar) {
  std::string first_row = "top";
  entries.take("first_row", first_row);
  if (first_row != "top" && first_row != "bottom") {
    entries.fail(*table.get("first_row"), "first_row must be \"top\" or \"bottom\"");
  }
  sidecar.first_row_on_top = first_row == "top";
}

void take_provenance(const Entries& entries, const toml::table& table, Sidecar& sidecar) {
  const toml::node* node = table.get("provenance");
  if (node == nullptr) return;
  if (!node->is_table()) entries.fail(*node, "provenance must be a table of texts");
  for (const auto& [key, value] : *node->as_table()) {
    const auto text = value.value_exact<std::string>();
    if (!text) entries.fail(value, fmt::format("provenance.{} must be text", clean_text(key.str())));
    sidecar.provenance[clean_text(key.str())] = clean_text(*text);
  }
}

void require_sizes(const std::filesystem::path& path, const Sidecar& sidecar) {
  const std::pair<const char*, std::optional<double>> positive[] = {
      {"width_um", sidecar.width_um}, {"length_um", sidecar.length_um}, {"xy_um", sidecar.xy_um}};
  for (const auto& [key, value] : positive) {
    if (value && !(*value > 0.0)) throw FileError(path, key, fmt::format("is {}; it must be positive", *value));
  }
  const std::pair<const char*, std::optional<double>> scales[] = {{"depth_um", sidecar.depth_um},
                                                                  {"value_um", sidecar.value_um}};
  for (const auto& [key, value] : scales) {
    if (value && *value == 0.0) throw FileError(path, key, "is 0; all heights would be the same");
  }
}

}  // namespace

std::filesystem::path sidecar_path(const std::filesystem::path& picture) {
  std::filesystem::path path = picture;
  path += ".toml";
  return path;
}

Sidecar parse_sidecar(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  if (bytes.size() > largest_sidecar_bytes) throw FileError(path, "", "is larger than the sidecar of any picture");
  const toml::table table = parse_toml(path, bytes);
  const Entries entries(path, table);
  entries.require_known({"width_um", "length_um", "depth_um", "value_um", "xy_um", "datum_um", "missing_gray",
                         "periodic", "first_row", "title", "provenance"});
  Sidecar sidecar;
  entries.take("width_um", sidecar.width_um);
  entries.take("length_um", sidecar.length_um);
  entries.take("depth_um", sidecar.depth_um);
  entries.take("value_um", sidecar.value_um);
  entries.take("xy_um", sidecar.xy_um);
  std::optional<double> datum_um;
  entries.take("datum_um", datum_um);
  sidecar.datum_um = datum_um.value_or(0.0);
  entries.take("periodic", sidecar.periodic);
  entries.take("title", sidecar.title);
  take_missing_gray(entries, table, sidecar);
  take_first_row(entries, table, sidecar);
  take_provenance(entries, table, sidecar);
  require_sizes(path, sidecar);
  return sidecar;
}

Sidecar read_sidecar(const std::filesystem::path& picture) {
  const std::filesystem::path path = sidecar_path(picture);
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    throw FileError(picture, "",
                    fmt::format("does not say how large it is; write its sizes into {}, such as width_um = 640.0 and "
                                "depth_um = 18.0 (docs/files.md)",
                                path.string()));
  }
  return parse_sidecar(path, read_file(path));
}

std::string sidecar_text(const Sidecar& sidecar) {
  toml::table table;
  const auto put = [&](const char* key, const std::optional<double>& value) {
    if (value) table.insert(key, *value);
  };
  put("width_um", sidecar.width_um);
  put("length_um", sidecar.length_um);
  put("depth_um", sidecar.depth_um);
  put("value_um", sidecar.value_um);
  put("datum_um", sidecar.datum_um);
  if (sidecar.missing_gray) table.insert("missing_gray", std::int64_t{*sidecar.missing_gray});
  if (sidecar.periodic) table.insert("periodic", true);
  if (!sidecar.title.empty()) table.insert("title", sidecar.title);
  toml::table provenance;
  for (const auto& [key, value] : sidecar.provenance) provenance.insert(key, value);
  if (!provenance.empty()) table.insert("provenance", provenance);
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << table << '\n';
  return text.str();
}

}  // namespace mezzotint
