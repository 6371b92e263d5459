#include <numbers>

#include "forward/pattern/pattern.h"
#include "measurement/correction/plane.h"
#include "measurement/texture/profile.h"
#include "tests/stability/scene.h"
#include "tests/stability/surfaces.h"

namespace mezzotint {
namespace {

using test::percent;

constexpr const char* theme = "Measurement";

struct Spread {
  double mean = 0.0, deviation = 0.0;
};

Spread spread_of(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  const auto n = static_cast<double>(values.size());
  return {sum / n, std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)))};
}

HeightField thinned(const HeightField& field, std::size_t step) {
  const auto wider = static_cast<double>(step);
  const Grid& grid = field.grid();
  return test::field_of(
      {grid.columns / step, grid.rows / step, grid.pitch_x * wider, grid.pitch_y * wider}, [&](double x, double y) {
        return double{field.at(step * static_cast<std::size_t>(x), step * static_cast<std::size_t>(y))};
      });
}

TEST(Slopes, OfAFractalGrowWithTheResolution) {
  const FractionalBrownianMotion fractal{.scale = 128.0_um, .height = 20.0_um, .hurst = 0.5, .octaves = 9};
  const HeightField fine = synthesize(fractal, {512, 512, 0.25_um, 0.25_um});
  std::vector<AreaRoughness> found;
  for (const std::size_t step : {16, 8, 4, 2, 1}) found.push_back(area_roughness(thinned(fine, step)));
  const double growth = std::pow(found[4].Sdq.value / found[0].Sdq.value, 0.25);
  // Sdq as spacing^(H − 1): √2 a halving for H = ½, less by what octaves leave out.
  EXPECT_NEAR(growth, std::numbers::sqrt2, 0.1);
  EXPECT_NEAR(found[4].Sq.value, found[0].Sq.value, 0.02 * found[0].Sq.value);
  const std::string told = test::texture_note(thinned(fine, 4), "twice the spacing");
  EXPECT_FALSE(told.empty());
  EXPECT_TRUE(test::texture_note(test::texture(128, 16.0), "twice the spacing").empty());
  test::record(
      {theme, "Sdq, Sdr", "fractional Brownian motion (H = ½), spacings of 4, 2, 1, ½ and ¼ µm",
       fmt::format("Sq is {:.2f} µm at all of them; Sdq is {:.2f}, {:.2f}, {:.2f}, {:.2f} and {:.2f}: {:.2f} times "
                   "as much each time (2^(1 − H) = 1.41), without end. Sdr goes from {} to {}.",
                   found[4].Sq.value, found[0].Sdq.value, found[1].Sdq.value, found[2].Sdq.value, found[3].Sdq.value,
                   found[4].Sdq.value, growth, percent(found[0].Sdr.value), percent(found[4].Sdr.value)),
       "Sdq of every second sample; from a tenth less on it says so. The wavelengths that Sdq holds are always said.",
       told});
}

TEST(SpatialParameters, OfAFieldOfFewCorrelationLengthsAreTooSmall) {
  constexpr double side = 96.0;
  const auto of_fields = [&](double lengths) {
    std::vector<double> sal, str, sq;
    for (std::uint64_t seed = 50; seed < 70; ++seed) {
      const HeightField field = level(test::texture(96, side / lengths / 0.4755, seed));
      const SpatialParameters spatial = spatial_parameters(field);
      sal.push_back(spatial.Sal.value * lengths / side);
      str.push_back(spatial.Str.value);
      sq.push_back(area_roughness(field).Sq.value);
    }
    return std::array{spread_of(sal), spread_of(str), spread_of(sq)};
  };
  const auto few = of_fields(3.0), some = of_fields(6.0), many = of_fields(24.0);
  const std::string told =
      test::texture_note(level(test::texture(96, side / 6.0 / 0.4755, 50)), "correlation lengths wide");
  EXPECT_FALSE(told.empty());
  EXPECT_LT(few[0].mean, some[0].mean);
  EXPECT_LT(some[0].mean, many[0].mean);
  EXPECT_NEAR(many[0].mean, 1.0, 0.05);
  test::record(
      {theme, "Sal, Str, Sq", "fields 3, 6 and 24 correlation lengths wide; isotropic, 20 of each",
       fmt::format("Sal is {:.2f}, {:.2f} and {:.2f} of what it should be, Str {:.2f} ± {:.2f}, {:.2f} ± {:.2f} and "
                   "{:.2f} ± {:.2f} instead of 1, Sq {:.2f}, {:.2f} and {:.2f} of the endless surface's.",
                   few[0].mean, some[0].mean, many[0].mean, few[1].mean, few[1].deviation, some[1].mean,
                   some[1].deviation, many[1].mean, many[1].deviation, few[2].mean, some[2].mean, many[2].mean),
       "Sal against the field's width; below 16 it says so.", told});
}

