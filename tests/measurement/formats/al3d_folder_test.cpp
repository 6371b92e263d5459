#include <cmath>

#include "forward/base/error.h"
#include "forward/base/file_output.h"
#include "measurement/formats/quality_map.h"
#include "measurement/formats/surface_file.h"
#include "tests/measurement/formats/instrument_builders.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

using test::as_bytes;
using test::build_bmp;

std::string small_al3d() {
  return test::build_al3d({3, 2, {1e-6F, 2e-6F, 3e-6F, 4e-6F, 5e-6F, 6e-6F}, true, true, {}});
}

std::string complaint(const std::filesystem::path& path, const ReadOptions& options) {
  try {
    static_cast<void>(read_surface(path, options));
  } catch (const FileError& error) {
    return error.what();
  }
  return "no complaint";
}

TEST(Al3dFolder, IsReadAsOneFile) {
  const test::TemporaryFolder folder;
  write_file(folder / "dem.al3d", small_al3d());
  write_file(
      folder / "info.xml",
      "<Object3D version=\"1\"><generalData><name>coin</name><createdBy> me </createdBy></generalData></Object3D>");
  const SurfaceFile surface = read_surface(folder.path());
  EXPECT_EQ(surface.format, "al3d");
  EXPECT_EQ(files_of_surface(folder.path()), std::vector<std::filesystem::path>{folder / "dem.al3d"});
  EXPECT_EQ(surface.field.missing_count(), 0U);
  EXPECT_EQ(surface.provenance.at("info.xml generalData/name"), "coin");
  EXPECT_EQ(surface.provenance.at("info.xml generalData/createdBy"), "me");
  write_file(folder / "info.xml", "<Object3D><gener");
  EXPECT_NE(read_surface(folder.path()).provenance.at("info.xml").find("cannot be used"), std::string::npos);
}

TEST(Al3dFolder, SamplesBelowTheThresholdOfQualityAreMissingOnRequest) {
  const test::TemporaryFolder folder;
  write_file(folder / "dem.al3d", small_al3d());
  write_file(folder / "qualitymap.bmp", build_bmp(3, 2, {255, 99, 100, 255, 0, 255}));
  EXPECT_EQ(read_surface(folder.path()).field.missing_count(), 0U);
  for (const auto& path : {folder.path(), folder / "dem.al3d"}) {
    const HeightField field = read_surface(path, {.min_quality = 100}).field;
    EXPECT_EQ(field.missing_count(), 2U);
    EXPECT_TRUE(std::isnan(field.at(1, 1)));  // the second of the top row
    EXPECT_TRUE(std::isnan(field.at(1, 0)));
    EXPECT_NEAR(field.at(2, 1) + field.datum().um(), 3.0, 1e-6);
  }
}

TEST(Al3dFolder, AThresholdWithoutAFittingMapIsRefused) {
  const test::TemporaryFolder folder;
  write_file(folder / "dem.al3d", small_al3d());
  EXPECT_NE(complaint(folder.path(), {.min_quality = 1}).find("qualitymap.bmp: no such file"), std::string::npos);
  write_file(folder / "qualitymap.bmp", build_bmp(2, 3, std::vector<std::uint8_t>(6)));
  EXPECT_NE(complaint(folder.path(), {.min_quality = 1}).find("has 2 × 3 pixels; the 3 × 2"), std::string::npos);
  write_file(folder / "scan.gwy",
             test::GwyBuilder().object("/0/data", "GwyDataField", test::gwy_field(1, 1, 1, 1, {0.0})).file());
  EXPECT_NE(complaint(folder / "scan.gwy", {.min_quality = 1}).find("has no quality map"), std::string::npos);
}

TEST(Al3dFolder, TellsTheQualityOfItsSamplesWhereItHasAMap) {
  const test::TemporaryFolder folder;
  write_file(folder / "dem.al3d", small_al3d());
  const SurfaceFile surface = read_surface(folder.path());
  EXPECT_FALSE(sample_quality(folder.path(), surface).has_value());
  write_file(folder / "qualitymap.bmp", build_bmp(3, 2, {255, 99, 100, 255, 7, 255}));
  for (const auto& path : {folder.path(), folder / "dem.al3d"}) {
    const auto quality = sample_quality(path, surface);
    ASSERT_TRUE(quality.has_value());
    EXPECT_EQ(quality->lowest, 7);
    EXPECT_EQ(quality->median, 255);  // the fourth of 7 99 100 255 255 255
    EXPECT_EQ(quality->highest, 255);
  }
}

TEST(QualityMap, ReadsPalettesBottomUpAndTopDownAndColoursThatAreGray) {
  std::string bmp = build_bmp(3, 2, {1, 2, 3, 4, 5, 6});
  EXPECT_EQ(parse_quality_map("q.bmp", as_bytes(bmp)).gray, (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6}));
  bmp[22] = static_cast<char>(0xFE);  // a height of −2
  bmp[23] = bmp[24] = bmp[25] = static_cast<char>(0xFF);
  EXPECT_EQ(parse_quality_map("q.bmp", as_bytes(bmp)).gray, (std::vector<std::uint8_t>{4, 5, 6, 1, 2, 3}));
  bmp[54 + 4 * 4] = 77;  // blue of the colour 4
  EXPECT_THROW(static_cast<void>(parse_quality_map("q.bmp", as_bytes(bmp))), FileError);
}

}  // namespace
}  // namespace mezzotint
