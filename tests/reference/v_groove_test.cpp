#include "tests/reference/v_groove.h"

#include <gtest/gtest.h>
#include <cmath>
#include <string>
#include <vector>

#include "forward/scattering/path_tracing.h"
#include "tests/forward/scattering/reliefs.h"

namespace mezzotint {
namespace {

constexpr std::uint32_t kept_orders = 12;

struct Groove {
  double slope;
  double theta_deg, phi_deg;
};

// Gentle to steep, across, askew and along the grooves; with slope 1 light comes back the way it went.
std::vector<Groove> grooves() {
  std::vector<Groove> all;
  for (const double slope : {0.2, 0.6, 1.0, 1.7, 3.0})
    for (const auto& [theta, phi] :
         {std::pair{0.0, 0.0}, {20.0, 0.0}, {50.0, 180.0}, {40.0, 65.0}, {70.0, 30.0}, {60.0, 90.0}, {85.0, 205.0}})
      all.push_back({slope, theta, phi});
  return all;
}

// Grooves along y, 64 cells apart: facets are planes of the mesh, so that the tracer knows them exactly.
HeightField relief_of(double slope) {
  return test::relief(64, 8, Continuation::Periodic, [=](double c, double) { return slope * std::abs(c - 32.0); });
}

PathTracingOptions options_for(const Groove& groove, const Material& material) {
  PathTracingOptions options;
  options.incidence = {Angle::from_degrees(groove.theta_deg), Angle::from_degrees(groove.phi_deg)};
  options.grid = {67, 67};  // odd, so that the plane of incidence is no border between bins; nor are its beams on one
  options.material = material;
  options.samples = 1U << 16;
  options.batches = 32;
  options.bounce_orders = kept_orders;
  return options;
}

std::string name_of(const Groove& groove) {
  return "slope " + std::to_string(groove.slope) + " from " + std::to_string(groove.theta_deg) + ", " +
         std::to_string(groove.phi_deg);
}

// Shares of the light a bin, of all beams or of those of one order.
std::vector<double> shares_of(const std::vector<test::GrooveBeam>& beams, const DirectionGrid& grid, int order = 0) {
  std::vector<double> shares(grid.size());
  for (const auto& beam : beams)
    if (order == 0 || beam.order == order) shares[grid.bin_of(beam.way.x(), beam.way.y())] += beam.share;
  return shares;
}

// The map holds these shares, in these bins and in no others. Borders between orders fall anywhere within a stratum:
// standard errors say how far off that is; of some 10^4 lit bins one may be off by 4.5 of them (31 degrees of freedom:
// 9e-5). Single precision has 1e-7 of the whole, times some bounces.
void expect_shares(const MapEstimate& map, const std::vector<double>& expected, const DirectionGrid& grid,
                   const std::string& what) {
  const auto areas = projected_solid_angles(grid);
  for (std::size_t bin = 0; bin < expected.size(); ++bin) {
    const double share = map.mean[bin] * areas[bin], error = map.standard_error[bin] * areas[bin];
    if (expected[bin] == 0.0) {
      EXPECT_EQ(share, 0.0) << what << ", bin " << bin;
    } else {
      EXPECT_NEAR(share, expected[bin], 4.5 * error + 1e-6) << what << ", bin " << bin;
      EXPECT_LT(error, 0.01) << what;  // or the comparison would be of no use
    }
  }
}

void expect_reflection_by_order(const Groove& groove, const Material& material, int orders) {
  const PathTracingOptions options = options_for(groove, material);
  const Bsdf bsdf = trace_bsdf(relief_of(groove.slope), options);
  const auto light = test::VGroove(groove.slope, to_direction(options.incidence), material).light();
  for (const auto& beam : light.reflected) ASSERT_LT(beam.order, static_cast<int>(kept_orders));
  for (int order = 1; order <= orders; ++order)
    expect_shares(bsdf.reflection_orders[static_cast<std::size_t>(order - 1)],
                  shares_of(light.reflected, options.grid, order), options.grid,
                  name_of(groove) + ", order " + std::to_string(order));
}

TEST(VGroove, OfMirrorsLosesNothing) {
  for (const Groove& groove : grooves()) {
    const PathTracingOptions options = options_for(groove, Mirror{});
    const auto light = test::VGroove(groove.slope, to_direction(options.incidence), Mirror{}).light();
    double sum = 0.0;
    for (const auto& beam : light.reflected) {
      sum += beam.share;
      EXPECT_GT(beam.way.z(), 0.0);
      EXPECT_NEAR(beam.way.norm(), 1.0, 1e-12);
    }
    EXPECT_NEAR(sum, 1.0, 1e-12) << name_of(groove);  // rounding
  }
}

TEST(VGroove, OfARightAngleSendsLightBackAcross) {
  // Two bounces turn x and z around, for all light from straight above.
  const auto light = test::VGroove(1.0, {0.0, 0.0, 1.0}, Mirror{}).light();
  ASSERT_EQ(light.reflected.size(), 2U);
  for (const auto& beam : light.reflected) {
    EXPECT_EQ(beam.order, 2);
    EXPECT_NEAR(beam.share, 0.5, 1e-12);
    EXPECT_NEAR((beam.way - Direction(0.0, 0.0, 1.0)).norm(), 0.0, 1e-12);
  }
}

TEST(VGroove, OfMirrorsIsTracedOrderByOrder) {
  for (const Groove& groove : grooves()) expect_reflection_by_order(groove, Mirror{}, kept_orders);
}

TEST(VGroove, OfMetalIsTracedOrderByOrder) {
  for (const Groove& groove : grooves()) expect_reflection_by_order(groove, Conductor{0.2, 3.0}, kept_orders);
}

TEST(VGroove, OfGlassIsTracedToItsSecondOrder) {
  // What has gone in and out again comes with the third order at the earliest: a prism bends light downwards.
  for (const Groove& groove : grooves()) expect_reflection_by_order(groove, Dielectric{1.5}, 2);
}

TEST(VGroove, OfGlassSendsOnWhatItRefracts) {
  int compared = 0;
  for (const Groove& groove : grooves()) {
    const PathTracingOptions options = options_for(groove, Dielectric{1.5});
    const auto light = test::VGroove(groove.slope, to_direction(options.incidence), Dielectric{1.5}).light();
    if (!light.refracts_for_good) continue;
    ++compared;
    const Bsdf bsdf = trace_bsdf(relief_of(groove.slope), options);
    expect_shares(bsdf.transmission, shares_of(light.transmitted, options.grid), options.grid, name_of(groove));
    expect_shares(bsdf.reflection, shares_of(light.reflected, options.grid), options.grid, name_of(groove));
  }
  EXPECT_GE(compared, 10);
}

}  // namespace
}  // namespace mezzotint
