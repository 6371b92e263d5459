#include <filesystem>

#include "tests/stability/scene.h"

namespace mezzotint {
namespace {

using test::light_at;
using test::percent;
using test::warning;

constexpr const char* theme = "Sums, budgets and states";

// Not ours: what a bin in single precision does.
TEST(FloatBins, StopCountingAt2ToThe24Entries) {
  constexpr int entries = 3 << 24;
  constexpr float weight = 0x1p-28F;
  float single = 0.0F;
  double twice = 0.0;
  for (int k = 0; k < entries; ++k) {
    single += weight;
    twice += double{weight};
  }
  EXPECT_EQ(single, 0x1p-4F);  // 2^24 · 2^-28: the next weight is half of its last digit
  EXPECT_EQ(twice, 0.1875);
  test::record(
      {theme, "bins in single precision", "50 million paths of weight 2^-28 into one bin",
       fmt::format("A float holds {:.4f} where {:.4f} came in: {:.0f} % are lost without a sign.", double{single},
                   twice, 100.0 * (1.0 - double{single} / twice)),
       "Does not happen: all sums are in double precision, slice by slice, so that the audit sums to 1 within 1e-12.",
       "—"});
}

TEST(Tolerance, ThatNoBudgetReachesIsReported) {
  PathTracingOptions options = light_at(60.0, Dielectric{1.5}, 16);
  options.tolerance = 1e-5;
  const Bsdf bsdf = trace_bsdf(test::random_relief(64, 0.5), options);
  const double reached = relative_error(bsdf.grid, bsdf.reflection);
  EXPECT_GT(reached, 1e-3);
  const std::string told = warning(bsdf, "the tolerance of 1e-05 was not met");
  EXPECT_FALSE(told.empty());
  options.tolerance = 0.9;
  EXPECT_TRUE(warning(trace_bsdf(test::random_relief(64, 0.5), options), "was not met").empty());
  test::record({theme, "`--tolerance`", "1e-5 with 65 536 paths",
                fmt::format("The run ends at a standard error of {}.", percent(reached)),
                "The standard error of the map after each pass; exit status 3.", told});
}

TEST(State, OfAnotherRunIsRefused) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "mezzotint_stability_state";
  std::filesystem::remove(file);
  PathTracingOptions options = light_at(30.0, Mirror{}, 12);
  options.state = file;
  const HeightField relief = test::random_relief(32, 0.3);
  (void)trace_bsdf(relief, options);
  options.incidence.theta = Angle::from_degrees(31.0);
  const std::string other = test::refusal([&] { (void)trace_bsdf(relief, options); });
  EXPECT_NE(other.find("is the state of another run"), std::string::npos);
  options.incidence.theta = Angle::from_degrees(30.0);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 1);
  const std::string damaged = test::refusal([&] { (void)trace_bsdf(relief, options); });
  EXPECT_NE(damaged.find("is cut short or damaged"), std::string::npos);
  std::filesystem::remove(file);
  test::record({theme, "`--resume`", "the state of a run with the light 1° lower; a state that lacks a byte",
                "Nothing is computed: sums of two lights in one map would look like any other map.",
                "A digest of all that the result depends on but the budget, and one of the content.",
                other.substr(other.find("is the state"))});
}

}  // namespace
}  // namespace mezzotint
