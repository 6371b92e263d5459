#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fabrication/job/uvj_layout.h"
#include "forward/base/error.h"
#include "tests/fabrication/job/uvj_samples.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

using namespace test;

std::string text(const std::vector<std::byte>& bytes) {
  std::string all;
  for (const std::byte byte : bytes) all.push_back(std::to_integer<char>(byte));
  return all;
}

TEST(UvjArchive, GoesThereAndBack) {
  const TemporaryFolder folder;
  Job job = sample_job();
  job.layers[0].exposure_s = 12.5;
  job.layers[2].top = 54.001_um;
  write_uvj(job, folder / "job.uvj");
  expect_same(read_uvj(folder / "job.uvj"), job);
}

TEST(UvjArchive, HasTheSameBytesEveryTime) {
  const TemporaryFolder folder;
  write_uvj(sample_job(), folder / "a.uvj");
  ::setenv("TZ", "Asia/Tokyo", 1);  // libzip would write local times
  ::tzset();
  write_uvj(sample_job(), folder / "b.uvj");
  ::unsetenv("TZ");
  EXPECT_EQ(bytes_of(folder / "a.uvj"), bytes_of(folder / "b.uvj"));
}

TEST(UvjArchive, HoldsTheStandardsConfiguration) {
  const TemporaryFolder folder;
  write_uvj(sample_job(), folder / "job.uvj");
  const ZipReader zip(folder / "job.uvj", 100);
  const auto config = nlohmann::json::parse(text(zip.read("config.json", 100000)));
  const auto& size = config["Properties"]["Size"];
  EXPECT_EQ(size["X"], 19);
  EXPECT_EQ(size["Y"], 13);
  EXPECT_EQ(size["Millimeter"]["X"], 0.14326);  // 19 · 7.54 µm
  EXPECT_EQ(size["Layers"], 3);
  EXPECT_EQ(size["LayerHeight"], 0.018);
  EXPECT_EQ(config["Properties"]["Exposure"]["LightOnTime"], 3.0);
  EXPECT_EQ(config["Properties"]["Exposure"]["LightPWM"], 230);
  EXPECT_TRUE(config["Properties"]["Bottom"].contains("Count"));
  ASSERT_EQ(config["Layers"].size(), 3U);
  EXPECT_EQ(config["Layers"][2]["Z"], 0.054);
  EXPECT_EQ(config["Layers"][2]["Exposure"]["LightOnTime"], 3.0);
  for (const char* member : {"slice/00000000.png", "slice/00000002.png", "preview/tiny.png", "preview/huge.png"}) {
    EXPECT_TRUE(zip.has(member)) << member;
  }
}

TEST(UvjArchive, PutsTheLastRowOnTopOfThePicture) {
  const TemporaryFolder folder;
  Job job = sample_job();
  job.layers[2].gray.assign(job.columns * job.rows, 0);
  job.layers[2].gray[12 * 19 + 5] = 200;  // in the row of the largest y
  write_uvj(job, folder / "job.uvj");
  const ZipReader zip(folder / "job.uvj", 100);
  const auto png = zip.read("slice/00000002.png", 100000);
  const auto pixels = decode_gray_png(png, 19, 13, {folder / "job.uvj", "slice/00000002.png"});
  EXPECT_EQ(pixels[5], 200);
  expect_same(read_uvj(folder / "job.uvj"), job);
}

TEST(UvjArchive, ListsEveryOtherMemberInItsManifest) {
  const TemporaryFolder folder;
  write_uvj(sample_job(), folder / "job.uvj");
  const ZipReader zip(folder / "job.uvj", 100);
  const auto manifest = nlohmann::json::parse(text(zip.read("manifest.json", 100000)));
  EXPECT_EQ(manifest["sha256"].size() + 1, zip.names().size());
  EXPECT_EQ(manifest["pixel_pitch_um"], 7.54);
  EXPECT_EQ(manifest["gray_bits"], 8);
  EXPECT_EQ(manifest["first_row"], "y_max");
}

TEST(UvjArchive, ReadsTheExampleOfTheFormatsAuthor) {
  // After example B of uvj/README.md in ezrec/uv3dp: bottom layers, one override, Z from 0.
  const TemporaryFolder folder;
  ForeignArchive archive;
  archive.add("config.json", R"({"Properties": {
      "Size": {"X": 4, "Y": 2, "Millimeter": {"X": 0.4, "Y": 0.2}, "Layers": 3, "LayerHeight": 0.1},
      "Exposure": {"LightOnTime": 3.1, "LightOffTime": 6, "LiftHeight": 5, "LiftSpeed": 100},
      "Bottom": {"LightOnTime": 25, "LightOffTime": 6, "Count": 2}},
      "Layers": [{"Z": 0, "Exposure": {"LightOnTime": 25}}, {"Z": 0.1, "Exposure": {"LightOnTime": 20}},
                 {"Z": 0.2, "Exposure": {"LightPWM": 255}}]})");
  for (std::size_t i = 0; i < 3; ++i) archive.add_slice(i, 4, 2);
  archive.write(folder / "foreign.uvj");
  const Job job = read_uvj(folder / "foreign.uvj");
  EXPECT_EQ(job.name, "foreign");
  EXPECT_EQ(job.pixel_pitch.um(), 100.0);
  EXPECT_EQ(job.layer.um(), 100.0);
  EXPECT_EQ(job.led_amplitude, 255);  // the standard's default
  EXPECT_EQ(job.layers[0].exposure_s, 25.0);
  EXPECT_EQ(job.layers[1].exposure_s, 20.0);
  EXPECT_EQ(job.layers[2].exposure_s, 3.1);
  EXPECT_EQ(job.layers[0].top.um(), 100.0);
  EXPECT_EQ(job.layers[2].top.um(), 300.0);
}

TEST(UvjArchive, ReadsLayersWithoutATable) {
  // After example A: no Layers at all.
  const TemporaryFolder folder;
  ForeignArchive archive;
  archive.add("config.json", R"({"Properties": {
      "Size": {"X": 4, "Y": 2, "Millimeter": {"X": 0.2, "Y": 0.1}, "Layers": 2, "LayerHeight": 0.05},
      "Exposure": {"LightOnTime": 11.5, "LightPWM": 90}, "Bottom": {"LightOnTime": 60, "LightPWM": 90, "Count": 1}}})");
  archive.add_slice(0, 4, 2).add_slice(1, 4, 2).write(folder / "plain.uvj");
  const Job job = read_uvj(folder / "plain.uvj");
  EXPECT_EQ(job.layers[0].exposure_s, 60.0);
  EXPECT_EQ(job.layers[1].exposure_s, 11.5);
  EXPECT_EQ(job.layers[1].top.um(), 100.0);
  EXPECT_EQ(job.led_amplitude, 90);
}

TEST(UvjArchive, IsNotWrittenWhereItCannotBe) {
  EXPECT_THROW(write_uvj(sample_job(), "/no/such/folder/job.uvj"), DeviceError);
  const TemporaryFolder folder;
  EXPECT_THROW(write_uvj(Job{}, folder / "job.uvj"), InvalidInput);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace mezzotint
