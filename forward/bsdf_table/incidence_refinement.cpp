#include "forward/bsdf_table/incidence_refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();
constexpr double least_gain = 0.2;  // of a difference, by halving its interval: smooth maps gain 3/4, kinks 1/2

// Two neighbours in θ, or in φ on a ring.
struct Interval {
  bool of_theta = true;
  double theta = 0.0;  ///< of the ring, where in φ
  double lower = 0.0, upper = 0.0;
  double priority = unknown;    ///< the largest first; among equals the oldest
  double difference = unknown;  ///< of the interval that this is a half of

  [[nodiscard]] double middle() const { return 0.5 * (lower + upper); }
};

// Whether there is light in a map, by halves, so that noise alone is none.
bool is_seen(const MapEstimate& map, const std::vector<double>& areas) {
  double sum = 0.0;
  for (std::size_t k = 0; k < areas.size(); ++k) sum += areas[k] * map.half_a[k] * map.half_b[k];
  return sum > 0.0;
}

void require_options(const BsdfTableOptions& options) {
  const double largest = options.largest_theta.degrees();
  require(largest > 0.0 && largest <= 89.9, "the largest theta of a BSDF table lies in (0, 89.9] degrees");
  require(options.coarse_rings >= 2 && options.coarse_rings <= 1000, "a BSDF table begins with 2 to 1000 rings");
  require(options.coarse_azimuths >= 2 && options.coarse_azimuths <= 1000,
          "a ring of a BSDF table begins with 2 to 1000 azimuths");
  require(options.tolerance > 0.0 && options.tolerance < 10.0, "the tolerance of a BSDF table lies in (0, 10)");
  require(options.relative_index >= 1.0001 && options.relative_index <= 10.0,
          "the relative index of a BSDF table lies in [1.0001, 10]");
  require(std::isfinite(options.symmetry.axis.radians()), "the axis of a BSDF table is no number");
  const std::size_t azimuths = options.symmetry.kind == SymmetryKind::Isotropic ? 1 : options.coarse_azimuths;
  const std::size_t coarse = 1 + (options.coarse_rings - 1) * azimuths;
  require(options.most_incidences >= coarse,
          fmt::format("the coarse BSDF table has {} incidences, the budget {}", coarse, options.most_incidences));
}

class Refinement {
public:
  Refinement(const ComputeBsdf& compute, const BsdfTableOptions& options, const Progress& progress,
             const FindBsdf& find)
      : compute_(compute), options_(options), progress_(progress), find_(find) {
    refined_.grid.symmetry = options.symmetry;
  }

  RefinedIncidences run() {
    begin_coarse();
    for (auto next = most_urgent(); next != pending_.end(); next = most_urgent()) {
      const Interval interval = *next;
      pending_.erase(next);
      interval.of_theta ? try_theta(interval) : try_azimuth(interval);
    }
    std::vector<IncidenceRing>& rings = refined_.grid.rings;
    rings.back().follows_theta = rings[rings.size() - 2].follows_theta;  // beyond it, as before it
    BsdfTableReport& report = refined_.report;
    for (const Interval& interval : pending_) {
      if (interval.difference != unknown) note_difference(interval.difference);
    }
    report.incidences = refined_.nodes.size();
    report.untried = pending_.size();
    report.met = report.untried == 0 && report.stalled == 0;
    return std::move(refined_);
  }

private:
  void begin_coarse() {
    const double steps = static_cast<double>(options_.coarse_rings - 1);
    for (std::size_t k = 0; k < options_.coarse_rings; ++k) {
      const bool last = k + 1 == options_.coarse_rings;
      const double sine = std::sin(options_.largest_theta.radians()) * static_cast<double>(k) / steps;
      add_ring(new_ring(last ? options_.largest_theta.radians() : std::asin(sine)), unknown);
    }
    const std::vector<IncidenceRing>& rings = refined_.grid.rings;
    for (std::size_t k = 0; k + 1 < rings.size(); ++k) {
      pending_.push_back({true, 0.0, rings[k].theta.radians(), rings[k + 1].theta.radians()});
    }
  }

