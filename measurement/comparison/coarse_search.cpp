#include "measurement/comparison/coarse_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace mezzotint {

namespace {

constexpr double least_overlap_share = 0.2;
constexpr std::size_t peaks_per_rotation = 12;
constexpr std::size_t candidate_count = 6;
// Samples of both images along a side together: bounds a rotation's transforms to 1280².
constexpr double largest_coarse_side = 1280.0;
constexpr double least_coarse_side = 48.0;

/// How likely a place is to be the hill to climb. `evidence` would be too sharp here: beside the top of a hill, where
/// coarse samples happen to lie, r is 0.98 in place of 0.99, and that must not outweigh a larger overlap.
double score_of(double r, double samples) { return r <= 0.0 ? 0.0 : r * r * samples; }

FieldPoint extent_of(const Grid& grid) {
  const FieldPoint middle = middle_of(grid);
  return {2.0 * middle.x_um, 2.0 * middle.y_um};
}

/// The reduced resolution: four samples a wavelength where that is affordable.
double coarse_pitch_um(const Grid& design, const Grid& measured, double half_width_um) {
  const FieldPoint a = extent_of(design);
  const FieldPoint b = extent_of(measured);
  const double finest =
      std::max({design.pitch_x.um(), design.pitch_y.um(), measured.pitch_x.um(), measured.pitch_y.um()});
  const double affordable = std::max(a.x_um + b.x_um, a.y_um + b.y_um) / largest_coarse_side;
  const double coarsest = std::min({a.x_um, a.y_um, b.x_um, b.y_um}) / least_coarse_side;
  return std::max({finest, affordable, std::min(1.5 * half_width_um, coarsest)});
}

/// Averaged over coarse cells that may be seen in part.
HeightField smoothed(const HeightField& field, double pitch_um) {
  return area_average(field, Length::from_um(pitch_um), Length::from_um(pitch_um), 0.25);
}

/// The field at the points `place(column, row)` of a coarse grid.
template <class Place>
HeightField sampled(const HeightField& field, const Grid& grid, Place place) {
  std::vector<float> heights_um(grid.size());
  for (std::size_t k = 0; k < heights_um.size(); ++k) {
    heights_um[k] = static_cast<float>(height_um_at(field, place(k % grid.columns, k / grid.columns)));
  }
  return {grid, Continuation::Mirrored, std::move(heights_um)};
}

Grid coarse_grid(FieldPoint extent, double pitch_um) {
  const auto count = [&](double length_um) { return static_cast<std::size_t>(length_um / pitch_um + 1e-9) + 1; };
  return {count(extent.x_um), count(extent.y_um), Length::from_um(pitch_um), Length::from_um(pitch_um)};
}

std::vector<double> rotations(double largest, double step) {
  const int each_way = static_cast<int>(std::ceil(largest / step - 1e-9));
  std::vector<double> angles;
  for (int k = -each_way; k <= each_way; ++k) angles.push_back(each_way == 0 ? 0.0 : largest * k / each_way);
  return angles;
}

/// All rotations of one design against one measurement.
class RotationSearch {
public:
  RotationSearch(const HeightField& design, const HeightField& measured, double pitch_um, double largest_rotation)
      : design_(smoothed(design, pitch_um)),
        centre_(middle_of(design.grid())),
        grid_(turned_grid(extent_of(design.grid()), pitch_um, largest_rotation)),
        correlation_(coarse(measured, pitch_um), grid_.columns, grid_.rows) {
    least_overlap_ = least_overlap_share * std::min(area(design), area(measured)) / (pitch_um * pitch_um);
  }

  [[nodiscard]] std::vector<Candidate> best_at(double rotation) const {
    const Placement turned{centre_, {}, rotation};
    const FieldPoint middle = middle_of(grid_);
    const double pitch_um = grid_.pitch_x.um();
    const HeightField image = sampled(design_, grid_, [&](std::size_t c, std::size_t r) {
      return turned.to_design({static_cast<double>(c) * pitch_um - middle.x_um + centre_.x_um,
                               static_cast<double>(r) * pitch_um - middle.y_um + centre_.y_um});
    });
    const CorrelationMap map = correlation_.with(standardised(image), least_overlap_);
    return peaks(map, rotation);
  }

private:
  static double area(const HeightField& field) {
    return static_cast<double>(field.grid().size() - field.missing_count()) * field.grid().pitch_x.um() *
           field.grid().pitch_y.um();
  }

  static MaskedImage coarse(const HeightField& measured, double pitch_um) {
    const auto place = [&](std::size_t c, std::size_t r) {
      return FieldPoint{static_cast<double>(c) * pitch_um, static_cast<double>(r) * pitch_um};
    };
    return standardised(
        sampled(smoothed(measured, pitch_um), coarse_grid(extent_of(measured.grid()), pitch_um), place));
  }

  /// Holds the design turned by any angle up to the largest.
  static Grid turned_grid(FieldPoint extent, double pitch_um, double largest) {
    const double across = std::hypot(extent.x_um, extent.y_um);
    const double s = std::sin(std::min(largest, 0.5 * std::numbers::pi));
    return coarse_grid(
        {std::min(across, extent.x_um + s * extent.y_um), std::min(across, extent.y_um + s * extent.x_um)}, pitch_um);
  }

