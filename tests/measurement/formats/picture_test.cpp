#include <cmath>
#include <limits>

#include "forward/base/error.h"
#include "forward/base/file_output.h"
#include "measurement/formats/plain_parsers.h"
#include "tests/measurement/formats/instrument_builders.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

using test::as_bytes;
using test::build_exr;
using test::build_png;
using test::build_tiff;

Sidecar gray_sidecar() {
  Sidecar sidecar;
  sidecar.width_um = 30.0;
  sidecar.depth_um = 18.0;
  return sidecar;
}

Sidecar float_sidecar(double value_um) {
  Sidecar sidecar;
  sidecar.width_um = 30.0;
  sidecar.value_um = value_um;
  return sidecar;
}

SurfaceFile parse(const std::string& bytes, const Sidecar& sidecar) {
  return parse_picture("test.png", as_bytes(bytes), sidecar);
}

std::string complaint(const std::string& bytes, const Sidecar& sidecar) {
  try {
    parse(bytes, sidecar);
  } catch (const FileError& error) {
    return error.what();
  }
  return "no complaint";
}

const std::vector<unsigned> six_grays = {0, 1, 32767, 32768, 65534, 65535};

// Gray levels as heights between 0 and the depth, the top row first.
void expect_six(const HeightField& field, double depth_um, double white = 65535.0) {
  ASSERT_EQ(field.columns(), 3U);
  ASSERT_EQ(field.rows(), 2U);
  for (std::size_t i = 0; i < 6; ++i) {
    const double expected = depth_um * six_grays[i] / white;
    EXPECT_NEAR(field.at(i % 3, 1 - i / 3) + field.datum().um(), expected, 1e-6) << i;  // floats about the mean
  }
}

TEST(Picture, GrayOf16BitsSpansTheDepthAndThePictureItsWidth) {
  const SurfaceFile surface = parse(build_png(3, 2, 16, six_grays), gray_sidecar());
  expect_six(surface.field, 18.0);
  EXPECT_NEAR(surface.field.grid().pitch_x.um(), 10.0, 1e-12);
  EXPECT_NEAR(surface.field.grid().pitch_y.um(), 10.0, 1e-12);
  EXPECT_EQ(surface.format, "png");
  EXPECT_EQ(surface.assumption, "");
}

TEST(Picture, TheSidecarGivesLengthDatumPeriodMissingGrayAndTheFirstRow) {
  Sidecar sidecar = gray_sidecar();
  sidecar.length_um = 50.0;
  sidecar.datum_um = 76000.0;
  sidecar.periodic = true;
  sidecar.missing_gray = 0;
  const HeightField field = parse(build_png(3, 2, 16, six_grays), sidecar).field;
  EXPECT_NEAR(field.grid().pitch_y.um(), 25.0, 1e-12);
  EXPECT_TRUE(field.periodic());
  EXPECT_EQ(field.missing_count(), 1U);
  EXPECT_TRUE(std::isnan(field.at(0, 1)));
  EXPECT_NEAR(field.at(2, 0) + field.datum().um(), 76018.0, 2e-6);  // a float of 7 µm, a double of 76 mm
  sidecar.first_row_on_top = false;
  EXPECT_TRUE(std::isnan(parse(build_png(3, 2, 16, six_grays), sidecar).field.at(0, 0)));
}

TEST(Picture, EveryLevelOf8BitsIsReadAndItsCoarsenessSaid) {
  std::vector<unsigned> levels;
  for (unsigned level = 0; level < 256; ++level) levels.push_back(level);
  Sidecar sidecar = gray_sidecar();
  sidecar.depth_um = 255.0;
  const SurfaceFile surface = parse(build_png(256, 1, 8, levels), sidecar);
  EXPECT_NE(surface.assumption.find("256 levels"), std::string::npos);
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_NEAR(surface.field.at(i, 0) + surface.field.datum().um(), static_cast<double>(i), 1e-5);
  }
}

TEST(Picture, TiffInBothByteOrdersAndWithFloats) {
  for (const bool big_endian : {false, true}) {
    SCOPED_TRACE(big_endian ? "MM" : "II");
    const std::vector<double> grays(six_grays.begin(), six_grays.end());
    expect_six(parse(build_tiff({3, 2, 16, big_endian, false, grays}), gray_sidecar()).field, 18.0);
    const std::vector<double> heights = {0.001, -0.002, 0.003, std::nan(""), 0.005, 0.006};
    const HeightField field = parse(build_tiff({3, 2, 32, big_endian, true, heights}), float_sidecar(1000.0)).field;
    EXPECT_EQ(field.missing_count(), 1U);
    EXPECT_NEAR(field.at(1, 1) + field.datum().um(), -2.0, 1e-6);
    EXPECT_NEAR(field.at(2, 0) + field.datum().um(), 6.0, 1e-6);
  }
}

