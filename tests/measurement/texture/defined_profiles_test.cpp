#include <cmath>
#include <numbers>

#include "measurement/texture/profile.h"
#include "tests/measurement/texture/agreement.h"

// Profiles with closed forms, each at three spacings.

namespace mezzotint::test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double length_um = 1000.0;

/// z of x − length/2, with so many samples: symmetric functions have no tilt.
template <class Height>
Profile sampled(std::size_t count, const Height& height_um) {
  const double spacing = length_um / static_cast<double>(count);
  Profile profile{Length::from_um(spacing), {}};
  for (std::size_t k = 0; k < count; ++k)
    profile.heights_um.push_back(height_um((static_cast<double>(k) + 0.5) * spacing - 0.5 * length_um));
  return profile;
}

Parameters parameters_of(const Profile& profile, const ProfileFilter& filter = {}) {
  const ProfileParameters p = profile_parameters(profile, filter);
  const std::string letter(1, p.letter);
  return {{letter + "a", p.a.value},   {letter + "q", p.q.value},   {letter + "z", p.z.value},
          {letter + "t", p.t.value},   {letter + "p", p.p.value},   {letter + "v", p.v.value},
          {letter + "sk", p.sk.value}, {letter + "ku", p.ku.value}, {letter + "dq", p.dq.value},
          {letter + "Sm", p.sm.value}};
}

const char* const crest = "samples lie beside the crests";
const char* const kinks = "the derivative reaches over three samples each way, so beyond a kink";

TEST(DefinedProfiles, Cosine) {
  constexpr double a = 3.0, wave = 20.0;
  expect_agreement(
      {"cosine profile",
       "3 cos(2πx/20), 50 waves",
       [](std::size_t n) {
         return parameters_of(sampled(n, [](double x) { return a * std::cos(2.0 * pi * x / wave); }));
       },
       2000,
       {to_order("Pa", 2.0 * a / pi, 2), exact("Pq", a / std::numbers::sqrt2), to_order("Pt", 2.0 * a, 2, crest),
        exact("Psk", 0.0, 1.0), exact("Pku", 1.5), exact("PSm", wave)}});
}

TEST(DefinedProfiles, CosineSlopes) {
  // Three samples more at each end, so that the derivative knows whole waves: at first eight samples each.
  constexpr double a = 3.0, wave = 20.0;
  const auto at = [](std::size_t n) {
    const double spacing = length_um / static_cast<double>(n);
    Profile profile{Length::from_um(spacing), {}};
    for (std::size_t k = 0; k < n + 6; ++k)
      profile.heights_um.push_back(a * std::cos(2.0 * pi * (static_cast<double>(k) - 2.5) * spacing / wave));
    return parameters_of(profile);
  };
  expect_agreement({"slopes of a cosine profile",
                    "3 cos(2πx/20), 8, 16 and 32 samples a wave",
                    at,
                    400,
                    {to_order("Pdq", std::numbers::sqrt2 * pi * a / wave, 6)}});
}

TEST(DefinedProfiles, TriangleWave) {
  constexpr double h = 4.0, wave = 20.0, s = 2.0 * h / wave;
  const auto z = [](double x) { return h * (2.0 * std::abs(std::remainder(x, wave)) / wave - 0.5); };
  expect_agreement(
      {"triangle profile",
       "4 (2 |rem(x, 20)|/20 − ½)",
       [&](std::size_t n) { return parameters_of(sampled(n, z)); },
       2000,
       {exact("Pa", h / 4.0), to_order("Pq", h / std::sqrt(12.0), 2), to_order("Pt", h, 1, crest),
        exact("Psk", 0.0, 1.0), to_order("Pku", 1.8, 2), to_order("Pdq", s, 1, kinks), exact("PSm", wave)}});
}

TEST(DefinedProfiles, TriangularGrooves) {
  // V grooves 8 µm wide and 2 µm deep every 20 µm: a share of 0.4.
  constexpr double depth = 2.0, share = 0.4, wave = 20.0;
  const auto z = [](double x) { return -depth * std::max(0.0, 1.0 - std::abs(std::remainder(x, wave)) / 4.0); };
  const double mean = -share * depth / 2.0, second = share * depth * depth / 3.0,
               third = -share * std::pow(depth, 3) / 4.0;
  const double rms = std::sqrt(second - mean * mean);
  expect_agreement({"grooved profile",
                    "−2 max(0, 1 − |rem(x, 20)|/4)",
                    [&](std::size_t n) { return parameters_of(sampled(n, z)); },
                    2000,
                    {to_order("Pq", rms, 2),
                     to_order("Psk", (third - 3.0 * mean * second + 2.0 * std::pow(mean, 3)) / std::pow(rms, 3), 2),
                     exact("Pp", -mean, depth), exact("PSm", wave)}});
}

TEST(DefinedProfiles, RoughnessOfTwoWaves) {
  // λ_c = 100 µm passes to roughness 1 − 2^(−(λc/λ)²): all but 2^−25 of 20 µm, ½ of 100 µm; λ_s = 10 µm lets
  // 2^(−1/4) of 20 µm pass.
  constexpr double fine = 2.0, coarse = 3.0;
  const double left = fine * std::exp2(-0.25) * (1.0 - std::exp2(-25.0)), half = coarse * 0.5 * std::exp2(-0.01);
  const auto z = [](double x) {
    return fine * std::cos(2.0 * pi * x / 20.0) + coarse * std::cos(2.0 * pi * x / 100.0);
  };
  expect_agreement({"filtered profile",
                    "2 cos(2πx/20) + 3 cos(2πx/100), λ_s = 10, λ_c = 100",
                    [&](std::size_t n) {
                      // From the middle, where the filter knows no ends: its regression there is of the first order.
                      Profile rough = sampled(4 * n, z);
                      const Profile fine_line = mean_line(rough, Length::from_um(10.0)),
                                    mean = mean_line(fine_line, Length::from_um(100.0));
                      Profile middle{rough.spacing, {}};
                      for (std::size_t k = n; k < 3 * n; ++k)
                        middle.heights_um.push_back(fine_line.heights_um[k] - mean.heights_um[k]);
                      return parameters_of(middle);
                    },
                    250,
                    {exact("Pq", std::hypot(left, half) / std::numbers::sqrt2)}});
}

}  // namespace
}  // namespace mezzotint::test