TEST(StandardErrors, OfDependentBlocksAreTooSmall) {
  const auto held = [](double block_in_sal) {
    constexpr int fields = 100;
    double count = 0.0;
    for (std::uint64_t seed = 100; seed < 100 + fields; ++seed) {
      const Quantity sq = area_roughness(level(test::texture(96, 24.0 / block_in_sal / 0.4755, seed))).Sq;
      count += std::abs(sq.value - 1.0) < 2.0 * *sq.standard_error ? 1.0 : 0.0;
    }
    return count / fields;
  };
  const double one = held(1.0), two = held(2.0), four = held(4.0), eight = held(8.0);
  const std::string told =
      test::texture_note(level(test::texture(96, 24.0 / 2.0 / 0.4755, 101)), "correlation lengths wide");
  EXPECT_FALSE(told.empty());
  EXPECT_LT(one, 0.7);
  // Of 95 % in 100 fields: four binomial deviations.
  EXPECT_GT(eight, 0.86);
  test::record(
      {theme, "standard errors by 16 blocks", "blocks of 1, 2, 4 and 8 correlation lengths, 100 fields of each",
       fmt::format("Intervals of ± 2 standard errors hold the true Sq in {}, {}, {} and {} of the fields (95 % would "
                   "be right).",
                   percent(one), percent(two), percent(four), percent(eight)),
       "Sal against a block's side; from a quarter on it says so.", told});
}

TEST(Sz, IsAnExtremeThatGrowsWithTheArea) {
  const HeightField large = test::texture(1024, 8.0);
  const auto sz = [&](std::size_t side) { return area_roughness(crop(large, 0, 0, side, side)).Sz.value; };
  EXPECT_GT(sz(1024), sz(256));
  EXPECT_GT(sz(256), sz(64));
  const std::string told = test::texture_note(crop(large, 0, 0, 256, 256), "extreme");
  test::record({theme, "Sz", "the same texture on 64², 256² and 1024² µm",
                fmt::format("{:.1f}, {:.1f} and {:.1f} µm where Sq is 1 µm throughout. It has no standard error.",
                            sz(64), sz(256), sz(1024)),
                "Always said, with the mean over sixteenths of the field.", told});
}

TEST(Str, OfALayThatTurnsIsThatOfNoPart) {
  const auto lay = [](double radius_um, std::size_t side) {
    const double middle = 0.5 * static_cast<double>(side);
    return level(test::field_of(test::micrometre_grid(side, side), [&](double x, double y) {
      const double r = std::hypot(x - middle + radius_um, y - middle) - radius_um;
      return std::sin(2.0 * std::numbers::pi * r / 9.0);
    }));
  };
  const SpatialParameters rings = spatial_parameters(lay(0.0, 256)), part = spatial_parameters(lay(1000.0, 256)),
                          straight = spatial_parameters(lay(1e7, 64));
  EXPECT_GT(rings.Str.value, 0.9);
  EXPECT_NE(rings.note.find("turns"), std::string::npos) << rings.note;
  EXPECT_LT(part.Str.value, 0.1);
  EXPECT_NE(straight.note.find("at most"), std::string::npos) << straight.note;
  test::record({theme, "Str, Std", "turned rings (a wave of 9 µm), their centre in the field",
                fmt::format("Str is {:.2f}, as of an isotropic texture; 1 mm from the centre it is {:.3f}.",
                            rings.Str.value, part.Str.value),
                "Str of the whole against its mean over sixteenths; from 2.5 times on it says so.", rings.note});
  test::record({theme, "Str", "straight ridges longer than the field (64 µm)",
                fmt::format("Str is the field's width over theirs, {:.3f}, not the ridges' own.", straight.Str.value),
                "The autocorrelation does not fall to 0.2 within half of the field.", straight.note});
}

TEST(Profile, OfFewSamplingLengthsIsALottery) {
  const HeightField field = test::texture(640, 10.0);
  const auto of_lines = [&](double lengths) {
    std::vector<double> rz, rq;
    for (double y = 5.0; y < 635.0; y += 10.0) {
      const ProfileParameters found =
          profile_parameters(profile_along(field, {0.0, y}, {50.0 * lengths, y}), {.lambda_c = 50.0_um});
      rz.push_back(found.z.value);
      rq.push_back(found.q.value);
    }
    return std::pair{spread_of(rz), spread_of(rq)};
  };
  const auto [z1, q1] = of_lines(1.0);
  const auto [z2, q2] = of_lines(2.0);
  const auto [z5, q5] = of_lines(5.0);
  EXPECT_GT(z1.deviation, 1.5 * z5.deviation);
  EXPECT_LT(q1.mean, q5.mean);
  test::record(
      {theme, "profile parameters", "1, 2 and 5 sampling lengths of 50 µm, 63 lines of one texture",
       fmt::format("Rz is {:.2f} ± {:.2f}, {:.2f} ± {:.2f} and {:.2f} ± {:.2f} µm from line to line, Rq {} too small "
                   "with one length against five: the filter's ends are most of it.",
                   z1.mean, z1.deviation, z2.mean, z2.deviation, z5.mean, z5.deviation,
                   percent(1.0 - q1.mean / q5.mean)),
       "Sampling lengths are counted; below five it says so. With one there is no standard error.",
       "profile over 2 sampling lengths, 0 % of it missing; ISO 21920-3 takes five: Rz and the standard errors of "
       "fewer are not comparable"});
}

}  // namespace
}  // namespace mezzotint
