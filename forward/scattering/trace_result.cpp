#include "forward/scattering/trace_result.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/scattering/bin_interval.h"

namespace mezzotint {

namespace {

double sum_of(const EnergyTally& energy) {
  double sum = 0.0;
  for (const double share : energy) sum += share;
  return sum;
}

// Tallies of weight to 1/sr: by the light that met the measured part, and the projected solid angle of the bin.
std::vector<double> map_scale(const DirectionGrid& grid, double light_that_met) {
  std::vector<double> scale = projected_solid_angles(grid);
  for (double& area : scale) area = area > 0.0 ? 1.0 / (light_that_met * area) : 0.0;
  return scale;
}

/// Batches as shares of the light that came in: what was traced, and the splat that it corrects.
class Shares {
public:
  Shares(const TraceState& state, const BatchTally* splat, double facets)
      : state_(state),
        splat_(splat),
        per_ray_(1.0 / static_cast<double>(state.rays_per_batch)),
        per_facet_(1.0 / facets) {
    if (splat_ != nullptr) splat_total_ = sum_of(splat_->total_energy) * per_facet_;
  }

  // With a splat the shares of a batch sum to 1 but for noise; the excess, spread like the splat's own light, is
  // taken out again. (A control variate with the coefficient 1: the expectation of the excess is 0.)
  [[nodiscard]] double excess(const BatchTally& tally) const {
    return splat_ == nullptr ? 0.0 : splat_total_ + sum_of(tally.total_energy) * per_ray_ - 1.0;
  }

  // 1 less the share of the splat's light that is taken out. A splat without light has none to spread the excess by.
  [[nodiscard]] double kept(const BatchTally& tally) const {
    return splat_ == nullptr || !(splat_total_ > 0.0) ? 1.0 : 1.0 - excess(tally) / splat_total_;
  }

  template <class Part>  // BatchTally → container of numbers
  void add_to(BatchStatistics& statistics, const Part& part) const {
    std::vector<double> values;
    for (const BatchTally& tally : state_.tallies) {
      const auto& traced = part(tally);
      values.resize(traced.size());
      const double dense_share = kept(tally);
      for (std::size_t k = 0; k < values.size(); ++k) {
        const double dense = splat_ == nullptr ? 0.0 : part(*splat_)[k] * per_facet_;
        values[k] = traced[k] * per_ray_ + dense * dense_share;
      }
      statistics.add(values);
    }
  }

  // What the paths brought to a bin of a map; in shares of all light.
  [[nodiscard]] BinHits hits(std::size_t map, std::size_t bin) const {
    BinHits all;
    const double per_path = per_ray_ / static_cast<double>(state_.tallies.size());
    for (const BatchTally& tally : state_.tallies) {
      all.sum += (map == 0 ? tally.reflected : tally.transmitted)[bin] * per_path;
      all.squares += tally.squares[map][bin] * per_path * per_path;
      all.negative += tally.negative[map][bin] * per_path;
    }
    return all;
  }
  // The largest that one path brought to any bin; a whole path where none came.
  [[nodiscard]] double largest_weight(std::size_t map) const {
    double largest = 0.0;
    for (const BatchTally& tally : state_.tallies) largest = std::max(largest, tally.largest_weight[map]);
    return (largest > 0.0 ? largest : 1.0) * per_ray_ / static_cast<double>(state_.tallies.size());
  }
  [[nodiscard]] bool corrects_a_splat() const { return splat_ != nullptr; }
  [[nodiscard]] std::uint32_t batches() const { return static_cast<std::uint32_t>(state_.tallies.size()); }

