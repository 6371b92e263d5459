#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/height_assembly.h"
#include "measurement/formats/plain_parsers.h"
#include "measurement/formats/text_scanner.h"

namespace mezzotint {

namespace {

struct Table {
  std::uint64_t columns = 0, rows = 0;
  std::vector<double> values;
};

std::string_view without_blanks(std::string_view line) {
  const std::size_t begin = line.find_first_not_of(' ');
  return begin == std::string_view::npos ? std::string_view{}
                                         : line.substr(begin, line.find_last_not_of(' ') + 1 - begin);
}

bool is_comment(std::string_view line) { return line.empty() || line.front() == '#' || line.front() == '%'; }

std::uint64_t take_row(std::string_view line, char separator, const TextScanner& scanner, std::vector<double>& values) {
  std::uint64_t cells = 0;
  const bool open_end = separator != ' ' && line.back() == separator;  // an empty cell, or just an end?
  while (!line.empty()) {
    values.push_back(height_of_cell(take_cell(line, separator), scanner));
    ++cells;
  }
  if (open_end) {
    values.push_back(height_of_cell("", scanner));
    ++cells;
  }
  return cells;
}

// A separator behind the last number of every line closes the line; it begins no further column.
void drop_closing_separators(Table& table) {
  for (std::size_t row = 0; row < table.rows; ++row) {
    for (std::size_t column = 0; column + 1 < table.columns; ++column) {
      table.values[row * (table.columns - 1) + column] = table.values[row * table.columns + column];
    }
  }
  --table.columns;
  table.values.resize(table.rows * table.columns);
}

Table take_table(TextScanner& scanner) {
  Table table;
  char separator = ' ';
  bool every_line_is_closed = true;
  while (!scanner.at_end()) {
    const std::string_view line = without_blanks(scanner.take_line());
    if (is_comment(line)) continue;
    if (table.rows == 0) separator = separator_of(line);
    every_line_is_closed = every_line_is_closed && separator != ' ' && line.back() == separator;
    const std::uint64_t cells = take_row(line, separator, scanner, table.values);
    if (table.rows == 0) table.columns = cells;
    if (cells != table.columns) {
      scanner.fail(fmt::format("has {} numbers; the lines before have {}", cells, table.columns));
    }
    ++table.rows;
  }
  if (table.rows == 0) scanner.fail("holds no numbers");
  if (every_line_is_closed && table.columns > 1) drop_closing_separators(table);
  return table;
}

}  // namespace

SurfaceFile parse_csv(const std::filesystem::path& path, std::span<const std::byte> bytes, const Sidecar& sidecar) {
  TextScanner scanner(path, bytes);
  const Table table = take_table(scanner);
  const Grid grid = sidecar_grid(path, sidecar, table.columns, table.rows);
  const double scale_m = required_scale_um(path, sidecar.value_um, "value_um") * 1e-6;
  const double datum_m = sidecar.datum_um * 1e-6;
  const auto height_m = [&](std::size_t i) {
    const double value = table.values[i];
    return std::isfinite(value) ? value * scale_m + datum_m : std::numeric_limits<double>::quiet_NaN();
  };
  HeightField field =
      assemble_heights(path, "numbers", grid, sidecar.first_row_on_top ? FirstRow::Top : FirstRow::Bottom,
                       sidecar_continuation(sidecar), height_m);
  return {std::move(field), "csv", sidecar.title, sidecar.provenance, ""};
}

}  // namespace mezzotint
