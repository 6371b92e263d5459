#include "fabrication/slicing/area_rows.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace mezzotint {

namespace {

// What rounding leaves where there is nothing, or where all is full; an eighth bit is 200 times as much.
constexpr double rounding = 2e-5;
// A row whose faces do not close by this much of a pixel has a hole.
constexpr double open_row = 1e-3;

float clean_coverage(double sum) {
  if (sum < rounding) return 0.0F;
  if (sum > 1.0 - rounding) return 1.0F;
  return static_cast<float>(sum);
}

void append(std::vector<CoverageRun>& runs, std::size_t begin, std::size_t end, double sum) {
  const float coverage = clean_coverage(sum);
  if (coverage == 0.0F || begin >= end) return;
  const auto first = static_cast<std::uint32_t>(begin), last = static_cast<std::uint32_t>(end);
  if (!runs.empty() && runs.back().end == first && runs.back().coverage == coverage) {
    runs.back().end = last;
  } else {
    runs.push_back({first, last, coverage});
  }
}

}  // namespace

AreaRows::AreaRows(std::size_t columns, std::size_t rows)
    : columns_(columns),
      rows_(rows),
      stride_(columns + 2),  // beyond the last column: what lies right of the picture, and its next
      words_((columns + 2 + 63) / 64),
      cells_(stride_ * rows, 0.0F),
      touched_(words_ * rows, 0),
      row_touched_(rows, 0) {}

std::size_t AreaRows::finish(const TakeCoverageRow& take_row) {
  std::vector<CoverageRun> runs;
  std::size_t open = 0;
  for (std::size_t row = 0; row < rows_; ++row) {
    if (row_touched_[row] == 0) continue;
    row_touched_[row] = 0;
    runs.clear();
    open += finish_row(row, runs) ? 0 : 1;
    if (!runs.empty()) take_row(row, runs);
  }
  return open;
}

// Only what was touched is visited; between two touched pixels the coverage stays.
bool AreaRows::finish_row(std::size_t row, std::vector<CoverageRun>& runs) {
  float* const cells = cells_.data() + row * stride_;
  std::uint64_t* const touched = touched_.data() + row * words_;
  std::uint64_t carried = 0;
  std::size_t done = 0;
  double sum = 0.0;
  for (std::size_t word = 0; word < words_; ++word) {
    // A mark stands for its cell and the next one.
    std::uint64_t marks = touched[word] | touched[word] << 1U | carried;
    carried = touched[word] >> 63U;
    touched[word] = 0;
    while (marks != 0) {
      const std::size_t column = word * 64 + static_cast<std::size_t>(std::countr_zero(marks));
      marks &= marks - 1;
      append(runs, done, std::min(column, columns_), sum);
      sum += double{cells[column]};
      cells[column] = 0.0F;
      append(runs, column, std::min(column + 1, columns_), sum);
      done = column + 1;
    }
  }
  return std::abs(sum) < open_row;
}

}  // namespace mezzotint
