#include <sys/resource.h>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>
#include <limits>

#include "forward/base/error.h"
#include "forward/base/file_output.h"
#include "forward/base/random.h"
#include "measurement/formats/surface_output.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Odd sizes, two pitches, a tilt, noise, and some missing samples; heights within 5 µm about a datum.
HeightField awkward_field(double datum_um, bool with_missing, Continuation continuation = Continuation::Mirrored) {
  const Grid grid{37, 23, Length::from_um(0.438027), Length::from_um(1.0 / 3.0)};
  const RandomStream random(11, RandomPurpose::Test);
  std::vector<float> heights_um;
  double sum = 0.0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double noise = random.bits4(i)[0] * 0x1p-32;
    heights_um.push_back(static_cast<float>(0.1 * static_cast<double>(i % 37) - 2.0 + noise));
    sum += heights_um.back();
  }
  // The datum of a field that was read is its mean.
  for (float& z : heights_um) z -= static_cast<float>(sum / static_cast<double>(grid.size()));
  if (with_missing) {
    for (const std::size_t i : {std::size_t{0}, std::size_t{40}, grid.size() - 1}) {
      heights_um[i] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  return HeightField(grid, continuation, std::move(heights_um), Length::from_um(datum_um));
}

double range_um(const HeightField& field) {
  const HeightRange range = height_range(field);
  return (range.highest - range.lowest).um();
}

struct Format {
  const char* ending;
  double resolution_um;  ///< besides the rounding to float
  double pitch_tolerance;
};

// What surface_output.h states, for heights of up to 5 µm.
std::vector<Format> formats(const HeightField& field) {
  return {{".gwy", 0.0, 1e-15},
          {".x3p", 0.0, 1e-15},
          {".exr", 0.0, 1e-15},
          {".al3d", 3e-7, 1e-15},
          {".sur", 5.0 * 0x1p-30, 6e-8},
          {".png", 0.5 * range_um(field) / (field.missing_count() > 0 ? 65534 : 65535), 1e-15}};
}

void expect_same(const HeightField& written, const HeightField& read, const Format& format) {
  ASSERT_EQ(read.columns(), written.columns());
  ASSERT_EQ(read.rows(), written.rows());
  EXPECT_EQ(read.missing_count(), written.missing_count());
  EXPECT_NEAR(read.grid().pitch_x / written.grid().pitch_x, 1.0, format.pitch_tolerance);
  EXPECT_NEAR(read.grid().pitch_y / written.grid().pitch_y, 1.0, format.pitch_tolerance);
  const double shift_um = (read.datum() - written.datum()).um();
  // Two floats of up to 4 µm, and doubles near the datum (1e-11 µm at 76 mm).
  const double tolerance_um = format.resolution_um * (1.0 + 1e-6) + 5e-7 + 1e-10;
  for (std::size_t i = 0; i < written.grid().size(); ++i) {
    const float before = written.heights_um()[i], after = read.heights_um()[i];
    ASSERT_EQ(std::isnan(before), std::isnan(after)) << i;
    if (!std::isnan(before)) {
      ASSERT_NEAR(after + shift_um, before, tolerance_um) << i;
    }
  }
}

TEST(SurfaceOutput, EveryFormatReadsBackToItsStatedResolution) {
  const test::TemporaryFolder folder;
  for (const double datum_um : {0.0, -3.25, 76340.123456}) {
    for (const bool missing : {false, true}) {
      const HeightField field = awkward_field(datum_um, missing);
      for (const Format& format : formats(field)) {
        SCOPED_TRACE(testing::Message() << format.ending << ", datum " << datum_um << ", missing " << missing);
        const auto path = folder.path() / (std::string("relief") + format.ending);
        write_surface({field, "", "a title", {{"operator", "me"}}, "an assumption"}, path);
        const SurfaceFile again = read_surface(path);
        EXPECT_EQ("." + again.format, format.ending);
        EXPECT_EQ(again.assumption, "");
        expect_same(field, again.field, format);
      }
    }
  }
}

TEST(SurfaceOutput, FlatAndWhollyMissingFieldsGoThroughEveryFormat) {
  const test::TemporaryFolder folder;
  const Grid grid{3, 2, Length::from_um(1.0), Length::from_um(1.0)};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float z : {0.0F, nan}) {
    const HeightField field(grid, Continuation::Mirrored, std::vector<float>(6, z), Length::from_um(12.5));
    for (const char* ending : {".gwy", ".x3p", ".exr", ".al3d", ".sur", ".png"}) {
      SCOPED_TRACE(testing::Message() << ending << ", " << z);
      const auto path = folder.path() / (std::string("relief") + ending);
      write_surface({field, "", "", {}, ""}, path);
      const HeightField again = read_surface(path).field;
      EXPECT_EQ(again.missing_count(), field.missing_count());
      if (!std::isnan(z)) {
        EXPECT_NEAR(again.datum().um() + again.at(1, 1), 12.5, 1e-9);
      }
    }
  }
}

