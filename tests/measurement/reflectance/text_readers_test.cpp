#include <gtest/gtest.h>

#include <string>

#include "forward/base/error.h"
#include "measurement/reflectance/reflectance_parsers.h"
#include "tests/measurement/reflectance/small_files.h"

namespace mezzotint {
namespace {

using Parser = MeasuredReflectance (*)(const std::filesystem::path&, std::span<const std::byte>);

MeasuredReflectance parsed(Parser parse, const std::string& text) { return parse("f", std::as_bytes(std::span(text))); }

std::string complaint(Parser parse, const std::string& text) {
  try {
    (void)parsed(parse, text);
  } catch (const FileError& error) {
    return error.what();
  }
  return "none";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

const auto files = test::small_files();
const std::string &zemax = files.at("zemax"), &fred = files.at("fred"), &cornell = files.at("cornell"),
                  &alta = files.at("alta");

TEST(TextReaders, ReadSmallFiles) {
  const MeasuredReflectance z = parsed(parse_zemax, zemax);
  const Direction up = Direction::UnitZ();
  EXPECT_NEAR(evaluate(z, up, up, {1.0}), 1.0, 1e-7);
  // Light from 20° is half way: the mirrored ray is worth (1 + 2)/2.
  const Direction light = to_direction({20.0_deg, 0.0_deg}), mirrored = to_direction({20.0_deg, 180.0_deg});
  EXPECT_NEAR(evaluate(z, light, mirrored, {1.0}), 1.5, 1e-6);
  // From 40°, 30° beyond the mirrored ray: the 0 says that nothing was measured.
  const Direction from_40 = to_direction({40.0_deg, 0.0_deg});
  EXPECT_TRUE(std::isnan(evaluate(z, from_40, to_direction({70.0_deg, 180.0_deg}), {1.0})));
  EXPECT_NEAR(evaluate(z, from_40, to_direction({10.0_deg, 180.0_deg}), {1.0}), 1.5, 1e-6);

  const MeasuredReflectance f = parsed(parse_fred, fred);
  EXPECT_NEAR(evaluate(f, to_direction({30.0_deg, 0.0_deg}), to_direction({20.0_deg, 180.0_deg}), {1.0}), 1.0, 1e-6);
  EXPECT_NEAR(evaluate(f, to_direction({30.0_deg, 0.0_deg}), to_direction({20.0_deg, 0.0_deg}), {1.0}), 0.6, 1e-6);
  EXPECT_NEAR(evaluate(f, to_direction({30.0_deg, 0.0_deg}), to_direction({30.0_deg, -90.0_deg}), {1.0}), 0.5, 1e-6);

  const MeasuredReflectance c = parsed(parse_cornell, cornell);
  const Direction from = to_direction({Angle::from_radians(0.5), 0.0_deg});
  EXPECT_NEAR(evaluate(c, from, from, channel_weights(c, {.wavelength = Length::from_nm(550.0)})), 3.5, 1e-6);

  const MeasuredReflectance a = parsed(parse_alta, alta);
  EXPECT_NEAR(evaluate(a, from, from, {1.0}), 2.0 / std::cos(0.5), 1e-6);
  EXPECT_NE(a.quantity.find("cosθ_o"), std::string::npos);
}

TEST(TextReaders, ComplainWithTheLine) {
  EXPECT_NE(complaint(parse_zemax, replaced(zemax, "1.0\t0.4", "1.0")).find("line 19: has 1 samples"),
            std::string::npos);
  EXPECT_NE(complaint(parse_zemax, replaced(zemax, "0\t40", "0\t40\t50")).find("line 9: has 3 angles"),
            std::string::npos);
  EXPECT_NE(complaint(parse_zemax, replaced(zemax, "0\t40", "40\t0")).find("must increase"), std::string::npos);
  EXPECT_NE(complaint(parse_zemax, replaced(zemax, "0.5", "nan")).find("not finite"), std::string::npos);
  EXPECT_NE(complaint(parse_zemax, replaced(zemax, "0.5", "-0.5")).find("line 18: holds a sample of -0.5"),
            std::string::npos);
  EXPECT_NE(complaint(parse_zemax, replaced(zemax, "BRDF", "BTDF")).find("only BRDF"), std::string::npos);
  EXPECT_NE(complaint(parse_zemax, zemax.substr(0, 250)).find("f: line "), std::string::npos);
  EXPECT_NE(complaint(parse_fred, replaced(fred, "20 90 0.4", "20 90 0.4 7")).find("line 6: has 4 numbers"),
            std::string::npos);
  EXPECT_NE(complaint(parse_fred, replaced(fred, "30 0\n", "")).find("line 3: a viewer stands before"),
            std::string::npos);
  EXPECT_NE(complaint(parse_fred, replaced(fred, "bsdf=value", "bsdf=log")).find("\"bsdf=log\" is not known"),
            std::string::npos);
  EXPECT_NE(complaint(parse_fred, replaced(fred, "40 90", "140 90")).find("line 9"), std::string::npos);
  EXPECT_NE(complaint(parse_cornell, replaced(cornell, "5 6\n", "5\n")).find("line 12: has 5 numbers"),
            std::string::npos);
  EXPECT_NE(complaint(parse_cornell, replaced(cornell, "600", "400")).find("must increase"), std::string::npos);
  EXPECT_NE(complaint(parse_cornell, replaced(cornell, "\n2\n", "\n99999999999\n")).find("1 to 4096"),
            std::string::npos);
  EXPECT_NE(complaint(parse_alta, alta + "#DIM 3 9\n").find("line 9: a line of the head stands after"),
            std::string::npos);
  EXPECT_NE(complaint(parse_alta, replaced(alta, "PROJ_DPHI", "DPHI")).find("line 4"), std::string::npos);
  EXPECT_NE(complaint(parse_alta, replaced(alta, "0.5 0.5 0 2", "0.5 0.5 0 x")).find("line 6: \"x\" is no number"),
            std::string::npos);
  EXPECT_NE(complaint(parse_alta, alta.substr(0, alta.find("0.5 0.5"))).find("three or more"), std::string::npos);
}

TEST(TextReaders, AllocateNoMoreThanTheFileCanHold) {
  // A head of 4096 angles each would promise 7e10 samples.
  std::string angles;
  for (int i = 0; i < 4096; ++i) angles += std::to_string(0.02 * i) + "\t";
  const std::string huge =
      "Source Measured\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterType BRDF\nSampleRotation 1\n0\n"
      "AngleOfIncidence 4096\n" +
      angles + "\nScatterAzimuth 4096\n" + angles + "\nScatterRadial 4096\n" + angles + "\n";
  EXPECT_NE(complaint(parse_zemax, huge).find("more than the rest of the file can hold"), std::string::npos);
  // A diagonal of FRED samples would make a grid of n².
  std::string diagonal = "type bsdf_data\nformat angles=deg bsdf=value scale=1\n30 0\n";
  for (int i = 1; i < 3000; ++i) diagonal += std::to_string(0.02 * i) + " " + std::to_string(0.05 * i) + " 1\n";
  EXPECT_NE(complaint(parse_fred, diagonal).find("a quarter or more"), std::string::npos);
}

}  // namespace
}  // namespace mezzotint
