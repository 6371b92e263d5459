#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "fabrication/part/part_file.h"
#include "fabrication/repair/repair.h"
#include "forward/base/error.h"
#include "tests/fabrication/part/reference_facts.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

class SharedRepair : public ::testing::Test {
protected:
  void SetUp() override {
    folder_ = test::external_data_folder() / "mesh";
    MEZZOTINT_NEEDS_DATA(folder_ / "reference_mesh_facts.csv");
  }
  RepairedPart mended(const std::string& name) { return repair_part(read_part(folder_ / name).mesh); }
  std::filesystem::path folder_;
};

TEST_F(SharedRepair, EveryMeshIsMendedOrRefusedWithAReason) {
  std::map<std::string, std::string> refused;
  for (const auto& reference : test::read_reference_facts(folder_ / "reference_mesh_facts.csv")) {
    SCOPED_TRACE(reference.file);
    try {
      const RepairedPart part = mended(reference.file);
      EXPECT_TRUE(part.summary.after.closed());
      EXPECT_GT(part.summary.after.volume_mm3, 0.0);
      // What bounds a volume already, facing out, is not touched.
      const bool sound =
          reference.boundary + reference.inconsistent + reference.non_manifold == 0 && reference.volume > 0.0;
      if (sound) {
        EXPECT_FALSE(part.summary.changed());
        EXPECT_NEAR(part.summary.after.volume_mm3, reference.volume, 1e-6 * reference.volume);
      }
    } catch (const MethodError& error) {
      refused[reference.file] = error.what();
    }
  }
  std::vector<std::string> names;
  for (const auto& [name, reason] : refused) names.push_back(name);
  EXPECT_EQ(names, (std::vector<std::string>{"ig_degenerated.obj", "tm_notenoughindices.obj", "tm_polygonfaces.obj",
                                             "tm_soup.stl"}));
}

// ADMesh's final volume of all of them is that of the block.
TEST_F(SharedRepair, TheBrokenBlocksBecomeTheBlock) {
  constexpr double block = 61.023745, area = 93.000187;
  for (const char* name : {"ad_block_fill-holes-bad.stl", "ad_block_fill-holes-good.stl",
                           "ad_block_normal-directions-bad.stl", "ad_block_normal-directions-good.stl"}) {
    SCOPED_TRACE(name);
    const MeshFacts facts = mended(name).summary.after;
    EXPECT_TRUE(facts.watertight());
    EXPECT_EQ(facts.triangles, 12U);
    EXPECT_EQ(facts.vertices, 8U);
    EXPECT_NEAR(facts.volume_mm3, block, 1e-6 * block);
    EXPECT_NEAR(facts.area_mm2, area, 1e-6 * area);
  }
}

TEST_F(SharedRepair, TheUnconnectedTriangleIsLeftOut) {
  const RepairedPart part = mended("ad_block_remove-unconnected-bad.stl");
  EXPECT_EQ(part.summary.scraps_removed, 1U);
  EXPECT_EQ(part.summary.after.triangles, 24U);
  EXPECT_NEAR(part.summary.after.volume_mm3, 122.04749, 1e-6 * 122.0);
  EXPECT_NEAR(part.summary.after.area_mm2, 186.00038, 1e-6 * 186.0);
}

// A corner of one of its triangles is 0.17 mm away, with a slit of four edges. ADMesh moves the corner, by a tolerance
// of the shortest edge; this closes the slit, which leaves a dent of that size at most.
TEST_F(SharedRepair, ACornerThatIsAwayIsClosedWithADent) {
  const MeshFacts facts = mended("ad_block_nearby-bad.stl").summary.after;
  EXPECT_TRUE(facts.watertight());
  EXPECT_NEAR(facts.volume_mm3, 61.023745, 0.6);
}

TEST_F(SharedRepair, BodiesThatTouchKeepTheirVolume) {
  EXPECT_NEAR(mended("tm_shared.STL").summary.after.volume_mm3, 2.0, 1e-9);
  EXPECT_NEAR(mended("tm_joined_tetrahedra.obj").summary.after.volume_mm3, 0.8660254, 1e-6);
}

}  // namespace
}  // namespace mezzotint
