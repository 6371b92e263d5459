// Files that were cut or have a wrong byte: a FileError or a sound mesh, never anything else.
#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "fabrication/part/mesh_facts.h"
#include "fabrication/part/part_file.h"
#include "forward/base/error.h"
#include "forward/base/random.h"
#include "tests/fabrication/part/solids.h"
#include "tests/fabrication/part/three_mf_writer.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

std::string text_stl(const PartMesh& mesh) {
  std::string text = "solid torus\n";
  for (const auto& t : mesh.triangles) {
    text += "facet normal 0 0 1\n outer loop\n";
    for (const std::uint32_t corner : t) {
      const auto& v = mesh.vertices_mm[corner];
      text += fmt::format("  vertex {} {} {}\n", v[0], v[1], v[2]);
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid torus\n";
}

std::string obj(const PartMesh& mesh) {
  std::string text = "o torus\n";
  for (const auto& v : mesh.vertices_mm) text += fmt::format("v {} {} {}\n", v[0], v[1], v[2]);
  for (const auto& t : mesh.triangles) text += fmt::format("f {}//1 {}/2 {}/3/4\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

template <class Number>
void put(std::string& bytes, Number value, bool big_endian) {
  std::array<char, sizeof(Number)> raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  if (big_endian) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

std::string ply(const PartMesh& mesh, const std::string& format) {
  std::string text = fmt::format(
      "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      format, mesh.vertices_mm.size(), mesh.triangles.size());
  const bool big = format == "binary_big_endian";
  for (const auto& v : mesh.vertices_mm) {
    if (format == "ascii")
      text += fmt::format("{} {} {}\n", v[0], v[1], v[2]);
    else
      for (const double coordinate : v) put(text, static_cast<float>(coordinate), big);
  }
  for (const auto& t : mesh.triangles) {
    if (format == "ascii") {
      text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
      continue;
    }
    text += '\3';
    for (const std::uint32_t corner : t) put(text, corner, big);
  }
  return text;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class DamagedParts : public ::testing::TestWithParam<const char*> {
protected:
  std::string whole() {
    const std::string kind = GetParam();
    const PartMesh mesh = test::torus(3.0, 1.0, 12, 6);
    if (kind == "text.stl") return text_stl(mesh);
    if (kind == "a.obj") return obj(mesh);
    if (kind == "text.ply") return ply(mesh, "ascii");
    if (kind == "little.ply") return ply(mesh, "binary_little_endian");
    if (kind == "big.ply") return ply(mesh, "binary_big_endian");
    if (kind == "a.3mf") {
      test::write_three_mf(path(),
                           test::model_text("millimeter", test::object_text(1, "", mesh), "<item objectid=\"1\"/>"));
    } else {
      write_stl(mesh, path());
    }
    return bytes_of(path());
  }
  std::filesystem::path path() { return folder_ / GetParam(); }
  // Whether it was read; a mesh that was is sound.
  bool reads(const std::string& bytes) {
    std::ofstream(path(), std::ios::binary) << bytes;
    try {
      const PartFile file = read_part(path());
      const MeshFacts facts = mesh_facts(file.mesh);
      EXPECT_GT(facts.triangles, 0U);
      EXPECT_TRUE(std::isfinite(facts.volume_mm3) && std::isfinite(facts.area_mm2));
      EXPECT_TRUE(file.mesh.groups.empty() || file.mesh.groups.size() == file.mesh.triangles.size());
      return true;
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find(GetParam()), std::string::npos) << "names no file: " << error.what();
      return false;
    }
  }
  test::TemporaryFolder folder_;
};

TEST_P(DamagedParts, CutAtTwentyPlacesAreRefusedOrSound) {
  const std::string bytes = whole();
  ASSERT_TRUE(reads(bytes));
  int refused = 0;
  for (std::size_t k = 0; k < 20; ++k) refused += reads(bytes.substr(0, bytes.size() * k / 20)) ? 0 : 1;
  // A cut OBJ ends between two lines as a whole one does, and names no vertex that is not there.
  EXPECT_GE(refused, std::string(GetParam()) == "a.obj" ? 5 : 20);
}

TEST_P(DamagedParts, WithOneWrongByteAreRefusedOrSound) {
  const std::string bytes = whole();
  RandomStream random(7, RandomPurpose::Test);
  int refused = 0;
  for (int k = 0; k < 200; ++k) {
    std::string damaged = bytes;
    const auto draw = random.uniform4(static_cast<std::uint64_t>(k));
    damaged[static_cast<std::size_t>(draw[0] * static_cast<double>(bytes.size()))] =
        static_cast<char>(static_cast<unsigned char>(draw[1] * 256.0));
    refused += reads(damaged) ? 0 : 1;
  }
  EXPECT_LT(refused, 200);
}

INSTANTIATE_TEST_SUITE_P(Formats, DamagedParts,
                         ::testing::Values("text.stl", "binary.stl", "a.obj", "text.ply", "little.ply", "big.ply",
                                           "a.3mf"));

}  // namespace
}  // namespace mezzotint
