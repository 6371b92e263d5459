#include "fabrication/calibration/wedge_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "fabrication/calibration/plateaus.h"
#include "fabrication/calibration/wedge_lattice.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::size_t most_steps = 64;

HeightField turned(const HeightField& field) {
  const Grid& grid = field.grid();
  HeightField out({grid.rows, grid.columns, grid.pitch_y, grid.pitch_x}, Continuation::Mirrored);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.columns; ++column) out.at(row, column) = field.at(column, row);
  }
  return out;
}

struct Rows {
  std::size_t begin, end;
};

// The part of a scan that holds the wedge, and where it begins.
struct WedgePart {
  HeightField field;
  std::size_t column = 0, row = 0;
  bool ends_before = false, ends_below = false;  ///< the scan goes on beyond its last column, last row
};

// Without what lies too deep to be base; then without rows and columns that were not half measured.
WedgePart wedge_part(const HeightField& scan, const Tilt& tilt, Length layer) {
  HeightField masked = scan;
  const auto level = [&](std::size_t column, std::size_t row) {
    return static_cast<double>(scan.at(column, row)) -
           tilt.slope_x * static_cast<double>(column) * scan.grid().pitch_x.um() -
           tilt.slope_y * static_cast<double>(row) * scan.grid().pitch_y.um();
  };
  std::vector<double> heights_um;
  for (std::size_t row = 0; row < scan.rows(); ++row) {
    for (std::size_t column = 0; column < scan.columns(); ++column) {
      if (!std::isnan(scan.at(column, row))) heights_um.push_back(level(column, row));
    }
  }
  // Not the highest of all: spikes are.
  const auto high = heights_um.begin() + static_cast<std::ptrdiff_t>(98 * heights_um.size() / 100);
  std::nth_element(heights_um.begin(), high, heights_um.end());
  const double deepest = *high - 1.25 * layer.um();
  std::vector<std::size_t> by_column(scan.columns(), 0), by_row(scan.rows(), 0);
  for (std::size_t row = 0; row < scan.rows(); ++row) {
    for (std::size_t column = 0; column < scan.columns(); ++column) {
      if (!(level(column, row) >= deepest)) {
        masked.at(column, row) = std::numeric_limits<float>::quiet_NaN();
        continue;
      }
      ++by_column[column];
      ++by_row[row];
    }
  }
  const auto range = [](const std::vector<std::size_t>& counts) {
    const std::size_t most = *std::max_element(counts.begin(), counts.end());
    const auto is_part = [most](std::size_t count) { return 2 * count > most; };
    const auto first = std::find_if(counts.begin(), counts.end(), is_part);
    const auto last = std::find_if(counts.rbegin(), counts.rend(), is_part).base();
    return Rows{static_cast<std::size_t>(first - counts.begin()), static_cast<std::size_t>(last - counts.begin())};
  };
  const Rows columns = range(by_column), rows = range(by_row);
  return {crop(masked, columns.begin, rows.begin, columns.end - columns.begin, rows.end - rows.begin), columns.begin,
          rows.begin, columns.end < scan.columns(), rows.end < scan.rows()};
}

bool lies_along_y(const HeightField& field, WedgeAxis along) {
  if (along != WedgeAxis::Longer) return along == WedgeAxis::Y;
  const Grid& grid = field.grid();
  return static_cast<double>(grid.rows) * grid.pitch_y.um() > static_cast<double>(grid.columns) * grid.pitch_x.um();
}

// Medians down some rows, levelled.
std::vector<double> median_profile(const HeightField& field, const Tilt& tilt, const Rows& rows) {
  std::vector<double> profile(field.columns(), std::numeric_limits<double>::quiet_NaN()), column_um;
  for (std::size_t column = 0; column < field.columns(); ++column) {
    column_um.clear();
    for (std::size_t row = rows.begin; row < rows.end; ++row) {
      const auto z = static_cast<double>(field.at(column, row));
      if (!std::isnan(z)) column_um.push_back(z - tilt.slope_y * static_cast<double>(row) * field.grid().pitch_y.um());
    }
    if (column_um.empty()) continue;
    const auto middle = column_um.begin() + static_cast<std::ptrdiff_t>(column_um.size() / 2);
    std::nth_element(column_um.begin(), middle, column_um.end());
    profile[column] = *middle - tilt.slope_x * static_cast<double>(column) * field.grid().pitch_x.um();
  }
  return profile;
}

