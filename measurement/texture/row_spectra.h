#pragma once

#include <algorithm>
#include <complex>
#include <cstddef>
#include <memory>
#include <span>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "forward/base/fft_line.h"

/// Inside of measurement/texture: a Fourier transform of a plane, in two steps that take the cache into account. First
/// that of each row; then of the columns, four at a time.

namespace mezzotint {

class RowSpectra {
public:
  using Complex = std::complex<double>;

  /// fill(row, values): the values of a row; those behind its samples are 0 beforehand.
  /// @param length  of the transform along a row
  template <class Fill>
  RowSpectra(std::size_t rows, std::size_t length, const Fill& fill)
      : rows_(rows), columns_(length / 2 + 1), values_(new Complex[rows * columns_]) {
    tbb::enumerable_thread_specific<RealFftLine> lines(length);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows), [&](const auto& some) {
      RealFftLine& line = lines.local();
      std::ranges::fill(line.real(), 0.0);
      for (std::size_t row = some.begin(); row < some.end(); ++row) {
        fill(row, line.real());
        line.forward();
        std::ranges::copy(line.spectrum(), this->row(row).begin());
      }
    });
  }

  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] std::span<Complex> row(std::size_t row) { return {values_.get() + row * columns_, columns_}; }

  /// visit(first column, columns): transforms of up to four columns beside each other, of `length` each, which may be
  /// more than the rows; the visitor may change them, and gives back how many of each go into their place again.
  template <class Visit>
  void for_each_four_columns(std::size_t length, const Visit& visit) {
    const std::size_t blocks = (columns_ + most - 1) / most;
    tbb::enumerable_thread_specific<Columns> workspaces([length] { return Columns(length); });
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks), [&](const auto& some) {
      Columns& work = workspaces.local();
      for (std::size_t block = some.begin(); block < some.end(); ++block) {
        const std::size_t first = block * most, count = std::min(most, columns_ - first);
        gather(first, count, work);
        for (std::size_t k = 0; k < count; ++k) work.line[k].forward();
        const std::size_t back = visit(first, std::span(work.line).first(count), work.power);
        for (std::size_t row = 0; row < back; ++row)
          for (std::size_t k = 0; k < count; ++k) values_[row * columns_ + first + k] = work.line[k].values()[row];
      }
    });
  }

private:
  static constexpr std::size_t most = 4;  // a cache line of complex values

  struct Columns {
    explicit Columns(std::size_t length)
        : line{ComplexFftLine(length), ComplexFftLine(length), ComplexFftLine(length), ComplexFftLine(length)},
          power(length) {}
    ComplexFftLine line[most];
    RealFftLine power;
  };

  void gather(std::size_t first, std::size_t count, Columns& work) {
    for (std::size_t row = 0; row < rows_; ++row)
      for (std::size_t k = 0; k < count; ++k) work.line[k].values()[row] = values_[row * columns_ + first + k];
    for (std::size_t k = 0; k < count; ++k) std::ranges::fill(work.line[k].values().subspan(rows_), 0.0);
  }

  std::size_t rows_, columns_;
  std::unique_ptr<Complex[]> values_;
};

}  // namespace mezzotint
