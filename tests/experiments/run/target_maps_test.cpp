#include "experiments/run/target_maps.h"

#include <cmath>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/optics/bsdf.h"
#include "inverse/target/lobe_target.h"
#include "tests/experiments/target_pictures.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

SimulationSpecification simulation_of(std::size_t resolution) {
  SimulationSpecification simulation;
  simulation.incidences = {{20.0_deg, 0.0_deg}, {20.0_deg, 90.0_deg}};
  simulation.resolution = resolution;
  return simulation;
}

double light_of(const TargetMaps& target, std::size_t i) {
  const auto areas = projected_solid_angles(target.grid);
  double sum = 0.0;
  for (std::size_t k = 0; k < areas.size(); ++k) sum += areas[k] * target.maps[i][k];
  return sum;
}

// Mean direction (x, y) of the light of a map.
std::array<double, 2> middle_of(const TargetMaps& target, std::size_t i) {
  const auto areas = projected_solid_angles(target.grid);
  std::array<double, 2> sum{};
  for (std::size_t k = 0; k < areas.size(); ++k) {
    const double side = static_cast<double>(target.grid.width), light = areas[k] * target.maps[i][k];
    sum[0] += light * (2.0 * (static_cast<double>(k % target.grid.width) + 0.5) / side - 1.0);
    sum[1] += light * (2.0 * (static_cast<double>(k / target.grid.width) + 0.5) / side - 1.0);
  }
  return {sum[0] / light_of(target, i), sum[1] / light_of(target, i)};
}

template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::BadInput);
    return error.what();
  }
  return "none";
}

#define EXPECT_REFUSED(call, part)                               \
  do {                                                           \
    const std::string message = refusal([&] { (void)(call); });  \
    EXPECT_NE(message.find(part), std::string::npos) << message; \
  } while (false)

Bsdf exr_of(const DirectionGrid& grid, const DirectionAngles& light, double albedo) {
  Bsdf bsdf;
  bsdf.incidence = light;
  bsdf.grid = grid;
  DirectionMap map = reflection_map(GgxLobe{0.3, 0.2, {}}, Mirror{}, light, grid);
  const auto areas = projected_solid_angles(grid);
  double sum = 0.0;
  for (std::size_t k = 0; k < map.size(); ++k) sum += areas[k] * map[k];
  for (double& value : map) value *= albedo / sum;
  const DirectionMap zero(map.size(), 0.0);
  bsdf.reflection = {map, zero, map, map, {}, {}};
  bsdf.transmission = {zero, zero, zero, zero, {}, {}};
  return bsdf;
}

class TargetMapsTest : public testing::Test {
protected:
  std::filesystem::path written(const char* name, const Bsdf& bsdf) {
    write_exr(bsdf, folder_ / name);
    return folder_ / name;
  }
  test::TemporaryFolder folder_;
};

TEST_F(TargetMapsTest, AGgxLobeIsItsOwnMap) {
  const SimulationSpecification simulation = simulation_of(32);
  const GgxLobe lobe{0.3, 0.1, 30.0_deg};
  const TargetMaps target = wanted_maps({.kind = "ggx", .wanted = lobe}, simulation);
  ASSERT_EQ(target.maps.size(), 2U);
  EXPECT_EQ(target.maps[1], reflection_map(lobe, simulation.material, simulation.incidences[1], {32, 32}));
  EXPECT_FALSE(target.any_brightness);
  // It is what the search takes.
  const LobeTarget goal = lobe_target(target.grid, simulation.material, target.incidences, target.maps, true);
  EXPECT_EQ(goal.maps.size(), 2U);
}

TEST_F(TargetMapsTest, MapsOfFilesHaveTheirOwnLight) {
  const DirectionGrid grid{32, 32};
  const DirectionAngles first{10.0_deg, 0.0_deg}, second{40.0_deg, 30.0_deg};
  const WantedMaps files{{written("a.exr", exr_of(grid, first, 0.04)), written("b.exr", exr_of(grid, second, 0.05))}};
  const TargetMaps target = wanted_maps({.kind = "bsdf", .wanted = files}, simulation_of(32));
  ASSERT_EQ(target.incidences.size(), 2U);
  EXPECT_NEAR(target.incidences[1].theta.degrees(), 40.0, 1e-9);
  EXPECT_NEAR(light_of(target, 1), 0.05, 1e-7);
  EXPECT_TRUE(target.notes.empty());
}