  [[nodiscard]] std::vector<double> coarse_azimuths(double theta) const {
    const SymmetryKind kind = options_.symmetry.kind;
    if (theta == 0.0 || kind == SymmetryKind::Isotropic) return {0.0};
    std::vector<double> azimuths(options_.coarse_azimuths);
    const std::size_t steps = azimuths.size() - (range_wraps(kind) ? 0 : 1);
    for (std::size_t k = 0; k < azimuths.size(); ++k) {
      azimuths[k] = azimuth_range(kind) * static_cast<double>(k) / static_cast<double>(steps);
    }
    return azimuths;
  }

  // Computes the nodes of a ring; it is not yet part of the grid.
  IncidenceRing new_ring(double theta) {
    IncidenceRing ring;
    ring.theta = Angle::from_radians(theta);
    for (const double azimuth : coarse_azimuths(theta)) {
      ring.azimuths.push_back(Angle::from_radians(azimuth));
      ring.nodes.push_back(ask(theta, azimuth));
    }
    return ring;
  }

  void add_ring(const IncidenceRing& ring, double priority) {
    std::vector<IncidenceRing>& rings = refined_.grid.rings;
    const auto place = std::upper_bound(rings.begin(), rings.end(), ring,
                                        [](const auto& a, const auto& b) { return a.theta < b.theta; });
    rings.insert(place, ring);
    if (ring.nodes.size() == 1) return;
    for (std::size_t k = 0; k < ring.azimuths.size(); ++k) {
      const bool last = k + 1 == ring.azimuths.size();
      if (last && !range_wraps(options_.symmetry.kind)) continue;
      const double end = last ? azimuth_range(options_.symmetry.kind) : ring.azimuths[k + 1].radians();
      pending_.push_back({false, ring.theta.radians(), ring.azimuths[k].radians(), end, priority});
    }
  }

  std::size_t ask(double theta, double azimuth) {
    IncidenceGrid place{options_.symmetry, {{Angle::from_radians(theta), {Angle::from_radians(azimuth)}, {0}}}};
    const DirectionAngles to_light = incidence_at(place, 0, 0);
    const double share = static_cast<double>(refined_.nodes.size()) / static_cast<double>(options_.most_incidences);
    report(progress_, "bsdf table", share,
           fmt::format("light at {:.2f}, {:.2f} degrees", to_light.theta.degrees(), to_light.phi.degrees()));
    std::optional<Bsdf> bsdf = find_ ? find_(to_light) : std::nullopt;
    if (!bsdf) {
      bsdf = compute_(to_light);
      ++refined_.report.computed;
    }
    require_fitting(*bsdf, to_light);
    bsdf->incidence = to_light;  // a file rounds to degrees
    if (options_.symmetry.kind == SymmetryKind::Isotropic) impose_isotropy(*bsdf);
    refined_.nodes.push_back(*std::move(bsdf));
    return refined_.nodes.size() - 1;
  }

  void require_fitting(const Bsdf& bsdf, const DirectionAngles& to_light) {
    constexpr double rounding = 1e-6;
    require((to_direction(bsdf.incidence) - to_direction(to_light)).norm() < rounding,
            "a BSDF for a table is lit from another direction than was asked for");
    if (refined_.nodes.empty()) areas_ = projected_solid_angles(bsdf.grid);
    require(refined_.nodes.empty() || bsdf.grid == refined_.nodes.front().grid, "the BSDFs of a table have one grid");
    for (const MapEstimate* map : {&bsdf.reflection, &bsdf.transmission}) {
      for (const DirectionMap* values : {&map->mean, &map->standard_error, &map->half_a, &map->half_b}) {
        require(values->size() == bsdf.grid.size(), "a map of a BSDF for a table does not fit its grid");
      }
    }
  }

