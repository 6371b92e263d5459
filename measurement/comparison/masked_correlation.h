#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace mezzotint {

/// Heights on a grid, 0 where they are not known, and which are known (1 or 0).
struct MaskedImage {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<double> values;
  std::vector<double> seen;
};

/// The correlation of two images for every displacement.
/// Shape    rows × columns; displacements 0, 1, … below the fixed image's size come first, negative ones stand at
///          the end, as a Fourier transform leaves them.
struct CorrelationMap {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::size_t positive_columns = 0;
  std::size_t positive_rows = 0;
  std::vector<double> correlation;  ///< −1…1 over the samples that both know; 0 where `overlap` is too small
  std::vector<double> overlap;      ///< how many samples both know

  [[nodiscard]] std::ptrdiff_t displacement_x(std::size_t index) const {
    const auto column = static_cast<std::ptrdiff_t>(index % columns);
    return index % columns < positive_columns ? column : column - static_cast<std::ptrdiff_t>(columns);
  }
  [[nodiscard]] std::ptrdiff_t displacement_y(std::size_t index) const {
    const auto row = static_cast<std::ptrdiff_t>(index / columns);
    return index / columns < positive_rows ? row : row - static_cast<std::ptrdiff_t>(rows);
  }
};

/// Normalised correlation of images with missing samples: for each displacement k, Pearson's r of f(n) and g(n + k)
/// over the n where both are known.
/// Source   Padfield 2012, equations 19–25.
class MaskedCorrelation {
public:
  /// @param fixed    g. Values of order 1 about 0: sums of squares are subtracted from each other.
  /// @param columns, rows  of any f to come, at most.
  MaskedCorrelation(const MaskedImage& fixed, std::size_t columns, std::size_t rows);

  /// May be called from several threads at once.
  /// @param least_overlap  samples that both must know; at least 3.
  [[nodiscard]] CorrelationMap with(const MaskedImage& moving, double least_overlap) const;

private:
  using Spectrum = std::vector<std::complex<double>>;
  std::size_t columns_;
  std::size_t rows_;
  std::size_t fixed_columns_;
  std::size_t fixed_rows_;
  Spectrum seen_;
  Spectrum values_;
  Spectrum squares_;
};

}  // namespace mezzotint
