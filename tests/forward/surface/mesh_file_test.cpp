#include <bit>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/file_output.h"
#include "forward/base/random.h"
#include "forward/surface/mesh_file.h"
#include "forward/surface/mesh_parsers.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

using namespace literals;

std::string number_bytes(std::uint32_t value) {
  std::string bytes;
  for (int k = 0; k < 4; ++k) bytes += static_cast<char>(value >> (8 * k));
  return bytes;
}
std::string number_bytes(float value) { return number_bytes(std::bit_cast<std::uint32_t>(value)); }

// Two triangles over the unit square, in every format.
std::string square_obj() {
  return "# a square\nv 0 0 0\nv 1 0 0 1.0\nv 1 +1 0\nvn 0 0 1\nv 0 1e0 0\no square\nf 1/1/1 2//1 3\\\n -1 # last\n";
}
std::string square_ply() {
  return "ply\r\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\nproperty uchar red\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0 7\n1 0 0 7\n1 1 0 7\n0 1 0 7\n4 0 1 2 3\n";
}
std::string square_binary_ply() {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement edge 1\nproperty int a\nelement vertex 4\nproperty float x\n"
      "property float y\nproperty float z\nelement face 2\nproperty list uchar uint vertex_index\nend_header\n";
  text += number_bytes(5U);
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 1.F, 0.F, 0.F, 1.F, 0.F}) text += number_bytes(x);
  for (const auto& corners : {std::array{0U, 1U, 2U}, std::array{0U, 2U, 3U}}) {
    text += '\3';
    for (const std::uint32_t corner : corners) text += number_bytes(corner);
  }
  return text;
}
std::string facet_text(const char* corners) {
  std::istringstream words(corners);
  std::string text = " facet normal 0 0 1\n  outer loop\n";
  for (std::string x, y; words >> x >> y;) text += "   vertex " + x + " " + y + " 0\n";
  return text + "  endloop\n endfacet\n";
}
std::string square_stl() {
  return "solid a square\n" + facet_text("0 0 1 0 1 1") + facet_text("0 0 1 1 -0 1") + "endsolid a square\n";
}
std::string square_binary_stl() {
  std::string bytes(80, ' ');
  bytes.replace(0, 6, "solid ");  // as some programs write
  bytes += number_bytes(2U);
  for (const auto& corners : {std::array{0.F, 0.F, 1.F, 0.F, 1.F, 1.F}, std::array{0.F, 0.F, 1.F, 1.F, 0.F, 1.F}}) {
    for (const float n : {0.F, 0.F, 1.F}) bytes += number_bytes(n);
    for (std::size_t k = 0; k < 6; k += 2)
      bytes += number_bytes(corners[k]) + number_bytes(corners[k + 1]) + number_bytes(0.F);
    bytes += std::string(2, '\0');
  }
  return bytes;
}

