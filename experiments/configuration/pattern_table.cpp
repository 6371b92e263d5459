#include "experiments/configuration/pattern_table.h"

#include <fmt/format.h>

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

void read_randomness(TomlTable& table, Noise& noise, PatternUse use) {
  if (use == PatternUse::Search && table.has("seed")) {
    table.complain("seed", "a search draws its patterns anew; its seed is that of [search]");
  }
  noise.seed = static_cast<std::uint64_t>(table.integer("seed", 0, INT64_MAX, std::int64_t(noise.seed)));
  noise.hash =
      table.choice("hash", {"integer", "slides"}, "integer") == "slides" ? CellHash::Slides : CellHash::Integer;
}

Grid read_grid(TomlTable table) {
  Grid grid;
  grid.columns = static_cast<std::size_t>(table.integer("columns", 2, 32768, 512));
  grid.rows = static_cast<std::size_t>(table.integer("rows", 2, 32768, 512));
  const Length pitch = Length::from_um(table.number("pitch_um", {1e-3, 1e5}, 2.0));
  grid.pitch_x = pitch;
  grid.pitch_y = pitch;
  table.finish();
  return grid;
}

}  // namespace

PatternSpecification read_pattern(TomlTable table, bool table_is_there, PatternUse use) {
  if (!table_is_there) return default_specification();
  PatternSpecification result;
  if (!table.has("kind")) result.reason = default_specification().reason;
  result.pattern = default_pattern(table.choice("kind", kinds(), "noise"));
  for (const auto& parameter : pattern_parameters(result.pattern)) {
    if (!table.has(parameter.name)) continue;
    const NumberOrFree value = table.number_or_free(parameter.name, {parameter.lowest, parameter.highest});
    if (value.fixed) {
      set_parameter(result.pattern, parameter.name, *value.fixed);
    } else {
      result.free.push_back({std::string(parameter.name), value.low, value.high, value.start});
    }
  }
  if (auto* noise = std::get_if<Noise>(&result.pattern)) read_randomness(table, *noise, use);
  table.finish();
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
  PatternFile result{specification.pattern, read_grid(root.table("grid"))};
  root.finish();
  return result;
}

std::string pattern_file_text(const PatternFile& file, const std::string& comment) {
  std::string text = "# " + comment + "\n[pattern]\nkind = \"" + std::string(kind_name(file.pattern)) + "\"\n";
  for (const auto& parameter : pattern_parameters(file.pattern)) {
    // With a point, so that TOML reads a number and not an integer.
    text += fmt::format("{} = {:#.17g}\n", parameter.name, get_parameter(file.pattern, parameter.name));
  }
  if (const auto* noise = std::get_if<Noise>(&file.pattern)) {
    text +=
        fmt::format("seed = {}\nhash = \"{}\"\n", noise->seed, noise->hash == CellHash::Slides ? "slides" : "integer");
  }
  return text + fmt::format("\n[grid]\ncolumns = {}\nrows = {}\npitch_um = {:#.17g}\n", file.grid.columns,
                            file.grid.rows, file.grid.pitch_x.um());
}

}  // namespace mezzotint
