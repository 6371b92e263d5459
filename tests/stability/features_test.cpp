#include <algorithm>

#include "tests/stability/scene.h"

namespace mezzotint {
namespace {

using test::light_at;
using test::percent;
using test::warning;

constexpr const char* theme = "Features, patches and lobes";

double peak(const Bsdf& bsdf) { return *std::max_element(bsdf.reflection.mean.begin(), bsdf.reflection.mean.end()); }

TEST(Features, OfOneSampleBelongToTheFacets) {
  const RandomStream random(5, RandomPurpose::Test);
  const HeightField noise = test::relief(64, 64, Continuation::Periodic, [&](double c, double r) {
    return 0.2 * random.normal4(static_cast<std::uint64_t>(64.0 * r + c))[0];
  });
  HeightField coarse({32, 32, Length::from_um(2.0), Length::from_um(2.0)}, Continuation::Periodic);
  for (std::size_t r = 0; r < 32; ++r) {
    for (std::size_t c = 0; c < 32; ++c) coarse.at(c, r) = noise.at(2 * c, 2 * r);
  }
  const double fine_gradient = test::rms_gradient(noise), coarse_gradient = test::rms_gradient(coarse);
  EXPECT_NEAR(fine_gradient / coarse_gradient, 2.0, 0.1);
  const std::string told = warning(trace_bsdf(noise, light_at(30.0)), "changes from sample to sample");
  EXPECT_FALSE(told.empty());
  EXPECT_TRUE(warning(trace_bsdf(test::random_relief(64, 0.3), light_at(30.0)), "changes from").empty());
  test::record(
      {theme, "height field", "features of one sample (white noise)",
       fmt::format("The RMS gradient is {:.2f}; with every other sample left out it is {:.2f}. The lobe is that of the "
                   "sampling.",
                   fine_gradient, coarse_gradient),
       "The variance of the slopes over two samples against that over one; below 0.55 (4.3 samples a wave) it warns.",
       told});
}

TEST(Features, AreNoneOnAFlatSurface) {
  const HeightField flat({64, 64, Length::from_um(1.0), Length::from_um(1.0)}, Continuation::Periodic);
  const Bsdf bsdf = trace_bsdf(flat, light_at(30.0, Dielectric{1.5}));
  const double exact = reflectance(Dielectric{1.5}, std::cos(std::numbers::pi / 6));
  EXPECT_NEAR(bsdf.energy.reflected.value, exact, 1e-6 * exact);
  const auto bins =
      std::count_if(bsdf.reflection.mean.begin(), bsdf.reflection.mean.end(), [](double f) { return f > 0.0; });
  EXPECT_EQ(bins, 1);
  PathTracingOptions options = light_at(30.0, Dielectric{1.5});
  options.grid = {128, 128};
  const Bsdf finer = trace_bsdf(flat, options);
  EXPECT_NEAR(peak(finer) / peak(bsdf), 4.0, 1e-3);  // a fourth of the bin; its sums are rounded to 1e-7
  const std::string told = warning(bsdf, "the reflected light fills 1.0 bins");
  EXPECT_FALSE(told.empty());
  test::record(
      {theme, "direction map", "a flat surface",
       fmt::format("All light lies in one bin, as it must; the albedo is Fresnel's ({} off). The value of that bin is "
                   "the mirror's light over the bin's area: with twice the bins a side it is {:.1f} times as high.",
                   test::below(std::abs(bsdf.energy.reflected.value / exact - 1.0)), peak(finer) / peak(bsdf)),
       "Effective number of bins, 1/Σp².", told});
}

TEST(Features, AsGentleAsThisMakeALobeNarrowerThanABin) {
  PathTracer tracer(test::random_relief(128, 0.01));
  PathTracingOptions options = light_at(20.0);
  const Bsdf coarse = tracer.splat(options);
  options.grid = {1024, 1024};
  const Bsdf fine = tracer.splat(options);
  EXPECT_GT(peak(fine) / peak(coarse), 2.0);
  const std::string told = warning(coarse, "narrower than a bin");
  EXPECT_FALSE(told.empty());
  EXPECT_TRUE(warning(fine, "narrower than a bin").empty());
  test::record(
      {theme, "direction map of 64 × 64 bins", "s = 0.01: a lobe of 0.8°, a bin of 1.8°",
       fmt::format("The peak reads {:.0f} per steradian; at 1024 × 1024 bins it is {:.0f}.", peak(coarse), peak(fine)),
       "Effective number of bins, 1/Σp², by two independent halves: below 4π the lobe's standard deviation is less "
       "than a bin.",
       told});
}

TEST(Patch, OfOneWavelengthIsAsGoodAsManyWhereItIsPeriodic) {
  const auto sine = [](std::size_t size, double waves) {
    const double unit = 2.0 * std::numbers::pi * waves / static_cast<double>(size);
    return test::relief(size, size, Continuation::Periodic,
                        [=](double c, double r) { return 0.4 / unit * std::sin(unit * c) * std::sin(unit * r); });
  };
  const HeightField one = sine(32, 1.0), many = sine(128, 4.0);
  const PathTracingOptions options = light_at(70.0, Mirror{}, 17);
  const Bsdf small = trace_bsdf(one, options), large = trace_bsdf(many, options);
  const double off = test::difference(small, large);
  // The same relief: what is left is noise, which `corrected` takes out but for its own error.
  EXPECT_LT(off, 0.05);
  // As a patch it sees mirrored copies.
  const Bsdf patch = trace_bsdf(crop(one, 0, 0, 31, 31), options);
  EXPECT_GT(patch.energy.left_sideways.value, 0.0);
  const std::string told = warning(patch, "another patch of the same texture");
  EXPECT_FALSE(told.empty());
  test::record({theme, "`paths`", "a patch of one wavelength (sin·sin, 70°)",
                fmt::format("Declared periodic it is as good as 4 × 4 wavelengths ({} apart, noise taken out). As a "
                            "patch without a period, {} of the light meets mirrored copies first.",
                            percent(off), percent(patch.energy.left_sideways.value)),
                "Feature size 2π·Sq/Sdq against the patch: below 16 features it warns.", told});
}

TEST(Patch, OfFewFeaturesDoesNotStandForItsTexture) {
  const HeightField texture = test::random_relief(256, 0.3);
  PathTracingOptions options = light_at(30.0, Mirror{}, 15);
  options.grid = {16, 16};
  std::vector<Bsdf> patches;
  for (std::size_t k = 0; k < 4; ++k) patches.push_back(trace_bsdf(crop(texture, 60 * k, 50, 32, 32), options));
  double apart = 0.0, stated = 0.0;
  for (std::size_t k = 1; k < 4; ++k) apart += test::difference(patches[k], patches[0]) / 3.0;
  for (const Bsdf& patch : patches) stated = std::max(stated, relative_error(patch.grid, patch.reflection));
  EXPECT_GT(apart, 3.0 * stated);
  const std::string told = warning(patches[0], "another patch of the same texture");
  EXPECT_FALSE(told.empty());
  test::record({theme, "standard errors", "patches of 32 × 32 samples that hold one feature each",
                fmt::format("Two patches of one texture are {} apart on average, where each states an error of {}: "
                            "that of its own paths.",
                            percent(apart), percent(stated)),
                "Feature size 2π·Sq/Sdq against the patch: below 16 features it warns. A periodic field is taken for "
                "all there is.",
                told});
}

TEST(Patch, AsSmallAsThisLosesLightSideways) {
  const HeightField patch = crop(test::random_relief(128, 0.5), 3, 5, 8, 8);
  const Bsdf bsdf = trace_bsdf(patch, light_at(80.0, Mirror{}, 14));
  EXPECT_GT(bsdf.energy.left_sideways.value, 0.2);
  EXPECT_NEAR(test::accounted_for(bsdf), 1.0, 1e-9);
  const std::string told = warning(bsdf, "met mirrored copies before the patch");
  EXPECT_FALSE(told.empty());
  test::record(
      {theme, "mirrored patch", "8 × 8 samples of s = 0.5, light at 80°",
       fmt::format("{} of the light first meets a mirrored copy. The maps are those of the rest.",
                   percent(bsdf.energy.left_sideways.value)),
       "`left_sideways` in the audit; above 10 % it warns, and where all light is lost it gives up (MethodError).",
       told});
}

}  // namespace
}  // namespace mezzotint