  // Between a computed node and what the grid, as it stands, makes of it.
  [[nodiscard]] Estimate difference(const Bsdf& node) const {
    Estimate largest;
    const auto compare = [&](const MapEstimate& guess, const MapEstimate& map) {
      const Estimate seen = relative_l2(node.grid, guess, map).corrected;
      if (seen.value > largest.value) largest = seen;
    };
    if (is_seen(node.reflection, areas_)) {
      compare(interpolated_reflection(refined_.grid, refined_.nodes, node.incidence), node.reflection);
    }
    if (is_seen(node.transmission, areas_)) {
      compare(interpolated_transmission(refined_.grid, refined_.nodes, node.incidence, options_.relative_index),
              node.transmission);
    }
    return largest;
  }

  void try_theta(const Interval& interval) {
    IncidenceRing ring = new_ring(interval.middle());
    bool& follows = lower_ring(interval).follows_theta;
    follows = true;
    const Estimate moved = largest_difference(ring);
    follows = false;
    const Estimate stayed = largest_difference(ring);
    follows = ring.follows_theta = moved.value <= stayed.value;
    add_ring(ring, std::min(moved.value, stayed.value));
    halve(interval, ring.follows_theta ? moved : stayed);
  }

  IncidenceRing& lower_ring(const Interval& interval) {
    return *std::find_if(refined_.grid.rings.begin(), refined_.grid.rings.end(),
                         [&](const IncidenceRing& ring) { return ring.theta.radians() == interval.lower; });
  }

  [[nodiscard]] Estimate largest_difference(const IncidenceRing& ring) const {
    Estimate largest;
    for (const std::size_t node : ring.nodes) {
      const Estimate seen = difference(refined_.nodes[node]);
      if (seen.value > largest.value) largest = seen;
    }
    return largest;
  }

  void try_azimuth(const Interval& interval) {
    const std::size_t node = ask(interval.theta, interval.middle());
    const Estimate seen = difference(refined_.nodes[node]);
    const Angle azimuth = Angle::from_radians(interval.middle());
    for (IncidenceRing& ring : refined_.grid.rings) {
      if (ring.theta.radians() != interval.theta) continue;
      const auto place = std::upper_bound(ring.azimuths.begin(), ring.azimuths.end(), azimuth);
      ring.nodes.insert(ring.nodes.begin() + (place - ring.azimuths.begin()), node);
      ring.azimuths.insert(place, azimuth);
    }
    halve(interval, seen);
  }

  void halve(const Interval& interval, const Estimate& seen) {
    const bool too_large = seen.value - seen.standard_error > options_.tolerance;
    const bool stalls = too_large && seen.value > (1.0 - least_gain) * interval.difference;
    if (!too_large || stalls) {
      note_difference(seen.value);
      if (stalls) ++refined_.report.stalled;
      return;
    }
    Interval half = interval;
    half.priority = half.difference = seen.value;
    half.upper = interval.middle();
    pending_.push_back(half);
    half.lower = interval.middle();
    half.upper = interval.upper;
    pending_.push_back(half);
  }

  void note_difference(double value) {
    double& largest = refined_.report.largest_difference;
    largest = std::max(largest, value);
  }

  // The worst interval that the budget still allows.
  std::vector<Interval>::iterator most_urgent() {
    const std::size_t left = options_.most_incidences - refined_.nodes.size();
    auto best = pending_.end();
    for (auto candidate = pending_.begin(); candidate != pending_.end(); ++candidate) {
      const std::size_t cost = candidate->of_theta ? coarse_azimuths(candidate->middle()).size() : 1;
      if (cost <= left && (best == pending_.end() || candidate->priority > best->priority)) best = candidate;
    }
    return best;
  }

  const ComputeBsdf& compute_;
  const BsdfTableOptions& options_;
  const Progress& progress_;
  const FindBsdf& find_;
  RefinedIncidences refined_;
  std::vector<double> areas_;
  std::vector<Interval> pending_;
};

}  // namespace

RefinedIncidences refine_incidences(const ComputeBsdf& compute, const BsdfTableOptions& options,
                                    const Progress& progress, const FindBsdf& find) {
  require(static_cast<bool>(compute), "a BSDF table needs a function that computes one incidence");
  require_options(options);
  return Refinement(compute, options, progress, find).run();
}

}  // namespace mezzotint
