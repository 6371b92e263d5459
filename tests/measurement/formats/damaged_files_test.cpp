#include <cmath>
#include <ctime>
#include <fstream>
#include <string>

#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "measurement/formats/surface_output.h"
#include "tests/measurement/formats/instrument_builders.h"
#include "tests/measurement/formats/victims.h"
#include "tests/measurement/relief.h"
#include "tests/test_data.h"

// Files as a user meets them, through read_surface: cut short at 20 places and with one byte changed at 200. Each is
// read, or refused by a FileError that names it; in no more time than the whole one takes, give or take.

namespace mezzotint {
namespace {

namespace fs = std::filesystem;

// An odd width, missing samples, heights 76 mm off the stage.
HeightField victim_field() {
  HeightField field = test::field_of(test::micrometre_grid(21, 17),
                                     [](double c, double r) { return 3.0 * std::sin(0.4 * c) + 0.1 * r; });
  field.at(3, 4) = field.at(20, 0) = test::missing;
  field.set_frame(Continuation::Mirrored, Length::from_m(0.0763));
  return field;
}

std::string bytes_of(const fs::path& path) {
  const auto bytes = read_file(path);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Straight to the place: write_file waits for the disk each time.
void put(const fs::path& path, std::string_view bytes) { std::ofstream(path, std::ios::binary) << bytes; }

// Reads a surface one of whose files is damaged; counts refusals.
bool is_refused(const fs::path& surface, const fs::path& damaged, const ReadOptions& options) {
  const std::clock_t start = std::clock();
  bool refused = false;
  try {
    static_cast<void>(read_surface(surface, options));
  } catch (const FileError& error) {
    refused = true;
    EXPECT_NE(std::string(error.what()).find(damaged.filename().string()), std::string::npos) << error.what();
    EXPECT_GT(std::string(error.what()).size(), damaged.string().size() + 8U) << error.what();
  }
  // Of computing: a whole one takes a millisecond, and a sanitizer makes no second of it.
  EXPECT_LT(static_cast<double>(std::clock() - start), 5.0 * CLOCKS_PER_SEC) << damaged;
  return refused;
}

struct Refusals {
  int of_cut = 0, of_changed = 0;
};

Refusals damage(const fs::path& surface, const fs::path& file, const ReadOptions& options = {}) {
  SCOPED_TRACE(file.filename().string());
  const std::string whole = bytes_of(file);
  static_cast<void>(read_surface(surface, options));
  Refusals refusals;
  for (std::size_t k = 0; k < 20; ++k) {
    put(file, std::string_view(whole).substr(0, whole.size() * k / 20));
    refusals.of_cut += is_refused(surface, file, options) ? 1 : 0;
  }
  for (std::size_t k = 0; k < 200; ++k) {
    std::string changed = whole;
    char& byte = changed[whole.size() * k / 200];
    byte = static_cast<char>(byte ^ (k % 2 == 0 ? 0x55 : 0xFF));
    put(file, changed);
    refusals.of_changed += is_refused(surface, file, options) ? 1 : 0;
  }
  put(file, whole);
  return refusals;
}

class DamagedFiles : public testing::TestWithParam<const char*> {};

TEST_P(DamagedFiles, AreReadOrRefusedByName) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / (std::string("relief") + GetParam());
  write_surface({victim_field(), "", "a title", {}, ""}, path);
  EXPECT_EQ(damage(path, path).of_cut, 20);
  if (!has_sidecar(path)) return;
  // Of a sidecar some parts may be missing.
  EXPECT_GT(damage(path, files_of_surface(path).at(1)).of_cut, 0);
}
INSTANTIATE_TEST_SUITE_P(EveryFormatThatIsWritten, DamagedFiles,
                         testing::Values(".al3d", ".gwy", ".x3p", ".sur", ".png", ".exr"));

struct Foreign {
  const char* format;
  const char* name;
  const char* sidecar;
};

class DamagedForeignFiles : public testing::TestWithParam<Foreign> {};

TEST_P(DamagedForeignFiles, AreReadOrRefusedByName) {
  const auto [format, name, sidecar] = GetParam();
  const test::TemporaryFolder folder;
  for (const test::Victim& victim : test::victims()) {
    if (std::string_view(victim.format) != format) continue;
    const fs::path path = folder / name;
    put(path, victim.bytes);
    if (*sidecar != '\0') put(path.string() + ".toml", sidecar);
    const Refusals refusals = damage(path, path);
    // Empty ones at least; the beginning of a list of numbers is a list of numbers.
    EXPECT_GE(refusals.of_cut, victim.any_part_may_be_whole ? 1 : 18) << victim.name;
  }
}
INSTANTIATE_TEST_SUITE_P(EveryOtherFormat, DamagedForeignFiles,
                         testing::Values(Foreign{"sdf", "relief.sdf", ""}, Foreign{"opd", "relief.opd", ""},
                                         Foreign{"sur", "relief.sur", ""}, Foreign{"x3p", "relief.x3p", ""},
                                         Foreign{"tiff", "relief.tif",
                                                 "width_um = 3.0\ndepth_um = 2.0\nvalue_um = 1.0\n"},
                                         Foreign{"csv", "relief.csv", "width_um = 3.0\nvalue_um = 1.0\n"},
                                         Foreign{"xyz", "relief.xyz", "xy_um = 1.0\nvalue_um = 1.0\n"}));

TEST(DamagedFolder, OfAliconaIsReadOrRefusedWhicheverOfItsFilesIsDamaged) {
  const test::TemporaryFolder folder;
  write_surface({victim_field(), "", "", {}, ""}, folder / "dem.al3d");
  put(folder / "qualitymap.bmp", test::build_bmp(21, 17, std::vector<std::uint8_t>(21 * 17, 200)));
  put(folder / "info.xml", "<Info><Objective><Name>50x</Name></Objective><Date>2019</Date></Info>");
  EXPECT_EQ(damage(folder.path(), folder / "dem.al3d", {.min_quality = 100}).of_cut, 20);
  EXPECT_EQ(damage(folder.path(), folder / "qualitymap.bmp", {.min_quality = 100}).of_cut, 20);
  // What is said about a scan is no reason to refuse its heights.
  const Refusals of_information = damage(folder.path(), folder / "info.xml", {.min_quality = 100});
  EXPECT_EQ(of_information.of_cut + of_information.of_changed, 0);
}

}  // namespace
}  // namespace mezzotint
