#include "measurement/texture/functional_parameters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "tests/measurement/relief.h"

namespace mezzotint {
namespace {

// 128² heights whose share above each is exactly that of a distribution, in a shuffled order.
template <class Quantile>
HeightField field_with(const Quantile& quantile) {
  HeightField field(test::micrometre_grid(128, 128), Continuation::Mirrored);
  const std::size_t n = field.grid().size();
  for (std::size_t k = 0; k < n; ++k)
    field.heights_um()[k * 7919 % n] =
        static_cast<float>(quantile((static_cast<double>(k) + 0.5) / static_cast<double>(n)));
  return field;
}

// By bisection of the complementary error function.
double gaussian_quantile(double above) {
  double low = -10.0, high = 10.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(middle / std::numbers::sqrt2) > above ? low : high) = middle;
  }
  return low;
}

TEST(FunctionalParameters, OfUniformHeightsAreTheClosedForm) {
  constexpr double h = 8.0;
  const FunctionalParameters p = functional_parameters(field_with([](double above) { return h * (1.0 - above); }));
  // 16384 heights: half a step at each end of the curve is h·3e-5.
  constexpr double tolerance = 4e-5 * h;
  EXPECT_NEAR(p.Sk.value, h, tolerance);
  EXPECT_NEAR(p.Spk.value, 0.0, tolerance);
  EXPECT_NEAR(p.Svk.value, 0.0, tolerance);
  EXPECT_NEAR(p.Smr1.value, 0.0, 1e-4);
  EXPECT_NEAR(p.Smr2.value, 1.0, 1e-4);
  // Triangles: ½·0.1²·h, ½·0.8²·h − that, ½·0.9²·h − ½·0.2²·h, ½·0.2²·h.
  EXPECT_NEAR(p.Vmp.value, 0.005 * h, tolerance);
  EXPECT_NEAR(p.Vmc.value, 0.315 * h, tolerance);
  EXPECT_NEAR(p.Vvc.value, 0.385 * h, tolerance);
  EXPECT_NEAR(p.Vvv.value, 0.02 * h, tolerance);
  EXPECT_NEAR(p.Sxp.value, 0.475 * h, tolerance);
}

TEST(FunctionalParameters, OfGaussianHeightsAreTheClosedForm) {
  const FunctionalParameters p = functional_parameters(field_with(gaussian_quantile));
  // The flattest 40 % lie about the median, |z| < c = z(0.3). The line of least squares there falls by
  // ∫ z (Φ − ½) φ dz / (2·0.2³/3) = (erf(c)/(2√π) − 0.4 φ(c)) / (2·0.2³/3) = 2.57398; the secant falls by 2.622.
  const double c = gaussian_quantile(0.3), phi_c = std::exp(-0.5 * c * c) / std::sqrt(2.0 * std::numbers::pi);
  const double sk = (std::erf(c) / std::sqrt(4.0 * std::numbers::pi) - 0.4 * phi_c) / (2.0 * 0.008 / 3.0);
  const double edge = 0.5 * sk;
  const double above = 0.5 * std::erfc(edge / std::numbers::sqrt2);
  const double density = std::exp(-0.5 * edge * edge) / std::sqrt(2.0 * std::numbers::pi);
  const double spk = 2.0 * (density - edge * above) / above;  // E(z − edge; z > edge) = φ − edge·Q
  EXPECT_NEAR(p.Sk.value, sk, 2e-4);                          // the line is sought in steps of 1e-4 of material ratio
  EXPECT_NEAR(p.Spk.value, spk, 2e-3);
  EXPECT_NEAR(p.Svk.value, spk, 2e-3);
  EXPECT_NEAR(p.Smr1.value, above, 2e-4);
  EXPECT_NEAR(p.Smr2.value, 1.0 - above, 2e-4);
  const double z10 = gaussian_quantile(0.1), phi10 = std::exp(-0.5 * z10 * z10) / std::sqrt(2.0 * std::numbers::pi);
  EXPECT_NEAR(p.Vmp.value, phi10 - 0.1 * z10, 2e-4);
  EXPECT_NEAR(p.Sxp.value, 1.95996, 2e-3);  // z(0.025), a table's figure; a step of the curve there is 1e-3
}