  // What one path more would add to a bin of a map (0 reflection, 1 transmission), by the mean weight of all; of the
  // splat's where no path has corrected anything.
  [[nodiscard]] double one_arrival(std::size_t map, double bins) const {
    double weight = 0.0, traced = 0.0;
    for (const BatchTally& tally : state_.tallies) {
      weight += tally.arrived_weight[map];
      traced += tally.arrivals[map];
    }
    double all = traced;
    if (traced == 0.0 && splat_ != nullptr) {
      weight = splat_->arrived_weight[map];
      all = splat_->arrivals[map];
    }
    const double rays = static_cast<double>(state_.tallies.size()) / per_ray_;
    return all > 0.0 ? weight / all / rays * std::sqrt(std::min(1.0, (traced + 1.0) / bins)) : 0.0;
  }

private:
  const TraceState& state_;
  const BatchTally* splat_;
  double per_ray_, per_facet_;
  double splat_total_ = 1.0;
};

template <class Part>
MapEstimate estimate(const Shares& shares, std::size_t size, const std::vector<double>& scale, const Part& part) {
  BatchStatistics statistics(size);
  shares.add_to(statistics, part);
  return statistics.estimate(scale);
}

// A map. The spread of a bin that few paths reach says little, and of one that none reached nothing: each is given one
// path more (as Agresti and Coull do for a proportion), or its share where there are fewer paths than bins. In a bin of
// ten paths that adds 5 % to the error, in a full one nothing.
template <class Part>
MapEstimate estimate_map(const Shares& shares, std::size_t map, const std::vector<double>& scale, const Part& part) {
  MapEstimate result = estimate(shares, scale.size(), scale, part);
  const double one = shares.one_arrival(map, static_cast<double>(scale.size()));
  for (std::size_t k = 0; k < scale.size(); ++k) {
    result.standard_error[k] = std::hypot(result.standard_error[k], one * scale[k]);
  }
  return result;
}

// Intervals: by Student's t where hits are enough, else by their number. What a splat holds is known but for the excess
// that is taken out of it, which batches tell.
void add_intervals(const Shares& shares, std::size_t map, const std::vector<double>& scale, MapEstimate& result) {
  const double student = student_95(shares.batches() - 1), largest = shares.largest_weight(map);
  result.low_95.resize(scale.size());
  result.high_95.resize(scale.size());
  for (std::size_t k = 0; k < scale.size(); ++k) {
    const BinHits hits = shares.hits(map, k);
    double below = student * result.standard_error[k], above = below;
    if (hits.effective() < few_hits) {
      const Interval few = few_hits_interval(hits, largest);
      const double least = shares.corrects_a_splat() ? below : 0.0;
      below = std::max(least, (hits.sum - few.low) * scale[k]);
      above = std::max(least, (few.high - hits.sum) * scale[k]);
    }
    result.low_95[k] = std::max(0.0, result.mean[k] - below);
    result.high_95[k] = result.mean[k] + above;
  }
}

EnergyAudit audit(const MapEstimate& shares) {
  const auto share = [&](Fate fate) {
    const auto k = static_cast<std::size_t>(fate);
    return Estimate{shares.mean[k], shares.standard_error[k]};
  };
  return {share(Fate::Reflected), share(Fate::Transmitted), share(Fate::Absorbed), share(Fate::LeftSideways),
          share(Fate::CutOff)};
}

const char* name_of(Placement placement) {
  switch (placement) {
    case Placement::Strata:
      return "strata";
    case Placement::Lattice:
      return "lattice";
    case Placement::Random:
      return "random";
  }
  return "";
}

std::string convergence_text(const TraceState& state) {
  std::string text;
  for (const auto& mark : state.convergence)
    text += fmt::format("{}{}:{:.4g}", text.empty() ? "" : " ", mark.paths, mark.error);
  return text;
}

Provenance provenance(const PathTracingOptions& options, const TraceState& state, const Shares& shares,
                      const CorrectionPlan* plan) {
  std::uint64_t interactions = 0, fallbacks = 0;
  double leaked = 0.0, excess = 0.0;
  for (const BatchTally& tally : state.tallies) {
    interactions += tally.interactions;
    fallbacks += tally.normal_fallbacks;
    leaked += tally.leaked;
    excess += shares.excess(tally) / static_cast<double>(state.tallies.size());
  }
  const std::uint64_t samples = state.rays_per_batch * options.batches;
  const auto per_path = 1.0 / static_cast<double>(samples);
  const double fallback_share =
      static_cast<double>(fallbacks) / static_cast<double>(std::max<std::uint64_t>(1, interactions));
  Provenance entries = {{"model", options.max_bounces == 1 ? "single" : "paths"},
                        {"tracer", options.tracer == TracerKind::Embree ? "embree" : "height field"},
                        {"estimator", options.estimator == Estimator::Flux ? "flux" : "slides"},
                        {"placement", name_of(options.placement)},
                        {"control_variate", plan != nullptr ? "slope splat" : "none"},
                        {"material", to_string(options.material)},
                        {"normals", options.normals == NormalKind::Geometric ? "geometric" : "interpolated"},
                        {"samples", std::to_string(samples)},
                        {"batches", std::to_string(options.batches)},
                        {"seed", std::to_string(options.seed)},
                        {"max_bounces", std::to_string(options.max_bounces)},
                        {"incidence_spread", options.spread_incidence_over_bin ? "bin" : "none"},
                        {"convergence", convergence_text(state)},
                        {"interactions_per_path", fmt::format("{:.6g}", static_cast<double>(interactions) * per_path)},
                        {"normal_fallback_share", fmt::format("{:.6g}", fallback_share)},
                        {"leaked_share", fmt::format("{:.6g}", leaked * per_path)}};
  if (plan != nullptr) {
    entries["unadjusted_energy"] = fmt::format("{:.8g}", 1.0 + excess);
    entries["splat_left_out"] = fmt::format("shadowed {:.4g}, meeting the surface again {:.4g} of the cells",
                                            plan->dark_share(), plan->meeting_share());
    entries["correction_density"] =
        plan->quiet() ? "even" : fmt::format("learned; like an even one on {:.4g} of the area", plan->density_share());
  }
  return entries;
}

}  // namespace

TraceResult summarise(const PathTracingOptions& options, const TraceState& state, const PlannedSplat* splat,
                      double facets) {
  const Shares shares(state, splat == nullptr ? nullptr : &splat->splat, facets);
  TraceResult result;
  Bsdf& bsdf = result.bsdf;
  bsdf.incidence = options.incidence;
  bsdf.grid = options.grid;
  const auto energy = [](const BatchTally& tally) -> const EnergyTally& { return tally.total_energy; };
  bsdf.energy = audit(estimate(shares, fate_count, std::vector<double>(fate_count, 1.0), energy));
  const double met = 1.0 - bsdf.energy.left_sideways.value;
  if (!(met > 0.0)) {
    throw MethodError("no light met the measured patch: it is too small for this incidence, or full of holes");
  }
  const std::vector<double> scale = map_scale(options.grid, met);
  bsdf.reflection =
      estimate_map(shares, 0, scale, [](const BatchTally& t) -> const DirectionMap& { return t.reflected; });
  bsdf.transmission =
      estimate_map(shares, 1, scale, [](const BatchTally& t) -> const DirectionMap& { return t.transmitted; });
  add_intervals(shares, 0, scale, bsdf.reflection);
  add_intervals(shares, 1, scale, bsdf.transmission);
  for (std::uint32_t order = 0; order < options.bounce_orders; ++order) {
    bsdf.reflection_orders.push_back(estimate_map(
        shares, 0, scale, [order](const BatchTally& t) -> const DirectionMap& { return t.orders[order]; }));
  }
  bsdf.provenance = provenance(options, state, shares, splat == nullptr ? nullptr : &splat->plan);
  return result;
}

Bsdf splat_result(const PathTracingOptions& options, const BatchTally& splat, double facets) {
  const double total = sum_of(splat.total_energy);
  // Steep mirrors may send all of it back onto the surface; then there is nothing to divide, and all of it is cut off.
  const double divisor = total > 0.0 ? total : 1.0;
  const std::vector<double> scale = map_scale(options.grid, divisor);
  const auto exact = [&](const DirectionMap& tally) {
    DirectionMap map(tally.size());
    for (std::size_t k = 0; k < map.size(); ++k) map[k] = tally[k] * scale[k];
    return MapEstimate{map, DirectionMap(map.size(), 0.0), map, map};
  };
  Bsdf bsdf{.incidence = options.incidence, .grid = options.grid};
  bsdf.reflection = exact(splat.reflected);
  bsdf.transmission = exact(splat.transmitted);
  const auto share = [&](Fate fate) {
    return Estimate{splat.total_energy[static_cast<std::size_t>(fate)] / divisor, 0.0};
  };
  bsdf.energy = {share(Fate::Reflected), share(Fate::Transmitted), share(Fate::Absorbed), {}, {}};
  if (total <= 0.0) bsdf.energy.cut_off.value = 1.0;
  bsdf.provenance = {{"model", "slopes"},
                     {"control_variate", "none"},
                     {"material", to_string(options.material)},
                     {"normals", "geometric"},
                     {"unadjusted_energy", fmt::format("{:.8g}", total / facets)}};
  return bsdf;
}

}  // namespace mezzotint
