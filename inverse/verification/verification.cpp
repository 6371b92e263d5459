#include "inverse/verification/verification.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "forward/base/error.h"
#include "forward/scattering/path_tracing.h"
#include "forward/scattering/slope_splat.h"

namespace mezzotint {

namespace {

void require_valid_verification(const LobeTarget& goal, const VerificationOptions& options) {
  require(!goal.incidences.empty() && goal.maps.size() == goal.incidences.size(),
          "a verification needs a lobe for each direction of the light, and at least one");
  require(options.seeds.size() >= 4,
          "a verification needs 4 fresh seeds or more; these are " + std::to_string(options.seeds.size()));
  require(std::set(options.seeds.begin(), options.seeds.end()).size() == options.seeds.size(),
          "a seed stands twice among those of a verification; all must differ");
}

// Mean over draws with its standard error.
Estimate mean_share(const std::vector<std::vector<EnergyAudit>>& audits, std::size_t light,
                    Estimate EnergyAudit::*share) {
  const auto n = static_cast<double>(audits.size());
  Estimate mean;
  for (const auto& draw : audits) mean.value += (draw[light].*share).value / n;
  double spread = 0.0;
  for (const auto& draw : audits) spread += std::pow((draw[light].*share).value - mean.value, 2);
  mean.standard_error = std::sqrt(spread / (n * (n - 1.0)));
  return mean;
}

std::vector<EnergyAudit> mean_audits(const std::vector<std::vector<EnergyAudit>>& audits) {
  constexpr std::array shares = {&EnergyAudit::reflected, &EnergyAudit::transmitted, &EnergyAudit::absorbed,
                                 &EnergyAudit::left_sideways, &EnergyAudit::cut_off};
  std::vector<EnergyAudit> means(audits.front().size());
  for (std::size_t light = 0; light < means.size(); ++light) {
    for (const auto share : shares) means[light].*share = mean_share(audits, light, share);
  }
  return means;
}

}  // namespace

std::vector<DirectionMap> traced_lobes(const HeightField& relief, const LobeTarget& goal, std::uint64_t samples,
                                       double tolerance, std::uint64_t seed, std::vector<EnergyAudit>& audits,
                                       const Progress& progress) {
  PathTracer tracer(relief);
  std::vector<DirectionMap> maps;
  for (const DirectionAngles& incidence : goal.incidences) {
    const Bsdf bsdf = tracer.trace({.incidence = incidence,
                                    .grid = goal.grid.grid(),
                                    .material = goal.material,
                                    .samples = samples,
                                    .tolerance = tolerance,
                                    .seed = seed},
                                   progress);
    maps.push_back(goal.grid.softened(bsdf.reflection.mean));
    audits.push_back(bsdf.energy);
  }
  return maps;
}

std::vector<DirectionMap> slope_lobes(const HeightField& relief, const LobeTarget& goal) {
  std::vector<DirectionMap> maps;
  for (const DirectionAngles& incidence : goal.incidences)
    maps.push_back(goal.grid.softened(slope_reflection_map(relief, goal.material, incidence, goal.grid.grid())));
  return maps;
}

Verification verify_design(const GrayOfSeed& gray_of_seed, const PrinterProfile& printer, const LobeTarget& goal,
                           const VerificationOptions& options, const Progress& progress) {
  require_valid_verification(goal, options);
  Verification result{.seeds = options.seeds, .wanted_light = wanted_light(goal)};
  std::vector<std::vector<DirectionMap>> traced, by_slope;
  std::vector<std::vector<EnergyAudit>> audits;
  const auto draws = static_cast<double>(options.seeds.size());
  for (const std::uint64_t seed : options.seeds) {
    const double before = static_cast<double>(traced.size()) / draws;
    const HeightField relief = print_draw(gray_of_seed(seed), printer, options.draw, seed);
    result.slope_covariances.push_back(slope_covariance(relief));
    by_slope.push_back(slope_lobes(relief, goal));
    audits.emplace_back();
    const Progress within = [&](const ProgressEvent& event) {
      report(progress, "verify", before + event.fraction / draws, "seed " + std::to_string(seed));
    };
    traced.push_back(traced_lobes(relief, goal, options.samples, options.tolerance, seed, audits.back(), within));
  }
  report(progress, "verify", 1.0);
  result.traced = judge_draws(traced, goal);
  result.by_slope = judge_draws(by_slope, goal);
  result.energy = mean_audits(audits);
  return result;
}

}  // namespace mezzotint