  [[nodiscard]] std::vector<Candidate> peaks(const CorrelationMap& map, double rotation) const {
    std::vector<double> score(map.correlation.size());
    for (std::size_t k = 0; k < score.size(); ++k) score[k] = score_of(map.correlation[k], map.overlap[k]);
    std::vector<std::size_t> found;
    for (std::size_t k = 0; k < score.size(); ++k) {
      if (score[k] > 0.0 && is_peak(map, score, k)) found.push_back(k);
    }
    const auto likelier = [&](std::size_t a, std::size_t b) {
      return score[a] != score[b] ? score[a] > score[b] : a < b;
    };
    const std::size_t kept = std::min(found.size(), peaks_per_rotation);
    std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept), found.end(), likelier);
    std::vector<Candidate> candidates;
    for (std::size_t k = 0; k < kept; ++k) {
      candidates.push_back({placement_at(map, found[k], rotation), score[found[k]]});
    }
    return candidates;
  }

  static bool is_peak(const CorrelationMap& map, const std::vector<double>& score, std::size_t k) {
    const std::size_t c = k % map.columns;
    const std::size_t r = k / map.columns;
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t row = (r + map.rows + j - 1) % map.rows;
        const std::size_t column = (c + map.columns + i - 1) % map.columns;
        if (score[row * map.columns + column] > score[k]) return false;
      }
    }
    return true;
  }

  /// Sample (i, j) of the turned design lies at i·pitch − middle + centre + shift in the measurement, so a
  /// displacement k means k·pitch = shift + centre − middle.
  [[nodiscard]] Placement placement_at(const CorrelationMap& map, std::size_t k, double rotation) const {
    const FieldPoint middle = middle_of(grid_);
    const double pitch_um = grid_.pitch_x.um();
    return {centre_,
            {static_cast<double>(map.displacement_x(k)) * pitch_um + middle.x_um - centre_.x_um,
             static_cast<double>(map.displacement_y(k)) * pitch_um + middle.y_um - centre_.y_um},
            rotation};
  }

  HeightField design_;
  FieldPoint centre_;
  Grid grid_;
  MaskedCorrelation correlation_;
  double least_overlap_ = 0.0;
};

/// The likeliest candidates that are no neighbours of each other.
std::vector<Candidate> separate(std::vector<Candidate> all, const MainLobe& lobe) {
  // Stable, and the input is in the order of the rotations: equal scores are decided the same way every time.
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
  std::vector<Candidate> chosen;
  for (const Candidate& candidate : all) {
    const bool apart = std::none_of(chosen.begin(), chosen.end(), [&](const Candidate& other) {
      return lobe.holds(candidate.placement.shift().x_um - other.placement.shift().x_um,
                        candidate.placement.shift().y_um - other.placement.shift().y_um);
    });
    if (apart) chosen.push_back(candidate);
    if (chosen.size() == candidate_count) break;
  }
  return chosen;
}

std::vector<Candidate> search_rotations(const RotationSearch& search, const std::vector<double>& angles,
                                        const Progress& progress) {
  constexpr std::size_t at_once = 8;  // between reports, and transforms in memory at once
  std::vector<Candidate> all;
  for (std::size_t first = 0; first < angles.size(); first += at_once) {
    const std::size_t count = std::min(at_once, angles.size() - first);
    std::vector<std::vector<Candidate>> found(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) { found[k] = search.best_at(angles[first + k]); });
    for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
    report(progress, "register", 0.8 * (static_cast<double>(first + count) / static_cast<double>(angles.size())),
           "comparing " + std::to_string(angles.size()) + " rotations");
  }
  return all;
}

}  // namespace

CoarseSearch search_coarsely(const HeightField& design, const HeightField& measured, Angle largest_rotation,
                             const Progress& progress) {
  const double half_width_um = feature_half_width_um(design);
  const double pitch_um = coarse_pitch_um(design.grid(), measured.grid(), half_width_um);
  // The corner of the right placement is off by at most one half-width at the rotation next to it; the mean over
  // the overlap, by less.
  const double corner_um = std::min(half_diagonal_um(design.grid()), half_diagonal_um(measured.grid()));
  const auto angles = rotations(largest_rotation.radians(), 2.0 * std::max(half_width_um, 0.5 * pitch_um) / corner_um);
  const RotationSearch search(design, measured, pitch_um, largest_rotation.radians());
  const auto all = search_rotations(search, angles, progress);

  const auto on_design = [&](std::size_t c, std::size_t r) {
    return FieldPoint{static_cast<double>(c) * pitch_um, static_cast<double>(r) * pitch_um};
  };
  MainLobe lobe(sampled(smoothed(design, pitch_um), coarse_grid(extent_of(design.grid()), pitch_um), on_design));
  const FieldPoint a = extent_of(design.grid());
  const FieldPoint b = extent_of(measured.grid());
  const double searched_um2 = (a.x_um + b.x_um) * (a.y_um + b.y_um);
  const double trials = static_cast<double>(angles.size()) * std::max(1.0, searched_um2 / lobe.area_um2());
  return {separate(all, lobe), Length::from_um(pitch_um), trials, std::move(lobe)};
}

}  // namespace mezzotint
