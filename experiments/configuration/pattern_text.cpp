#include <fmt/format.h>

#include "experiments/configuration/pattern_table.h"
#include "forward/pattern/pattern_parameters.h"

namespace mezzotint {

namespace {

// "key = value" of what a pattern is, without its parts.
using Lines = std::vector<std::string>;

std::string number(double value) {
  // With a point, so that TOML reads a number and not an integer.
  return fmt::format("{:#.17g}", value);
}

std::string in_quotes(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

std::string joined(const Lines& lines, const char* between) { return fmt::format("{}", fmt::join(lines, between)); }

Lines lines_of(const Pattern& pattern, bool own_height);

std::string inline_table(const Pattern& pattern, bool own_height, const std::string& first = "") {
  return "{ " + first + joined(lines_of(pattern, own_height), ", ") + " }";
}

std::string singularities(const LineIntegralConvolution& lines) {
  Lines points;
  for (const Singularity& point : lines.singularities) {
    points.push_back(fmt::format("{{ x_um = {}, y_um = {}, index = {:.1f} }}", number(point.place.x.um()),
                                 number(point.place.y.um()), point.index));
  }
  return "singularities = [" + joined(points, ", ") + "]";
}

std::string list(const std::vector<PatternPart>& parts, bool own_height) {
  Lines tables;
  for (const PatternPart& part : parts) tables.push_back(inline_table(part.pattern, own_height));
  return "parts = [" + joined(tables, ", ") + "]";
}

template <typename Kind>
void add_parts(Lines&, const Kind&, bool) {}
void add_parts(Lines& lines, const PatternSum& sum, bool) { lines.push_back(list(sum.parts, true)); }
void add_parts(Lines& lines, const PatternProduct& product, bool) { lines.push_back(list(product.parts, false)); }
void add_parts(Lines& lines, const TurnedPattern& turned, bool own_height) {
  lines.push_back("part = " + inline_table(turned.parts[0].pattern, own_height));
}
void add_parts(Lines& lines, const MaskedPattern& masked, bool) {
  lines.push_back("inside = " + inline_table(masked.parts[0].pattern, true));
  lines.push_back("outside = " + inline_table(masked.parts[1].pattern, true));
  lines.push_back("mask = " + inline_table(masked.parts[2].pattern, false));
}
void add_parts(Lines& lines, const PatternRegions& regions, bool) {
  lines.push_back("labels = " + in_quotes(regions.source));
  Lines tables;
  for (const PatternPart& part : regions.parts) {
    tables.push_back(inline_table(part.pattern, true, fmt::format("label = {}, ", part.label)));
  }
  lines.push_back("parts = [" + joined(tables, ", ") + "]");
}

Lines lines_of(const Pattern& pattern, bool own_height) {
  Lines lines = {"kind = \"" + std::string(kind_name(pattern)) + "\""};
  for (const auto& parameter : pattern_parameters(pattern)) {
    if (parameter.name == "height_um" && !own_height) continue;
    const double value = get_parameter(pattern, parameter.name);
    lines.push_back(
        fmt::format("{} = {}", parameter.name, parameter.whole ? fmt::format("{:.0f}", value) : number(value)));
  }
  if (const auto random = randomness(pattern)) {
    lines.push_back(fmt::format("seed = {}", random->seed));
    lines.push_back(fmt::format("hash = \"{}\"", random->hash == CellHash::Slides ? "slides" : "integer"));
  }
  const auto* field = std::get_if<LineIntegralConvolution>(&pattern);
  if (field != nullptr && !field->singularities.empty()) lines.push_back(singularities(*field));
  std::visit([&](const auto& kind) { add_parts(lines, kind, own_height); }, pattern);
  return lines;
}

}  // namespace

std::string pattern_file_text(const PatternFile& file, const std::string& comment) {
  std::string text = "# " + comment + "\n[pattern]\n" + joined(lines_of(file.pattern, true), "\n");
  text += fmt::format("\n\n[grid]\ncolumns = {}\nrows = {}\npitch_um = {}\n", file.grid.columns, file.grid.rows,
                      number(file.grid.pitch_x.um()));
  if (file.continuation == Continuation::Periodic) text += "periodic = true\n";
  return text;
}

}  // namespace mezzotint