TEST_F(TargetMapsTest, RefusesMapsThatCannotBe) {
  const DirectionGrid grid{32, 32};
  const DirectionAngles light{10.0_deg, 0.0_deg};
  const auto maps = [&](std::vector<std::filesystem::path> files) {
    return wanted_maps({.kind = "bsdf", .wanted = WantedMaps{std::move(files)}}, simulation_of(32));
  };
  const auto good = written("a.exr", exr_of(grid, light, 0.04));
  EXPECT_REFUSED(maps({good, written("b.exr", exr_of(grid, light, 0.05))}), "are for the same light");
  EXPECT_REFUSED(maps({written("c.exr", exr_of({16, 16}, light, 0.04))}), "set resolution = 16");
  EXPECT_REFUSED(maps({written("d.exr", exr_of({32, 16}, light, 0.04))}), "as many rows as columns");
  EXPECT_REFUSED(maps({written("e.exr", exr_of(grid, light, 1.3))}),
                 "for light from (10°, 0°) the target is brighter than a mirror: it reflects 1.3 times");
  Bsdf negative = exr_of(grid, light, 0.04);
  negative.reflection.mean[16 * 32 + 16] = -0.01;
  EXPECT_REFUSED(maps({written("f.exr", negative)}), "noise explains no less");
  negative.reflection.standard_error[16 * 32 + 16] = 0.005;
  EXPECT_NO_THROW((void)maps({written("g.exr", negative)}));
  EXPECT_REFUSED(maps({written("h.exr", exr_of(grid, light, 0.0))}), "the map is dark");
  EXPECT_REFUSED(maps({folder_ / "none.exr"}), "none.exr");
  DirectionMap nan(grid.size(), 0.1);
  nan[40] = NAN;
  EXPECT_REFUSED(require_possible("it", light, grid, nan, {}), "is not finite");
}

TEST_F(TargetMapsTest, BrightnessThatAMaterialLacksIsSaid) {
  const WantedMaps files{{written("a.exr", exr_of({32, 32}, {10.0_deg, 0.0_deg}, 0.8))}};
  const TargetMaps target = wanted_maps({.kind = "bsdf", .wanted = files}, simulation_of(32));
  ASSERT_EQ(target.notes.size(), 1U);
  EXPECT_NE(target.notes[0].find("its brightness cannot"), std::string::npos);
}

TEST_F(TargetMapsTest, ShapesLieWhereTheyAreAskedFor) {
  const SimulationSpecification simulation = simulation_of(64);
  const auto maps = [&](const WantedPainting& painting) {
    return wanted_maps({.kind = "image", .wanted = painting}, simulation);
  };
  const TargetMaps square = maps({.lobe = SquareShape{0.25}, .albedo = 0.5});
  EXPECT_NEAR(light_of(square, 0), 0.5, 1e-9);
  // A square of side ½ holds its light evenly: f = albedo/area.
  EXPECT_NEAR(square.maps[0][32 * 64 + 32], 0.5 / 0.25, 1e-9);
  EXPECT_EQ(square.maps[0][32 * 64 + 41], 0.0);
  EXPECT_FALSE(square.any_brightness);

  // About the mirrored ray, and off it.
  const std::vector<DirectionAngles> light = {{30.0_deg, 90.0_deg}};
  const auto ring = maps({.lobe = RingShape{0.3, 0.1}, .incidences = light});
  EXPECT_NEAR(middle_of(ring, 0)[1], -0.5, 1e-3);
  EXPECT_TRUE(ring.any_brightness);
  EXPECT_NEAR(light_of(ring, 0), reflectance(simulation.material, std::cos(std::numbers::pi / 6.0)), 1e-9);
  const auto tilt = maps({.lobe = TiltShape{0.08}, .centre_x = 0.2, .centre_y = 0.1, .incidences = light});
  EXPECT_NEAR(middle_of(tilt, 0)[0], 0.2, 1e-3);
  EXPECT_NEAR(middle_of(tilt, 0)[1], -0.4, 1e-3);

  // Two spots along a turned axis: the second moments are d² cos², d² sin², d² cos·sin, and σ² each.
  const auto lobes = maps({.lobe = TwoLobesShape{0.3, 0.05}, .rotation = 30.0_deg});
  const auto areas = projected_solid_angles(lobes.grid);
  double xx = 0.0, xy = 0.0;
  for (std::size_t k = 0; k < areas.size(); ++k) {
    const double x = (static_cast<double>(k % 64) + 0.5) / 32.0 - 1.0,
                 y = (static_cast<double>(k / 64) + 0.5) / 32.0 - 1.0;
    xx += areas[k] * lobes.maps[0][k] * x * x / light_of(lobes, 0);
    xy += areas[k] * lobes.maps[0][k] * x * y / light_of(lobes, 0);
  }
  EXPECT_NEAR(xx, 0.09 * 0.75 + 0.0025, 3e-4);
  EXPECT_NEAR(xy, 0.09 * std::sqrt(3.0) / 4.0, 3e-4);
}

