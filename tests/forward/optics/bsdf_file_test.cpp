#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "forward/optics/bsdf.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

namespace fs = std::filesystem;

DirectionMap wavy(std::size_t size, double phase) {
  DirectionMap map(size);
  for (std::size_t k = 0; k < size; ++k) map[k] = std::exp(3.0 * std::sin(0.37 * static_cast<double>(k) + phase));
  return map;
}

Bsdf example(const DirectionGrid& grid) {
  const std::size_t n = grid.size();
  Bsdf bsdf;
  bsdf.incidence = {Angle::from_degrees(20.0), Angle::from_degrees(-75.5)};
  bsdf.grid = grid;
  bsdf.reflection = {wavy(n, 1), wavy(n, 2), wavy(n, 3), wavy(n, 4)};
  bsdf.transmission = {wavy(n, 5), wavy(n, 6), wavy(n, 7), wavy(n, 8)};
  bsdf.energy = {{0.1, 1e-3}, {0.2, 2e-3}, {0.3, 3e-3}, {0.4, 4e-3}, {1e-12, 0.0}};
  bsdf.provenance = {{"model", "paths"}, {"seed", "17"}, {"material", "dielectric:1.5"}, {"note", "µm, two\nlines"}};
  return bsdf;
}

std::string bytes_of(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_bytes(const fs::path& path, const std::string& bytes) {
  fs::remove(path);  // some file systems flush to the disk where a file is written over
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::string example_bytes(const test::TemporaryFolder& folder) {
  write_exr(example({9, 6}), folder / "whole.exr");
  return bytes_of(folder / "whole.exr");
}

// The message with which a file is refused; empty where it is read.
std::string refusal(const fs::path& path) {
  try {
    (void)read_exr(path);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

std::string refusal(const test::TemporaryFolder& folder, const std::string& bytes) {
  write_bytes(folder / "damaged.exr", bytes);
  return refusal(folder / "damaged.exr");
}

// Where the value of an attribute begins, after its name, type and size.
std::size_t value_of(const std::string& bytes, const std::string& name, const std::string& type) {
  const std::string key = name + '\0' + type + '\0';
  const std::size_t found = bytes.find(key);
  EXPECT_NE(found, std::string::npos) << name;
  return found + key.size() + 4;
}

void put_word(std::string& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>((value >> (8 * i)) & 0xffU);
}

void expect_floats_of(const DirectionMap& expected, const DirectionMap& seen) {
  ASSERT_EQ(seen.size(), expected.size());
  for (std::size_t k = 0; k < seen.size(); ++k) ASSERT_EQ(seen[k], double{static_cast<float>(expected[k])});
}

void expect_floats_of(const MapEstimate& expected, const MapEstimate& seen) {
  expect_floats_of(expected.mean, seen.mean);
  expect_floats_of(expected.standard_error, seen.standard_error);
  expect_floats_of(expected.half_a, seen.half_a);
  expect_floats_of(expected.half_b, seen.half_b);
}

TEST(BsdfFile, MakesTheRoundTripToTheLastBitOfAFloat) {
  const test::TemporaryFolder folder;
  for (const DirectionGrid grid : {DirectionGrid{64, 64}, DirectionGrid{9, 6}, DirectionGrid{1, 1}}) {
    const Bsdf bsdf = example(grid);
    write_exr(bsdf, folder / "a.exr");
    const Bsdf back = read_exr(folder / "a.exr");
    EXPECT_EQ(back.grid, grid);
    expect_floats_of(bsdf.reflection, back.reflection);
    expect_floats_of(bsdf.transmission, back.transmission);
    EXPECT_EQ(back.provenance, bsdf.provenance);
    // Degrees in the file: a rounding there and back.
    EXPECT_NEAR(back.incidence.theta.radians(), bsdf.incidence.theta.radians(), 1e-15);
    EXPECT_NEAR(back.incidence.phi.radians(), bsdf.incidence.phi.radians(), 1e-15);
    EXPECT_EQ(back.energy.reflected.value, 0.1);
    EXPECT_EQ(back.energy.transmitted.standard_error, 2e-3);
    EXPECT_EQ(back.energy.absorbed.value, 0.3);
    EXPECT_EQ(back.energy.left_sideways.value, 0.4);
    EXPECT_EQ(back.energy.cut_off.value, 1e-12);
  }
}

TEST(BsdfFile, HasTheSameBytesForTheSameResultAndLeavesNothingBeside) {
  const test::TemporaryFolder folder;
  write_exr(example({9, 6}), folder / "a.exr");
  write_exr(example({9, 6}), folder / "b.exr");
  EXPECT_EQ(bytes_of(folder / "a.exr"), bytes_of(folder / "b.exr"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 2);
  // No time of writing, which would make the bytes of tomorrow differ: its text has no length.
  const std::string bytes = bytes_of(folder / "a.exr");
  EXPECT_EQ(bytes.substr(value_of(bytes, "capDate", "string") - 4, 4), std::string(4, '\0'));
}

TEST(BsdfFile, SaysWhichEndIsMinusY) {
  const test::TemporaryFolder folder;
  const std::string bytes = example_bytes(folder);
  EXPECT_EQ(bytes.substr(value_of(bytes, "mezzotint:first_line", "string"), 6), "y = -1");
}

TEST(BsdfFile, IsRefusedWhereverItIsCutOff) {
  const test::TemporaryFolder folder;
  const std::size_t whole = example_bytes(folder).size();
  const fs::path path = folder / "whole.exr";
  EXPECT_EQ(refusal(path), "");
  for (std::size_t length = whole; length-- > 0;) {
    fs::resize_file(path, length);
    ASSERT_NE(refusal(path), "") << length << " of " << whole;
  }
}

TEST(BsdfFile, IsRefusedForAHugePictureBeforeMemoryIsTaken) {
  const test::TemporaryFolder folder;
  std::string bytes = example_bytes(folder);
  const std::size_t window = value_of(bytes, "dataWindow", "box2i");
  put_word(bytes, window + 8, 999999999);
  put_word(bytes, window + 12, 999999999);
  EXPECT_NE(refusal(folder, bytes).find("1000000000 x 1000000000 bins"), std::string::npos);
  put_word(bytes, window + 8, 0x7fffffff);
  put_word(bytes, window + 0, 0x80000000);  // from −2^31 to 2^31 − 1: more than 32 bits can count
  EXPECT_NE(refusal(folder, bytes).find("4096"), std::string::npos);
}

TEST(BsdfFile, IsRefusedForAnAttributeThatClaimsMoreThanTheFileHas) {
  const test::TemporaryFolder folder;
  std::string bytes = example_bytes(folder);
  put_word(bytes, value_of(bytes, "mezzotint:first_line", "string") - 4, 0x7ffffff0);
  EXPECT_NE(refusal(folder, bytes).find("truncated or damaged"), std::string::npos);
}

TEST(BsdfFile, IsRefusedForChannelsThatAreNotThere) {
  const test::TemporaryFolder folder;
  std::string bytes = example_bytes(folder);
  bytes[bytes.find("transmission.half_b") + 18] = 'z';
  EXPECT_NE(refusal(folder, bytes).find("lacks the channel \"transmission.half_b\""), std::string::npos);
}

TEST(BsdfFile, IsRefusedForNumbersThatAreNotThere) {
  const test::TemporaryFolder folder;
  std::string bytes = example_bytes(folder);
  bytes[bytes.find("mezzotint:energy.absorbed") + 24] = 'z';
  EXPECT_NE(refusal(folder, bytes).find("mezzotint:energy.absorbed"), std::string::npos);
}

TEST(BsdfFile, IsRefusedForHalfFloatsLossAndTiles) {
  const test::TemporaryFolder folder;
  const std::string whole = example_bytes(folder);
  std::string half = whole, lossy = whole, tiled = whole;
  half[whole.find(std::string("reflection\0", 11)) + 11] = 1;
  lossy[value_of(whole, "compression", "compression")] = 9;  // DWAB
  tiled[5] = static_cast<char>(tiled[5] | 2);
  EXPECT_NE(refusal(folder, half).find("32-bit float"), std::string::npos);
  EXPECT_NE(refusal(folder, lossy).find("loss"), std::string::npos);
  EXPECT_NE(refusal(folder, tiled).find("tiles"), std::string::npos);
}

TEST(BsdfFile, IsRefusedWhereItIsNoFileOrNoExr) {
  const test::TemporaryFolder folder;
  EXPECT_THROW((void)read_exr(folder / "missing.exr"), FileError);
  EXPECT_THROW((void)read_exr(folder.path()), FileError);
  EXPECT_NE(refusal(folder, ""), "");
  EXPECT_NE(refusal(folder, "P6 2 2 255 abcdefghijkl"), "");
}

TEST(BsdfFile, SurvivesBytesThatWereChanged) {
  const test::TemporaryFolder folder;
  const std::string whole = example_bytes(folder);
  const RandomStream stream(1, RandomPurpose::Test);
  for (std::uint64_t trial = 0; trial < 400; ++trial) {
    std::string bytes = whole;
    const auto u = stream.uniform4(trial);
    const auto value = stream.bits4(trial, 1);
    bytes[static_cast<std::size_t>(u[0] * static_cast<double>(bytes.size()))] = static_cast<char>(value[0] & 0xffU);
    bytes[static_cast<std::size_t>(u[1] * static_cast<double>(bytes.size()))] = static_cast<char>(value[1] & 0xffU);
    (void)refusal(folder, bytes);  // read or refused, but never anything else
  }
}

TEST(BsdfFile, IsNotWrittenForMapsThatDoNotFitOrWhereThereIsNoFolder) {
  const test::TemporaryFolder folder;
  Bsdf bsdf = example({9, 6});
  EXPECT_THROW(write_exr(bsdf, folder / "no/such/folder.exr"), DeviceError);
  bsdf.transmission.half_a.pop_back();
  EXPECT_THROW(write_exr(bsdf, folder / "a.exr"), InvalidInput);
  bsdf = example({9, 6});
  bsdf.provenance[std::string(201, 'k')] = "too long a key";
  EXPECT_THROW(write_exr(bsdf, folder / "a.exr"), InvalidInput);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(BsdfFile, KeepsTheIntervals) {
  const test::TemporaryFolder folder;
  Bsdf bsdf = example({9, 6});
  write_exr(bsdf, folder / "none.exr");
  EXPECT_TRUE(read_exr(folder / "none.exr").reflection.low_95.empty());
  bsdf.reflection.low_95 = wavy(54, 20.0);
  bsdf.reflection.high_95 = wavy(54, 21.0);
  bsdf.transmission.low_95 = wavy(54, 22.0);
  bsdf.transmission.high_95 = wavy(54, 23.0);
  write_exr(bsdf, folder / "intervals.exr");
  const Bsdf again = read_exr(folder / "intervals.exr");
  expect_floats_of(bsdf.reflection.low_95, again.reflection.low_95);
  expect_floats_of(bsdf.reflection.high_95, again.reflection.high_95);
  expect_floats_of(bsdf.transmission.low_95, again.transmission.low_95);
  expect_floats_of(bsdf.transmission.high_95, again.transmission.high_95);
  bsdf.transmission.high_95.clear();  // all or none
  EXPECT_THROW(write_exr(bsdf, folder / "intervals.exr"), InvalidInput);
}

TEST(BsdfFile, KeepsTheOrdersOfInteraction) {
  const test::TemporaryFolder folder;
  Bsdf bsdf = example({9, 6});
  for (int order = 0; order < 3; ++order) {
    MapEstimate map;
    map.mean = wavy(54, 20.0 + order);
    map.standard_error = wavy(54, 30.0 + order);
    bsdf.reflection_orders.push_back(map);
  }
  write_exr(bsdf, folder / "orders.exr");
  const Bsdf again = read_exr(folder / "orders.exr");
  ASSERT_EQ(again.reflection_orders.size(), 3U);
  for (std::size_t order = 0; order < 3; ++order) {
    for (std::size_t k = 0; k < 54; ++k) {
      EXPECT_FLOAT_EQ(static_cast<float>(bsdf.reflection_orders[order].mean[k]),
                      static_cast<float>(again.reflection_orders[order].mean[k]));
      EXPECT_FLOAT_EQ(static_cast<float>(bsdf.reflection_orders[order].standard_error[k]),
                      static_cast<float>(again.reflection_orders[order].standard_error[k]));
    }
  }
}

// Three channels that differ in everything but grid and light.
std::vector<Bsdf> coloured_example() {
  std::vector<Bsdf> channels(3, example({9, 6}));
  for (std::size_t c = 0; c < 3; ++c) {
    const auto shade = static_cast<double>(c);
    channels[c].reflection.mean = wavy(54, 10.0 + shade);
    channels[c].energy.reflected = {0.1 * shade, 1e-3};
    channels[c].provenance["material"] = "dielectric:1.5" + std::to_string(c);
    channels[c].reflection_orders = {{wavy(54, 20.0 + shade), wavy(54, 1.0), {}, {}}};
    for (MapEstimate* map : {&channels[c].reflection, &channels[c].transmission}) {
      map->low_95 = wavy(54, 30.0 + shade);
      map->high_95 = wavy(54, 40.0 + shade);
    }
  }
  return channels;
}

TEST(BsdfFileOfThreeChannels, MakesTheRoundTrip) {
  const test::TemporaryFolder folder;
  const std::vector<Bsdf> before = coloured_example();
  write_channels_exr(before, folder / "rgb.exr");
  const std::vector<Bsdf> after = read_channels_exr(folder / "rgb.exr");
  ASSERT_EQ(after.size(), 3U);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(after[c].provenance, before[c].provenance);
    EXPECT_EQ(after[c].energy.reflected.value, before[c].energy.reflected.value);
    EXPECT_EQ(after[c].incidence.phi.degrees(), before[c].incidence.phi.degrees());
    for (std::size_t k = 0; k < 54; ++k) {
      EXPECT_EQ(after[c].reflection.mean[k], double{static_cast<float>(before[c].reflection.mean[k])});
      EXPECT_EQ(after[c].transmission.high_95[k], double{static_cast<float>(before[c].transmission.high_95[k])});
      EXPECT_EQ(after[c].transmission.half_b[k], double{static_cast<float>(before[c].transmission.half_b[k])});
    }
    ASSERT_EQ(after[c].reflection_orders.size(), 1U);
    EXPECT_EQ(after[c].reflection_orders[0].mean[7],
              double{static_cast<float>(before[c].reflection_orders[0].mean[7])});
  }
}

TEST(BsdfFileOfThreeChannels, IsNotTakenForOne) {
  const test::TemporaryFolder folder;
  write_channels_exr(coloured_example(), folder / "rgb.exr");
  EXPECT_NE(refusal(folder / "rgb.exr").find("three channels"), std::string::npos);
  write_exr(example({9, 6}), folder / "one.exr");
  EXPECT_EQ(read_channels_exr(folder / "one.exr").size(), 1U);
}

TEST(BsdfFileOfThreeChannels, NeedsThreeThatBelongTogether) {
  const test::TemporaryFolder folder;
  std::vector<Bsdf> channels = coloured_example();
  EXPECT_THROW(write_channels_exr(std::span(channels).first(2), folder / "rgb.exr"), InvalidInput);
  channels[2].incidence.theta = Angle::from_degrees(21.0);
  EXPECT_THROW(write_channels_exr(channels, folder / "rgb.exr"), InvalidInput);
  channels = coloured_example();
  channels[1] = example({9, 7});
  EXPECT_THROW(write_channels_exr(channels, folder / "rgb.exr"), InvalidInput);
}

TEST(BsdfFile, HoldsAsManyOrdersAsThereMayBe) {
  const test::TemporaryFolder folder;
  std::vector<Bsdf> channels(3, example({2, 2}));
  for (Bsdf& bsdf : channels) bsdf.reflection_orders.assign(64, {wavy(4, 1.0), wavy(4, 2.0), {}, {}});
  write_channels_exr(channels, folder / "orders.exr");
  EXPECT_EQ(read_channels_exr(folder / "orders.exr")[2].reflection_orders.size(), 64U);
}

}  // namespace
}  // namespace mezzotint
