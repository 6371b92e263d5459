#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/pattern/pattern.h"
#include "tests/forward/pattern/draws.h"

namespace mezzotint {
namespace {

using test::expect_drawn;
using test::mean_square_about;
using test::over_draws;
using test::square_grid;

const Noise noise{.scale = 32.0_um, .stretch = 2.0, .direction = 20.0_deg, .height = 8.0_um};
const Ridges ridges{.wavelength = 60.0_um, .direction = 30.0_deg, .height = 10.0_um, .skew = 0.4};
const Sinusoid sinusoid{.wavelength_u = 64.0_um, .wavelength_v = 128.0_um, .height = 6.0_um};

void expect_closed_form(const Pattern& pattern, double bias) {
  const auto expected = closed_form_slope_covariance(pattern);
  ASSERT_TRUE(expected.has_value());
  const auto drawn = over_draws(pattern, square_grid(768, 1.0), 12, [](const HeightField& field) {
    const SlopeCovariance slopes = slope_covariance(field);
    return std::vector{slopes.xx, slopes.yy, slopes.xy};
  });
  expect_drawn(drawn[0], expected->xx, bias, "xx");
  expect_drawn(drawn[1], expected->yy, bias, "yy");
  EXPECT_NEAR(drawn[2].mean, expected->xy, 4.0 * drawn[2].error + bias * (expected->xx + expected->yy)) << "xy";
}

TEST(PatternSum, AddsHeightsAndTheSlopesOfItsParts) {
  const Pattern sum = PatternSum{{{noise}, {ridges}, {noise}}};
  EXPECT_DOUBLE_EQ(height_of(sum).um(), 26.0);
  // 2 % of the facets hold an edge of the ridges; differences over 1/32 of a cell lose 0.3 %, the cut 0.5 %. Were the
  // two noises the same one, their slopes would be twice as large as here.
  expect_closed_form(sum, 0.025);
}

TEST(PatternProduct, HasTheSlopesOfIndependentFactors) {
  const Pattern product = PatternProduct{12.0_um, {{noise}, {sinusoid}}};
  EXPECT_DOUBLE_EQ(height_of(product).um(), 12.0);
  expect_closed_form(product, 0.015);
  // Three factors, the last of them a sum.
  expect_closed_form(PatternProduct{12.0_um, {{noise}, {ridges}, {PatternSum{{{noise}, {noise}}}}}}, 0.025);
}

TEST(PatternProduct, OfTwoGratingsIsTheirProductAtEverySample) {
  const Pattern other = Ridges{.wavelength = 60.0_um, .direction = 120.0_deg, .height = 10.0_um};
  const Grid grid = square_grid(100, 1.0);
  const HeightField one = synthesize(ridges, grid), two = synthesize(other, grid);
  const HeightField both = synthesize(PatternProduct{5.0_um, {{ridges}, {other}}}, grid);
  for (std::size_t i = 0; i < both.heights_um().size(); ++i) {
    EXPECT_NEAR(both.heights_um()[i], 5.0F * one.heights_um()[i] / 10.0F * two.heights_um()[i] / 10.0F, 1e-5);
  }
}

TEST(PatternProduct, HasNoClosedFormWherePeriodicPartsMayBeat) {
  const Ridges along{.wavelength = 61.0_um, .direction = 210.0_deg};  // the same axis as `ridges`
  EXPECT_FALSE(closed_form_slope_covariance(PatternProduct{5.0_um, {{ridges}, {along}}}).has_value());
  EXPECT_FALSE(closed_form_slope_covariance(PatternSum{{{ridges}, {along}}}).has_value());
  EXPECT_FALSE(closed_form_slope_covariance(PatternSum{{{sinusoid}, {sinusoid}}}).has_value());
  // A turn parts them; the sinusoid's diagonals are at ±63.4°.
  const Pattern turned = TurnedPattern{40.0_deg, {}, {{along}}};
  EXPECT_TRUE(closed_form_slope_covariance(PatternSum{{{ridges}, {turned}, {sinusoid}}}).has_value());
  const Ridges diagonal{.direction = Angle::from_radians(std::atan(0.5))};
  EXPECT_FALSE(closed_form_slope_covariance(PatternSum{{{sinusoid}, {diagonal}}}).has_value());
  // Three gratings may close a triangle of wave vectors: their sum is none the worse, their product is.
  const std::vector<PatternPart> three = {
      {Ridges{.direction = 0.0_deg}}, {Ridges{.direction = 60.0_deg}}, {Ridges{.direction = 120.0_deg}}};
  EXPECT_TRUE(closed_form_slope_covariance(PatternSum{three}).has_value());
  EXPECT_FALSE(closed_form_slope_covariance(PatternProduct{5.0_um, three}).has_value());
}

TEST(TurnedPattern, IsThePatternWithAnotherDirection) {
  const Grid grid = square_grid(64, 2.0);
  Ridges turned_ridges = ridges;
  turned_ridges.direction = 75.0_deg;
  Noise turned_noise = noise;
  turned_noise.direction = 65.0_deg;
  for (const auto& [before, after] : {std::pair<Pattern, Pattern>{ridges, turned_ridges}, {noise, turned_noise}}) {
    const auto closed = closed_form_slope_covariance(TurnedPattern{45.0_deg, {}, {{before}}}).value();
    EXPECT_NEAR(closed.xy, closed_form_slope_covariance(after)->xy, 1e-15);
  }
  const HeightField turned = synthesize(TurnedPattern{45.0_deg, {}, {{ridges}}}, grid);
  const HeightField direct = synthesize(turned_ridges, grid);
  for (std::size_t i = 0; i < turned.heights_um().size(); ++i) {
    // Slopes of 10 µm in 24 µm; the phase is known to 1e-15.
    EXPECT_NEAR(turned.heights_um()[i], direct.heights_um()[i], 1e-5);
  }
}

TEST(TurnedPattern, LeavesItsCentreWhereItIs) {
  const Position centre{26.0_um, 14.0_um};
  const HeightField before = synthesize(sinusoid, square_grid(32, 2.0));
  const HeightField after = synthesize(TurnedPattern{77.0_deg, centre, {{sinusoid}}}, square_grid(32, 2.0));
  EXPECT_NEAR(before.at(13, 7), after.at(13, 7), 1e-5);
  EXPECT_GT(std::abs(before.at(20, 20) - after.at(20, 20)), 0.01);
}

TEST(TurnedPattern, TurnsALineFieldWithItsNoise) {
  const LineIntegralConvolution lines{.scale = 24.0_um, .length = 200.0_um, .height = 10.0_um};
  const HeightField turned = synthesize(TurnedPattern{30.0_deg, {}, {{lines}}}, square_grid(600, 1.2));
  // 30 × 3.6 grains with slopes of 6.6 : 1: standard error √(1/108)/6.5 = 0.9°, and 0.3° for the triangles of a cell.
  EXPECT_LT(axis_difference(principal_axes(slope_covariance(turned)).rotation, 30.0_deg).degrees(), 3.0);
}

TEST(MaskedPattern, ShowsOnePartWhereTheMaskIsHighAndTheOtherElsewhere) {
  const Grid grid = square_grid(200, 2.0);
  const Ridges mask{.wavelength = 100.0_um};
  MaskedPattern masked{.threshold = 0.5, .parts = {{ridges}, {sinusoid}, {mask}}};
  const HeightField in = synthesize(ridges, grid), out = synthesize(sinusoid, grid), at = synthesize(mask, grid);
  const HeightField both = synthesize(masked, grid);
  EXPECT_DOUBLE_EQ(height_of(masked).um(), 10.0);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const float expected = at.heights_um()[i] >= 8.0F ? in.heights_um()[i] : out.heights_um()[i];
    EXPECT_NEAR(both.heights_um()[i], expected, 1e-5);
  }
  EXPECT_FALSE(closed_form_slope_covariance(masked).has_value());
  // Soft: between both, and half of each on the threshold itself (a quarter of the ridges' wavelength: 25 µm).
  masked.softness = 0.4;
  const HeightField soft = synthesize(masked, square_grid(200, 1.0));
  const HeightField fine_in = synthesize(ridges, square_grid(200, 1.0)),
                    fine_out = synthesize(sinusoid, square_grid(200, 1.0));
  EXPECT_NEAR(soft.at(25, 9), 0.5F * (fine_in.at(25, 9) + fine_out.at(25, 9)), 1e-5);
}

TEST(PatternRegions, PutEveryPartWhereItsLabelIs) {
  PatternRegions regions{.pixel = 20.0_um, .corner = {10.0_um, 0.0_um}, .columns = 2, .rows = 1, .labels = {7, 200}};
  regions.parts = {{ridges, 7}, {sinusoid, 200}};
  const Grid grid = square_grid(60, 2.0);
  const HeightField one = synthesize(ridges, grid), two = synthesize(sinusoid, grid), both = synthesize(regions, grid);
  for (std::size_t column = 0; column < 60; ++column) {
    const double x = 2.0 * static_cast<double>(column) - 10.0;
    const bool first = x - 40.0 * std::floor(x / 40.0) < 20.0;  // the picture repeats
    EXPECT_NEAR(both.at(column, 11), first ? one.at(column, 11) : two.at(column, 11), 1e-5) << column;
  }
}

TEST(PatternComposition, OfEqualSeedsHasIndependentParts) {
  // The variance of a sum of two is twice that of one, not four times.
  const Grid grid = square_grid(512, 4.0);
  const double one =
      mean_square_about(synthesize(PatternSum{{{noise}, {Noise{.scale = 1000.0_um, .height = 0.001_um}}}}, grid), 4.0);
  const double two = mean_square_about(synthesize(PatternSum{{{noise}, {noise}}}, grid), 8.0);
  EXPECT_NEAR(two / one, 2.0, 0.2);  // 64 × 32 cells: 2 % each
}

// Two gratings of one axis and one wavelength add to anything from none to twice either of them, by their phases: only
// over many draws with phases of their own are the slopes those of independent parts.
TEST(PatternComposition, IsDrawnWithAPhaseOfItsOwnForEachPart) {
  const Ridges grating{.wavelength = 60.0_um, .height = 6.0_um};
  const Grid grid = square_grid(240, 1.0);
  const auto slopes = [&](const Pattern& pattern, std::uint64_t seed) {
    return slope_covariance(synthesize(draw_instance(pattern, seed).pattern, grid)).xx;
  };
  const Pattern sum = PatternSum{{{grating}, {TurnedPattern{180.0_deg, {}, {{grating}}}}}};
  const double one = slopes(grating, 1);
  double mean = 0.0, least = HUGE_VAL, most = 0.0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const double found = slopes(sum, seed) / one;
    mean += found / 200.0;
    least = std::min(least, found);
    most = std::max(most, found);
  }
  // (2 − 4 |x|)·2 for a shift of x periods, uniform over 0 … 4: the mean of 200 is known to 0.082.
  EXPECT_NEAR(mean, 2.0, 0.33);
  EXPECT_LT(least, 0.2);
  EXPECT_GT(most, 3.8);
}