// Which rows look like the profile, about the middle one: their share of it, by least squares.
std::vector<double> shares_of_rows(const HeightField& field, const Tilt& tilt, const std::vector<double>& profile) {
  std::vector<double> shares;
  for (std::size_t row = 0; row < field.rows(); ++row) {
    double count = 0.0, p = 0.0, z = 0.0, pp = 0.0, pz = 0.0;
    for (std::size_t column = 0; column < field.columns(); ++column) {
      const double height = static_cast<double>(field.at(column, row)) -
                            tilt.slope_x * static_cast<double>(column) * field.grid().pitch_x.um();
      if (std::isnan(height) || std::isnan(profile[column])) continue;
      count += 1.0;
      p += profile[column];
      z += height;
      pp += profile[column] * profile[column];
      pz += profile[column] * height;
    }
    const double spread = pp - p * p / std::max(1.0, count);
    shares.push_back(count > 1.0 && spread > 0.0 ? (pz - p * z / count) / spread : 1.0);
  }
  return shares;
}

// Rows of steps, and of frame beyond them (begin == end where there is none).
struct Across {
  Rows steps, below, above;
};

Across rows_of(const HeightField& field, const Tilt& tilt, const std::vector<double>& profile, std::size_t border) {
  const std::vector<double> shares = shares_of_rows(field, tilt, profile);
  std::size_t begin = field.rows() / 2, end = begin + 1;
  while (begin > 0 && shares[begin - 1] > 0.5) --begin;
  while (end < field.rows() && shares[end] > 0.5) ++end;
  Across across{{begin, end}, {0, 0}, {field.rows(), field.rows()}};
  if (begin > 0) {
    across.below.end = begin > border ? begin - border : 0;
    across.steps.begin = std::min(begin + border, end);
  }
  if (end < field.rows()) {
    across.above.begin = std::min(end + border, field.rows());
    across.steps.end = end > border ? std::max(end - border, across.steps.begin) : across.steps.begin;
  }
  return across;
}

std::size_t samples_of(Length length, Length pitch) {
  return static_cast<std::size_t>(std::ceil(length / pitch - 1e-9));
}

class Reader {
public:
  Reader(const HeightField& scan, const WedgeScanOptions& options)
      : options_(options),
        tilt_(rough_tilt(scan, std::max<std::size_t>(1, scan.columns() / (8 * options.grays.size())),
                         std::max<std::size_t>(1, scan.rows() / 8))),
        part_(wedge_part(scan, tilt_, options.layer)),
        field_(part_.field) {
    require(field_.rows() >= 8 && field_.columns() >= 8, "a wedge needs at least 8 × 8 samples");
  }

  // Lattice and tilt decide each other: twice is enough, since the first tilt leaves plateaus nearly flat.
  [[nodiscard]] WedgeScan read() {
    Rows middle{3 * field_.rows() / 10, std::max(3 * field_.rows() / 10 + 1, 7 * field_.rows() / 10)};
    for (int i = 0; i < 3; ++i) {
      profile_ = median_profile(field_, tilt_, middle);
      lattice_ = fit_lattice(WedgeProfile(profile_), options_.grays.size(), options_.grays);
      require_found();
      place_patches();
      levelled_ = level_plateaus(field_, patches_, options_.grays.size() + 1, tilt_);
      tilt_ = levelled_.tilt;
      middle = across_.steps;
    }
    require_count();
    return described();
  }

private:
  [[nodiscard]] Length pitch() const { return field_.grid().pitch_x; }
  [[nodiscard]] std::size_t base() const { return options_.grays.size(); }

  void require_found() const {
    require(std::isfinite(lattice_.cost),
            fmt::format("no {} steps side by side were found, each at least 6 samples wide and together a third of the "
                        "scan; crop the scan to the wedge and its frame",
                        options_.grays.size()));
  }

