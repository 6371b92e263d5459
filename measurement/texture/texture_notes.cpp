#include "measurement/texture/texture_notes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "measurement/texture/blocks.h"

namespace mezzotint {

namespace {

// Holes that have nothing to do with slopes: 0.9 to 1.1 where 0.3 % are missing, 0.97 to 1 where 3 % and more are.
constexpr double steeper_beside_few = 1.25, steeper = 1.1, many_missing = 0.01, fewest_cells = 100.0;
constexpr double gentler = 0.9;
constexpr double widest_block_share = 0.25;

// Mean over the blocks that have samples of their range.
double mean_block_range_um(const HeightField& field) {
  std::array<double, block_count> lowest{}, highest{};
  lowest.fill(HUGE_VAL);
  highest.fill(-HUGE_VAL);
  for_each_in_blocks(field, [&](std::size_t block, double z) {
    lowest[block] = std::min(lowest[block], z);
    highest[block] = std::max(highest[block], z);
  });
  double sum = 0.0, count = 0.0;
  for (std::size_t block = 0; block < block_count; ++block) {
    if (highest[block] < lowest[block]) continue;
    sum += highest[block] - lowest[block];
    count += 1.0;
  }
  return sum / count;
}

std::string extreme_note(const HeightField& field, const AreaRoughness& roughness) {
  if (roughness.Sz.value == 0.0) return "";
  return fmt::format(
      "Sz is an extreme value, and grows with the area: {:.4g} um here, {:.4g} um on average over a sixteenth of it",
      roughness.Sz.value, mean_block_range_um(field));
}

HeightField every_second(const HeightField& field) {
  const Grid& grid = field.grid();
  HeightField result({(grid.columns + 1) / 2, (grid.rows + 1) / 2, grid.pitch_x * 2.0, grid.pitch_y * 2.0},
                     Continuation::Mirrored);
  for (std::size_t row = 0; row < result.rows(); ++row)
    for (std::size_t column = 0; column < result.columns(); ++column)
      result.at(column, row) = field.at(2 * column, 2 * row);
  return result;
}

/// Mean square gradients of whole cells, next to missing samples and elsewhere.
struct SlopesBesideHoles {
  double beside = 0.0, cells_beside = 0.0, elsewhere = 0.0, cells_elsewhere = 0.0;

