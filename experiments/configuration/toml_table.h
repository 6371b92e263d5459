#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "forward/base/error.h"

namespace mezzotint {

/// A complaint about a configuration file: "run.toml:7:1: unknown key …".
class ConfigurationError : public Error {
public:
  explicit ConfigurationError(const std::string& message) : Error(message, ExitStatus::BadInput) {}
};

/// A TOML file, whole, with the `--set KEY=VALUE` of the command line applied.
class TomlFile {
public:
  /// @throws ConfigurationError for a file that is missing, larger than 1 MiB or not TOML, with line and column.
  explicit TomlFile(const std::filesystem::path& path, const std::vector<std::string>& settings = {});

  [[nodiscard]] const toml::table& root() const { return root_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// The configuration as it stands, in a canonical form: what a run is identified by.
  [[nodiscard]] std::string canonical_text() const;

private:
  void apply(const std::string& setting);
  std::filesystem::path path_;
  toml::table root_;
};

/// The closed interval in which a number must lie.
struct Range {
  double low;
  double high;
};

/// A number that may be free: `90.0`, or `{ free = [30.2, 400.0], start = 90.0 }`.
struct NumberOrFree {
  std::optional<double> fixed;
  double low = 0.0;
  double high = 0.0;
  std::optional<double> start;
};

/// One table of a TOML file, read key by key; what was not asked for is an unknown key.
///
/// Every getter throws ConfigurationError with file, line and column for a wrong type or a value out of range.
/// A getter with a fallback returns it where the key is left out; without one the key must be there.
class TomlTable {
public:
  explicit TomlTable(const TomlFile& file);

  [[nodiscard]] bool has(std::string_view key);
  [[nodiscard]] double number(std::string_view key, Range range, std::optional<double> fallback = {});
  [[nodiscard]] std::int64_t integer(std::string_view key, std::int64_t low, std::int64_t high,
                                     std::optional<std::int64_t> fallback = {});
  [[nodiscard]] bool boolean(std::string_view key, std::optional<bool> fallback = {});
  [[nodiscard]] std::string text(std::string_view key, std::optional<std::string> fallback = {});
  [[nodiscard]] std::string choice(std::string_view key, const std::vector<std::string>& choices,
                                   std::optional<std::string> fallback = {});
  /// A path: relative to the file that holds the key, or to the working folder where `--set` gave it.
  [[nodiscard]] std::filesystem::path file(std::string_view key);
  /// A list of paths, at least one.
  [[nodiscard]] std::vector<std::filesystem::path> files(std::string_view key);
  [[nodiscard]] std::vector<std::array<double, 2>> pairs(std::string_view key, Range range,
                                                         const std::vector<std::array<double, 2>>& fallback);
  /// A list of so many numbers.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count, Range range);
  [[nodiscard]] NumberOrFree number_or_free(std::string_view key, Range range);

  [[nodiscard]] bool is_table(std::string_view key) const;
  /// A table within this one; an empty one where it is left out.
  [[nodiscard]] TomlTable table(std::string_view key);
  /// An array of tables.
  [[nodiscard]] std::vector<TomlTable> tables(std::string_view key);

  /// @throws ConfigurationError for the first key that nobody asked for.
  void finish() const;
  /// A complaint that points to a key (or to the table where the key is not there).
  [[noreturn]] void complain(std::string_view key, const std::string& problem) const;

private:
  TomlTable(const TomlFile& file, const toml::table* table, std::string name);
  const toml::node* find(std::string_view key);
  [[noreturn]] void complain_at(const toml::node* node, const std::string& problem) const;
  [[noreturn]] void missing(std::string_view key) const;
  double checked(const toml::node& node, std::string_view key, Range range) const;
  [[nodiscard]] std::filesystem::path resolved(const toml::node& node, std::filesystem::path path) const;

  const TomlFile* file_;
  const toml::table* table_;  ///< null where it is left out
  std::string name_;
  std::set<std::string, std::less<>> asked_;
};

}  // namespace mezzotint