TEST(PatternComposition, DrawsTheSamePhasesForTheSameSeedWhateverItsNumbers) {
  Sinusoid other = sinusoid;
  other.wavelength_u = 99.0_um;
  const auto drawn = [](const Pattern& part) {
    const PatternInstance instance = draw_instance(PatternSum{{{ridges}, {part}, {part}}}, 5);
    const auto& parts = *parts_of(instance.pattern);
    return std::array{std::get<Ridges>(parts[0].pattern).phase, std::get<Sinusoid>(parts[1].pattern).phase_u,
                      std::get<Sinusoid>(parts[1].pattern).phase_v, std::get<Sinusoid>(parts[2].pattern).phase_u};
  };
  const auto phases = drawn(sinusoid);
  EXPECT_EQ(phases, drawn(other));
  EXPECT_EQ(std::set(phases.begin(), phases.end()).size(), phases.size());
}

TEST(PatternComposition, IsAValueOfItsOwn) {
  Pattern sum = PatternSum{{{noise}, {ridges}}};
  const Pattern copy = sum;
  std::get<PatternSum>(sum).parts[0].pattern = sinusoid;
  EXPECT_EQ(kind_name(parts_of(copy)->front().pattern), "noise");
  const PatternInstance drawn = draw_instance(copy, 99);
  EXPECT_EQ(randomness(parts_of(drawn.pattern)->front().pattern)->seed, 99U);
}

TEST(PatternComposition, RefusesWhatIsMissingOrTooMuch) {
  EXPECT_THROW(require_valid(PatternSum{{{noise}}}), InvalidInput);
  EXPECT_THROW(require_valid(PatternProduct{}), InvalidInput);
  EXPECT_THROW(require_valid(TurnedPattern{}), InvalidInput);
  EXPECT_THROW(require_valid(MaskedPattern{.parts = {{noise}, {noise}}}), InvalidInput);
  EXPECT_THROW(require_valid(PatternSum{{{noise}, {Noise{.stretch = NAN}}}}), InvalidInput);
  PatternRegions regions{.columns = 2, .rows = 1, .labels = {7, 200}, .parts = {{ridges, 7}}};
  EXPECT_THROW(require_valid(regions), InvalidInput) << "nobody has the label 200";
  regions.parts = {{ridges, 7}, {noise, 200}, {noise, 200}};
  EXPECT_THROW(require_valid(regions), InvalidInput);
  Pattern deep = noise;
  for (int level = 0; level < 8; ++level) deep = TurnedPattern{10.0_deg, {}, {{deep}}};
  EXPECT_THROW(require_valid(deep), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
