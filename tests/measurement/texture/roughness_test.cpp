#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "measurement/texture/block_jackknife.h"
#include "measurement/texture/roughness.h"

namespace mezzotint {
namespace {

constexpr double pi = std::numbers::pi;
constexpr float missing = std::numeric_limits<float>::quiet_NaN();

template <class Height>
HeightField field_of(const Grid& grid, Continuation continuation, const Height& height_um) {
  HeightField field(grid, continuation);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      field.at(column, row) = static_cast<float>(height_um(static_cast<double>(column), static_cast<double>(row)));
    }
  }
  return field;
}

Grid square_grid(std::size_t side, double pitch_um = 1.0) {
  return {side, side, Length::from_um(pitch_um), Length::from_um(pitch_um)};
}

// H/2 · sin sin: Sq = H/4, Sa = 2H/π², Ssk = 0, Sku = 9/4.
TEST(AreaRoughness, OfTheSineProductIsTheClosedForm) {
  constexpr double height_um = 8.0, period = 64.0, pitch_um = 0.5;
  const double k = 2.0 * pi / period;
  const auto field = field_of(square_grid(256, pitch_um), Continuation::Periodic, [&](double c, double r) {
    return 0.5 * height_um * std::sin(k * (c + 0.5)) * std::sin(k * (r + 0.5));
  });
  const AreaRoughness result = area_roughness(field);
  // Sums of whole periods are exact for moments up to the fourth, but for the float heights (6e-8).
  EXPECT_NEAR(result.Sq.value, height_um / 4.0, 1e-6);
  EXPECT_NEAR(result.Ssk.value, 0.0, 1e-6);
  EXPECT_NEAR(result.Sku.value, 9.0 / 4.0, 1e-6);
  // |sin| has a kink; midpoints of 64 a period leave (π/64)²/6 = 4e-4 in each of the two means, both too high.
  const double midpoint_mean = pi / period / std::sin(pi / period);
  EXPECT_NEAR(result.Sa.value, 2.0 * height_um / (pi * pi) * midpoint_mean * midpoint_mean, 1e-6);
  EXPECT_NEAR(result.Sa.value, 2.0 * height_um / (pi * pi), 1e-3 * result.Sa.value);
  // The crests lie half a sample beside a sample.
  EXPECT_NEAR(result.Sz.value, height_um * std::pow(std::cos(pi / period), 2), 1e-6);
  // The slope of the facets is the chord's, 2 sin(k dx/2)/dx in place of k.
  const double chord = 2.0 * std::sin(0.5 * k) / pitch_um;
  EXPECT_NEAR(result.Sdq.value, height_um / 4.0 * chord * std::sqrt(2.0), 1e-6);
  EXPECT_EQ(result.samples, 65536U);
  EXPECT_EQ(result.missing, 0U);
}