  [[nodiscard]] std::size_t border() const {
    const Length share = pitch() * (lattice_.width * options_.border_share);
    return samples_of(std::max(share, options_.least_border), pitch());
  }

  void add_patch(double from, double to, const Rows& rows, std::size_t plateau) {
    const double last = static_cast<double>(field_.columns());
    const auto begin = static_cast<std::size_t>(std::ceil(std::clamp(from, 0.0, last)));
    const auto end = static_cast<std::size_t>(std::floor(std::clamp(to, 0.0, last)));
    if (begin < end && rows.begin < rows.end) patches_.push_back({begin, end, rows.begin, rows.end, plateau});
  }

  // Steps inside of their borders; frame on both sides, and above and below; steps of gray 0 are base too.
  void place_patches() {
    const auto edge = static_cast<double>(border());
    const std::size_t edge_rows = samples_of(pitch() * edge, field_.grid().pitch_y);
    across_ = rows_of(field_, tilt_, profile_, edge_rows);
    if (part_.row > 0) across_.below.begin = std::min(edge_rows, across_.below.end);
    if (part_.ends_below) across_.above.end = std::max(across_.above.begin, field_.rows() - edge_rows);
    patches_.clear();
    const std::size_t count = options_.grays.size();
    for (std::size_t i = 0; i < count; ++i) {
      const double from = lattice_.first + static_cast<double>(i) * lattice_.width;
      const std::size_t told = lattice_.reversed ? count - 1 - i : i;
      const bool is_base = options_.grays[told] == 0.0;
      add_patch(from + edge, from + lattice_.width - edge, across_.steps, is_base ? base() : told);
    }
    const double end = lattice_.first + static_cast<double>(count) * lattice_.width;
    const auto last = static_cast<double>(field_.columns());
    // The outer edge of a frame is round too, where the platform is seen beyond it.
    const double left = part_.column > 0 ? edge : 0.0, right = part_.ends_before ? last - edge : last;
    add_patch(left, lattice_.first - edge, across_.steps, base());
    add_patch(end + edge, right, across_.steps, base());
    add_patch(left, right, across_.below, base());
    add_patch(left, right, across_.above, base());
  }

  // Another number of strips that leaves far less variance is the number of steps.
  void require_count() const {
    const std::size_t told = options_.grays.size();
    const WedgeProfile profile(profile_);
    const double noise = profile.length() * 1e-6;  // µm²: nothing is rougher than a nanometre to no purpose
    std::vector<double> costs;
    double least = std::numeric_limits<double>::infinity();
    const std::size_t most = std::min(told + 6, most_steps);
    for (std::size_t n = 2; n <= most; ++n) {
      costs.push_back(fit_lattice(profile, n, {}).cost);
      least = std::min(least, costs.back());
    }
    if (lattice_.cost <= 2.0 * least + noise) return;
    std::size_t found = 2;
    while (costs[found - 2] > 1.5 * least + noise) ++found;
    throw InvalidInput(
        fmt::format("the scan shows {} steps of one width (or more that do not stand out), not the {} that "
                    "the levels tell: check --levels, and that the scan holds the whole wedge",
                    found, told));
  }

  [[nodiscard]] WedgeScan described() const {
    WedgeScan wedge;
    wedge.reversed = lattice_.reversed;
    wedge.step_width = pitch() * lattice_.width;
    wedge.across_from = field_.grid().pitch_y * static_cast<double>(part_.row + across_.steps.begin);
    wedge.across_to = field_.grid().pitch_y * static_cast<double>(part_.row + across_.steps.end);
    wedge.profile_start = pitch() * static_cast<double>(part_.column);
    wedge.tilt_x = tilt_.slope_x;
    wedge.tilt_y = tilt_.slope_y;
    wedge.roughness_um = levelled_.roughness_um;
    const PlateauMean& base_mean = levelled_.plateaus[base()];
    require(
        base_mean.samples > 0,
        "no base is seen that heights could be over: the scan needs a frame beside the steps, or a step of level 0");
    wedge.base_error_um = base_mean.standard_error_um;
    for (std::size_t i = 0; i < options_.grays.size(); ++i) wedge.steps.push_back(step(i, base_mean));
    for (std::size_t i = 1; i < wedge.steps.size(); ++i) {
      const WedgeStep &a = wedge.steps[i - 1], &b = wedge.steps[i];
      const double error = std::hypot(a.standard_error_um, b.standard_error_um);
      wedge.standing_out += std::abs(a.height_um - b.height_um) > 4.0 * error ? 1 : 0;
    }
    wedge.profile_pitch = pitch();
    for (const double height : median_profile(field_, tilt_, across_.steps))
      wedge.profile_um.push_back(height - base_mean.height_um);
    add_notes(wedge);
    return wedge;
  }