  void add(double square, bool next_to_hole) {
    (next_to_hole ? beside : elsewhere) += square;
    (next_to_hole ? cells_beside : cells_elsewhere) += 1.0;
  }
  [[nodiscard]] double ratio() const {
    const bool enough = cells_beside >= fewest_cells && elsewhere > 0.0;
    return enough ? std::sqrt(beside / cells_beside / (elsewhere / cells_elsewhere)) : 1.0;
  }
};

double square_gradient(const HeightField& field, std::size_t column, std::size_t row) {
  const double z = double{field.at(column, row)};
  const double dx = (double{field.at(column + 1, row)} - z) / field.grid().pitch_x.um();
  const double dy = (double{field.at(column, row + 1)} - z) / field.grid().pitch_y.um();
  return dx * dx + dy * dy;
}

// Whether a sample is missing within two samples of one.
bool is_near_a_hole(const HeightField& field, std::size_t column, std::size_t row) {
  const std::size_t last_row = std::min(row + 2, field.rows() - 1), last = std::min(column + 2, field.columns() - 1);
  for (std::size_t r = row < 2 ? 0 : row - 2; r <= last_row; ++r)
    for (std::size_t c = column < 2 ? 0 : column - 2; c <= last; ++c)
      if (std::isnan(field.at(c, r))) return true;
  return false;
}

std::string missing_note(double share) {
  constexpr double much = 0.25;
  if (share < much) return "";
  return fmt::format(
      "{:.3g} % of the samples are missing: what was found is of those that were seen, and nothing tells whether the "
      "others are alike",
      100.0 * share);
}

std::string survivor_note(const HeightField& field, const AreaRoughness& roughness) {
  if (roughness.missing == 0) return "";
  SlopesBesideHoles slopes;
  for (std::size_t row = 0; row + 1 < field.rows(); ++row)
    for (std::size_t column = 0; column + 1 < field.columns(); ++column) {
      const double square = square_gradient(field, column, row);
      if (!std::isnan(square)) slopes.add(square, is_near_a_hole(field, column, row));
    }
  const double share = static_cast<double>(roughness.missing) / static_cast<double>(field.grid().size());
  if (slopes.ratio() < (share < many_missing ? steeper_beside_few : steeper)) return missing_note(share);
  return fmt::format(
      "beside missing samples ({:.3g} %) the surface is {:.3g} times as steep as elsewhere: what is missing is steep, "
      "and Sdq and Sdr of what was seen are too small",
      100.0 * share, slopes.ratio());
}

std::string resolution_note(const HeightField& field, const AreaRoughness& roughness) {
  if (field.columns() < 4 || field.rows() < 4 || roughness.missing > field.grid().size() / 4) return "";
  const double coarse = area_roughness(every_second(field)).Sdq.value;
  if (!(coarse < gentler * roughness.Sdq.value)) return "";
  return fmt::format(
      "Sdq is {:.3g}, and would be {:.3g} at twice the spacing: it grows as finer structure is resolved. State the "
      "bandwidth with it, or set it (--s-filter)",
      roughness.Sdq.value, coarse);
}

std::string block_note(const HeightField& field, const SpatialParameters& spatial) {
  const Grid& grid = field.grid();
  const double side = std::min(static_cast<double>(grid.columns) * grid.pitch_x.um(),
                               static_cast<double>(grid.rows) * grid.pitch_y.um()) /
                      static_cast<double>(blocks_a_side);
  if (!(spatial.Sal.value > widest_block_share * side)) return "";
  return fmt::format(
      "the field is {:.2g} correlation lengths wide (Sal {:.3g} um): Sq, Sal and Str of so few come out too small on "
      "average, and standard errors too, since the blocks that they come from are not independent. Measure a field "
      "{:.2g} times as wide",
      static_cast<double>(blocks_a_side) * side / spatial.Sal.value, spatial.Sal.value,
      spatial.Sal.value / (widest_block_share * side));
}

// Differences between neighbours along rows; of 64 rows at most.
std::vector<float> steps_between_neighbours(const HeightField& field) {
  constexpr std::size_t rows_looked_at = 64;
  std::vector<float> steps;
  for (std::size_t row = 0; row < field.rows(); row += std::max<std::size_t>(1, field.rows() / rows_looked_at))
    for (std::size_t column = 0; column + 1 < field.columns(); ++column) {
      const float step = std::abs(field.at(column + 1, row) - field.at(column, row));
      if (!std::isnan(step)) steps.push_back(step);
    }
  return steps;
}

// The step that most differences are a few whole ones of; 0 where there is none.
double height_step_um(const HeightField& field) {
  constexpr double few = 20.0, off = 0.1, most = 0.5, nearly_all = 0.95;
  const std::vector<float> steps = steps_between_neighbours(field);
  float smallest = std::numeric_limits<float>::infinity();
  for (const float step : steps)
    if (step > 0.0F) smallest = std::min(smallest, step);
  double small = 0.0, whole = 0.0;
  for (const float step : steps) {
    const double times = double{step} / double{smallest};
    if (times > few) continue;
    small += 1.0;
    whole += std::abs(times - std::round(times)) < off ? 1.0 : 0.0;
  }
  const bool in_steps = small > most * static_cast<double>(steps.size()) && whole > nearly_all * small;
  return in_steps ? double{smallest} : 0.0;
}

}  // namespace

std::vector<std::string> texture_notes(const HeightField& field, const AreaRoughness& roughness,
                                       const SpatialParameters* spatial) {
  std::vector<std::string> notes;
  const auto add = [&](std::string&& note) {
    if (!note.empty()) notes.push_back(std::move(note));
  };
  add(extreme_note(field, roughness));
  add(resolution_note(field, roughness));
  add(survivor_note(field, roughness));
  if (spatial != nullptr) add(block_note(field, *spatial));
  return notes;
}

std::string height_step_note(const HeightField& as_read, const AreaRoughness& roughness) {
  constexpr double noticeable = 0.1;
  const double step = height_step_um(as_read);
  // Rounding to a step is noise of a variance of step²/12; a difference of two has twice that, along either axis.
  const Grid& grid = as_read.grid();
  const double slope = step / std::sqrt(6.0) * std::hypot(1.0 / grid.pitch_x.um(), 1.0 / grid.pitch_y.um());
  if (step == 0.0 || slope < noticeable * roughness.Sdq.value) return "";
  return fmt::format(
      "heights come in steps of {:.3g} nm, as single precision has them far from zero; rounding alone makes a Sdq of "
      "{:.2g} ({:.2g} was found). Take the offset out before heights are stored, or filter (--s-filter)",
      1e3 * step, slope, roughness.Sdq.value);
}

}  // namespace mezzotint
