#include "measurement/texture/profile.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "tests/measurement/relief.h"

namespace mezzotint {
namespace {

constexpr double pi = std::numbers::pi;

Profile wave_of(double amplitude_um, double wavelength_um, std::size_t count = 4000, double spacing_um = 0.5) {
  Profile profile{Length::from_um(spacing_um), {}};
  // Symmetric about the middle, so that the least-squares line is level.
  const double middle = 0.5 * static_cast<double>(count - 1);
  for (std::size_t k = 0; k < count; ++k)
    profile.heights_um.push_back(amplitude_um *
                                 std::cos(2.0 * pi * (static_cast<double>(k) - middle) * spacing_um / wavelength_um));
  return profile;
}

TEST(ProfileParameters, OfASineAreTheClosedForm) {
  // 50 whole waves: an element must be wider than 1 % of the profile, and is 2 % of it.
  const ProfileParameters p = profile_parameters(wave_of(3.0, 20.0, 2000));
  EXPECT_EQ(p.letter, 'P');
  EXPECT_NEAR(p.a.value, 2.0 * 3.0 / pi, 5e-3);
  EXPECT_NEAR(p.q.value, 3.0 / std::numbers::sqrt2, 1e-3);
  EXPECT_NEAR(p.t.value, 6.0, 0.03);  // the crest lies between two samples, 1 − cos(π/40) at the most
  EXPECT_NEAR(p.sk.value, 0.0, 1e-3);
  EXPECT_NEAR(p.ku.value, 1.5, 1e-3);
  EXPECT_NEAR(p.dq.value, 3.0 * 2.0 * pi / 20.0 / std::numbers::sqrt2, 1e-3);
  EXPECT_NEAR(p.sm.value, 20.0, 1e-2);
}

TEST(ProfileParameters, RoughnessIsWhatTheCutoffLeaves) {
  // 20 µm passes a cut-off of 250 µm by 1 − 2^(−(250/20)²) = 1; 1000 µm by 1 − 2^(−1/16) = 0.0424.
  Profile profile = wave_of(3.0, 20.0, 8000);
  const Profile wave = wave_of(10.0, 1000.0, 8000);
  for (std::size_t k = 0; k < 8000; ++k) profile.heights_um[k] += wave.heights_um[k];
  const ProfileParameters r = profile_parameters(profile, {Length{}, Length::from_um(250.0)});
  EXPECT_EQ(r.letter, 'R');
  EXPECT_EQ(r.sampling_lengths, 16U);
  EXPECT_NEAR(r.q.value, std::hypot(3.0, 10.0 * 0.0424) / std::numbers::sqrt2, 0.02);  // ends
  EXPECT_NEAR(r.sm.value, 20.0, 0.1);
  EXPECT_TRUE(std::isfinite(*r.z.standard_error));
}

TEST(MeanLine, PassesHalfOfAWaveAsLongAsItsCutoffAndAnyTilt) {
  const Profile line = mean_line(wave_of(1.0, 50.0), Length::from_um(50.0));
  for (std::size_t k = 500; k < 3500; ++k)
    EXPECT_NEAR(line.heights_um[k], 0.5 * wave_of(1.0, 50.0).heights_um[k], 1e-6);
  Profile tilt{Length::from_um(1.0), {}};
  for (int k = 0; k < 300; ++k) tilt.heights_um.push_back(k % 7 == 0 ? std::nan("") : 0.25 * k);
  const Profile same = mean_line(tilt, Length::from_um(40.0));
  for (std::size_t k = 0; k < 300; ++k) {
    if (k % 7 == 0)
      EXPECT_TRUE(std::isnan(same.heights_um[k]));
    else
      EXPECT_NEAR(same.heights_um[k], tilt.heights_um[k], 1e-10);
  }
}

TEST(ProfileParameters, AnElementThatAGapInterruptsDoesNotCount) {
  Profile profile = wave_of(3.0, 20.0, 2000);
  // Gaps of an eighth of a wave, every 13 waves: an element across one would be 20 µm too long or too short.
  for (std::size_t k = 0; k < 2000; ++k)
    if (k % 531 < 5) profile.heights_um[k] = std::nan("");
  const ProfileParameters p = profile_parameters(profile);
  EXPECT_NEAR(p.sm.value, 20.0, 1e-3);  // chords between samples a fortieth of a wave apart
  EXPECT_LT(*p.sm.standard_error, 1e-3);
}

TEST(ProfileParameters, HaveStandardErrorsFromTheirSamplingLengths) {
  double stated = 0.0, sum = 0.0, squares = 0.0;
  constexpr int draws = 60;
  for (int i = 0; i < draws; ++i) {
    const RandomStream random(900 + static_cast<std::uint64_t>(i), RandomPurpose::Test);
    Profile profile{Length::from_um(1.0), {}};
    for (std::uint64_t k = 0; k < 2000; ++k) profile.heights_um.push_back(random.normal4(k)[0]);
    const ProfileParameters r = profile_parameters(profile, {Length{}, Length::from_um(100.0)});
    stated += std::pow(*r.ku.standard_error, 2) / draws;
    sum += r.ku.value;
    squares += r.ku.value * r.ku.value;
  }
  // A variance of 60 draws scatters by √(2/59) = 18 %, one of 20 lengths by 32 % (more for fourth powers).
  EXPECT_NEAR(stated * (draws - 1) / (squares - sum * sum / draws), 1.0, 0.6);
}

TEST(Profile, FollowsALineInAnyDirection) {
  const HeightField field =
      test::field_of(test::micrometre_grid(60, 40), [](double c, double r) { return 0.5 * c - 0.2 * r; });
  const Profile profile = profile_along(field, {5.0, 35.0}, {53.0, 3.0});
  EXPECT_EQ(profile.heights_um.size(), 49U);
  EXPECT_NEAR(profile.spacing.um(), std::hypot(48.0, 32.0) / 48.0, 1e-12);
  EXPECT_NEAR(profile.heights_um.front(), 0.5 * 5.0 - 0.2 * 35.0, 1e-5);
  EXPECT_NEAR(profile.heights_um.back(), 0.5 * 53.0 - 0.2 * 3.0, 1e-5);
  EXPECT_THROW((void)profile_along(field, {0.0, 0.0}, {60.0, 0.0}), InvalidInput);
  EXPECT_THROW((void)profile_along(field, {0.0, 0.0}, {10.0, 0.0}), InvalidInput);
}

TEST(ProfileParameters, RefuseAProfileShorterThanItsSamplingLength) {
  EXPECT_THROW((void)profile_parameters(wave_of(1.0, 20.0, 400), {Length{}, Length::from_um(800.0)}), InvalidInput);
  EXPECT_THROW((void)profile_parameters({Length::from_um(1.0), std::vector<double>(15, 0.0)}), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
