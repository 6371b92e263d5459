#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "forward/bsdf_table/bsdf_table_file.h"
#include "tests/forward/bsdf_table/beckmann_table.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

namespace fs = std::filesystem;
using test::beckmann;
using test::coarse;
using test::degrees;

BsdfTable example(SymmetryKind kind, const DirectionGrid& grid = {17, 12}) {
  const ComputeBsdf lobe = beckmann({0.4, 0.2, Angle::from_degrees(20)}, grid);
  const ComputeBsdf compute = [&](const DirectionAngles& light) {
    Bsdf bsdf = lobe(light);
    for (double& error : bsdf.reflection.standard_error) error = 0.01;
    // Glass lit from the right only: some maps are empty.
    if (light.phi.radians() > 0.5) bsdf.transmission = test::exact(DirectionMap(bsdf.grid.size(), 0.3));
    bsdf.energy = {{0.1, 1e-3}, {0.2, 2e-3}, {0.3, 3e-3}, {0.4, 4e-3}, {1e-12, 0.0}};
    bsdf.provenance = {{"model", "paths"}, {"note", "µm, two\nlines"}, {"empty", ""}};
    return bsdf;
  };
  BsdfTableOptions options = coarse({kind, Angle::from_degrees(20)}, 3, 4);
  options.join_tolerance = 0.02;
  return build_bsdf_table(compute, options).table;
}