class MeshFiles : public testing::Test {
protected:
  std::filesystem::path put(const std::string& name, const std::string& bytes) {
    const std::filesystem::path path = folder_.path() / name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  std::string complaint(const std::string& name, const std::string& bytes) {
    try {
      (void)read_mesh(put(name, bytes));
    } catch (const FileError& error) {
      return error.what();
    }
    return "none";
  }

private:
  test::TemporaryFolder folder_;
};

struct Format {
  const char* name;
  std::string bytes;
  const char* format;
  RawMesh (*parser)(const std::filesystem::path&, std::span<const std::byte>);
};
std::vector<Format> formats() {
  return {{"square.obj", square_obj(), "obj", parse_obj},
          {"text.ply", square_ply(), "ply (text)", parse_ply},
          {"binary.PLY", square_binary_ply(), "ply (binary)", parse_ply},
          {"text.stl", square_stl(), "stl (text)", parse_stl},
          {"binary.STL", square_binary_stl(), "stl (binary)", parse_stl}};
}

TEST_F(MeshFiles, HoldTheSameSquareInEveryFormat) {
  for (const Format& format : formats()) {
    const MeshFile file = read_mesh(put(format.name, format.bytes), 1.0_um);
    EXPECT_EQ(file.format, format.format);
    EXPECT_EQ(file.assumption, "") << format.name;
    EXPECT_EQ(file.mesh.vertices_um.size(), 4U) << format.name;  // an STL's six corners are four vertices
    ASSERT_EQ(file.mesh.triangles.size(), 2U) << format.name;
    const auto corner = [&](std::size_t triangle, std::size_t k) {
      return file.mesh.vertices_um[file.mesh.triangles[triangle][k]];
    };
    EXPECT_EQ(corner(0, 1), (std::array{1.F, 0.F, 0.F}));
    EXPECT_EQ(corner(0, 2), (std::array{1.F, 1.F, 0.F}));
    EXPECT_EQ(corner(1, 2), (std::array{0.F, 1.F, 0.F}));
  }
}

TEST_F(MeshFiles, SayWhichUnitWasAssumed) {
  const MeshFile stl = read_mesh(put("a.stl", square_stl()));
  EXPECT_EQ(stl.mesh.vertices_um[1][0], 1000.0F);
  EXPECT_NE(stl.assumption.find("1 mm"), std::string::npos);
  const MeshFile obj = read_mesh(put("a.obj", square_obj()));
  EXPECT_EQ(obj.mesh.vertices_um[1][0], 1.0F);
  EXPECT_NE(obj.assumption.find("1 µm"), std::string::npos);
  EXPECT_EQ(read_mesh(put("a.obj", square_obj()), Length::from_m(1.0)).mesh.vertices_um[1][0], 1e6F);
}

TEST_F(MeshFiles, ReadBackWhatWriteObjWroteToTheLastBit) {
  HeightField field({17, 9, 0.123_um, 0.456_um}, Continuation::Mirrored);
  for (std::size_t k = 0; k < field.grid().size(); ++k)
    field.heights_um()[k] = static_cast<float>(std::sin(1e3 * static_cast<double>(k)) * 1e-3);
  const TriangleMesh mesh = to_mesh(field);
  const std::filesystem::path path = put("relief.obj", "");
  write_obj(mesh, {}, path);
  const MeshFile file = read_mesh(path);
  EXPECT_EQ(file.assumption, "");  // its comment names the unit
  EXPECT_EQ(file.mesh.vertices_um, mesh.vertices_um);
  EXPECT_EQ(file.mesh.triangles, mesh.triangles);
}

TEST_F(MeshFiles, AreMovedToTheOriginInDoubleWhereTheyLieFarAway) {
  const MeshFile file = read_mesh(put("far.obj", "v 1e7 0 0\nv 10000000.125 0 0\nv 1e7 1 0\nf 1 2 3\n"));
  EXPECT_EQ(file.mesh.vertices_um[1][0], 0.125F);  // single precision has steps of 1 there
  EXPECT_NE(file.assumption.find("moved by"), std::string::npos);
}

TEST_F(MeshFiles, LeaveOutFacesWithoutAreaAndSaySo) {
  const MeshFile file =
      read_mesh(put("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 2 0 0\nf 1 2 3\nf 1 2\nf 1 2 4\nf 1 1 3\n"));
  EXPECT_EQ(file.mesh.triangles.size(), 1U);
  EXPECT_NE(file.assumption.find("3 faces"), std::string::npos) << file.assumption;
}

TEST_F(MeshFiles, AreRefusedWithThePlaceOfWhatIsWrong) {
  const auto has = [&](const std::string& name, const std::string& bytes, const std::string& words) {
    const std::string message = complaint(name, bytes);
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  has("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "line 4: a face names vertex 4; there are 3");
  has("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", "line 4: a face names vertex -4");
  has("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n", "line 4");
  has("a.obj", "v 0 0 nan\n", "line 1: a vertex has a coordinate that is no finite number");
  has("a.obj", "v 0 0\n", "line 1: a vertex needs three numbers");
  has("a.obj", "v 0 0 0\n", "has no triangle");
  has("a.obj", "", "is empty");
  has("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "has no triangle with an area");
  has("a.dxf", "0", "no mesh by its ending");
  has("a.stl", std::string(84, '\0'), "has no triangle");
  has("a.stl", square_binary_stl().substr(0, 150), "says 2 triangles, but has bytes for 1");
  has("a.stl", std::string(80, '\0') + number_bytes(4000000000U), "says 4000000000 triangles");
  has("a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0", "line 4: ends where \"a number\" is due");
  has("a.ply", "ply\nformat ascii 1.0\nelement vertex 1000000000000\nproperty float x\nend_header\n1",
      "more than the file");
  has("a.ply", "ply\nformat ascii 1.0\nelement nothing 1000000000000\nend_header\n1", "more than the file");
  has("a.ply", square_ply().substr(0, square_ply().size() - 4), "truncated");
  has("a.ply", square_binary_ply().substr(0, square_binary_ply().size() - 4), "longer than the file");
  has("a.ply", "plx", "is no PLY");
}

// Outcome does not matter; no crash, no other exception, no memory out of bounds (sanitizers watch along).
TEST_F(MeshFiles, MayBeCutAndAlteredAnywhere) {
  const RandomStream random(1, RandomPurpose::Test);
  std::size_t refused = 0, tries = 0;
  for (const Format& format : formats()) {
    for (std::uint64_t k = 0; k < 400; ++k) {
      std::string bytes = format.bytes;
      const auto u = random.uniform4(k);
      if (k < 100) {
        bytes.resize(static_cast<std::size_t>(u[0] * static_cast<double>(bytes.size())));
      } else {
        for (std::uint32_t change = 0; change <= k % 4; ++change) {
          const auto v = random.uniform4(k, change + 1);
          bytes[static_cast<std::size_t>(v[0] * static_cast<double>(bytes.size()))] = static_cast<char>(v[1] * 256.0);
        }
      }
      ++tries;
      const std::vector<std::byte> exact(std::as_bytes(std::span(bytes)).begin(),
                                         std::as_bytes(std::span(bytes)).end());
      try {
        const RawMesh mesh = format.parser("hostile", exact);
        for (const auto& triangle : mesh.triangles)
          for (const std::uint32_t corner : triangle) ASSERT_LT(corner, mesh.vertices.size());
      } catch (const FileError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, tries / 4);  // so many are damaged beyond doubt: all of the cut ones, nearly
}

// Facts found by trimesh and admesh; STL files are in whatever unit they say, so figures are in theirs.
TEST_F(MeshFiles, AgreeWithOtherReadersOnPublicMeshes) {
  const std::filesystem::path list = test::external_data_folder() / "mesh" / "reference_mesh_facts.csv";
  MEZZOTINT_NEEDS_DATA(list);
  std::ifstream facts(list);
  std::string line;
  std::getline(facts, line);
  int compared = 0;
  while (std::getline(facts, line)) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    const std::filesystem::path path = test::external_data_folder() / "mesh" / cells[0];
    SCOPED_TRACE(cells[0]);
    if (cells[2].starts_with("0")) {  // a file without triangles
      EXPECT_THROW((void)read_mesh(path), FileError);
      continue;
    }
    const MeshFile file = read_mesh(path, 1.0_um);
    EXPECT_EQ(file.mesh.triangles.size(), std::stoul(cells[2]));
    if (file.format.starts_with("stl")) {
      EXPECT_EQ(file.mesh.vertices_um.size(), std::stoul(cells[3]));
    }
    double area = 0.0;
    for (const auto& [a, b, c] : file.mesh.triangles) {
      std::array<double, 3> u{}, v{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        u[axis] = double{file.mesh.vertices_um[b][axis]} - double{file.mesh.vertices_um[a][axis]};
        v[axis] = double{file.mesh.vertices_um[c][axis]} - double{file.mesh.vertices_um[a][axis]};
      }
      area += 0.5 * std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
    }
    EXPECT_NEAR(area / std::stod(cells[9]), 1.0, 1e-6);  // coordinates are single precision
    ++compared;
  }
  EXPECT_GT(compared, 20);
}

}  // namespace
}  // namespace mezzotint
