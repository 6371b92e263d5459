#include "experiments/configuration/pattern_table.h"

#include <cmath>

#include <fmt/format.h>

#include "experiments/configuration/label_image.h"
#include "forward/pattern/pattern_parameters.h"

namespace mezzotint {

namespace {

std::vector<std::string> kinds() { return {pattern_kinds().begin(), pattern_kinds().end()}; }

// Wavelengths from four pixels of the finest printers to a patch, all that one layer reaches, every direction.
std::vector<FreeParameter> default_freedom() {
  return {{"scale_um", 30.2, 400.0, {}}, {"stretch", 1.0, 8.0, {}}, {"direction_deg", -90.0, 90.0, {}}};
}

PatternSpecification default_specification() {
  return {Noise{}, default_freedom(),
          "no [pattern] is named: stretched noise, since its slopes are nearly Gaussian and so come closest to a "
          "Beckmann lobe"};
}

// Whether a pattern's own height counts, or only its shape.
enum class OwnHeight { Counts, IsNothing };

constexpr int most_levels = 8;

Pattern read_part(TomlTable table, int level, OwnHeight own_height);

void read_randomness(TomlTable& table, Pattern& pattern, PatternUse use) {
  auto random = randomness(pattern);
  if (!random) return;
  if (use == PatternUse::Search && table.has("seed")) {
    table.complain("seed", "a search draws its patterns anew; its seed is that of [search]");
  }
  random->seed = static_cast<std::uint64_t>(table.integer("seed", 0, INT64_MAX, std::int64_t(random->seed)));
  random->hash =
      table.choice("hash", {"integer", "slides"}, "integer") == "slides" ? CellHash::Slides : CellHash::Integer;
  set_randomness(pattern, *random);
}

void read_singularities(TomlTable& table, LineIntegralConvolution& lines) {
  for (TomlTable& point : table.tables("singularities")) {
    const auto place = [&point](std::string_view key) { return Length::from_um(point.number(key, {-1e6, 1e6})); };
    lines.singularities.push_back({{place("x_um"), place("y_um")}, point.number("index", {-4.0, 4.0}, 1.0)});
    if (const double twice = 2.0 * lines.singularities.back().index; twice != std::round(twice)) {
      point.complain("index", "\"index\" is a multiple of 0.5: a line that is turned by half a turn is the same line");
    }
    point.finish();
  }
}

std::vector<PatternPart> read_parts(TomlTable& table, int level, OwnHeight own_height, std::size_t least) {
  std::vector<TomlTable> tables = table.tables("parts");
  if (tables.size() < least) {
    table.complain("parts",
                   fmt::format("this kind needs {} parts or more, like parts = [{{ kind = \"noise\" }}, {{ kind = "
                               "\"ridges\" }}]",
                               least));
  }
  std::vector<PatternPart> parts;
  for (TomlTable& part : tables) parts.push_back({read_part(part, level + 1, own_height)});
  return parts;
}

PatternPart read_named_part(TomlTable& table, std::string_view key, int level, OwnHeight own_height) {
  if (!table.has(key))
    table.complain(key, fmt::format("\"{}\" is missing; it is a pattern, like {{ kind = \"noise\" }}", key));
  return {read_part(table.table(key), level + 1, own_height)};
}

template <typename Kind>
void read_parts_of(TomlTable&, Kind&, int, OwnHeight) {}
void read_parts_of(TomlTable& table, PatternSum& sum, int level, OwnHeight) {
  sum.parts = read_parts(table, level, OwnHeight::Counts, 2);
}
void read_parts_of(TomlTable& table, PatternProduct& product, int level, OwnHeight) {
  product.parts = read_parts(table, level, OwnHeight::IsNothing, 2);
}
void read_parts_of(TomlTable& table, TurnedPattern& turned, int level, OwnHeight own_height) {
  turned.parts = {read_named_part(table, "part", level, own_height)};
}
void read_parts_of(TomlTable& table, MaskedPattern& masked, int level, OwnHeight) {
  masked.parts = {read_named_part(table, "inside", level, OwnHeight::Counts),
                  read_named_part(table, "outside", level, OwnHeight::Counts),
                  read_named_part(table, "mask", level, OwnHeight::IsNothing)};
}
void read_parts_of(TomlTable& table, PatternRegions& regions, int level, OwnHeight) {
  try {
    read_label_image(table.file("labels"), regions);
  } catch (const FileError& error) {
    table.complain("labels", error.what());
  }
  std::vector<TomlTable> tables = table.tables("parts");
  for (TomlTable& part : tables) {
    const auto label = static_cast<int>(part.integer("label", 0, 255));
    regions.parts.push_back({read_part(part, level + 1, OwnHeight::Counts), label});
  }
  if (tables.empty()) table.complain("parts", "regions need parts, like parts = [{ label = 255, kind = \"noise\" }]");
}

void set_checked(TomlTable& table, Pattern& pattern, const PatternParameter& parameter, double value) {
  if (parameter.whole && value != std::round(value)) {
    table.complain(parameter.name, fmt::format("\"{}\" must be a whole number, not {:g}", parameter.name, value));
  }
  set_parameter(pattern, parameter.name, value);
}

// What is more than numbers: draws, singularities, parts.
void read_rest(TomlTable& table, Pattern& pattern, PatternUse use, int level, OwnHeight own_height) {
  read_randomness(table, pattern, use);
  if (auto* lines = std::get_if<LineIntegralConvolution>(&pattern)) read_singularities(table, *lines);
  std::visit([&](auto& kind) { read_parts_of(table, kind, level, own_height); }, pattern);
  try {
    require_valid(pattern);
  } catch (const InvalidInput& error) {
    table.complain("kind", error.what());
  }
  table.finish();
}

// A pattern within another: nothing of it is free.
Pattern read_part(TomlTable table, int level, OwnHeight own_height) {
  if (level > most_levels) {
    table.complain("kind", fmt::format("patterns stand within patterns more than {} levels deep", most_levels));
  }
  Pattern pattern = default_pattern(table.choice("kind", kinds(), "noise"));
  for (const auto& parameter : pattern_parameters(pattern)) {
    if (!table.has(parameter.name)) continue;
    if (parameter.name == "height_um" && own_height == OwnHeight::IsNothing) {
      table.complain("height_um",
                     "a factor or a mask counts by its shape alone, from 0 to 1, and has no \"height_um\"");
    }
    set_checked(table, pattern, parameter, table.number(parameter.name, {parameter.lowest, parameter.highest}));
  }
  read_rest(table, pattern, PatternUse::Synthesis, level, own_height);
  return pattern;
}

void read_grid(TomlTable table, PatternFile& file) {
  Grid& grid = file.grid;
  grid.columns = static_cast<std::size_t>(table.integer("columns", 2, 32768, 512));
  grid.rows = static_cast<std::size_t>(table.integer("rows", 2, 32768, 512));
  const Length pitch = Length::from_um(table.number("pitch_um", {1e-3, 1e5}, 2.0));
  grid.pitch_x = pitch;
  grid.pitch_y = pitch;
  if (table.boolean("periodic", false)) file.continuation = Continuation::Periodic;
  table.finish();
}

}  // namespace

PatternSpecification read_pattern(TomlTable table, bool table_is_there, PatternUse use) {
  if (!table_is_there) return default_specification();
  PatternSpecification result;
  if (!table.has("kind")) result.reason = default_specification().reason;
  result.pattern = default_pattern(table.choice("kind", kinds(), "noise"));
  if (use == PatternUse::Search && parts_of(result.pattern) != nullptr) {
    table.complain("kind",
                   fmt::format("a composed pattern (\"{}\") cannot be searched yet; search one of its parts, or "
                               "use mezzotint synthesize",
                               kind_name(result.pattern)));
  }
  for (const auto& parameter : pattern_parameters(result.pattern)) {
    if (!table.has(parameter.name)) continue;
    const NumberOrFree value = table.number_or_free(parameter.name, {parameter.lowest, parameter.highest});
    if (value.fixed) {
      set_checked(table, result.pattern, parameter, *value.fixed);
    } else if (parameter.whole) {
      table.complain(
          parameter.name,
          fmt::format("\"{}\" is a whole number, which a search cannot change; give it a value", parameter.name));
    } else {
      result.free.push_back({std::string(parameter.name), value.low, value.high, value.start});
    }
  }
  read_rest(table, result.pattern, use, 1, OwnHeight::Counts);
  return result;
}

PatternFile read_pattern_file(const std::filesystem::path& path, const std::vector<std::string>& settings) {
  const TomlFile file(path, settings);
  TomlTable root(file);
  if (!root.has("pattern")) root.complain("pattern", "a pattern file needs a [pattern] table");
  PatternSpecification specification = read_pattern(root.table("pattern"), true, PatternUse::Synthesis);
  if (!specification.free.empty()) {
    root.complain("pattern", "\"" + specification.free.front().name +
                                 "\" is free, but synthesize searches nothing; give it a value");
  }
  PatternFile result{specification.pattern, {}};
  read_grid(root.table("grid"), result);
  root.finish();
  return result;
}

}  // namespace mezzotint
