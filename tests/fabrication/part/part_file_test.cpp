#include "fabrication/part/part_file.h"

#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "fabrication/part/mesh_facts.h"
#include "forward/base/error.h"
#include "tests/fabrication/part/solids.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

class PartFiles : public ::testing::Test {
protected:
  std::filesystem::path put(const char* name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  std::string refusal(const char* name, const std::string& text) {
    try {
      (void)read_part(put(name, text));
    } catch (const FileError& error) {
      return error.what();
    }
    return "";
  }
  test::TemporaryFolder folder_;
};

TEST_F(PartFiles, AnStlComesBackAsItWasWritten) {
  const PartMesh mesh = test::torus(3.0, 1.0, 50, 20);
  write_stl(mesh, folder_ / "torus.stl");
  EXPECT_EQ(std::filesystem::file_size(folder_ / "torus.stl"), 84U + 50U * mesh.triangles.size());
  const PartFile file = read_part(folder_ / "torus.stl");
  ASSERT_EQ(file.mesh.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(file.mesh.vertices_mm.size(), mesh.vertices_mm.size());
  EXPECT_TRUE(file.notes.empty());
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double written = mesh.vertices_mm[mesh.triangles[k][corner]][axis];
        EXPECT_EQ(file.mesh.vertices_mm[file.mesh.triangles[k][corner]][axis], double{static_cast<float>(written)});
      }
    }
  }
}

TEST_F(PartFiles, CornersAtOnePlaceAreOneVertexAndMinusZeroIsZero) {
  const PartFile file = read_part(put("a.obj",
                                      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 -0.0\nv 0 0 1\nv 7 7 7\n"
                                      "f 1 3 2\nf 4 2 5\nf 2 3 5\nf 3 4 5\n"));
  EXPECT_EQ(file.mesh.vertices_mm.size(), 4U);  // and the one that nothing uses is gone
  EXPECT_TRUE(mesh_facts(file.mesh).watertight());
}

TEST_F(PartFiles, AUnitIsAsked) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto path = put("a.obj", triangle);
  EXPECT_EQ(read_part(path).mesh.vertices_mm[1][0], 1.0);
  ASSERT_EQ(read_part(path).notes.size(), 1U);
  EXPECT_NE(read_part(path).notes[0].find("1 mm"), std::string::npos);
  EXPECT_DOUBLE_EQ(read_part(path, {.unit = Length::from_mm(25.4)}).mesh.vertices_mm[1][0], 25.4);
  const auto ours = put("b.obj", "# Mezzotint: micrometres\n" + triangle);
  EXPECT_DOUBLE_EQ(read_part(ours).mesh.vertices_mm[1][0], 1e-3);
  EXPECT_THROW((void)read_part(path, {.unit = Length::from_mm(0.0)}), InvalidInput);
  EXPECT_THROW((void)read_part(path, {.unit = Length::from_mm(1e12)}), FileError);
}

TEST_F(PartFiles, GroupsOfAnObjAreNamedByObjectGroupAndMaterial) {
  const PartMesh mesh = read_part(put("a.obj",
                                      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\no head\ng eyes\nusemtl black\n"
                                      "f 1 2 4\nusemtl red\nf 1 2 3 4\nusemtl black\nf 2 3 4\n"))
                            .mesh;
  ASSERT_EQ(mesh.group_names, (std::vector<std::string>{"", "head/eyes/black", "head/eyes/red"}));
  EXPECT_EQ(mesh.groups, (std::vector<std::uint32_t>{0, 1, 2, 2, 1}));
  EXPECT_TRUE(read_part(put("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")).mesh.groups.empty());
}

TEST_F(PartFiles, WhatIsWrongIsSaidWithItsPlace) {
  EXPECT_NE(refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n").find("line 4"), std::string::npos);
  EXPECT_NE(refusal("b.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n").find("line 2"), std::string::npos);
  EXPECT_NE(refusal("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n").find("no triangle"), std::string::npos);
  EXPECT_NE(refusal("d.stl", "solid a\nendsolid a\n").find("no triangle"), std::string::npos);
  EXPECT_NE(refusal("e.step", "ISO-10303-21;").find(".3mf"), std::string::npos);
}

TEST_F(PartFiles, ABinaryStlWithInfinityIsRefusedAtItsByte) {
  PartMesh mesh = test::unit_box();
  mesh.vertices_mm[7][2] = std::numeric_limits<double>::infinity();
  write_stl(mesh, folder_ / "a.stl");
  try {
    (void)read_part(folder_ / "a.stl");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("byte 220"), std::string::npos) << error.what();  // third triangle, third
  }
}

TEST_F(PartFiles, ABinaryStlThatBeginsWithSolidIsBinary) {
  write_stl(test::unit_box(), folder_ / "a.stl");
  std::fstream(folder_ / "a.stl", std::ios::in | std::ios::out | std::ios::binary) << "solid facet ";
  EXPECT_EQ(read_part(folder_ / "a.stl").format, "stl (binary)");
}

TEST_F(PartFiles, NothingToWriteIsRefused) {
  EXPECT_THROW(write_stl({}, folder_ / "a.stl"), InvalidInput);
  EXPECT_THROW(write_stl(test::unit_box(), folder_ / "a.obj"), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
