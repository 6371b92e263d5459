#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "forward/base/units.h"

namespace mezzotint {

/// What lies beyond the ends of a patch of relief.
enum class Continuation {
  Periodic,  ///< the patch repeats; sample (columns, r) is sample (0, r) again
  Mirrored   ///< nothing is known there: mirrored copies stand in, and only shadow
};

/// Where the samples of a height field lie.
struct Grid {
  std::size_t columns = 0;
  std::size_t rows = 0;
  Length pitch_x;
  Length pitch_y;

  [[nodiscard]] std::size_t size() const { return columns * rows; }
  bool operator==(const Grid&) const = default;
};

/// Heights over the xy-plane on a regular grid: a patch of relief.
///
/// Frame    x along a row, y from row to row, z out of the material; sample (0, 0) at the origin.
/// Shape    rows × columns, row after row; sample (c, r) at (c·pitch_x, r·pitch_y).
/// Units    micrometres, in float: 24 bits resolve 1 nm over 16 mm. The offset of an absolute
///          measurement is subtracted in double before it is stored, and kept in `datum()`.
/// Missing  a sample that the instrument could not see is NaN, never 0.
/// Errors   InvalidInput for a grid without samples, with more than 2^30 of them, or with a pitch
///          that is not positive and finite; infinite heights are refused.
/// Source   Frisvad 2019, slide "Profilometry and data export".
class HeightField {
public:
  /// All heights zero.
  HeightField(const Grid& grid, Continuation continuation);
  HeightField(const Grid& grid, Continuation continuation, std::vector<float> heights_um, Length datum = Length{});

  [[nodiscard]] const Grid& grid() const { return grid_; }
  [[nodiscard]] std::size_t columns() const { return grid_.columns; }
  [[nodiscard]] std::size_t rows() const { return grid_.rows; }
  [[nodiscard]] Continuation continuation() const { return continuation_; }
  [[nodiscard]] bool periodic() const { return continuation_ == Continuation::Periodic; }

  /// Height of z = 0 in the frame of the instrument.
  [[nodiscard]] Length datum() const { return datum_; }
  /// Says anew what lies beyond the ends and where z = 0 stands; for who has changed the heights in place.
  void set_frame(Continuation continuation, Length datum) {
    continuation_ = continuation;
    datum_ = datum;
  }

  [[nodiscard]] float at(std::size_t column, std::size_t row) const {
    return heights_um_[row * grid_.columns + column];
  }
  float& at(std::size_t column, std::size_t row) { return heights_um_[row * grid_.columns + column]; }

  [[nodiscard]] std::span<const float> heights_um() const { return heights_um_; }
  [[nodiscard]] std::span<float> heights_um() { return heights_um_; }

  [[nodiscard]] std::size_t missing_count() const;

private:
  Grid grid_;
  Continuation continuation_;
  std::vector<float> heights_um_;
  Length datum_;
};

/// Checks a grid before anything is allocated for it (see HeightField).
/// @throws InvalidInput
void require_valid_grid(const Grid& grid);

/// Lowest and highest height; missing samples are left out.
/// @throws InvalidInput when no sample is left.
struct HeightRange {
  Length lowest;
  Length highest;
};
[[nodiscard]] HeightRange height_range(const HeightField& field);

/// Root-mean-square height about the mean: Sq of ISO 25178-2. Missing samples are left out.
/// @throws InvalidInput when no sample is left.
[[nodiscard]] Length root_mean_square_height(const HeightField& field);

/// The part of a field from sample (column, row) on; no longer periodic, unless it is the whole.
/// @throws InvalidInput when the part reaches outside of the field.
[[nodiscard]] HeightField crop(const HeightField& field, std::size_t column, std::size_t row, std::size_t columns,
                               std::size_t rows);

}  // namespace mezzotint