TEST(Picture, ExrHoldsHeightsAsFloats) {
  const float inf = std::numeric_limits<float>::infinity();
  const SurfaceFile surface = parse(build_exr(3, 2, {1.0F, -2.0F, 3.0F, inf, 5.0F, 6.0F}), float_sidecar(1.0));
  EXPECT_EQ(surface.format, "exr");
  EXPECT_EQ(surface.field.missing_count(), 1U);
  EXPECT_NEAR(surface.field.at(1, 1) + surface.field.datum().um(), -2.0, 1e-6);
}

TEST(Picture, TheSidecarMustHaveWhatTheKindOfPictureNeeds) {
  EXPECT_NE(complaint(build_png(3, 2, 16, six_grays), float_sidecar(1.0)).find("test.png.toml: depth_um: is missing"),
            std::string::npos);
  EXPECT_NE(complaint(build_exr(1, 1, {1.0F}), gray_sidecar()).find("value_um: is missing"), std::string::npos);
  Sidecar no_width = gray_sidecar();
  no_width.width_um.reset();
  EXPECT_NE(complaint(build_png(3, 2, 16, six_grays), no_width).find("width_um: is missing"), std::string::npos);
}

TEST(Picture, ColourAndDamageAreRefused) {
  std::string png = build_png(3, 2, 16, six_grays);
  std::string damaged = png;
  damaged[png.size() - 20] = static_cast<char>(damaged[png.size() - 20] ^ 1);
  EXPECT_NE(complaint(damaged, gray_sidecar()).find("checksum does not fit"), std::string::npos);
  EXPECT_NE(complaint(build_png(3, 2, 4, std::vector<unsigned>(6)), gray_sidecar()).find("4 bits a pixel"),
            std::string::npos);
  EXPECT_NE(complaint(build_png(30000, 30000, 16, {}), gray_sidecar()).find("which deflate cannot do"),
            std::string::npos);
}

TEST(Picture, WithoutASidecarItIsRefusedWithWhatToWrite) {
  const test::TemporaryFolder folder;
  write_file(folder / "relief.png", build_png(3, 2, 16, six_grays));
  try {
    static_cast<void>(read_surface(folder / "relief.png"));
    FAIL() << "guessed a size";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("relief.png.toml, such as width_um"), std::string::npos) << error.what();
  }
  write_file(folder / "relief.png.toml", "width_um = 30.0\ndepth_um = 18.0\n");
  expect_six(read_surface(folder / "relief.png").field, 18.0);
  EXPECT_EQ(files_of_surface(folder / "relief.png").size(), 2U);
}

std::string sidecar_complaint(std::string_view toml) {
  try {
    static_cast<void>(parse_sidecar("a.toml", as_bytes(toml)));
  } catch (const FileError& error) {
    return error.what();
  }
  return "no complaint";
}

TEST(Sidecar, ComplainsWithLineAndColumn) {
  EXPECT_EQ(sidecar_complaint("width_um = 1.0\nwdith_um = 2.0").substr(0, 41),
            "a.toml: 2:12: unknown key \"wdith_um\"; the");
  EXPECT_NE(sidecar_complaint("width_um = \"wide\"").find("1:12: width_um must be a number"), std::string::npos);
  EXPECT_NE(sidecar_complaint("width_um = nan").find("must be a number"), std::string::npos);
  EXPECT_NE(sidecar_complaint("width_um = 0").find("must be positive"), std::string::npos);
  EXPECT_NE(sidecar_complaint("depth_um = 0").find("all heights would be the same"), std::string::npos);
  EXPECT_NE(sidecar_complaint("missing_gray = 70000").find("0 to 65535"), std::string::npos);
  EXPECT_NE(sidecar_complaint("first_row = \"left\"").find("\"top\" or \"bottom\""), std::string::npos);
  EXPECT_NE(sidecar_complaint("width_um = ").find("is not valid TOML"), std::string::npos);
}

TEST(Sidecar, ReadsBackWhatItWrites) {
  Sidecar sidecar;
  sidecar.width_um = 640.1;
  sidecar.length_um = 1.0 / 3.0;
  sidecar.depth_um = 18.0;
  sidecar.datum_um = 76340.123456789;
  sidecar.missing_gray = 0;
  sidecar.periodic = true;
  sidecar.title = "a \"coin\"";
  sidecar.provenance = {{"operator", "J\xC3\xB6rg"}, {"two words", "back\\slash"}};
  const Sidecar again = parse_sidecar("a.toml", as_bytes(sidecar_text(sidecar)));
  EXPECT_EQ(again.width_um, sidecar.width_um);
  EXPECT_EQ(again.length_um, sidecar.length_um);
  EXPECT_EQ(again.depth_um, sidecar.depth_um);
  EXPECT_EQ(again.datum_um, sidecar.datum_um);
  EXPECT_EQ(again.missing_gray, sidecar.missing_gray);
  EXPECT_TRUE(again.periodic);
  EXPECT_EQ(again.title, sidecar.title);
  EXPECT_EQ(again.provenance, sidecar.provenance);
}

}  // namespace
}  // namespace mezzotint