TEST_F(TargetMapsTest, APictureIsAMapOfDirections) {
  std::vector<std::uint8_t> gray(64 * 64, 0);
  for (int row = 12; row < 20; ++row) {
    for (int column = 40; column < 48; ++column) gray[static_cast<std::size_t>(row * 64 + column)] = 255;
  }
  test::write_png(folder_ / "spot.png", 64, 1, gray);
  const WantedPainting painting{.lobe = read_lobe_picture(folder_ / "spot.png", false)};
  const TargetMaps target = wanted_maps({.kind = "image", .wanted = painting}, simulation_of(32));
  // Columns 40 … 48 of 64: x = 0.25 … 0.5; rows 12 … 20 from the top: y = 0.625 … 0.375.
  EXPECT_NEAR(middle_of(target, 0)[0], 0.375, 1e-9);
  EXPECT_NEAR(middle_of(target, 0)[1], 0.5, 1e-9);
  EXPECT_EQ(target.incidences[0].theta, 0.0_deg);
}

TEST_F(TargetMapsTest, MeasurementsSayWhatTheyLack) {
  const auto file = test::external_data_folder() / "brdf" / "AnoBlackNiTEonSteel.txt";
  MEZZOTINT_NEEDS_DATA(file);
  SimulationSpecification simulation = simulation_of(32);
  const TargetSpecification wanted{.kind = "measured", .wanted = WantedMeasurement{.file = file}};
  const TargetMaps own = wanted_maps(wanted, simulation);
  ASSERT_EQ(own.incidences.size(), 4U) << "the file's own directions, where the experiment names none";
  EXPECT_TRUE(own.any_brightness);
  EXPECT_GE(own.notes.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    // The lobe leans toward the mirrored ray: the light of an isotropic sample is laid to φ = 0.
    EXPECT_LT(middle_of(own, i)[0], 0.0) << i;
    for (std::size_t k = 0; k < own.maps[i].size(); ++k) {
      EXPECT_TRUE(own.measured[i][k] > 0.0 || own.maps[i][k] == 0.0);
    }
  }
  simulation.incidences_given = true;
  EXPECT_REFUSED(wanted_maps(wanted, simulation), "10°, 30°, 50°, 70°");
  simulation.incidences = {{30.0_deg, 45.0_deg}};
  EXPECT_EQ(wanted_maps(wanted, simulation).maps.size(), 1U);
  const TargetSpecification strict{.kind = "measured", .wanted = WantedMeasurement{.file = file, .most_missing = 0.01}};
  EXPECT_REFUSED(wanted_maps(strict, simulation), "most_missing");
  const TargetSpecification other{.kind = "measured",
                                  .wanted = WantedMeasurement{.file = file, .channel = {.name = "R"}}};
  EXPECT_REFUSED(wanted_maps(other, simulation), "no channel \"R\"");
}

TEST_F(TargetMapsTest, KindsWithoutMapsAreRefused) {
  const SimulationSpecification simulation = simulation_of(16);
  EXPECT_REFUSED(wanted_maps({.kind = "anisotropy", .wanted = WantedAnisotropy{2.0, 0.1}}, simulation),
                 "names no lobe");
  EXPECT_REFUSED(wanted_maps({.kind = "regions", .wanted = WantedRegions{}}, simulation), "region by region");
}

}  // namespace
}  // namespace mezzotint
