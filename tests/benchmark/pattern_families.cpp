#include "pattern_families.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include <Eigen/Eigenvalues>

#include "forward/base/random.h"
#include "forward/pattern/pattern_parameters.h"

namespace mezzotint {

namespace {

std::vector<FreeParameter> lengths(const std::vector<FreeParameter>& free) {
  std::vector<FreeParameter> truth = free;
  for (FreeParameter& p : truth) {
    if (p.name.ends_with("direction_deg")) continue;
    const double room = std::pow(p.high / p.low, 0.12);  // truths keep off the bounds
    p.low *= room;
    p.high /= room;
  }
  return truth;
}

}  // namespace

std::vector<Family> families(const std::string& letters) {
  std::vector<Family> all;
  const double turn = 180.0;
  const std::vector<FreeParameter> s = {{"wavelength_u_um", 30.2, 300.0, {}},
                                        {"wavelength_v_um", 30.2, 300.0, {}},
                                        {"direction_deg", -turn, turn, {}},
                                        {"height_um", 3.0, 17.5, {}}};
  all.push_back({'S', Sinusoid{}, s, lengths(s), 96, 4, 0.02});
  const std::vector<FreeParameter> r = {
      {"parts[0].wavelength_um", 45.0, 300.0, {}},   {"parts[0].direction_deg", -turn, turn, {}},
      {"parts[0].height_um", 2.0, 11.0, {}},         {"parts[0].skew", 0.15, 0.85, {}},
      {"parts[1].wavelength_u_um", 45.0, 300.0, {}}, {"parts[1].height_um", 2.0, 6.5, {}}};
  all.push_back({'R', PatternSum{{{Ridges{}}, {Sinusoid{}}}}, r, lengths(r), 128, 8, 0.02});
  const std::vector<FreeParameter> n = {{"scale_um", 60.0, 300.0, {}},
                                        {"stretch", 1.0, 6.0, {}},
                                        {"direction_deg", -turn, turn, {}},
                                        {"height_um", 3.0, 17.5, {}},
                                        {"hurst", 0.3, 0.95, {}}};
  all.push_back({'N', FractionalBrownianMotion{.octaves = 2}, n, lengths(n), 128, 8, 0.05});
  const std::vector<FreeParameter> c = {
      {"parts[0].wavelength_um", 45.0, 300.0, {}},   {"parts[0].direction_deg", -turn, turn, {}},
      {"parts[0].height_um", 1.5, 7.0, {}},          {"parts[0].skew", 0.15, 0.85, {}},
      {"parts[1].wavelength_u_um", 45.0, 300.0, {}}, {"parts[1].height_um", 1.0, 4.5, {}},
      {"parts[2].scale_um", 60.0, 300.0, {}},        {"parts[2].height_um", 1.5, 6.0, {}}};
  all.push_back({'C', PatternSum{{{Ridges{}}, {Sinusoid{}}, {Noise{}}}}, c, lengths(c), 128, 8, 0.05});
  std::erase_if(all, [&](const Family& family) { return letters.find(family.letter) == std::string::npos; });
  return all;
}

Pattern truth_of(const Family& family, std::uint64_t number) {
  const RandomStream stream(1000 + number, RandomPurpose::StudySample);
  Pattern pattern = family.pattern;
  for (std::size_t i = 0; i < family.truth.size(); ++i) {
    const FreeParameter& p = family.truth[i];
    const double u = stream.uniform4(i)[0];
    const bool additive = p.low <= 0.0 || p.name.ends_with("skew") || p.name.ends_with("hurst");
    set_parameter(pattern, p.name, additive ? p.low + u * (p.high - p.low) : p.low * std::pow(p.high / p.low, u));
  }
  return pattern;
}

double largest_error(const SlopeCovariance& found, const SlopeCovariance& truth) {
  Eigen::Matrix2d f, t;
  f << found.xx, found.xy, found.xy, found.yy;
  t << truth.xx, truth.xy, truth.xy, truth.yy;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> solver(f, t, Eigen::EigenvaluesOnly);
  return (solver.eigenvalues().array() - 1.0).abs().maxCoeff();
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace mezzotint