std::string bytes_of(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// The message with which bytes are refused; empty where they are read.
std::string refusal(const test::TemporaryFolder& folder, const std::string& bytes) {
  const fs::path path = folder / "damaged.exr";
  fs::remove(path);
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  try {
    (void)read_bsdf_table(path);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

std::string example_bytes(const test::TemporaryFolder& folder) {
  write_bsdf_table(example(SymmetryKind::Mirror), folder / "whole.exr");
  return bytes_of(folder / "whole.exr");
}

std::string replaced(std::string bytes, const std::string& from, const std::string& to) {
  EXPECT_EQ(from.size(), to.size());
  EXPECT_NE(bytes.find(from), std::string::npos) << from;
  return bytes.replace(bytes.find(from), from.size(), to);
}

TEST(BsdfTableFile, MakesTheRoundTripToTheLastBit) {
  const test::TemporaryFolder folder;
  const RandomStream stream(1, RandomPurpose::Test);
  for (const SymmetryKind kind : {SymmetryKind::None, SymmetryKind::Point, SymmetryKind::Mirror,
                                  SymmetryKind::PointAndMirror, SymmetryKind::Isotropic}) {
    const BsdfTable table = example(kind);
    write_bsdf_table(table, folder / "a.exr");
    const BsdfTable back = read_bsdf_table(folder / "a.exr");
    EXPECT_EQ(back.provenance, table.provenance);
    ASSERT_EQ(back.nodes.size(), table.nodes.size());
    for (std::size_t k = 0; k < back.nodes.size(); ++k) {
      EXPECT_EQ(back.nodes[k].energy.left_sideways.value, 0.4);
      EXPECT_EQ(back.nodes[k].incidence.phi, table.nodes[k].incidence.phi);
      EXPECT_EQ(back.nodes[k].reflection.square_count(), table.nodes[k].reflection.square_count());
      EXPECT_EQ(back.nodes[k].transmission.empty(), table.nodes[k].transmission.empty());
    }
    for (std::uint64_t k = 0; k < 100; ++k) {
      const auto u = stream.uniform4(k);
      const Direction light = to_direction(degrees(89.0 * u[0], 360.0 * u[1]));
      const BsdfSample drawn = sample(table, light, u[2], u[3]), again = sample(back, light, u[2], u[3]);
      EXPECT_EQ(again.pdf, drawn.pdf);
      EXPECT_EQ(again.to_viewer, drawn.to_viewer);
      EXPECT_EQ(evaluate(back, light, drawn.to_viewer).standard_error,
                evaluate(table, light, drawn.to_viewer).standard_error);
    }
  }
}

TEST(BsdfTableFile, HasTheSameBytesForTheSameTableAndLeavesNothingBeside) {
  const test::TemporaryFolder folder;
  const BsdfTable table = example(SymmetryKind::Point);
  write_bsdf_table(table, folder / "a.exr");
  write_bsdf_table(read_bsdf_table(folder / "a.exr"), folder / "b.exr");
  EXPECT_EQ(bytes_of(folder / "a.exr"), bytes_of(folder / "b.exr"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 2);
}

TEST(BsdfTableFile, IsRefusedWhereverItIsCutOff) {
  const test::TemporaryFolder folder;
  const std::string whole = example_bytes(folder);
  EXPECT_EQ(refusal(folder, whole), "");
  for (std::size_t length = 0; length < whole.size(); length += 37) {
    ASSERT_NE(refusal(folder, whole.substr(0, length)), "") << length << " of " << whole.size();
  }
}

TEST(BsdfTableFile, IsRefusedForAHeaderThatContradictsItself) {
  const test::TemporaryFolder folder;
  const std::string whole = example_bytes(folder);
  EXPECT_NE(refusal(folder, replaced(whole, "\"mirror\"", "\"mirrow\"")).find("mirrow"), std::string::npos);
  EXPECT_NE(refusal(folder, replaced(whole, "\"version\":1", "\"version\":2")).find("version"), std::string::npos);
  EXPECT_NE(refusal(folder, replaced(whole, "\"width\":17", "\"width\":99")).find("pixels"), std::string::npos);
  EXPECT_NE(refusal(folder, replaced(whole, "\"width\":17", "\"width\":-1")), "");
  EXPECT_NE(refusal(folder, replaced(whole, "\"width\":17", "\"width\":0 ")), "");
  EXPECT_NE(refusal(folder, replaced(whole, "\"rings\":", "\"wings\":")).find("rings"), std::string::npos);
  EXPECT_NE(refusal(folder, replaced(whole, "\"relative_index\":1.5", "\"relative_index\":0.5")).find("index"),
            std::string::npos);
  EXPECT_NE(refusal(folder, replaced(whole, "reflection.level", "reflection.lewel")).find("reflection.level"),
            std::string::npos);
}

TEST(BsdfTableFile, IsRefusedForASingleBsdf) {
  const test::TemporaryFolder folder;
  Bsdf bsdf = beckmann({0.3, 0.3, {}}, {8, 8})(degrees(20, 0));
  write_exr(bsdf, folder / "single.exr");
  EXPECT_NE(refusal(folder, bytes_of(folder / "single.exr")).find("single BSDF"), std::string::npos);
  EXPECT_THROW((void)read_bsdf_table(folder / "missing.exr"), FileError);
  EXPECT_NE(refusal(folder, "P6 2 2 255 abcdefghijkl"), "");
}

TEST(BsdfTableFile, SurvivesBytesThatWereChanged) {
  const test::TemporaryFolder folder;
  const std::string whole = example_bytes(folder);
  const RandomStream stream(2, RandomPurpose::Test);
  for (std::uint64_t trial = 0; trial < 300; ++trial) {
    std::string bytes = whole;
    const auto u = stream.uniform4(trial);
    const auto value = stream.bits4(trial, 1);
    bytes[static_cast<std::size_t>(u[0] * static_cast<double>(bytes.size()))] = static_cast<char>(value[0] & 0xffU);
    // Header first: most of the decisions are taken there.
    bytes[static_cast<std::size_t>(u[1] * 2000.0)] = static_cast<char>(value[1] & 0xffU);
    (void)refusal(folder, bytes);  // read or refused, but never anything else
  }
}

TEST(BsdfTableFile, IsNotWrittenWhereItDoesNotFitOrThereIsNoFolder) {
  const test::TemporaryFolder folder;
  BsdfTable table = example(SymmetryKind::Isotropic, {8, 8});
  EXPECT_THROW(write_bsdf_table(table, folder / "no/such/folder.exr"), DeviceError);
  table.grid = {4096, 4096};
  EXPECT_THROW(write_bsdf_table(table, folder / "a.exr"), InvalidInput);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace mezzotint
