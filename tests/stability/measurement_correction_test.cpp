#include <numbers>

#include "measurement/correction/fill.h"
#include "measurement/correction/flatten_base.h"
#include "measurement/correction/outliers.h"
#include "measurement/correction/plane.h"
#include "measurement/correction/polynomial.h"
#include "measurement/correction/step_lines.h"
#include "tests/stability/scene.h"
#include "tests/stability/surfaces.h"

namespace mezzotint {
namespace {

using test::percent;

constexpr const char* theme = "Measurement";
constexpr std::size_t side = 256;

/// Heights by `shape`, on a roughness of so many µm.
template <class Shape>
HeightField rough(double sq_um, const Shape& shape, std::size_t samples = side) {
  const HeightField ground = test::texture(samples, 6.0);
  return test::field_of(test::micrometre_grid(samples, samples), [&](double x, double y) {
    return shape(x, y) + sq_um * double{ground.at(static_cast<std::size_t>(x), static_cast<std::size_t>(y))};
  });
}

/// Round bumps of 8 µm, 16 µm across, on a lattice of 50 µm (8 % of the area), on a bowed base.
HeightField bumps_on(double bow_um) {
  constexpr std::size_t samples = 512;
  return rough(
      0.01,
      [bow_um](double x, double y) {
        const double dx = std::remainder(x - 12.0, 50.0), dy = std::remainder(y - 12.0, 50.0);
        const double u = 2.0 * x / (samples - 1) - 1.0, v = 2.0 * y / (samples - 1) - 1.0;
        return 8.0 * std::max(0.0, 1.0 - (dx * dx + dy * dy) / 64.0) + bow_um * (u * u + 0.5 * v * v);
      },
      samples);
}

double highest_over_base_um(const HeightField& flat) { return height_range(flat).highest.um(); }

TEST(OutlierMask, OfTheSlidesOrderTakesTheBumps) {
  const HeightField scan = bumps_on(17.0);
  const OutlierResult first = mask_outliers(scan, 3.0);
  const FlattenedBase flat = flatten_base(fill_missing(first.field));
  const OutlierResult second = mask_outliers(flat.field, 3.0), hidden = mask_outliers(bumps_on(25.0), 3.0);
  const double left = highest_over_base_um(fill_missing(second.field));
  const double right = highest_over_base_um(flatten_base(scan).field);
  EXPECT_GT(second.removed, 3 * first.removed);
  EXPECT_FALSE(first.warning.empty());
  EXPECT_FALSE(second.warning.empty());
  EXPECT_TRUE(hidden.warning.empty());
  EXPECT_LT(left, 0.6 * right);
  EXPECT_NEAR(right, 8.0, 0.3);
  test::record(
      {theme, "`correct --outliers 3 --fill --level base --outliers 3 --fill`",
       "bumps of 8 µm over 8 % of a base bowed by 17 µm",
       fmt::format(
           "The slides' order takes {} samples first, while the bow hides most bumps, and {} when the base is flat: "
           "bumps of {:.1f} µm are left with {:.1f} µm. It warns both times; on a bow of 25 µm the first pass takes "
           "{}, too few to tell, and says nothing. Flatten the base first, and leave the mask out.",
           first.removed, second.removed, right, left, hidden.removed),
       "How many go against Gaussian heights, whether they lie side by side, and whether all lie on one side.",
       second.warning});
}

TEST(LocalOutlierMask, TakesFeaturesNarrowerThanFiveSamples) {
  const auto taken = [](double radius) {
    const HeightField scan = rough(0.1, [&](double x, double y) {
      return std::hypot(std::remainder(x - 8.0, 16.0), std::remainder(y - 8.0, 16.0)) <= radius ? 5.0 : 0.0;
    });
    return mask_local_outliers(scan, 8.0);
  };
  const OutlierResult one = taken(0.4), three = taken(1.5), seven = taken(3.0);
  EXPECT_EQ(one.removed, 256U);
  EXPECT_TRUE(one.warning.empty());
  EXPECT_EQ(three.removed, 9U * 256U);
  EXPECT_FALSE(three.warning.empty());
  EXPECT_LT(seven.removed, 29U * 256U / 3U);
  test::record({theme, "`correct --local-outliers 8`", "posts 1, 3 and 7 samples wide",
                fmt::format("All {} samples of single posts go, all {} of those 3 wide, and the corners ({} of {}) of "
                            "those 7 wide.",
                            one.removed, three.removed, seven.removed, 29 * 256),
                "Posts of one sample are not noticed: nothing tells them from spikes. Wider ones lie side by side.",
                three.warning});
}

HeightField with_hole(const HeightField& field, double diameter) {
  HeightField holed = field;
  const double middle = 0.5 * static_cast<double>(side);
  for (std::size_t row = 0; row < side; ++row)
    for (std::size_t column = 0; column < side; ++column)
      if (std::hypot(static_cast<double>(column) - middle, static_cast<double>(row) - middle) < 0.5 * diameter)
        holed.at(column, row) = test::missing;
  return holed;
}

// Of the heights that stand in for missing ones, the RMS over that of the heights that were there.
double kept_in_hole(const HeightField& whole, const HeightField& holed, const HeightField& filled) {
  double there = 0.0, here = 0.0;
  for (std::size_t i = 0; i < whole.grid().size(); ++i) {
    if (!std::isnan(holed.heights_um()[i])) continue;
    there += std::pow(double{whole.heights_um()[i]}, 2);
    here += std::pow(double{filled.heights_um()[i]}, 2);
  }
  return std::sqrt(here / there);
}

TEST(Fill, OfAHoleWiderThanTheTextureIsTooFlat) {
  constexpr double sal_um = 0.4755 * 20.0;
  const HeightField whole = test::texture(side, 20.0);
  const double sq = area_roughness(whole).Sq.value;
  std::vector<double> kept, lost;
  std::string told;
  for (const double in_sal : {1.0, 4.0, 16.0}) {
    const HeightField holed = with_hole(whole, in_sal * sal_um), filled = fill_missing(holed);
    kept.push_back(kept_in_hole(whole, holed, filled));
    lost.push_back(1.0 - area_roughness(filled).Sq.value / sq);
    told = fill_warning(holed, filled);
    EXPECT_EQ(told.empty(), in_sal < 8.0) << told;
  }
  EXPECT_LT(kept[2], 0.5);
  test::record(
      {theme, "`correct --fill`",
       "one hole of 1, 4 and 16 correlation lengths (Sal) across, 0.1, 2 and 28 % of the field",
       fmt::format(
           "Laplace's equation spans holes like a soap film: {}, {} and {} of the RMS height that was there. Sq of "
           "the whole falls by {}, {} and {}.",
           percent(kept[0]), percent(kept[1]), percent(kept[2]), percent(lost[0]), percent(lost[1]), percent(lost[2])),
       "Slopes of the whole against those between measured neighbours; from 1 % on it warns.", told});
}

TEST(FlattenBase, TakesPlateausOverHalfOfTheSurfaceForTheBase) {
  const auto base_of = [](double plateaus) {
    return flatten_base(rough(0.05,
                              [&](double x, double) {
                                const double u = x / 127.5 - 1.0;
                                return (std::fmod(x, 32.0) < 32.0 * plateaus ? 5.0 : 0.0) + 10.0 * u * u;
                              }),
                        4);
  };
  const FlattenedBase less = base_of(0.45), more = base_of(0.55);
  EXPECT_NEAR(height_range(less.field).highest.um(), 5.0, 0.4);
  EXPECT_NEAR(height_range(more.field).lowest.um(), -5.0, 0.4);
  EXPECT_TRUE(less.warning.empty());
  EXPECT_FALSE(more.warning.empty());
  test::record(
      {theme, "`correct --level base`", "plateaus of 5 µm over 45 % and 55 % of a bowed base",
       fmt::format("With 45 % the base is found ({} of the samples). With 55 % the plateaus are taken for it, and "
                   "the base comes out {:.1f} µm deep; either is made flat.",
                   percent(less.base_share), -height_range(more.field).lowest.um()),
       "More than a quarter of the samples lie below what was taken for the base.", more.warning});
}

TEST(Polynomial, TakesWavesAsLongAsTheFieldForForm) {
  const HeightField waves = test::texture(side, 100.0);
  const double before = root_mean_square_height(level(waves)).um();
  const auto left = [&](int degree) {
    return root_mean_square_height(subtract_polynomial(waves, fit_polynomial(waves, degree))).um() / before;
  };
  EXPECT_LT(left(5), 0.7);
  EXPECT_LT(left(12), left(5));
  test::record(
      {theme, "`correct --level poly:N`", "a texture with a Sal of a fifth of the field, degrees 2, 5 and 12",
       fmt::format("{}, {} and {} of its RMS height is left: what is as long as form is form to a polynomial.",
                   percent(left(2)), percent(left(5)), percent(left(12))),
       "What was taken out is said beside what is left. Which of it is form only the user knows: an --l-filter has "
       "a wavelength, a polynomial has none.",
       "levelled by a polynomial of degree 5, which took out … um (rms) of form beyond a plane and left … um"});
}

TEST(Filter, NeedsSamplesAndAField) {
  const HeightField white = test::white_noise(test::micrometre_grid(side, side), 3);
  const auto left = [&](double cutoff_um) {
    return root_mean_square_height(s_filter(white, Length::from_um(cutoff_um))).um() /
           root_mean_square_height(white).um();
  };
  const std::string near = filter_warning(white, 2.0_um), far = filter_warning(white, 300.0_um);
  EXPECT_FALSE(near.empty());
  EXPECT_FALSE(far.empty());
  EXPECT_TRUE(filter_warning(white, 4.0_um).empty());
  EXPECT_TRUE(filter_warning(white, 255.0_um).empty());
  // Of the frequencies that samples hold, by the transfer 2^(−(cutoff · f)²).
  const auto ideal = [](double cutoff) {
    const double root = std::sqrt(0.5 * std::numbers::ln2) * cutoff;
    return 0.5 * std::sqrt(std::numbers::pi) * std::erf(root) / root;
  };
  EXPECT_NEAR(left(8.0), ideal(8.0), 0.01);
  test::record(
      {theme, "`--s-filter`", "a cut-off of 1, 2 and 4 spacings, white noise",
       fmt::format("{}, {} and {} of Sq passes, where a Gaussian of that cut-off passes {}, {} and {}: the filter "
                   "has no samples to be a filter with.",
                   percent(left(1.0)), percent(left(2.0)), percent(left(4.0)), percent(ideal(1.0)), percent(ideal(2.0)),
                   percent(ideal(4.0))),
       "The weights at whole samples: from 55 % of a wave as long as the cut-off on it warns.", near});
  test::record(
      {theme, "`--s-filter`, `--l-filter`", "a cut-off longer than the field (300 µm on 256 µm)",
       fmt::format("The S-filter leaves {} of Sq, little more than a plane; the L-filter takes no more than that.",
                   percent(left(300.0))),
       "The cut-off against the shorter side.", far});
}

TEST(StepLines, OfTheSurfaceItselfAreTakenOutToo) {
  const HeightField ridges = rough(0.1, [](double, double y) { return std::fmod(y, 32.0) < 16.0 ? 2.0 : 0.0; });
  const StepLineResult result = correct_step_lines(ridges), fine = correct_step_lines(test::texture(side, 6.0));
  const double before = root_mean_square_height(ridges).um(), left = root_mean_square_height(result.field).um();
  EXPECT_LT(left, 0.2 * before);
  EXPECT_FALSE(result.warning.empty());
  EXPECT_TRUE(fine.warning.empty());
  const double changed = root_mean_square_height(fine.field) / root_mean_square_height(test::texture(side, 6.0)) - 1.0;
  test::record(
      {theme, "`correct --step-lines`", "ridges of 2 µm along the rows, with steep walls",
       fmt::format("They are gone: Sq falls from {:.2f} to {:.2f} µm. On a texture without steps, Sq changes by {}.",
                   before, left, percent(changed)),
       "What was taken out against what is left; above 0.3 it warns.", result.warning});
}

}  // namespace
}  // namespace mezzotint
