#include "forward/scattering/trace_state.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/scattering/path_tracing.h"
#include "tests/forward/scattering/reliefs.h"

namespace mezzotint {
namespace {

namespace fs = std::filesystem;

class TraceStateFile : public testing::Test {
protected:
  void SetUp() override { fs::remove(path_); }
  void TearDown() override { fs::remove(path_); }

  PathTracingOptions options(double tolerance) const {
    PathTracingOptions wanted;
    wanted.incidence = {Angle::from_degrees(60.0), Angle::from_degrees(10.0)};
    wanted.grid = {16, 16};
    wanted.samples = std::uint64_t{1} << 20;
    wanted.tolerance = tolerance;
    return wanted;
  }
  PathTracingOptions kept(double tolerance) const {
    PathTracingOptions wanted = options(tolerance);
    wanted.state = path_;
    return wanted;
  }
  HeightField relief_ = test::random_relief(48, 0.4);
  fs::path path_ = fs::path(testing::TempDir()) /
                   (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".state");
};

void expect_same_bits(const Bsdf& a, const Bsdf& b) {
  EXPECT_EQ(a.reflection.mean, b.reflection.mean);
  EXPECT_EQ(a.reflection.standard_error, b.reflection.standard_error);
  EXPECT_EQ(a.transmission.mean, b.transmission.mean);
  EXPECT_EQ(a.energy.reflected.value, b.energy.reflected.value);
  EXPECT_EQ(a.provenance, b.provenance);
}

TEST_F(TraceStateFile, RefinesToTheSameBitsAsNeverHavingStopped) {
  const Bsdf rough = trace_bsdf(relief_, kept(0.05));
  EXPECT_LE(relative_error(rough.grid, rough.reflection), 0.05);
  const Bsdf refined = trace_bsdf(relief_, kept(0.01));
  EXPECT_LE(relative_error(refined.grid, refined.reflection), 0.01);
  expect_same_bits(refined, trace_bsdf(relief_, options(0.01)));
}

TEST_F(TraceStateFile, GoesOnAfterAnInterruption) {
  int calls = 0;
  const Progress stop = [&](const ProgressEvent&) {
    if (++calls == 4) throw Interrupted();
  };
  EXPECT_THROW((void)trace_bsdf(relief_, kept(0.003), stop), Interrupted);
  EXPECT_TRUE(fs::exists(path_));
  expect_same_bits(trace_bsdf(relief_, kept(0.003)), trace_bsdf(relief_, options(0.003)));
}

TEST_F(TraceStateFile, RefusesAnotherRunsStateAndDamage) {
  (void)trace_bsdf(relief_, kept(0.05));
  PathTracingOptions other = kept(0.05);
  other.seed = 2;
  EXPECT_THROW((void)trace_bsdf(relief_, other), FileError);
  const auto size = fs::file_size(path_);
  for (const auto length : {std::uintmax_t{5}, std::uintmax_t{90}, size / 2, size - 1}) {
    fs::resize_file(path_, length);
    EXPECT_THROW((void)trace_bsdf(relief_, kept(0.05)), FileError) << length;
    fs::remove(path_);
    (void)trace_bsdf(relief_, kept(0.05));
  }
  std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(size / 2));
  file.put('\x55');
  file.close();
  EXPECT_THROW((void)trace_bsdf(relief_, kept(0.05)), FileError);
}

TEST(PathTracingOrders, SumToTheWholeReflection) {
  PathTracingOptions options;
  options.incidence = {Angle::from_degrees(30.0), Angle::from_degrees(0.0)};
  options.grid = {16, 16};
  options.material = Mirror{};
  options.samples = 1U << 15;
  options.bounce_orders = 3;
  for (const ControlVariate variate : {ControlVariate::On, ControlVariate::Off}) {
    options.control_variate = variate;
    const Bsdf bsdf = trace_bsdf(test::random_relief(48, 0.8), options);
    ASSERT_EQ(bsdf.reflection_orders.size(), 3U);
    double second = 0.0;
    for (std::size_t k = 0; k < options.grid.size(); ++k) {
      double sum = 0.0;
      for (const MapEstimate& order : bsdf.reflection_orders) sum += order.mean[k];
      EXPECT_NEAR(sum, bsdf.reflection.mean[k], 1e-9);  // double sums
      second += bsdf.reflection_orders[1].mean[k];
    }
    EXPECT_GT(second, 0.0);
  }
}

TEST(PathTracingAbsorption, FollowsBeerAndLambertThroughAFlatSlab) {
  // A pit of 100 µm in a plain: nearly all light falls 100 µm to the plane of the lowest point at normal incidence.
  const HeightField field = test::relief(64, 64, Continuation::Periodic,
                                         [](double c, double r) { return c == 9.0 && r == 9.0 ? 0.0 : 100.0; });
  PathTracingOptions options;
  options.grid = {8, 8};
  options.samples = 1U << 14;
  options.material = Dielectric{1.5, 0.01};
  const Bsdf bsdf = trace_bsdf(field, options);
  // 0.96 · e^−1, but for the cells of the pit: 8 facets of 8192, a thousandth.
  EXPECT_NEAR(bsdf.energy.transmitted.value, 0.96 * std::exp(-1.0), 2e-3);
  EXPECT_NEAR(bsdf.energy.transmitted.value + bsdf.energy.absorbed.value + bsdf.energy.reflected.value, 1.0, 1e-6);
}

}  // namespace
}  // namespace mezzotint