TEST(FunctionalParameters, HaveStandardErrorsOfTheSizeThatDrawsScatterBy) {
  double sum = 0.0, squares = 0.0, stated = 0.0;
  constexpr int draws = 40;
  for (int i = 0; i < draws; ++i) {
    const FunctionalParameters p = functional_parameters(test::white_noise(test::micrometre_grid(64, 64), 100 + i));
    sum += p.Sk.value;
    squares += p.Sk.value * p.Sk.value;
    stated += std::pow(*p.Sk.standard_error, 2);
  }
  const double scatter = (squares - sum * sum / draws) / (draws - 1);
  // A variance of 40 draws scatters by √(2/39) = 23 %, three of these.
  EXPECT_NEAR(stated / draws / scatter, 1.0, 0.7);
}

TEST(BearingCurve, GoesFromTheHighestToTheLowest) {
  const BearingCurve curve({1.0F, 4.0F, 2.0F, 3.0F});
  EXPECT_EQ(curve.height_um(0.0), 4.0);
  EXPECT_EQ(curve.height_um(1.0), 1.0);
  EXPECT_EQ(curve.height_um(0.5), 2.5);
  EXPECT_EQ(curve.ratio(2.5), 0.5);
  EXPECT_EQ(curve.ratio(5.0), 0.0);
  EXPECT_EQ(curve.ratio(1.0), 1.0);
  EXPECT_NEAR(curve.integral_um(0.0, 1.0), 2.5, 1e-15);  // the mean
  EXPECT_THROW(BearingCurve(std::vector<float>{1.0F, 2.0F, 3.0F}), InvalidInput);
}

// Of so many samples the curve is counted, not sorted. Two levels with a gap between them are no less sharp for it.
TEST(BearingCurve, OfManySamplesIsTheSortedOneToABinOfItsRange) {
  const HeightField noise = test::white_noise(test::micrometre_grid(512, 400), 4);
  HeightField field = noise;
  for (std::size_t i = 0; i < field.grid().size(); i += 3) field.heights_um()[i] += 20.0F;
  const BearingCurve counted(field), sorted({field.heights_um().begin(), field.heights_um().end()});
  const HeightRange range = height_range(field);
  const double bin_um = (range.highest - range.lowest).um() / 65536.0;
  for (double p = 0.0005; p < 1.0; p += 0.001) {
    // Where the sorted curve steps from one height to the next, half a step of ratio is what the two may be apart.
    const double half = 0.5 / static_cast<double>(field.grid().size());
    EXPECT_LE(counted.height_um(p), sorted.height_um(p - 2.0 * half) + bin_um) << p;
    EXPECT_GE(counted.height_um(p), sorted.height_um(p + 2.0 * half) - bin_um) << p;
    EXPECT_NEAR(counted.integral_um(0.0, p), sorted.integral_um(0.0, p), bin_um) << p;
  }
  for (const double z : {-2.0, 0.0, 1.0, 10.0, 19.0, 21.5})
    EXPECT_NEAR(counted.ratio(z), sorted.ratio(z), 2e-5) << z;  // four samples of 204800
}

TEST(FunctionalParameters, OfManySamplesAreThoseOfTheSortedCurve) {
  // The same heights eleven times over: counted, while the single field is sorted.
  const HeightField one = field_with(gaussian_quantile);
  HeightField many(test::micrometre_grid(128, 128 * 11), Continuation::Mirrored);
  for (std::size_t i = 0; i < many.grid().size(); ++i) many.heights_um()[i] = one.heights_um()[i % one.grid().size()];
  const FunctionalParameters a = functional_parameters(one), b = functional_parameters(many);
  // Bins of 1/65536 of 8 µm; steps at the ends of the sorted curve are wider.
  EXPECT_NEAR(a.Sk.value, b.Sk.value, 3e-4);
  // Half a step of ratio at an end, over the 2.7 µm beyond the line and twice over its share of 0.095: 1.7e-3.
  EXPECT_NEAR(a.Spk.value, b.Spk.value, 1.7e-3);
  EXPECT_NEAR(a.Svk.value, b.Svk.value, 1.7e-3);
  EXPECT_NEAR(a.Smr1.value, b.Smr1.value, 2e-4);
  EXPECT_NEAR(a.Vmp.value, b.Vmp.value, 1e-4);
  EXPECT_NEAR(a.Vvv.value, b.Vvv.value, 1e-4);
  EXPECT_NEAR(a.Sxp.value, b.Sxp.value, 1e-3);
}

}  // namespace
}  // namespace mezzotint
