#include "inverse/verification/printed_draw.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "forward/base/random.h"

namespace mezzotint {

namespace {

// Places in a sub-pixel are numbered; a free-form search counts its epochs from 0.
constexpr std::uint64_t verification_place = std::uint64_t{1} << 40;

// Samples over which a ground is faded to close a tile of so many.
std::size_t fade_length(std::size_t samples, Length pitch, const std::vector<GroundOctave>& octaves) {
  Length coarsest;
  for (const GroundOctave& octave : octaves) coarsest = std::max(coarsest, octave.scale);
  const double wanted = std::ceil(4.0 * (coarsest / pitch));
  return std::min(samples / 2, static_cast<std::size_t>(std::min(wanted, 1e9)));
}

// Weights of what lies behind the start and beyond the end; squares sum to 1, and nothing has a kink.
struct Fade {
  float start, end;
};
Fade fade_at(std::size_t sample, std::size_t length) {
  const double t = (static_cast<double>(sample) + 0.5) / static_cast<double>(length);
  const double angle = 0.5 * std::numbers::pi * t * t * (3.0 - 2.0 * t);
  return {static_cast<float>(std::sin(angle)), static_cast<float>(std::cos(angle))};
}

// The first `grid` of a ground that reaches further, with its ends made to meet.
void add_closed(HeightField& relief, HeightField& ground, std::size_t fade_x, std::size_t fade_y) {
  const std::size_t columns = relief.columns(), rows = relief.rows();
  for (std::size_t row = 0; row < rows + fade_y; ++row) {
    for (std::size_t column = 0; column < fade_x; ++column) {
      const Fade fade = fade_at(column, fade_x);
      ground.at(column, row) = fade.start * ground.at(column, row) + fade.end * ground.at(column + columns, row);
    }
  }
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      float z = ground.at(column, row);
      if (row < fade_y) {
        const Fade fade = fade_at(row, fade_y);
        z = fade.start * z + fade.end * ground.at(column, row + rows);
      }
      relief.at(column, row) += z;
    }
  }
}

}  // namespace

HeightField print_draw(const GrayImage& image, const PrinterProfile& printer, const DrawOptions& options,
                       std::uint64_t seed) {
  const auto place = RandomStream(seed, RandomPurpose::SamplePlace).uniform4(verification_place);
  HeightField relief =
      print_layer(quantize(image, printer), printer, {options.subsamples, options.surround, place[0], place[1]});
  const std::vector<GroundOctave> octaves = split_ground(printer, options.wavelength).geometric;
  if (!relief.periodic()) {
    add_ground(relief, printer, octaves, seed);
    return relief;
  }
  Grid grid = relief.grid();
  const std::size_t fade_x = fade_length(grid.columns, grid.pitch_x, octaves);
  const std::size_t fade_y = fade_length(grid.rows, grid.pitch_y, octaves);
  grid.columns += fade_x;
  grid.rows += fade_y;
  HeightField ground(grid, Continuation::Mirrored);
  add_ground(ground, printer, octaves, seed);
  add_closed(relief, ground, fade_x, fade_y);
  return relief;
}

}  // namespace mezzotint
