#include "fabrication/job/job_file.h"

#include <sys/resource.h>

#include <csignal>

#include <gtest/gtest.h>

#include "fabrication/job/layer_png.h"
#include "forward/base/error.h"
#include "tests/fabrication/job/uvj_samples.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

using namespace test;

void write_layers(JobWriter& writer, const Job& job) {
  for (const JobLayer& layer : job.layers) {
    LayerPicture picture = to_runs(layer.gray, job.columns, job.rows);
    const std::string png = encode_layer_png(picture);
    writer.add(std::move(picture), png, layer.exposure_s, layer.top);
  }
}

void write_job(const Job& job, const std::filesystem::path& path) {
  JobWriter writer(job, path);
  write_layers(writer, job);
  writer.close();
}

std::string complaint(const std::filesystem::path& path) {
  try {
    (void)read_job(path);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST(JobFile, GoesThereAndBackInEveryFormat) {
  const TemporaryFolder folder;
  Job job = sample_job();
  job.layers[0].exposure_s = 9.5;
  for (const char* name : {"job.uvj", "job.sl1", "job", "other/"}) {
    write_job(job, folder / name);
    Job read = read_job(folder / name);
    EXPECT_TRUE(JobReader(folder / name).has_hashes());
    expect_same(read, job);
  }
}

TEST(JobFile, IsWholeForOtherZipProgramsToo) {
  const TemporaryFolder folder;
  write_job(sample_job(), folder / "job.sl1");
  if (std::system("unzip -v > /dev/null 2>&1") != 0) GTEST_SKIP() << "needs unzip";
  EXPECT_EQ(std::system(("unzip -tqq " + (folder / "job.sl1").string()).c_str()), 0);
}

TEST(JobFile, HasTheSameBytesEveryTime) {
  const TemporaryFolder folder;
  write_job(sample_job(), folder / "a.sl1");
  write_job(sample_job(), folder / "b.sl1");
  EXPECT_EQ(bytes_of(folder / "a.sl1"), bytes_of(folder / "b.sl1"));
}

TEST(JobFile, RefusesExposuresThatSl1CannotHold) {
  const TemporaryFolder folder;
  Job job = sample_job();
  job.layers[2].exposure_s = 4.0;
  EXPECT_THROW(write_job(job, folder / "job.sl1"), InvalidInput);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_NO_THROW(write_job(job, folder / "job.uvj"));
}

TEST(JobFile, LeavesNothingWithoutClose) {
  const TemporaryFolder folder;
  for (const char* name : {"job.uvj", "job.sl1", "job/"}) {
    {
      JobWriter writer(sample_job(), folder / name);
      write_layers(writer, sample_job());
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << name;
  }
}

// A disk that takes no more: here a limit on the size of files.
TEST(JobFile, LeavesNothingOnAFullDisk) {
  const TemporaryFolder folder;
  Job job = sample_job();
  job.layers.resize(1);
  job.columns = job.rows = 500;
  job.layers[0].gray.resize(250000);
  for (std::size_t i = 0; i < job.layers[0].gray.size(); ++i) {
    job.layers[0].gray[i] = static_cast<std::uint8_t>(i * i * 2654435761U >> 24U);
  }
  rlimit before = {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  // 200 kB: not even the layers fit. 300 kB: the layers do, the archive with its previews does not.
  for (const rlim_t bytes : {rlim_t{200000}, rlim_t{251000}}) {
    for (const char* name : {"job.uvj", "job.sl1"}) {
      const rlimit limit = {bytes, before.rlim_max};
      ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
      EXPECT_THROW(write_job(job, folder / name), DeviceError) << name;
      ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
      EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << name;
    }
  }
  std::signal(SIGXFSZ, handler);
}

TEST(JobFile, TakesNoFolderThatHoldsSomething) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "full");
  put_bytes(folder / "full" / "file", "x");
  EXPECT_THROW(write_job(sample_job(), folder / "full"), InvalidInput);
  EXPECT_THROW(write_job(sample_job(), folder / "job.zip"), InvalidInput);
  EXPECT_THROW(write_job(sample_job(), "/no/such/folder/job.sl1"), DeviceError);
}

TEST(JobFile, RefusesAWrongOrder) {
  const TemporaryFolder folder;
  const Job job = sample_job();
  JobWriter writer(job, folder / "job.uvj");
  const LayerPicture picture = to_runs(job.layers[0].gray, job.columns, job.rows);
  writer.add(picture, encode_layer_png(picture), 3.0, 18.0_um);
  EXPECT_THROW(writer.add(picture, encode_layer_png(picture), 3.0, 18.0_um), InvalidInput);
  EXPECT_THROW(writer.add(picture, encode_layer_png(picture), 0.0, 36.0_um), InvalidInput);
  EXPECT_THROW(writer.add(to_runs(std::vector<std::uint8_t>(9), 3, 3), "", 3.0, 36.0_um), InvalidInput);
  Job empty = job;
  empty.layers.clear();
  JobWriter none(empty, folder / "none.uvj");
  EXPECT_THROW(none.close(), InvalidInput);
}

TEST(JobFile, FindsAChangedPictureInAnSl1) {
  const TemporaryFolder folder;
  Job job = sample_job();
  write_job(job, folder / "a.sl1");
  job.layers[1].gray[70] = 3;
  write_job(job, folder / "b.sl1");
  const ZipReader a(folder / "a.sl1", 100), b(folder / "b.sl1", 100);
  ForeignArchive mixed;
  for (const std::string& name : a.names()) {
    const auto bytes = (name.find("00001.png") != std::string::npos ? b : a).read(name, 1000000);
    mixed.add(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  mixed.write(folder / "mixed.sl1");
  EXPECT_NE(complaint(folder / "mixed.sl1").find("does not have the SHA-256"), std::string::npos);
}

TEST(JobFile, NamesWhatIsWrongInAnSl1) {
  const TemporaryFolder folder;
  const std::string config =
      "action = print\njobDir = x\nexpTime = 3\nexpTimeFirst = 9\nlayerHeight = 0.05\nnumFade = 1\nnumFast = "
      "2\nnumSlow = 0\n";
  const std::string slicer =
      "display_pixels_x = 4\ndisplay_pixels_y = 2\ndisplay_width = 0.2\ndisplay_height = 0.1\ndisplay_orientation = "
      "landscape\ninitial_layer_height = 0.07\n";
  const std::string png = encode_png(std::vector<std::uint8_t>(8, 9), 4, 2, 1);
  const auto archive = [&](const std::string& c, const std::string& s) {
    ForeignArchive zip;
    zip.add("config.ini", c).add("prusaslicer.ini", s).add("x00000.png", png).add("x00001.png", png);
    zip.write(folder / "job.sl1");
    return folder / "job.sl1";
  };
  const auto without = [](std::string text, const std::string& part, const std::string& instead = "") {
    return text.replace(text.find(part), part.size(), instead);
  };
  ASSERT_EQ(complaint(archive(config, slicer)), "");
  const Job job = read_job(folder / "job.sl1");
  EXPECT_EQ(job.layers[0].exposure_s, 9.0);
  EXPECT_EQ(job.layers[1].exposure_s, 6.0);  // half-way of one fading layer
  EXPECT_EQ(job.layers[1].top.um(), 120.0);
  EXPECT_EQ(job.pixel_pitch.um(), 50.0);
  const auto complains = [&](const std::string& c, const std::string& s, std::string_view of) {
    const std::string text = complaint(archive(c, s));
    EXPECT_NE(text.find(of), std::string::npos) << text;
  };
  complains(without(config, "expTime = 3\n"), slicer, "\"expTime\" is missing");
  complains(without(config, "0.05", "thin"), slicer, "\"layerHeight\" is \"thin\"");
  complains(without(config, "numFast = 2", "numFast = 3"), slicer, "x00002.png: is missing");
  complains(without(config, "numFast = 2", "numFast = 1"), slicer, "holds 2 pictures");
  complains(without(config, "numFast = 2", "numFast = 1e9"), slicer, "\"numFast\"");
  complains(config, without(slicer, "0.1\n", "0.3\n"), "not square");
  complains(config, without(slicer, "x = 4", "x = 70000"), "display_pixels_x");
  complains(config, without(slicer, "landscape", "portrait"), "has 4 x 2 pixels");
}

TEST(JobFile, ReadsTheArchivesOfPrusaSlicer) {
  const auto path = external_data_folder() / "sla" / "cube_with_concave_hole_L0.1.sl1";
  MEZZOTINT_NEEDS_DATA(path);
  const JobReader reader(path);
  EXPECT_FALSE(reader.has_hashes());
  EXPECT_EQ(reader.frame().columns, 1440U);
  EXPECT_EQ(reader.frame().rows, 2560U);
  EXPECT_EQ(reader.frame().pixel_pitch.um(), 47.25);
  EXPECT_EQ(reader.frame().layer.um(), 100.0);
  EXPECT_EQ(reader.frame().layers.front().exposure_s, 45.0);
  EXPECT_EQ(reader.frame().layers.back().exposure_s, 13.0);
  EXPECT_GT(figures_of(to_runs(reader.read_layer(3), 1440, 2560)).full, 100000U);
}

}  // namespace
}  // namespace mezzotint
