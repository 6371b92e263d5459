#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "forward/base/error.h"
#include "forward/surface/mesh.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

using namespace literals;

// Lines of a file by their first word.
std::map<std::string, std::vector<std::string>> lines_of(const std::filesystem::path& path) {
  std::map<std::string, std::vector<std::string>> lines;
  std::ifstream file(path);
  EXPECT_TRUE(file.good()) << path;
  for (std::string line; std::getline(file, line);) {
    const std::size_t blank = line.find(' ');
    lines[line.substr(0, blank)].push_back(blank == std::string::npos ? "" : line.substr(blank + 1));
  }
  return lines;
}

std::array<float, 3> numbers_in(const std::string& line) {
  std::istringstream stream(line);
  std::array<float, 3> numbers{};
  stream >> numbers[0] >> numbers[1] >> numbers[2];
  EXPECT_FALSE(stream.fail()) << line;
  return numbers;
}

TriangleMesh rough_mesh() {
  HeightField field({17, 9, 0.123_um, 0.456_um}, Continuation::Mirrored);
  for (std::size_t k = 0; k < field.grid().size(); ++k) {
    field.heights_um()[k] = static_cast<float>(std::sin(1e3 * static_cast<double>(k)) * 1e-3);
  }
  return to_mesh(field);
}

TEST(ObjFile, ReadsBackTheSameFloats) {
  const test::TemporaryFolder folder;
  const TriangleMesh mesh = rough_mesh();
  write_obj(mesh, {}, folder / "relief.obj");
  const auto lines = lines_of(folder / "relief.obj");
  ASSERT_EQ(lines.at("v").size(), mesh.vertices_um.size());
  ASSERT_EQ(lines.at("vn").size(), mesh.normals.size());
  ASSERT_EQ(lines.at("f").size(), mesh.triangles.size());
  for (std::size_t k = 0; k < mesh.vertices_um.size(); ++k) {
    EXPECT_EQ(numbers_in(lines.at("v")[k]), mesh.vertices_um[k]);
    EXPECT_EQ(numbers_in(lines.at("vn")[k]), mesh.normals[k]);
  }
}

TEST(ObjFile, CountsCornersFromOneAndGivesEachItsNormal) {
  const test::TemporaryFolder folder;
  write_obj(to_mesh(HeightField({2, 2, 1.0_um, 1.0_um}, Continuation::Mirrored)), {}, folder / "cell.obj");
  const auto lines = lines_of(folder / "cell.obj");
  EXPECT_EQ(lines.at("f")[0], "1//1 2//2 4//4");
  EXPECT_EQ(lines.at("f")[1], "1//1 4//4 3//3");
}

TEST(ObjFile, NamesAMaterialThatRefracts) {
  const test::TemporaryFolder folder;
  write_obj(rough_mesh(), {"resin", 1.53}, folder / "part.obj");
  const auto object = lines_of(folder / "part.obj");
  EXPECT_EQ(object.at("mtllib"), std::vector<std::string>{"part.mtl"});
  EXPECT_EQ(object.at("usemtl"), std::vector<std::string>{"resin"});
  const auto material = lines_of(folder / "part.mtl");
  EXPECT_EQ(material.at("newmtl"), std::vector<std::string>{"resin"});
  EXPECT_EQ(material.at("Ni"), std::vector<std::string>{"1.53"});
  EXPECT_EQ(material.at("illum"), std::vector<std::string>{"4"});
}

TEST(ObjFile, LeavesNothingButTheTwoFiles) {
  const test::TemporaryFolder folder;
  write_obj(rough_mesh(), {}, folder / "relief.obj");
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"relief.mtl", "relief.obj"}));
}

TEST(ObjFile, RefusesWhatItsReadersWouldMisread) {
  const test::TemporaryFolder folder;
  TriangleMesh mesh = rough_mesh();
  EXPECT_THROW(write_obj(mesh, {}, folder / "relief.mtl"), InvalidInput);
  EXPECT_THROW(write_obj(mesh, {"two words", 1.5}, folder / "relief.obj"), InvalidInput);
  EXPECT_THROW(write_obj(mesh, {"resin", std::nan("")}, folder / "relief.obj"), InvalidInput);
  EXPECT_THROW(write_obj(mesh, {}, folder / "no/such/folder.obj"), DeviceError);
  mesh.normals.pop_back();
  EXPECT_THROW(write_obj(mesh, {}, folder / "relief.obj"), InvalidInput);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace mezzotint