  [[nodiscard]] WedgeStep step(std::size_t told, const PlateauMean& base_mean) const {
    const std::size_t count = options_.grays.size(), place = lattice_.reversed ? count - 1 - told : told;
    const double from = lattice_.first + static_cast<double>(place) * lattice_.width;
    const double first = from + static_cast<double>(part_.column);
    WedgeStep step{options_.grays[told], pitch() * first, pitch() * (first + lattice_.width)};
    // Steps of gray 0 are base: theirs is its height.
    const PlateauMean& mean = levelled_.plateaus[options_.grays[told] == 0.0 ? base() : told];
    require(mean.samples > 0, fmt::format("step {} has no measured samples inside of its borders", told + 1));
    step.height_um = mean.height_um - base_mean.height_um;
    const double lever_um = mean.middle_x_um - base_mean.middle_x_um;
    step.standard_error_um = std::max(1e-4, std::hypot(mean.standard_error_um, lever_um * levelled_.tilt.error_x));
    step.samples = mean.samples;
    step.outliers = mean.outliers;
    return step;
  }

  void add_notes(WedgeScan& wedge) const {
    if (wedge.standing_out + 1 < wedge.steps.size())
      wedge.notes.push_back(
          fmt::format("{} of {} borders between steps stand out; the others were placed by the width of "
                      "the steps",
                      wedge.standing_out, wedge.steps.size() - 1));
    if (wedge.reversed) wedge.notes.push_back("the step told first lies at the far end of the scan");
  }

  const WedgeScanOptions& options_;
  Tilt tilt_;
  WedgePart part_;
  const HeightField& field_;
  std::vector<double> profile_;
  Lattice lattice_;
  Across across_{};
  std::vector<Patch> patches_;
  Levelled levelled_;
};

}  // namespace

WedgeScan measure_wedge(const HeightField& scan, const WedgeScanOptions& options) {
  require(options.grays.size() >= 2 && options.grays.size() <= most_steps, "a wedge in a scan has 2 to 64 steps");
  for (const double gray : options.grays) require(gray >= 0.0 && gray <= 1.0, "a gray value lies between 0 and 1");
  require(options.border_share >= 0.0 && options.border_share < 0.5, "the border of a step is a share below 0.5 of it");
  require(scan.missing_count() < scan.grid().size(), "the scan has no measured samples");
  require(scan.rows() >= 8 && scan.columns() >= 8, "a wedge needs at least 8 × 8 samples");
  const bool along_y = lies_along_y(scan, options.along);
  WedgeScan wedge = along_y ? Reader(turned(scan), options).read() : Reader(scan, options).read();
  wedge.along = along_y ? WedgeAxis::Y : WedgeAxis::X;
  if (along_y) std::swap(wedge.tilt_x, wedge.tilt_y);
  return wedge;
}

std::vector<CurePoint> cure_points(const WedgeScan& wedge) {
  std::vector<CurePoint> points;
  for (std::size_t i = 0; i < wedge.steps.size(); ++i) {
    const WedgeStep& step = wedge.steps[i];
    points.push_back({.gray = step.gray,
                      .height_um = step.height_um,
                      .standard_error_um = step.standard_error_um,
                      .place = fmt::format("step {}", i + 1)});
  }
  return points;
}

}  // namespace mezzotint
