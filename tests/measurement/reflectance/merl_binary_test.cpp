#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/optics/microfacet.h"
#include "measurement/reflectance/reflectance_map.h"
#include "measurement/reflectance/reflectance_parsers.h"
#include "tests/measurement/reflectance/tensor_builder.h"

namespace mezzotint {
namespace {

constexpr double pi = std::numbers::pi;
const GgxLobe lobe{0.3, 0.3, {}};

// The pair of directions at half and difference angles, built forward: the difference direction turned by the half
// angle about y. The reader goes the other way.
std::pair<Direction, Direction> pair_of(double half, double difference, double phi) {
  const Direction d(std::sin(difference) * std::cos(phi), std::sin(difference) * std::sin(phi), std::cos(difference));
  const Direction light(std::cos(half) * d.x() + std::sin(half) * d.z(), d.y(),
                        std::cos(half) * d.z() - std::sin(half) * d.x());
  const Direction m(std::sin(half), 0.0, std::cos(half));
  return {light, 2.0 * light.dot(m) * m - light};
}

// GGX in red, half of it in green, a quarter in blue, at the middle of every bin; negative below the horizon.
std::string file() {
  std::string bytes;
  for (const std::int32_t count : {90, 90, 180}) test::append(bytes, count);
  const double scale[3] = {1500.0, 0.5 * 1500.0 / 1.15, 0.25 * 1500.0 / 1.66};
  for (const double factor : scale) {
    for (int h = 0; h < 90; ++h) {
      for (int d = 0; d < 90; ++d) {
        for (int p = 0; p < 180; ++p) {
          const double share = (h + 0.5) / 90.0;
          const auto [light, viewer] =
              pair_of(share * share * pi / 2.0, (d + 0.5) / 90.0 * pi / 2.0, (p + 0.5) / 180.0 * pi);
          const bool above = light.z() > 0.0 && viewer.z() > 0.0;
          test::append(bytes, above ? factor * brdf(lobe, Mirror{}, light, viewer) : -1.0);
        }
      }
    }
  }
  return bytes;
}

const std::string& whole_file() {
  static const std::string bytes = file();
  return bytes;
}

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

TEST(Merl, GivesAModelBackWithinItsBins) {
  const MeasuredReflectance measured = parse_merl("f.binary", bytes_of(whole_file()));
  EXPECT_TRUE(measured.isotropic);
  for (const double phi_i : {0.0, 40.0, -100.0}) {
    for (const double theta_i : {10.0, 30.0, 60.0}) {
      const Direction light = to_direction({Angle::from_degrees(theta_i), Angle::from_degrees(phi_i)});
      double missed = 0.0, of = 0.0;
      for (int theta = 2; theta <= 76; theta += 3) {
        for (int phi = 0; phi < 360; phi += 11) {
          const Direction viewer = to_direction({Angle::from_degrees(theta), Angle::from_degrees(phi)});
          const double wanted = brdf(lobe, Mirror{}, light, viewer);
          missed += std::abs(evaluate(measured, light, viewer, channel_weights(measured, {.name = "R"})) - wanted);
          of += wanted;
        }
      }
      // Half a bin is 0.5° in the difference angle, and 0.9 % of θ_h at its end: some per cent of a lobe of α = 0.3.
      EXPECT_LT(missed / of, 0.03) << theta_i;
    }
  }
}

TEST(Merl, IsReciprocalAndScalesItsChannels) {
  const MeasuredReflectance measured = parse_merl("f.binary", bytes_of(whole_file()));
  const Direction a = to_direction({Angle::from_degrees(20), Angle::from_degrees(10)});
  const Direction b = to_direction({Angle::from_degrees(47), Angle::from_degrees(150)});
  const ChannelWeights red = channel_weights(measured, {.name = "R"}), blue = channel_weights(measured, {.name = "B"});
  EXPECT_DOUBLE_EQ(evaluate(measured, a, b, red), evaluate(measured, b, a, red));
  EXPECT_NEAR(evaluate(measured, a, b, blue) / evaluate(measured, a, b, red), 0.25, 1e-6);
  EXPECT_NEAR(evaluate(measured, a, b, channel_weights(measured)) / evaluate(measured, a, b, red),
              0.2126 + 0.7152 * 0.5 + 0.0722 * 0.25, 1e-6);
}

TEST(Merl, MapOfTheModelKeepsItsLight) {
  const MeasuredReflectance measured = parse_merl("f.binary", bytes_of(whole_file()));
  const DirectionGrid grid{32, 32};
  const DirectionAngles light{Angle::from_degrees(30), Angle::from_degrees(0)};
  const ReflectanceMap map = reflectance_map(measured, light, {.name = "R"}, grid);
  EXPECT_LT(relative_l2(grid, map.map, reflection_map(lobe, Mirror{}, light, grid)), 0.02);
  EXPECT_LT(map.not_measured_share, 0.03) << "bins whose middle lies below the horizon are missing in the file";
}

TEST(Merl, RefusesWrongCountsAndLengths) {
  const auto complaint = [](const std::string& text) -> std::string {
    try {
      (void)parse_merl("f.binary", bytes_of(text));
    } catch (const FileError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_NE(complaint(whole_file().substr(0, 1000)).find("byte 1000: ends after 1000 bytes"), std::string::npos);
  EXPECT_NE(complaint(whole_file() + "x").find("has 34992012"), std::string::npos);
  EXPECT_NE(complaint("ab").find("byte 0"), std::string::npos);
  std::string wrong = whole_file().substr(0, 12);
  wrong[0] = 91;
  EXPECT_NE(complaint(wrong).find("has 91 angles"), std::string::npos);
  std::string nan = whole_file();
  for (int i = 0; i < 8; ++i) nan[12 + 80 + i] = '\xff';
  EXPECT_NE(complaint(nan).find("byte 92: holds a sample that is not finite"), std::string::npos);
}

}  // namespace
}  // namespace mezzotint