TEST(AreaRoughness, DevelopedAreaOfAPlaneIsExact) {
  // A plane of slope (1, 1) has √3 times the area of its projection, at any pitch.
  const Grid grid{9, 7, Length::from_um(0.5), Length::from_um(2.0)};
  const auto field = field_of(grid, Continuation::Mirrored, [](double c, double r) { return 0.5 * c + 2.0 * r; });
  const AreaRoughness result = area_roughness(field);
  EXPECT_NEAR(result.Sdr.value, std::sqrt(3.0) - 1.0, 1e-15);  // .7320508; exact floats, a few roundings
  EXPECT_NEAR(result.Sdr.value, 0.7320508, 5e-8);
  EXPECT_NEAR(result.Sdq.value, std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(*result.Sdr.standard_error, 0.0, 1e-14);  // every facet is alike
}

TEST(AreaRoughness, DevelopedAreaOfAFaintReliefDoesNotCancel) {
  // s²/2 for a slope of 2^-17 is 2.9e-11, where √(1+s²) − 1 in floats would be 0.
  const double slope = std::ldexp(1.0, -17);
  const auto field = field_of(square_grid(8), Continuation::Mirrored, [&](double c, double) { return slope * c; });
  EXPECT_NEAR(area_roughness(field).Sdr.value / (0.5 * slope * slope), 1.0, 1e-10);  // the next term is s²/4 of it
}

TEST(AreaRoughness, APeriodicFieldHasTheCellsThatCloseIt) {
  // One row of ridges: up 1, down 1 over four samples of 1 µm; mirrored it has 3 columns of cells, of slopes 0, 1, 0.
  const auto steps = [](double c, double) { return c < 2.0 ? 0.0 : 1.0; };
  EXPECT_DOUBLE_EQ(area_roughness(field_of(square_grid(4), Continuation::Mirrored, steps)).Sdq.value,
                   std::sqrt(1.0 / 3.0));
  EXPECT_DOUBLE_EQ(area_roughness(field_of(square_grid(4), Continuation::Periodic, steps)).Sdq.value,
                   std::sqrt(2.0 / 4.0));
}

// Five heights by hand: mean 2, deviations −2 −1 0 −1 4.
TEST(AreaRoughness, MissingSamplesAreLeftOut) {
  const Grid grid{3, 2, Length::from_um(1.0), Length::from_um(1.0)};
  const HeightField field(grid, Continuation::Mirrored, {0.0F, 1.0F, 2.0F, 1.0F, 6.0F, missing});
  const AreaRoughness result = area_roughness(field);
  EXPECT_EQ(result.samples, 5U);
  EXPECT_EQ(result.missing, 1U);
  const double variance = (4.0 + 1.0 + 0.0 + 1.0 + 16.0) / 5.0;
  EXPECT_DOUBLE_EQ(result.Sa.value, (2.0 + 1.0 + 0.0 + 1.0 + 4.0) / 5.0);
  EXPECT_DOUBLE_EQ(result.Sq.value, std::sqrt(variance));
  EXPECT_DOUBLE_EQ(result.Sz.value, 6.0);
  EXPECT_DOUBLE_EQ(result.Sp.value, 4.0);
  EXPECT_DOUBLE_EQ(result.Sv.value, 2.0);
  EXPECT_DOUBLE_EQ(result.Ssk.value, (-8.0 - 1.0 - 1.0 + 64.0) / 5.0 / std::pow(variance, 1.5));
  EXPECT_DOUBLE_EQ(result.Sku.value, (16.0 + 1.0 + 1.0 + 256.0) / 5.0 / (variance * variance));
  // One whole cell; its triangles have the slopes (1, 5) and (5, 1).
  EXPECT_DOUBLE_EQ(result.Sdq.value, std::sqrt(26.0));
}

TEST(AreaRoughness, AnOffsetDoesNotMatter) {
  const auto wave = [](double c, double r) { return std::round(256.0 * std::sin(0.7 * c + 0.3 * r)) / 256.0; };
  const AreaRoughness low = area_roughness(field_of(square_grid(64), Continuation::Mirrored, wave));
  const AreaRoughness high = area_roughness(
      field_of(square_grid(64), Continuation::Mirrored, [&](double c, double r) { return wave(c, r) + 1024.0; }));
  // Both fields are exact in float; the mean is right to 1e-13 µm.
  EXPECT_NEAR(high.Sq.value, low.Sq.value, 1e-12);
  EXPECT_NEAR(high.Ssk.value, low.Ssk.value, 1e-11);
  EXPECT_NEAR(*high.Sa.standard_error, *low.Sa.standard_error, 1e-11);
}

TEST(AreaRoughness, AFlatFieldHasNoShape) {
  const AreaRoughness result = area_roughness(HeightField(square_grid(8), Continuation::Mirrored));
  EXPECT_EQ(result.Sq.value, 0.0);
  EXPECT_EQ(result.Sdr.value, 0.0);
  EXPECT_TRUE(std::isnan(result.Ssk.value));
  EXPECT_TRUE(std::isnan(result.Sku.value));
}

TEST(AreaRoughness, NamesItsUnitsAndGivesTheExtremeNoStandardError) {
  const auto field = field_of(square_grid(8), Continuation::Mirrored, [](double c, double r) { return c * r; });
  const AreaRoughness result = area_roughness(field);
  EXPECT_EQ(result.Sa.unit, "µm");
  EXPECT_EQ(result.Sdr.unit, "1");
  EXPECT_TRUE(std::isnan(*result.Sz.standard_error));
}

TEST(AreaRoughness, RefusesAFieldWithTooFewSamplesOrNoCell) {
  const Grid line{9, 1, Length::from_um(1.0), Length::from_um(1.0)};
  EXPECT_THROW(static_cast<void>(area_roughness(HeightField(line, Continuation::Mirrored))), InvalidInput);
  const HeightField three(square_grid(2), Continuation::Mirrored, {1.0F, missing, 2.0F, 3.0F});
  EXPECT_THROW(static_cast<void>(area_roughness(three)), InvalidInput);
}

/// Mean square of the stated standard errors over independent realisations, against the truth.
struct Honesty {
  double Sa = 0.0, Sq = 0.0, Ssk = 0.0, Sku = 0.0;
};

constexpr int realisations = 100;

// `grain` samples in a row and column share one Gaussian height of standard deviation 1.
Honesty stated_variances(std::size_t side, std::size_t grain, std::size_t missing_rows = 0) {
  Honesty sums;
  for (int i = 0; i < realisations; ++i) {
    const RandomStream random(1000 + static_cast<std::uint64_t>(i), RandomPurpose::Test);
    HeightField field(square_grid(side), Continuation::Mirrored);
    for (std::size_t row = 0; row < side; ++row) {
      for (std::size_t column = 0; column < side; ++column) {
        const std::size_t index = row / grain * side + column / grain;
        field.at(column, row) =
            row < missing_rows && column < side / 2 ? missing : static_cast<float>(random.normal4(index)[0]);
      }
    }
    const AreaRoughness result = area_roughness(field);
    const auto square = [](const Quantity& quantity) { return std::pow(*quantity.standard_error, 2) / realisations; };
    sums.Sa += square(result.Sa);
    sums.Sq += square(result.Sq);
    sums.Ssk += square(result.Ssk);
    sums.Sku += square(result.Sku);
  }
  return sums;
}

// A variance from 16 blocks scatters by √(2/15) = 37 %, its mean over 100 realisations by 3.7 %; four of these.
constexpr double scatter = 0.15;

TEST(Jackknife, IsHonestOnWhiteNoise) {
  constexpr double n = 64.0 * 64.0;
  const Honesty stated = stated_variances(64, 1);
  EXPECT_NEAR(stated.Sq * 2.0 * n, 1.0, scatter);               // SE(Sq) = Sq/√(2n)
  EXPECT_NEAR(stated.Sa * n / (1.0 - 2.0 / pi), 1.0, scatter);  // the variance of |z|
  EXPECT_NEAR(stated.Ssk * n / 6.0, 1.0, scatter);              // Gaussian: 6/n
  EXPECT_NEAR(stated.Sku * n / 24.0, 1.0, 2.0 * scatter);       // 24/n; fourth powers scatter more
}

TEST(Jackknife, RespectsTheCorrelationOfNeighbours) {
  // Grains of 4 × 4 samples: 16 times fewer independent heights.
  constexpr double n = 128.0 * 128.0 / 16.0;
  const Honesty stated = stated_variances(128, 4);
  EXPECT_NEAR(stated.Sq * 2.0 * n, 1.0, scatter);
  EXPECT_NEAR(stated.Sa * n / (1.0 - 2.0 / pi), 1.0, scatter);
}

TEST(Jackknife, IsHonestWhereBlocksAreOfUnequalSize) {
  // 40 of 64 rows are missing in the left half: four blocks are empty, and two are cut in half.
  constexpr double n = 64.0 * 64.0 - 40.0 * 32.0;
  const Honesty stated = stated_variances(64, 1, 40);
  EXPECT_NEAR(stated.Sq * 2.0 * n, 1.0, 1.3 * scatter);  // fewer blocks
}

// The delete-one jackknife of a mean is the textbook standard error s/√n.
TEST(Jackknife, OfAMeanIsTheTextbookStandardError) {
  const std::vector<double> values = {1.0, 4.0, 2.0, 8.0, 5.0};
  const double mean = 4.0;
  std::vector<double> without;
  double squares = 0.0;
  for (const double value : values) {
    without.push_back((5.0 * mean - value) / 4.0);
    squares += (value - mean) * (value - mean);
  }
  const std::vector<double> ones(5, 1.0);
  EXPECT_NEAR(jackknife_standard_error(mean, without, ones), std::sqrt(squares / 4.0 / 5.0), 1e-14);
}

TEST(Jackknife, HasNothingToSayAboutASingleBlock) {
  EXPECT_TRUE(std::isnan(jackknife_standard_error(1.0, std::vector<double>{0.0, 1.0}, std::vector<double>{4.0, 0.0})));
}

}  // namespace
}  // namespace mezzotint
