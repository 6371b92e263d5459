#include <gtest/gtest.h>

#include "measurement/reflectance/reflectance_file.h"
#include "measurement/reflectance/reflectance_map.h"
#include "tests/test_data.h"

// Real measurements, against what is known of them from elsewhere.

namespace mezzotint {
namespace {

constexpr double pi = std::numbers::pi;

DirectionAngles angles(double theta, double phi) { return {Angle::from_degrees(theta), Angle::from_degrees(phi)}; }

std::filesystem::path brdf_file(const char* name) { return test::external_data_folder() / "brdf" / name; }

double or_zero(double value) { return std::isnan(value) ? 0.0 : value; }

// The Zemax files' own "TIS", by their script: ∫ f dω over half a turn about the mirrored ray (without the cosine of
// the viewer, and half of the hemisphere), up to 90° from that ray, less a cone of the beam's width. The nodes of their
// sum are asked for one by one, as directions.
double stated_scatter(const MeasuredReflectance& measured, double theta_i) {
  const std::vector<double> radial = {0, 5, 10, 15, 20, 30, 40, 50, 60, 70, 80, 90};
  const double t = theta_i * pi / 180.0;
  const Direction mirrored(-std::sin(t), 0.0, std::cos(t)), up(std::cos(t), 0.0, std::sin(t)), side(0.0, 1.0, 0.0);
  const Direction light(std::sin(t), 0.0, std::cos(t));
  const auto sample = [&](double azimuth, double r) {
    const double a = azimuth * pi / 180.0, s = r * pi / 180.0;
    const Direction viewer = std::cos(s) * mirrored + std::sin(s) * (std::cos(a) * up + std::sin(a) * side);
    // Some of their nodes lie below the horizon, where a BRDF has no value.
    return or_zero(evaluate(std::get<PolarLobes>(measured.data), light, viewer, {1.0}));
  };
  double sum = 0.0;
  for (int az = 0; az < 180; az += 10) {
    for (std::size_t k = 0; k + 1 < radial.size(); ++k) {
      const double mean = (sample(az, radial[k]) + sample(az, radial[k + 1]) + sample(az + 10, radial[k]) +
                           sample(az + 10, radial[k + 1])) /
                          4.0;
      const double low = radial[k] * pi / 180.0, high = radial[k + 1] * pi / 180.0;
      sum += mean * (std::sin(low) + std::sin(high)) / 2.0 * (high - low) * 10.0 * pi / 180.0;
    }
  }
  const double beam = std::asin(1.75 / 82.0);
  return sum - sample(0, 0) * (1.0 - std::cos(beam)) * beam * pi;
}

TEST(ZemaxFile, IntegratesToItsStatedScatter) {
  MEZZOTINT_NEEDS_DATA(brdf_file("AnoBlackNiTEonSteel.bsdf"));
  const MeasuredReflectance steel = read_reflectance(brdf_file("AnoBlackNiTEonSteel.bsdf"));
  ASSERT_EQ(steel.incidences.size(), 4U);
  for (const double theta : {10.0, 30.0, 50.0, 70.0}) {
    const double stated = std::stod(steel.provenance.at("Monochrome TIS at " + std::to_string(int(theta)) + "°"));
    // The file gives four digits of a sample; the sum needs them at their own places.
    EXPECT_NEAR(stated_scatter(steel, theta) / stated, 1.0, 1e-4) << theta;
  }
  const MeasuredReflectance vinyl = read_reflectance(brdf_file("ValidationTest_of_TIS_via_BrownVinyl.bsdf"));
  for (const double theta : {15.0, 30.0, 50.0, 70.0}) {
    const double stated = std::stod(vinyl.provenance.at("Monochrome TIS at " + std::to_string(int(theta)) + "°"));
    EXPECT_NEAR(stated_scatter(vinyl, theta) / stated, 1.0, 1e-4) << theta;
  }
}

// Mean deviation of two measurements relative to the second, over viewers up to 75° at these azimuths from the light;
// of the first, the viewer is turned by `turn`.
double deviation(const MeasuredReflectance& first, const MeasuredReflectance& second, double theta_i,
                 const std::vector<double>& azimuths, double turn) {
  const Direction light = to_direction(angles(theta_i, 123.0));
  double missed = 0.0, of = 0.0;
  for (int theta = 0; theta <= 75; theta += 5) {
    for (const double phi : azimuths) {
      const double a = evaluate(first, light, to_direction(angles(theta, 123.0 + phi + turn)), {1.0});
      const double b = evaluate(second, light, to_direction(angles(theta, 123.0 + phi)), {1.0});
      if (std::isnan(a) || std::isnan(b)) continue;
      missed += std::abs(a - b);
      of += b;
    }
  }
  return missed / of;
}

// The same measurements of the same sample, on angles about the mirrored ray and on angles about the normal.
TEST(ZemaxFile, AgreesWithTheFredFileOfTheSameSample) {
  MEZZOTINT_NEEDS_DATA(brdf_file("AnoBlackNiTEonSteel.txt"));
  const MeasuredReflectance zemax = read_reflectance(brdf_file("AnoBlackNiTEonSteel.bsdf"));
  const MeasuredReflectance fred = read_reflectance(brdf_file("AnoBlackNiTEonSteel.txt"));
  ASSERT_EQ(fred.incidences.size(), 4U);
  EXPECT_TRUE(fred.isotropic);
  std::vector<double> all;
  for (int phi = 0; phi < 360; phi += 10) all.push_back(phi);
  for (const double theta_i : {10.0, 30.0, 50.0}) {
    // In the plane of incidence only the coarser grid of the Zemax file (10° in the flanks) parts them.
    EXPECT_LT(deviation(zemax, fred, theta_i, {0.0, 180.0}, 0.0), 0.04) << theta_i;
    // Out of it the Zemax file jumps by up to 20 % from one azimuth to the next (10° incidence, 30° from the mirrored
    // ray, azimuths 80° and 90°), which the FRED file does not.
    EXPECT_LT(deviation(zemax, fred, theta_i, all, 0.0), 0.12) << theta_i;
    EXPECT_GT(deviation(zemax, fred, theta_i, all, 180.0), 0.3) << "a frame that is turned round must be noticed";
  }
}

TEST(FredFile, LeavesTheDetectorsShadowOut) {
  MEZZOTINT_NEEDS_DATA(brdf_file("AnoBlackNiTEonSteel.txt"));
  const MeasuredReflectance fred = read_reflectance(brdf_file("AnoBlackNiTEonSteel.txt"));
  const Direction light = to_direction(angles(10.0, 0.0));
  // Line by line of the file, (theta, phi) about the mirrored ray's azimuth.
  EXPECT_NEAR(evaluate(fred, light, to_direction(angles(10.0, 180.0)), {1.0}), 0.060094, 1e-7);
  EXPECT_NEAR(evaluate(fred, light, to_direction(angles(5.0, 180.0 - 140.0)), {1.0}), 0.049226, 1e-7);
  EXPECT_NEAR(evaluate(fred, light, Direction::UnitZ(), {1.0}), 0.052967, 1e-7);
  EXPECT_TRUE(std::isnan(evaluate(fred, light, to_direction(angles(10.0, 0.0)), {1.0}))) << "the detector stands there";
  EXPECT_TRUE(std::isnan(evaluate(fred, light, to_direction(angles(84.0, 180.0)), {1.0})));
  EXPECT_TRUE(std::isnan(evaluate(fred, to_direction(angles(20.0, 0.0)), Direction::UnitZ(), {1.0})));
}

TEST(CornellFile, IsReciprocal) {
  MEZZOTINT_NEEDS_DATA(brdf_file("cornell_garnet_red.brdf"));
  const MeasuredReflectance paint = read_reflectance(brdf_file("cornell_garnet_red.brdf"));
  EXPECT_EQ(paint.channels.size(), 31U);
  EXPECT_EQ(paint.incidences.size(), 8U);
  const ChannelWeights red = channel_weights(paint, {.wavelength = Length::from_nm(650.0)});
  double missed = 0.0, of = 0.0, mirrored = 0.0;
  int pairs = 0;
  for (int a = 10; a <= 70; a += 10) {
    for (int b = a + 10; b <= 70; b += 10) {
      for (int phi = 0; phi <= 180; phi += 15) {
        const auto value = [&](int from, int to, double turn) {
          return evaluate(paint, to_direction(angles(from, 0.0)), to_direction(angles(to, turn)), red);
        };
        const double forth = value(a, b, phi), back = value(b, a, phi);
        if (std::isnan(forth) || std::isnan(back)) continue;
        missed += std::abs(forth - back);
        mirrored += std::abs(forth - or_zero(value(b, a, 180 - phi)));
        of += 0.5 * (forth + back);
        ++pairs;
      }
    }
  }
  EXPECT_GT(pairs, 200);
  EXPECT_LT(missed / of, 0.02) << "measurement and interpolation on 8° rings";
  EXPECT_GT(mirrored / of, 0.15) << "reciprocity that a wrong azimuth would keep says nothing";
}

TEST(CornellFile, GivesItsOwnRowsBack) {
  MEZZOTINT_NEEDS_DATA(brdf_file("cornell_garnet_red.brdf"));
  const MeasuredReflectance paint = read_reflectance(brdf_file("cornell_garnet_red.brdf"));
  const auto radians = [](double theta, double phi) {
    return to_direction({Angle::from_radians(theta), Angle::from_radians(phi)});
  };
  const ChannelWeights first = channel_weights(paint, {.name = "400 nm"}),
                       last = channel_weights(paint, {.name = "700 nm"});
  EXPECT_NEAR(evaluate(paint, radians(0.872665, 0.0), radians(0.573513, 0.0), first), 0.023025, 1e-6);
  EXPECT_NEAR(evaluate(paint, radians(0.872665, 0.0), radians(0.573513, 0.0), last), 0.050083, 1e-6);
  EXPECT_NEAR(evaluate(paint, radians(0.523599, 1.0), radians(0.573513, 1.0 - 0.589049), last), 0.060848, 1e-6);
  EXPECT_TRUE(std::isnan(evaluate(paint, radians(0.523599, 0.0), radians(1.45, 0.5), last))) << "beyond the last ring";
}

// Reciprocity tells which cosine the numbers of the file hold: that of the viewer.
TEST(AltaFile, HoldsTheCosineOfTheViewer) {
  MEZZOTINT_NEEDS_DATA(brdf_file("alta_retro-gray-tape.dat"));
  const MeasuredReflectance tape = read_reflectance(brdf_file("alta_retro-gray-tape.dat"));
  ASSERT_EQ(tape.incidences.size(), 3U);
  const auto value = [&](double from, double to, double phi) {
    return evaluate(tape, to_direction(angles(from, 0.0)), to_direction(angles(to, phi)), {1.0});
  };
  double with = 0.0, without = 0.0;
  int pairs = 0;
  for (const auto& [a, b] : {std::pair{15.0, 30.0}, std::pair{15.0, 60.0}, std::pair{30.0, 60.0}}) {
    for (const double phi : {0.0, 180.0}) {
      const double forth = value(a, b, phi), back = value(b, a, phi);
      const double cos_a = std::cos(a * pi / 180.0), cos_b = std::cos(b * pi / 180.0);
      with += std::abs(std::log(forth / back));
      without += std::abs(std::log(forth * cos_b / (back * cos_a)));
      ++pairs;
    }
  }
  EXPECT_LT(with / pairs, 0.1);
  EXPECT_GT(without / pairs, 2.0 * with / pairs);
  // A retro-reflector: brightest back into the light, and not where a mirror would send it.
  EXPECT_GT(value(15.0, 15.0, 0.0), 50.0 * value(15.0, 15.0, 180.0));
}

TEST(MeasuredFiles, MapsSayWhatWasNotMeasured) {
  MEZZOTINT_NEEDS_DATA(brdf_file("AnoBlackNiTEonSteel.bsdf"));
  const DirectionGrid grid{32, 32};
  const ReflectanceMap zemax =
      reflectance_map(read_reflectance(brdf_file("AnoBlackNiTEonSteel.bsdf")), angles(30, 0), {}, grid);
  const ReflectanceMap fred =
      reflectance_map(read_reflectance(brdf_file("AnoBlackNiTEonSteel.txt")), angles(30, 0), {}, grid);
  // Both end near 80°: beyond lie cos² 80° = 3 % of the disc.
  EXPECT_GT(zemax.not_measured_share, 0.02);
  EXPECT_LT(zemax.not_measured_share, 0.2);
  EXPECT_GT(fred.not_measured_share, 0.02);
  EXPECT_LT(fred.not_measured_share, 0.2);
  EXPECT_NEAR(zemax.albedo / fred.albedo, 1.0, 0.08);
  // A map is bright about the mirrored ray: x < 0 for a light at x > 0.
  double left = 0.0, right = 0.0;
  for (std::size_t row = 0; row < 32; ++row) {
    for (std::size_t column = 0; column < 32; ++column) (column < 16 ? left : right) += fred.map[row * 32 + column];
  }
  EXPECT_GT(left, 1.5 * right);
}

TEST(MeasuredFiles, RefuseALightThatIsNotThereWithThoseThatAre) {
  MEZZOTINT_NEEDS_DATA(brdf_file("AnoBlackNiTEonSteel.txt"));
  const auto refusal = [](const char* name, double theta) {
    return refusal_of_incidence(read_reflectance(brdf_file(name)), angles(theta, 17.0));
  };
  EXPECT_NE(refusal("AnoBlackNiTEonSteel.txt", 20.0).find("10°, 30°, 50°, 70°"), std::string::npos);
  EXPECT_EQ(refusal("AnoBlackNiTEonSteel.txt", 30.0), "");
  EXPECT_EQ(refusal("AnoBlackNiTEonSteel.bsdf", 20.0), "") << "the format's authors interpolate";
  EXPECT_NE(refusal("AnoBlackNiTEonSteel.bsdf", 5.0), "");
  EXPECT_NE(refusal("cornell_garnet_red.brdf", 15.0).find("10°, 20°"), std::string::npos);
  EXPECT_NE(refusal("alta_retro-gray-tape.dat", 45.0).find("15°, 30°, 60°"), std::string::npos);
}

}  // namespace
}  // namespace mezzotint
