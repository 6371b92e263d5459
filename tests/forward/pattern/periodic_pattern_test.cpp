#include <cmath>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/pattern/pattern.h"
#include "tests/forward/pattern/draws.h"

namespace mezzotint {
namespace {

using test::square_grid;

const Grid tile{160, 120, 2.0_um, 2.5_um};

// In any direction, and of every kind that can.
std::vector<Pattern> patterns() {
  PatternRegions regions{.pixel = 20.0_um, .columns = 2, .rows = 1, .labels = {0, 1}};
  regions.parts = {{Noise{.scale = 60.0_um}, 0}, {Noise{.scale = 50.0_um}, 1}};
  return {Noise{.scale = 30.0_um, .stretch = 2.0, .direction = 33.0_deg},
          Noise{.scale = 30.0_um, .direction = 10.0_deg, .hash = CellHash::Slides},
          FractionalBrownianMotion{.scale = 90.0_um, .direction = 20.0_deg, .lacunarity = 1.7, .octaves = 3},
          Turbulence{.scale = 90.0_um, .octaves = 2},
          LineIntegralConvolution{.scale = 30.0_um, .length = 120.0_um, .direction = 25.0_deg},
          Sinusoid{.wavelength_u = 50.0_um, .wavelength_v = 80.0_um, .direction = 40.0_deg},
          Ridges{.wavelength = 40.0_um, .direction = 15.0_deg},
          PatternSum{{{Noise{.scale = 40.0_um}}, {TurnedPattern{20.0_deg, {}, {{Sinusoid{.wavelength_u = 60.0_um}}}}}}},
          regions};
}

// The pattern of the tile, seen from one tile further on.
HeightField moved(const Pattern& pattern, double tiles_x, double tiles_y) {
  return synthesize(pattern, tile, {Length::from_um(320.0 * tiles_x), Length::from_um(300.0 * tiles_y)},
                    Continuation::Periodic);
}

TEST(PeriodicPattern, ComesBackAfterATileOfEveryKind) {
  for (const Pattern& pattern : patterns()) {
    const HeightField here = moved(pattern, 0.0, 0.0);
    EXPECT_TRUE(here.periodic());
    for (const HeightField& there : {moved(pattern, 1.0, 0.0), moved(pattern, 0.0, 1.0), moved(pattern, -3.0, 2.0)}) {
      std::size_t different = 0;
      for (std::size_t i = 0; i < tile.size(); ++i) {
        different += std::abs(here.heights_um()[i] - there.heights_um()[i]) > 1e-3F ? 1 : 0;
      }
      // Heights of up to 16 µm in float. Where a region ends, a sample on the line itself may fall to either side.
      EXPECT_LE(different, std::holds_alternative<PatternRegions>(pattern) ? tile.size() / 8 : 0) << kind_name(pattern);
    }
  }
}

TEST(PeriodicPattern, IsAsSteepAcrossItsBorderAsWithin) {
  for (const Pattern& pattern : patterns()) {
    if (std::holds_alternative<PatternRegions>(pattern)) continue;  // cliffs
    const HeightField field = moved(pattern, 0.0, 0.0);
    double across = 0.0, within = 0.0, bend_across = 0.0, bend_within = 0.0;
    for (std::size_t row = 0; row < tile.rows; ++row) {
      const auto step = [&](std::size_t c) {
        return static_cast<double>(field.at((c + 1) % tile.columns, row)) - field.at(c % tile.columns, row);
      };
      for (std::size_t c = 0; c < tile.columns; ++c) {
        within = std::max(within, std::abs(step(c)) * (c + 1 < tile.columns ? 1.0 : 0.0));
        bend_within = std::max(bend_within, std::abs(step(c + 1) - step(c)) * (c + 2 < tile.columns ? 1.0 : 0.0));
      }
      across = std::max(across, std::abs(step(tile.columns - 1)));
      bend_across = std::max(bend_across, std::abs(step(tile.columns) - step(tile.columns - 1)));
    }
    // Values and slopes go on: neither the largest step nor the largest change of it is at the border.
    EXPECT_LE(across, within) << kind_name(pattern);
    EXPECT_LE(bend_across, bend_within) << kind_name(pattern);
  }
}

TEST(PeriodicPattern, IsChangedAsLittleAsItSays) {
  // 320 µm hold 4 waves of 80 µm: nothing to change. Of 75 µm they hold 4.27, made 4: longer by 6.7 %.
  EXPECT_NEAR(periodic_change(Ridges{.wavelength = 80.0_um}, tile), 0.0, 1e-12);
  EXPECT_NEAR(periodic_change(Ridges{.wavelength = 75.0_um}, tile), 1.0 - 4.0 / (320.0 / 75.0), 1e-12);
  // The larger the tile, the smaller the change: half a period in a side's length of them, in each of two axes.
  const Noise noise{.scale = 10.0_um, .direction = 33.0_deg};
  EXPECT_LE(periodic_change(noise, square_grid(256, 2.0)), 0.71 * 10.0 / 512.0);
  EXPECT_NEAR(periodic_change(PatternSum{{{Ridges{.wavelength = 80.0_um}}, {Ridges{.wavelength = 75.0_um}}}}, tile),
              1.0 - 4.0 / (320.0 / 75.0), 1e-12);
}

TEST(PeriodicPattern, KeepsItsSlopes) {
  const Pattern noise = Noise{.scale = 32.0_um, .stretch = 2.0, .direction = 30.0_deg};
  const Grid grid = square_grid(1024, 1.0);
  const double change = periodic_change(noise, grid);
  EXPECT_LT(change, 0.05);
  const SlopeCovariance wanted = closed_form_slope_covariance(noise).value();
  double xx = 0.0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    xx += 0.25 * slope_covariance(synthesize(draw_instance(noise, seed).pattern, grid, {}, Continuation::Periodic)).xx;
  }
  // Twice the change, and 2000 cells of two independent values: 2 %, taken three times.
  EXPECT_NEAR(xx, wanted.xx, (2.0 * change + 0.06) * wanted.xx);
}

TEST(PeriodicPattern, RefusesATileOfLessThanAPeriod) {
  EXPECT_THROW((void)synthesize(Noise{.scale = 1000.0_um}, tile, {}, Continuation::Periodic), InvalidInput);
  EXPECT_THROW((void)synthesize(Ridges{.wavelength = 1000.0_um}, tile, {}, Continuation::Periodic), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
