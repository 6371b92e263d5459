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

// Where a pattern stands: in what, and what of it may be free.
struct Place {
  PatternUse use;
  int level = 1;
  OwnHeight own_height = OwnHeight::Counts;
  std::string path;       // before the names of its numbers
  std::string_view kind;  // its own, once that is known
  std::vector<FreeParameter>* free;

  [[nodiscard]] Place below(std::size_t part, OwnHeight height) const {
    return {use, level + 1, height, path + part_name(kind, part) + ".", {}, free};
  }
};

Pattern read_part(TomlTable table, const Place& place);

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

using Parts = std::vector<PatternPart>;

void read_list(TomlTable& table, Parts& parts, const Place& place, OwnHeight own_height) {
  constexpr std::size_t least = 2;
  const std::vector<TomlTable> tables = table.tables("parts");
  if (tables.size() < least) {
    table.complain("parts",
                   fmt::format("this kind needs {} parts or more, like parts = [{{ kind = \"noise\" }}, {{ kind = "
                               "\"ridges\" }}]",
                               least));
  }
  for (const TomlTable& part : tables) parts.push_back({read_part(part, place.below(parts.size(), own_height))});
}

void read_named(TomlTable& table, Parts& parts, const Place& place, OwnHeight own_height) {
  const std::string key = part_name(place.kind, parts.size());
  if (!table.has(key))
    table.complain(key, fmt::format("\"{}\" is missing; it is a pattern, like {{ kind = \"noise\" }}", key));
  parts.push_back({read_part(table.table(key), place.below(parts.size(), own_height))});
}

template <typename Kind>
void read_parts_of(TomlTable&, Kind&, const Place&) {}
void read_parts_of(TomlTable& table, PatternSum& sum, const Place& place) {
  read_list(table, sum.parts, place, OwnHeight::Counts);
}
void read_parts_of(TomlTable& table, PatternProduct& product, const Place& place) {
  read_list(table, product.parts, place, OwnHeight::IsNothing);
}
void read_parts_of(TomlTable& table, TurnedPattern& turned, const Place& place) {
  read_named(table, turned.parts, place, place.own_height);
}
void read_parts_of(TomlTable& table, MaskedPattern& masked, const Place& place) {
  for (const OwnHeight height : {OwnHeight::Counts, OwnHeight::Counts, OwnHeight::IsNothing}) {
    read_named(table, masked.parts, place, height);
  }
}
void read_parts_of(TomlTable& table, PatternRegions& regions, const Place& place) {
  try {
    read_label_image(table.file("labels"), regions);
  } catch (const FileError& error) {
    table.complain("labels", error.what());
  }
  std::vector<TomlTable> tables = table.tables("parts");
  for (TomlTable& part : tables) {
    const auto label = static_cast<int>(part.integer("label", 0, 255));
    regions.parts.push_back({read_part(part, place.below(regions.parts.size(), OwnHeight::Counts)), label});
  }
  if (tables.empty()) table.complain("parts", "regions need parts, like parts = [{ label = 255, kind = \"noise\" }]");
}

void read_parameter(TomlTable& table, Pattern& pattern, const PatternParameter& parameter, const Place& place) {
  const std::string& name = parameter.name;
  if (name == "height_um" && place.own_height == OwnHeight::IsNothing) {
    table.complain(name, "a factor or a mask counts by its shape alone, from 0 to 1, and has no \"height_um\"");
  }
  if (place.use == PatternUse::Search && parameter.drawn) table.complain(name, why_fixed(parameter));
  const NumberOrFree value = table.number_or_free(name, {parameter.lowest, parameter.highest});
  if (value.fixed) {
    if (parameter.whole && *value.fixed != std::round(*value.fixed)) {
      table.complain(name, fmt::format("\"{}\" must be a whole number, not {:g}", name, *value.fixed));
    }
    set_parameter(pattern, name, *value.fixed);
  } else if (place.use == PatternUse::Synthesis) {
    table.complain(name, fmt::format("\"{}\" is free, but synthesize searches nothing; give it a value", name));
  } else if (const std::string why = why_fixed(parameter); !why.empty()) {
    table.complain(name, why);
  } else {
    place.free->push_back({place.path + name, value.low, value.high, value.start});
  }
}

// What is more than numbers: draws, singularities, parts.
void read_rest(TomlTable& table, Pattern& pattern, Place place) {
  place.kind = kind_name(pattern);
  read_randomness(table, pattern, place.use);
  if (auto* lines = std::get_if<LineIntegralConvolution>(&pattern)) read_singularities(table, *lines);
  std::visit([&](auto& kind) { read_parts_of(table, kind, place); }, pattern);
  try {
    require_valid(pattern);
  } catch (const InvalidInput& error) {
    table.complain("kind", error.what());
  }
  table.finish();
}

Pattern read_part(TomlTable table, const Place& place) {
  if (place.level > most_levels) {
    table.complain("kind", fmt::format("patterns stand within patterns more than {} levels deep", most_levels));
  }
  Pattern pattern = default_pattern(table.choice("kind", kinds(), "noise"));
  for (const auto& parameter : pattern_parameters(pattern)) {
    if (table.has(parameter.name)) read_parameter(table, pattern, parameter, place);
  }
  read_rest(table, pattern, place);
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

constexpr const char* free_form_kind = "free_form";

FreeFormOptions read_free_form(TomlTable& table) {
  FreeFormOptions options;
  options.pixels = static_cast<std::size_t>(table.integer("pixels", 16, 1024, std::int64_t(options.pixels)));
  options.evaluations = static_cast<int>(table.integer("evaluations", 8, 100'000, options.evaluations));
  options.start_evaluations =
      static_cast<int>(table.integer("start_evaluations", 1, 10'000, options.start_evaluations));
  options.traced_corrections = static_cast<int>(table.integer("traced_corrections", 0, 4, options.traced_corrections));
  options.algorithm = table.text("algorithm", options.algorithm);
  if (!options.algorithm.starts_with("LD_") || !is_known_algorithm(options.algorithm)) {
    table.complain("algorithm",
                   "a free form has thousands of unknowns and needs a local method with slopes, like "
                   "\"LD_MMA\" or \"LD_LBFGS\"; \"" +
                       options.algorithm + "\" is none");
  }
  return options;
}

}  // namespace

PatternSpecification read_pattern(TomlTable table, bool table_is_there, PatternUse use) {
  if (!table_is_there) return default_specification();
  PatternSpecification result;
  if (use == PatternUse::Search && table.has("kind") && table.text("kind") == free_form_kind) {
    result.free_form = read_free_form(table);
    table.finish();
    return result;
  }
  if (!table.has("kind")) result.reason = default_specification().reason;
  result.pattern = read_part(std::move(table), {.use = use, .free = &result.free});
  return result;
}

PatternFile read_pattern_file(const std::filesystem::path& path, const std::vector<std::string>& settings) {
  const TomlFile file(path, settings);
  TomlTable root(file);
  if (!root.has("pattern")) root.complain("pattern", "a pattern file needs a [pattern] table");
  PatternFile result{read_pattern(root.table("pattern"), true, PatternUse::Synthesis).pattern, {}};
  read_grid(root.table("grid"), result);
  root.finish();
  return result;
}

}  // namespace mezzotint
