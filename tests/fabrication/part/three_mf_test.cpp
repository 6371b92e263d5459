#include <gtest/gtest.h>

#include "fabrication/part/mesh_facts.h"
#include "fabrication/part/part_file.h"
#include "forward/base/error.h"
#include "tests/fabrication/part/solids.h"
#include "tests/fabrication/part/three_mf_writer.h"
#include "tests/test_data.h"

#ifdef __SANITIZE_ADDRESS__
// lib3mf 1.8.1 forgets what it opened of a package that it then refuses. Its frames show in whole stacks only.
extern "C" const char* __lsan_default_suppressions() { return "leak:lib3MF"; }
extern "C" const char* __asan_default_options() { return "fast_unwind_on_malloc=0"; }
#endif

namespace mezzotint {
namespace {

class ThreeMf : public ::testing::Test {
protected:
  PartFile read(const std::string& model) {
    test::write_three_mf(folder_ / "a.3mf", model);
    return read_part(folder_ / "a.3mf");
  }
  test::TemporaryFolder folder_;
};

TEST_F(ThreeMf, UnitsBecomeMillimetres) {
  const std::string cube = test::object_text(1, "", test::unit_box()), item = "<item objectid=\"1\"/>";
  const auto side = [&](const char* unit) {
    return mesh_facts(read(test::model_text(unit, cube, item)).mesh).high_mm[0];
  };
  EXPECT_DOUBLE_EQ(side("micron"), 1e-3);
  EXPECT_DOUBLE_EQ(side("millimeter"), 1.0);
  EXPECT_DOUBLE_EQ(side("centimeter"), 10.0);
  EXPECT_DOUBLE_EQ(side("inch"), 25.4);
  EXPECT_DOUBLE_EQ(side("foot"), 304.8);
  EXPECT_DOUBLE_EQ(side("meter"), 1000.0);
}

// Scaled by 2 in the component, turned by a quarter about z and moved in the build: x' = 5 − 2 y, y' = 6 + 2 x.
TEST_F(ThreeMf, ComponentsAreTransformedFirstThenTheItem) {
  const std::string resources = test::object_text(1, "cube", test::box({1.0, 0.0, 0.0}, {2.0, 3.0, 4.0})) +
                                "<object id=\"2\" name=\"pair\" type=\"model\"><components><component objectid=\"1\" "
                                "transform=\"2 0 0 0 2 0 0 0 2 0 0 0\"/></components></object>";
  const PartFile file = read(test::model_text(
      "millimeter", resources, "<item objectid=\"2\" transform=\"0 1 0 -1 0 0 0 0 1 5 6 7\"/><item objectid=\"1\"/>"));
  EXPECT_EQ(file.mesh.group_names, (std::vector<std::string>{"pair", "cube"}));
  ASSERT_EQ(file.mesh.triangles.size(), 24U);
  EXPECT_EQ(file.mesh.groups[11], 0U);
  EXPECT_EQ(file.mesh.groups[12], 1U);
  const MeshFacts facts = mesh_facts(file.mesh);
  EXPECT_TRUE(facts.watertight());
  EXPECT_DOUBLE_EQ(facts.volume_mm3, 12.0 * 9.0);
  EXPECT_EQ(facts.low_mm, (std::array<double, 3>{-1.0, 0.0, 0.0}));
  EXPECT_EQ(facts.high_mm, (std::array<double, 3>{5.0, 10.0, 15.0}));
}

TEST_F(ThreeMf, AMirrorKeepsTheOutsideOut) {
  const PartFile file = read(test::model_text("millimeter", test::object_text(1, "", test::unit_box()),
                                              "<item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/>"));
  EXPECT_DOUBLE_EQ(mesh_facts(file.mesh).volume_mm3, 1.0);
}

TEST_F(ThreeMf, ComponentsThatMultiplyWithoutEndAreRefused) {
  std::string resources = test::object_text(1, "", test::unit_box());
  for (int id = 2; id < 40; ++id) {
    resources += fmt::format(
        "<object id=\"{0}\" type=\"model\"><components><component objectid=\"{1}\"/><component objectid=\"{1}\"/>"
        "</components></object>",
        id, id - 1);
  }
  EXPECT_THROW((void)read(test::model_text("millimeter", resources, "<item objectid=\"39\"/>")), FileError);
}

TEST_F(ThreeMf, WhatIsNoneOrHasNothingToBuildIsRefused) {
  const std::string cube = test::object_text(1, "", test::unit_box());
  EXPECT_THROW((void)read(test::model_text("millimeter", cube, "")), FileError);
  EXPECT_THROW((void)read(test::model_text("millimeter", cube, "<item objectid=\"7\"/>")), FileError);
  EXPECT_THROW((void)read("no model"), FileError);
  PartMesh far = test::unit_box();
  far.triangles[0][0] = 99;
  EXPECT_THROW((void)read(test::model_text("millimeter", test::object_text(1, "", far), "<item objectid=\"1\"/>")),
               FileError);
}

// Triangles, volume and area by an own reading of the XML, in double; the library holds single precision.
TEST(SharedThreeMf, SamplesHaveTheFactsOfTheirXml) {
  const std::filesystem::path folder = test::external_data_folder() / "3mf";
  MEZZOTINT_NEEDS_DATA(folder);
  struct Sample {
    const char* name;
    std::size_t triangles;
    double volume, area;
  };
  const Sample samples[] = {{"MUSTPASS_MUSTPASS_Chapter2.1_PartsRelationships.3mf", 12, 8000.0, 2400.0},
                            {"MUSTPASS_MUSTPASS_Chapter3.2b_UnitsMeasurementMM.3mf", 12, 1000.0, 600.0},
                            {"MUSTPASS_MUSTPASS_Chapter3.4.2_MetaData_Resources_Build.3mf", 12, 1000.0, 600.0},
                            {"MUSTPASS_MUSTPASS_Chapter4.2_Components.3mf", 60, 14000.0028, 6000.0008},
                            {"MUSTPASS_MUSTPASS_Chapter5.1c_MaterialResources_sRGB_RGB_Colors.3mf", 12, 1000.0, 600.0},
                            {"examples_core_cylinder.3mf", 88, 6198.10185, 1872.17931},
                            {"examples_core_multiple_cylinders.3mf", 528, 37188.5573, 11233.065},
                            {"examples_core_torus.3mf", 2200, 776.830795, 785.594698}};
  for (const Sample& sample : samples) {
    SCOPED_TRACE(sample.name);
    const MeshFacts facts = mesh_facts(read_part(folder / sample.name).mesh);
    EXPECT_EQ(facts.triangles, sample.triangles);
    EXPECT_TRUE(facts.watertight());
    EXPECT_NEAR(facts.volume_mm3, sample.volume, 1e-6 * sample.volume);
    EXPECT_NEAR(facts.area_mm2, sample.area, 1e-6 * sample.area);
  }
}

TEST(SharedThreeMf, SamplesThatMustFailAreRefusedOrReadWithWarnings) {
  const std::filesystem::path folder = test::external_data_folder() / "3mf";
  MEZZOTINT_NEEDS_DATA(folder);
  std::size_t refused = 0, warned = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!entry.path().filename().string().starts_with("MUSTFAIL")) continue;
    try {
      const PartFile file = read_part(entry.path());
      EXPECT_FALSE(file.notes.empty()) << entry.path();
      ++warned;
    } catch (const FileError&) {
      ++refused;
    }
  }
  EXPECT_EQ(refused, 3U);
  EXPECT_EQ(warned, 9U);
}

}  // namespace
}  // namespace mezzotint
