#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "experiments/configuration/toml_table.h"

namespace mezzotint {

namespace {

constexpr std::uintmax_t largest_configuration_bytes = 1U << 20U;

[[noreturn]] void not_toml(const std::string& name, const toml::parse_error& error) {
  const auto place = error.source().begin;
  throw ConfigurationError(
      fmt::format("{}:{}:{}: not valid TOML: {}", name, place.line, place.column, error.description()));
}

std::string contents_of(const std::filesystem::path& path) {
  std::error_code problem;
  if (!std::filesystem::exists(path, problem)) throw ConfigurationError(path.string() + ": no such file");
  if (!std::filesystem::is_regular_file(path, problem)) {
    throw ConfigurationError(path.string() + ": is not a regular file");
  }
  if (std::filesystem::file_size(path, problem) > largest_configuration_bytes) {
    throw ConfigurationError(path.string() + ": larger than 1 MiB; that is no configuration file");
  }
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw ConfigurationError(path.string() + ": cannot be read");
  return text.str();
}

// A bare word is a text for whoever types it: --set target.kind=scan.
toml::table parse_setting(const std::string& key, const std::string& value, const std::string& source) {
  try {
    return toml::parse(key + " = " + value, source);
  } catch (const toml::parse_error&) {
  }
  try {
    toml::table table = toml::parse(key + " = 0", source);
    // Only the value was not TOML: take it as text, through an escaped literal that keeps its source.
    std::string quoted;
    for (const char c : value) quoted += (c == '"' || c == '\\') ? std::string{'\\', c} : std::string{c};
    return toml::parse(key + " = \"" + quoted + "\"", source);
  } catch (const toml::parse_error& error) {
    not_toml(source, error);
  }
}

void merge(toml::table& into, toml::table& from) {
  for (auto&& [key, node] : from) {
    toml::node* existing = into.get(key.str());
    if (existing != nullptr && existing->is_table() && node.is_table()) {
      merge(*existing->as_table(), *node.as_table());
    } else {
      into.insert_or_assign(key, std::move(node));
    }
  }
}

}  // namespace

TomlFile::TomlFile(const std::filesystem::path& path, const std::vector<std::string>& settings) : path_(path) {
  const std::string text = contents_of(path);
  try {
    root_ = toml::parse(text, path.string());
  } catch (const toml::parse_error& error) {
    not_toml(path.string(), error);
  }
  for (const auto& setting : settings) apply(setting);
}

void TomlFile::apply(const std::string& setting) {
  const auto equals = setting.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw ConfigurationError("--set " + setting + ": reads KEY=VALUE, for example --set target.alpha_x=0.3");
  }
  const std::string key = setting.substr(0, equals), value = setting.substr(equals + 1);
  toml::table table = parse_setting(key, value, "--set " + setting);
  merge(root_, table);
}

std::string TomlFile::canonical_text() const {
  std::ostringstream text;
  text << toml::toml_formatter(root_);
  return text.str();
}

}  // namespace mezzotint