TEST(SurfaceOutput, ThePeriodIsKeptWhereAFormatHasRoomForIt) {
  const test::TemporaryFolder folder;
  const HeightField field = awkward_field(0.0, false, Continuation::Periodic);
  for (const auto& [ending, kept] : {std::pair{".gwy", true}, {".png", true}, {".exr", true}, {".sur", false}}) {
    const auto path = folder.path() / (std::string("relief") + ending);
    write_surface({field, "", "", {}, ""}, path);
    EXPECT_EQ(read_surface(path).field.periodic(), kept) << ending;
  }
}

TEST(SurfaceOutput, TheSameReliefGivesTheSameBytes) {
  const test::TemporaryFolder folder;
  const HeightField field = awkward_field(76340.0, true);
  for (const char* ending : {".gwy", ".x3p", ".exr", ".al3d", ".sur", ".png", ".obj"}) {
    const auto first = folder.path() / (std::string("first") + ending);
    const auto second = folder.path() / (std::string("second") + ending);
    write_surface({field, "", "", {{"date", "2019-12-31"}}, ""}, first);
    write_surface({field, "", "", {{"date", "2019-12-31"}}, ""}, second);
    if (std::string_view(ending) != ".obj") {  // names its material file
      EXPECT_TRUE(bytes_of(first) == bytes_of(second)) << ending;
    }
  }
}

TEST(SurfaceOutput, OtherEndingsAreRefusedByName) {
  try {
    write_surface({awkward_field(0.0, false), "", "", {}, ""}, "relief.stl");
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find(".gwy, .x3p, .sur"), std::string::npos);
  }
}

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

/// As long as it lives, no file can grow beyond a size: what a full disk does to a writer.
class FullDisk {
public:
  explicit FullDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

private:
  rlimit before_{};
};

TEST(SurfaceOutput, AFullDiskLeavesNothingHalfAndTheOldFileWhole) {
  const HeightField field = awkward_field(0.0, true);
  for (const char* ending : {".gwy", ".x3p", ".exr", ".al3d", ".sur", ".png"}) {
    SCOPED_TRACE(ending);
    const test::TemporaryFolder folder;
    const auto path = folder.path() / (std::string("relief") + ending);
    write_surface({field, "", "", {}, ""}, path);
    const std::string before = bytes_of(path);
    const std::size_t files = files_in(folder.path());
    {
      const FullDisk full(512);
      const HeightField other = awkward_field(5.0, false);
      EXPECT_THROW(write_surface({other, "", "", {}, ""}, path), DeviceError);
    }
    EXPECT_TRUE(bytes_of(path) == before);
    EXPECT_EQ(files_in(folder.path()), files);
    expect_same(field, read_surface(path).field, {ending, 1e-3, 1e-6});
  }
}

TEST(SurfaceOutput, KnowsHowFarHeightsMayBeOff) {
  const test::TemporaryFolder folder;
  for (const bool with_missing : {false, true}) {
    const HeightField field = awkward_field(0.0, with_missing, Continuation::Periodic);
    for (const char* ending : {".gwy", ".x3p", ".exr", ".al3d", ".sur", ".png"}) {
      const auto path = folder.path() / (std::string("copy") + ending);
      write_surface({field, "", "", {}, ""}, path);
      const HeightField read = read_surface(path).field;
      EXPECT_EQ(read.periodic(), keeps_period(path)) << ending;
      double worst = 0.0;
      for (std::size_t i = 0; i < field.grid().size(); ++i)
        if (!std::isnan(field.heights_um()[i]))
          worst = std::max(worst,
                           std::abs(double{read.heights_um()[i]} + read.datum().um() - double{field.heights_um()[i]}));
      const double stated = rounding_of(field, path)->um();
      EXPECT_LE(worst, stated + 2.5e-7) << ending;  // a float of up to 4 µm, about the mean that reading takes out
      if (std::string(ending) == ".png") {
        EXPECT_GT(worst, 0.5 * stated);  // of 850 heights some lie near half a step
      }
    }
    EXPECT_FALSE(rounding_of(field, folder / "mesh.obj").has_value());
  }
}

}  // namespace
}  // namespace mezzotint
