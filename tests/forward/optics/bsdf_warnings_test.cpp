#include "forward/optics/bsdf_warnings.h"

#include <filesystem>

#include <gtest/gtest.h>

namespace mezzotint {
namespace {

MapEstimate exact(const DirectionMap& map) { return {map, DirectionMap(map.size(), 0.0), map, map}; }

// All light spread over so many whole bins in the middle of the map.
Bsdf lobe_of(std::size_t bins_a_side) {
  Bsdf bsdf;
  bsdf.grid = {64, 64};
  DirectionMap map(bsdf.grid.size(), 0.0);
  for (std::size_t row = 0; row < bins_a_side; ++row) {
    for (std::size_t column = 0; column < bins_a_side; ++column) map[(28 + row) * 64 + 28 + column] = 100.0;
  }
  bsdf.reflection = exact(map);
  bsdf.transmission = exact(DirectionMap(bsdf.grid.size(), 0.0));
  return bsdf;
}

TEST(BsdfWarnings, AreKeptOncePerSentence) {
  Bsdf bsdf = lobe_of(4);
  EXPECT_TRUE(warnings_of(bsdf.provenance).empty());
  add_warnings(bsdf, {"one; with a semicolon", "two"});
  add_warnings(bsdf, {"two", "three"});
  EXPECT_EQ(warnings_of(bsdf.provenance), (std::vector<std::string>{"one; with a semicolon", "two", "three"}));
  const auto file = std::filesystem::temp_directory_path() / "mezzotint_bsdf_warnings.exr";
  write_exr(bsdf, file);
  EXPECT_EQ(warnings_of(read_exr(file).provenance), warnings_of(bsdf.provenance));
  std::filesystem::remove(file);
}

TEST(BsdfWarnings, ComeFromALobeNarrowerThanABin) {
  // 9 bins are fewer than 4π = 12.6, 16 are more.
  ASSERT_EQ(map_warnings(lobe_of(3)).size(), 1U);
  EXPECT_NE(map_warnings(lobe_of(3)).front().find("the reflected light fills 9.0 bins only"), std::string::npos);
  EXPECT_TRUE(map_warnings(lobe_of(4)).empty());
}

TEST(BsdfWarnings, DoNotTakeNoiseForALobe) {
  Bsdf bsdf = lobe_of(8);
  // Two halves that saw different bins: a few paths, not a narrow lobe.
  bsdf.reflection.half_a.assign(bsdf.grid.size(), 0.0);
  bsdf.reflection.half_b.assign(bsdf.grid.size(), 0.0);
  bsdf.reflection.half_a[2000] = bsdf.reflection.half_b[2100] = 1e4;
  EXPECT_TRUE(map_warnings(bsdf).empty());
}

TEST(BsdfWarnings, ComeFromLightOnTheRim) {
  Bsdf bsdf = lobe_of(4);
  const auto areas = projected_solid_angles(bsdf.grid);
  double inner = 16.0 * 100.0 * areas[28 * 64 + 28], rim = 0.0;
  for (std::size_t k = 0; k < areas.size(); ++k) {
    if (areas[k] > 0.0 && areas[k] < 0.999 * areas[28 * 64 + 28]) rim += areas[k];
  }
  const auto with_share = [&](double share) {
    Bsdf both = bsdf;
    DirectionMap map = both.reflection.mean;
    for (std::size_t k = 0; k < areas.size(); ++k) {
      if (areas[k] > 0.0 && areas[k] < 0.999 * areas[28 * 64 + 28]) map[k] = share / (1.0 - share) * inner / rim;
    }
    both.reflection = exact(map);
    return map_warnings(both);
  };
  EXPECT_TRUE(with_share(0.19).empty());
  ASSERT_EQ(with_share(0.25).size(), 1U);
  EXPECT_EQ(with_share(0.25).front().find("25 % of the reflected light"), 0U);
}

}  // namespace
}  // namespace mezzotint
