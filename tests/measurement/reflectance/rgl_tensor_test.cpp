#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "measurement/reflectance/reflectance_map.h"
#include "measurement/reflectance/reflectance_parsers.h"
#include "tests/measurement/reflectance/tensor_builder.h"

namespace mezzotint {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

DirectionAngles angles(double theta, double phi) { return {Angle::from_degrees(theta), Angle::from_degrees(phi)}; }

struct Agreement {
  double largest = 0.0;  // relative to the lobe's peak at that light
  double mean_relative = 0.0;
  std::size_t count = 0, missing = 0;
};

// Over viewers up to 75°: nearer to the horizon the samples end.
Agreement agreement(const MeasuredReflectance& measured, const MicrofacetLobe& lobe, const DirectionAngles& light) {
  Agreement result;
  const Direction to_light = to_direction(light);
  const ChannelWeights weights = channel_weights(measured, {.name = "G"});
  double peak = 0.0;
  std::vector<std::pair<double, double>> pairs;
  for (int theta = 1; theta <= 75; theta += 2) {
    for (int phi = -180; phi < 180; phi += 7) {
      const Direction viewer = to_direction(angles(theta, phi));
      const double wanted = 0.5 * brdf(lobe, Mirror{}, to_light, viewer);
      const double got = evaluate(measured, to_light, viewer, weights);
      peak = std::max(peak, wanted);
      if (std::isnan(got)) {
        ++result.missing;
      } else {
        pairs.emplace_back(got, wanted);
      }
    }
  }
  double sum = 0.0, of = 0.0;
  for (const auto& [got, wanted] : pairs) {
    result.largest = std::max(result.largest, std::abs(got - wanted) / peak);
    sum += std::abs(got - wanted);
    of += wanted;
  }
  result.count = pairs.size();
  result.mean_relative = sum / of;
  return result;
}

TEST(RglTensor, GivesAnIsotropicModelBack) {
  for (const MicrofacetLobe& lobe :
       {MicrofacetLobe{BeckmannLobe{0.35, 0.35, {}}}, MicrofacetLobe{GgxLobe{0.3, 0.3, {}}}}) {
    const std::string file = test::packed(test::tensor_of(lobe, {}));
    const MeasuredReflectance measured = parse_rgl("f.bsdf", bytes_of(file));
    EXPECT_TRUE(measured.isotropic);
    EXPECT_EQ(measured.incidences.size(), 9U);
    EXPECT_EQ(measured.provenance.at("description"), "Analytic lobe");
    // At the file's own directions of the light, from any azimuth; the bilinear grids leave some thousandths.
    for (const auto& light : {angles(20, 0), angles(40, 77), angles(60, -130)}) {
      const Agreement own = agreement(measured, lobe, light);
      EXPECT_LT(own.largest, 0.006) << light.theta.degrees();
      EXPECT_LT(own.mean_relative, 0.002) << light.theta.degrees();
      EXPECT_GT(own.count, 1200U) << own.missing << " " << light.theta.degrees();
    }
    // Half way between two of them, 10° apart, the warps are mixed, which is the authors' approximation.
    const Agreement between = agreement(measured, lobe, angles(35, 10));
    EXPECT_LT(between.largest, 0.03);
    EXPECT_LT(between.mean_relative, 0.003);
  }
}

TEST(RglTensor, GivesAnAnisotropicModelBackWithItsRotation) {
  const MicrofacetLobe lobe = GgxLobe{0.45, 0.2, Angle::from_degrees(25.0)};
  const std::string file =
      test::packed(test::tensor_of(lobe, {.theta = 5, .phi = 9, .visible = 96, .samples = 40, .normals = 160}));
  const MeasuredReflectance measured = parse_rgl("f.bsdf", bytes_of(file));
  EXPECT_FALSE(measured.isotropic);
  for (const auto& light : {angles(20, 45), angles(40, -90), angles(40, 180)}) {
    const Agreement own = agreement(measured, lobe, light);
    EXPECT_LT(own.largest, 0.006) << light.theta.degrees() << " " << light.phi.degrees();
    EXPECT_LT(own.mean_relative, 0.002) << light.theta.degrees() << " " << light.phi.degrees();
  }
  const Agreement turned = agreement(measured, GgxLobe{0.45, 0.2, Angle::from_degrees(-25.0)}, angles(40, -90));
  EXPECT_GT(turned.mean_relative, 0.2) << "a test that a mirrored frame would pass is no test";
}

TEST(RglTensor, HalfATurnOfTheLightIsEnough) {
  const MicrofacetLobe lobe = BeckmannLobe{0.45, 0.25, Angle::from_degrees(25.0)};
  const std::string file = test::packed(test::tensor_of(
      lobe, {.theta = 5, .phi = 5, .turn = std::numbers::pi, .visible = 96, .samples = 40, .normals = 160}));
  const MeasuredReflectance measured = parse_rgl("f.bsdf", bytes_of(file));
  for (const auto& light : {angles(40, -45), angles(40, 45), angles(40, 135)}) {
    EXPECT_LT(agreement(measured, lobe, light).mean_relative, 0.002) << light.phi.degrees();
  }
}

TEST(RglTensor, MapKeepsTheLightOfTheModel) {
  const MicrofacetLobe lobe = GgxLobe{0.3, 0.3, {}};
  const std::string file = test::packed(test::tensor_of(lobe, {}));
  const MeasuredReflectance measured = parse_rgl("f.bsdf", bytes_of(file));
  const DirectionGrid grid{32, 32};
  const ReflectanceMap map = reflectance_map(measured, angles(20, 30), {.name = "R"}, grid);
  const DirectionMap wanted = reflection_map(lobe, Mirror{}, angles(20, 30), grid);
  double missed = 0.0, albedo = 0.0;
  const auto areas = projected_solid_angles(grid);
  for (std::size_t k = 0; k < areas.size(); ++k) {
    missed += areas[k] * std::abs(map.map[k] * map.measured[k] - wanted[k] * map.measured[k]);
    albedo += areas[k] * wanted[k] * map.measured[k];
  }
  EXPECT_LT(missed / albedo, 0.01);
  EXPECT_NEAR(map.albedo, albedo, 0.01 * albedo);
  EXPECT_LT(map.not_measured_share, 0.1);
  EXPECT_GT(map.not_measured_share, 0.0) << "samples below the horizon are invalid in the file";
}

TEST(RglTensor, RefusesALightBeyondTheMeasuredOnes) {
  const std::string file =
      test::packed(test::tensor_of(BeckmannLobe{}, {.theta = 3, .visible = 8, .samples = 8, .normals = 8}));
  const MeasuredReflectance measured = parse_rgl("f.bsdf", bytes_of(file));
  try {
    (void)reflectance_map(measured, angles(85, 0), {}, {16, 16});
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("0°, 40°, 80°"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(std::isnan(evaluate(measured, to_direction(angles(85, 0)), Direction::UnitZ(), {1.0, 0.0, 0.0})));
}

class DamagedTensor : public testing::Test {
protected:
  static std::string complaint(const std::vector<test::TensorFieldBytes>& fields) {
    return complaint_of(test::packed(fields));
  }
  static std::string complaint_of(const std::string& file) {
    try {
      (void)parse_rgl("f.bsdf", bytes_of(file));
    } catch (const FileError& error) {
      return error.what();
    }
    return "none";
  }
  std::vector<test::TensorFieldBytes> fields_ =
      test::tensor_of(BeckmannLobe{}, {.theta = 3, .visible = 6, .samples = 6, .normals = 6});
};

TEST_F(DamagedTensor, IsRefusedWithTheByte) {
  EXPECT_EQ(complaint(fields_), "none");
  const std::string whole = test::packed(fields_);
  for (std::size_t length = 0; length < whole.size(); length += 97)
    EXPECT_NE(complaint_of(whole.substr(0, length)).find("byte "), std::string::npos) << length;
  auto damaged = fields_;
  test::append(damaged[3].bytes, std::nanf(""));
  damaged[3].bytes = damaged[3].bytes.substr(sizeof(float));
  EXPECT_NE(complaint(damaged).find("\"ndf\" holds nan"), std::string::npos);
  damaged = fields_;
  damaged[2].shape[0] = 2;
  EXPECT_NE(complaint(damaged).find("does not fit"), std::string::npos);
  damaged = fields_;
  damaged[5].shape[3] = std::uint64_t{1} << 61U;
  EXPECT_NE(complaint(damaged).find("claims"), std::string::npos);
  damaged = fields_;
  damaged.erase(damaged.begin() + 4);
  EXPECT_NE(complaint(damaged).find("\"sigma\""), std::string::npos);
  damaged = fields_;
  damaged[5].bytes.assign(damaged[5].bytes.size(), '\0');
  EXPECT_NE(complaint(damaged).find("empty"), std::string::npos);
}

}  // namespace
}  // namespace mezzotint
