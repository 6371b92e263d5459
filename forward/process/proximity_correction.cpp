#include "forward/process/proximity_correction.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "forward/process/proximity_solver.h"
#include "forward/process/surrounding_pixel.h"

namespace mezzotint {

namespace {

// How far a tile looks beyond its own pixels at least: corrections of corrections die out with the blur.
constexpr std::size_t least_halo = 8;

struct Task {
  const HeightField& wanted;
  const PrinterProfile& profile;
  ProcessOptions process;
  CorrectionOptions options;
  std::size_t columns, rows;  // pixels
  std::size_t samples;        // of `wanted`, a pixel and axis
  float reachable_um;
};

struct Piece {
  std::size_t column, row, columns, rows;  // its own pixels
  std::size_t halo;                        // around them
  Surround surround;                       // beyond the halo
};

struct Sums {
  double before = 0.0, after = 0.0;  // squares
  std::size_t saturated = 0;
};

Task make_task(const HeightField& wanted, const PrinterProfile& profile, const ProcessOptions& process,
               const CorrectionOptions& options) {
  require_valid(profile);
  require(process.subsamples >= 1 && process.subsamples <= 16, "subsamples must be within 1 and 16");
  require(options.tolerance > Length{}, "the tolerance of a corrected pixel must be positive");
  require(options.tile_pixels >= 16, "a tile of a proximity correction needs 16 pixels a side");
  const double ratio = profile.pixel_pitch / wanted.grid().pitch_x;
  const auto n = static_cast<std::size_t>(std::max(1L, std::lround(ratio)));
  const bool fits = std::abs(ratio - static_cast<double>(n)) < 1e-6 * ratio &&
                    std::abs(wanted.grid().pitch_y / wanted.grid().pitch_x - 1.0) < 1e-6 &&
                    (n == 1 || n == process.subsamples) && wanted.columns() % n == 0 && wanted.rows() % n == 0;
  require(fits, "a proximity correction needs one wanted height a pixel, or as many as the process has samples (" +
                    std::to_string(process.subsamples) + " a pixel and axis)");
  require(wanted.missing_count() == 0, "a proximity correction needs every height; fill the missing samples first");
  return {wanted,
          profile,
          process,
          options,
          wanted.columns() / n,
          wanted.rows() / n,
          n,
          static_cast<float>(reachable_height(profile).um())};
}

std::vector<Piece> pieces_of(const Task& task) {
  const bool far = task.profile.spread.kernel == PixelSpread::Kernel::Lorentzian;
  const std::size_t side = task.options.tile_pixels;
  // What four tiles hold is solved at once.
  if (far || task.columns * task.rows <= 4 * side * side)
    return {{0, 0, task.columns, task.rows, 0, task.process.surround}};
  const double sigma = task.profile.spread.width / task.profile.pixel_pitch;
  const std::size_t halo = least_halo + static_cast<std::size_t>(std::ceil(16.0 * sigma));
  std::vector<Piece> pieces;
  for (std::size_t row = 0; row < task.rows; row += side) {
    for (std::size_t column = 0; column < task.columns; column += side)
      pieces.push_back({column, row, std::min(side, task.columns - column), std::min(side, task.rows - row), halo,
                        Surround::Mirror});
  }
  return pieces;
}

// A tile's wanted heights, with what lies beyond the picture's edges.
ProximityTile tile_of(const Task& task, const Piece& piece) {
  const std::size_t n = task.samples;
  ProximityTile tile{piece.columns + 2 * piece.halo, piece.rows + 2 * piece.halo, {}, {}};
  tile.wanted_um.assign(tile.columns * tile.rows * n * n, 0.0F);
  if (piece.halo > 0 && task.process.surround == Surround::Dark) tile.dark.assign(tile.columns * tile.rows, 0);
  const auto source = [&](std::size_t index, std::size_t start, std::size_t count, std::size_t scale) {
    const auto at = static_cast<std::int64_t>(index + start * scale) - static_cast<std::int64_t>(piece.halo * scale);
    return pixel_at(at, count * scale, task.process.surround);
  };
  for (std::size_t r = 0; r < tile.rows * n; ++r) {
    const auto row = source(r, piece.row, task.rows, n);
    for (std::size_t c = 0; c < tile.columns * n; ++c) {
      const auto column = source(c, piece.column, task.columns, n);
      if (row && column)
        tile.wanted_um[r * tile.columns * n + c] = std::clamp(task.wanted.at(*column, *row), 0.0F, task.reachable_um);
      else
        tile.dark[r / n * tile.columns + c / n] = 1;
    }
  }
  return tile;
}

bool uniform(const ProximityTile& tile) {
  const auto same = [&](float height) { return height == tile.wanted_um.front(); };
  const bool lit = std::ranges::none_of(tile.dark, [](std::uint8_t dark) { return dark != 0; });
  return lit && std::ranges::all_of(tile.wanted_um, same);
}

// Whether a bound stands in the way of a pixel or of one of its neighbours.
Unreached reason(const GrayImage& image, std::size_t column, std::size_t row, double error) {
  for (std::size_t r = row - std::min<std::size_t>(row, 1); r <= std::min(row + 1, image.rows - 1); ++r) {
    for (std::size_t c = column - std::min<std::size_t>(column, 1); c <= std::min(column + 1, image.columns - 1); ++c) {
      if (error < 0.0 && image.at(c, r) >= 1.0F) return Unreached::NeedsMoreLight;
      if (error > 0.0 && image.at(c, r) <= 0.0F) return Unreached::TooMuchLight;
    }
  }
  return Unreached::FinerThanBlur;
}

struct PixelError {
  double mean = 0.0, squares = 0.0;
};
PixelError pixel_error(const std::vector<float>& errors, std::size_t width, std::size_t n, std::size_t column,
                       std::size_t row) {
  PixelError sum;
  for (std::size_t r = row * n; r < (row + 1) * n; ++r) {
    for (std::size_t c = column * n; c < (column + 1) * n; ++c) {
      const double error = static_cast<double>(errors[r * width + c]);
      sum.mean += error;
      sum.squares += error * error;
    }
  }
  return {sum.mean / static_cast<double>(n * n), sum.squares / static_cast<double>(n * n)};
}

// Solves a piece and writes its pixels into the result.
Sums correct_piece(const Task& task, const Piece& piece, ProximityCorrection& into) {
  const ProximityTile tile = tile_of(task, piece);
  ProcessOptions process = task.process;
  process.surround = piece.surround;
  const GrayImage plain = exposed(tile, task.profile);
  const bool idle = uniform(tile);
  const GrayImage image =
      quantize(idle ? plain : solve_proximity(tile, task.profile, process, task.options.steps), task.profile);
  const std::vector<float> before = relief_errors(tile, quantize(plain, task.profile), task.profile, process);
  const std::vector<float> after = idle ? before : relief_errors(tile, image, task.profile, process);
  const std::size_t n = process.subsamples, width = tile.columns * n;
  Sums sums;
  for (std::size_t row = 0; row < piece.rows; ++row) {
    for (std::size_t column = 0; column < piece.columns; ++column) {
      const std::size_t c = column + piece.halo, r = row + piece.halo;
      const std::size_t to = (piece.row + row) * task.columns + piece.column + column;
      const PixelError error = pixel_error(after, width, n, c, r);
      sums.before += pixel_error(before, width, n, c, r).squares;
      sums.after += error.squares;
      const double residual = std::copysign(std::sqrt(error.squares), error.mean);
      into.image.values[to] = image.at(c, r);
      into.residual_um[to] = static_cast<float>(residual);
      if (std::abs(residual) > task.options.tolerance.um()) into.unreached[to] = reason(image, c, r, residual);
    }
  }
  return sums;
}

std::size_t saturated_samples(const Task& task) {
  // Float heights carry 1e-6 µm of rounding.
  const float most = task.reachable_um + 1e-5F;
  return static_cast<std::size_t>(
      std::ranges::count_if(task.wanted.heights_um(), [most](float h) { return h > most; }));
}

}  // namespace

std::array<std::size_t, 4> ProximityCorrection::counts() const {
  std::array<std::size_t, 4> counts{};
  for (const Unreached why : unreached) ++counts[static_cast<std::size_t>(why)];
  return counts;
}

ProximityCorrection correct_proximity(const HeightField& wanted, const PrinterProfile& profile,
                                      const ProcessOptions& process, const CorrectionOptions& options) {
  const Task task = make_task(wanted, profile, process, options);
  const std::size_t pixels = task.columns * task.rows;
  ProximityCorrection correction;
  correction.image = {task.columns, task.rows, std::vector<float>(pixels)};
  correction.residual_um.resize(pixels);
  correction.unreached.resize(pixels, Unreached::None);
  correction.saturated = saturated_samples(task);
  const std::vector<Piece> pieces = pieces_of(task);
  std::vector<Sums> sums(pieces.size());
  tbb::parallel_for(std::size_t{0}, pieces.size(),
                    [&](std::size_t i) { sums[i] = correct_piece(task, pieces[i], correction); });
  Sums whole;
  for (const Sums& sum : sums) {
    whole.before += sum.before;
    whole.after += sum.after;
  }
  const auto count = static_cast<double>(pixels);
  correction.error_before = Length::from_um(std::sqrt(whole.before / count));
  correction.error_after = Length::from_um(std::sqrt(whole.after / count));
  return correction;
}

}  // namespace mezzotint
