#include <cmath>

#include <gtest/gtest.h>

#include "fabrication/part/mesh_facts.h"
#include "fabrication/part/part_file.h"
#include "forward/base/error.h"
#include "tests/fabrication/part/reference_facts.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

// The reference holds eight digits.
void expect_near(double value, double reference, double scale, const std::string& what) {
  EXPECT_NEAR(value, reference, 1e-6 * std::max(std::abs(reference), 1e-3 * scale)) << what;
}

TEST(SharedMeshes, HaveTheFactsThatAnotherReaderFound) {
  const std::filesystem::path folder = test::external_data_folder() / "mesh";
  MEZZOTINT_NEEDS_DATA(folder / "reference_mesh_facts.csv");
  const auto all = test::read_reference_facts(folder / "reference_mesh_facts.csv");
  ASSERT_EQ(all.size(), 30U);
  for (const auto& reference : all) {
    const MeshFacts facts = mesh_facts(read_part(folder / reference.file).mesh);
    SCOPED_TRACE(reference.file);
    EXPECT_EQ(facts.triangles, reference.triangles);
    EXPECT_EQ(facts.vertices, reference.vertices);
    EXPECT_EQ(facts.degenerate_triangles, reference.degenerate);
    EXPECT_EQ(facts.boundary_edges, reference.boundary);
    EXPECT_EQ(facts.non_manifold_edges, reference.non_manifold);
    EXPECT_EQ(facts.inconsistent_edges, reference.inconsistent);
    expect_near(facts.area_mm2, reference.area, reference.area, "area");
    expect_near(facts.volume_mm3, reference.volume, std::pow(reference.area, 1.5), "volume");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      expect_near(facts.low_mm[axis], reference.low[axis], std::sqrt(reference.area), "low");
      expect_near(facts.high_mm[axis], reference.high[axis], std::sqrt(reference.area), "high");
    }
  }
}

TEST(SharedMeshes, WithoutATriangleAreRefused) {
  const std::filesystem::path folder = test::external_data_folder() / "mesh";
  MEZZOTINT_NEEDS_DATA(folder / "tm_stl_empty_ascii.stl");
  EXPECT_THROW((void)read_part(folder / "tm_stl_empty_ascii.stl"), FileError);
  EXPECT_THROW((void)read_part(folder / "tm_stl_empty_bin.stl"), FileError);
}

}  // namespace
}  // namespace mezzotint
