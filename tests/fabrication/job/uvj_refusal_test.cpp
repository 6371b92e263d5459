#include <gtest/gtest.h>

#include <span>

#include "fabrication/job/uvj_layout.h"
#include "forward/base/error.h"
#include "tests/fabrication/job/uvj_samples.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

using namespace test;

// What the reader complains of; empty where it does not.
std::string complaint(const std::filesystem::path& path) {
  try {
    (void)read_uvj(path);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

bool complains(const std::filesystem::path& path, std::string_view of) {
  const std::string text = complaint(path);
  EXPECT_NE(text.find(of), std::string::npos) << text;
  return text.find(of) != std::string::npos;
}

constexpr const char* plain_config = R"({"Properties": {
  "Size": {"X": 4, "Y": 2, "Millimeter": {"X": 0.2, "Y": 0.1}, "Layers": 2, "LayerHeight": 0.05},
  "Exposure": {"LightOnTime": 11.5}, "Bottom": {"LightOnTime": 60, "Count": 1}}})";

std::string config_with(const std::string& old_text, const std::string& new_text) {
  std::string config = plain_config;
  const std::size_t at = config.find(old_text);
  EXPECT_NE(at, std::string::npos) << old_text;
  return config.replace(at, old_text.size(), new_text);
}

std::filesystem::path archive_of(const TemporaryFolder& folder, const std::string& config) {
  ForeignArchive archive;
  archive.add("config.json", config).add_slice(0, 4, 2).add_slice(1, 4, 2).write(folder / "job.uvj");
  return folder / "job.uvj";
}

TEST(UvjReader, RefusesAnyTruncation) {
  const TemporaryFolder folder;
  write_uvj(sample_job(), folder / "whole.uvj");
  const std::string whole = bytes_of(folder / "whole.uvj");
  const std::size_t step = whole.size() / 100;
  for (std::size_t length = 0; length < whole.size(); length += step) {
    put_bytes(folder / "cut.uvj", whole.substr(0, length));
    EXPECT_NE(complaint(folder / "cut.uvj"), "") << length;
  }
  put_bytes(folder / "cut.uvj", whole.substr(0, whole.size() - 1));
  EXPECT_NE(complaint(folder / "cut.uvj"), "");
}

TEST(UvjReader, NeverTakesADamagedArchiveForAnotherJob) {
  // A flipped bit is found, or it sits where a zip holds nothing of the job (dates, versions, attributes).
  const TemporaryFolder folder;
  const Job job = sample_job();
  write_uvj(job, folder / "whole.uvj");
  const std::string whole = bytes_of(folder / "whole.uvj");
  std::size_t refused = 0, tried = 0;
  for (std::size_t at = 0; at < whole.size(); at += 19, ++tried) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << at % 8));
    put_bytes(folder / "damaged.uvj", damaged);
    try {
      const Job read = read_uvj(folder / "damaged.uvj");
      expect_same(read, job);
    } catch (const FileError&) {
      ++refused;
    }
  }
  // A member costs 12 bytes of dates and versions in its own header and 20 in the directory: 7 of them in some 5700
  // bytes.
  EXPECT_GT(refused, tried * 9 / 10) << refused << " of " << tried;
  RecordProperty("refused", static_cast<int>(refused));
  RecordProperty("tried", static_cast<int>(tried));
}

TEST(UvjReader, RefusesAChangedSlice) {
  // The zip itself is whole: only the hash can tell.
  const TemporaryFolder folder;
  Job job = sample_job();
  write_uvj(job, folder / "a.uvj");
  job.layers[1].gray[70] = 3;
  write_uvj(job, folder / "b.uvj");
  const ZipReader a(folder / "a.uvj", 100), b(folder / "b.uvj", 100);
  ForeignArchive mixed;
  for (const std::string& name : a.names()) {
    const auto bytes = (name == "slice/00000001.png" ? b : a).read(name, 1000000);
    mixed.add(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  mixed.write(folder / "mixed.uvj");
  EXPECT_TRUE(complains(folder / "mixed.uvj", "slice/00000001.png: does not have the SHA-256"));
  mixed.add("slice/extra.txt", "hello").write(folder / "mixed.uvj");
  EXPECT_TRUE(complains(folder / "mixed.uvj", "slice/extra.txt: is not listed"));
}

TEST(UvjReader, RefusesMissingAndSurplusLayers) {
  const TemporaryFolder folder;
  ForeignArchive one;
  one.add("config.json", plain_config).add_slice(0, 4, 2).write(folder / "one.uvj");
  EXPECT_TRUE(complains(folder / "one.uvj", "slice/00000001.png: is missing"));
  ForeignArchive three;
  three.add("config.json", plain_config).add_slice(0, 4, 2).add_slice(1, 4, 2).add_slice(2, 4, 2);
  three.write(folder / "three.uvj");
  EXPECT_TRUE(complains(folder / "three.uvj", "holds 3 pictures; config.json says 2"));
  ForeignArchive none;
  none.add_slice(0, 4, 2).write(folder / "none.uvj");
  EXPECT_TRUE(complains(folder / "none.uvj", "config.json: is missing"));
}

TEST(UvjReader, RefusesPicturesOfAnotherKind) {
  const TemporaryFolder folder;
  const std::string gray = encode_png(std::vector<std::uint8_t>(8, 9), 4, 2, 1);
  const auto with_slice = [&](const std::string& png) {
    ForeignArchive archive;
    archive.add("config.json", plain_config).add_slice(0, 4, 2).add("slice/00000001.png", png);
    archive.write(folder / "job.uvj");
    return folder / "job.uvj";
  };
  EXPECT_EQ(complaint(with_slice(gray)), "");
  std::string deep = gray;
  deep[24] = 16;  // IHDR: bit depth
  EXPECT_TRUE(complains(with_slice(deep), "slice/00000001.png: has 16 bits a pixel"));
  EXPECT_TRUE(complains(with_slice(encode_png(std::vector<std::uint8_t>(24, 9), 4, 2, 3)), "is not gray"));
  EXPECT_TRUE(complains(with_slice(encode_png(std::vector<std::uint8_t>(8, 9), 2, 4, 1)), "has 2 x 4 pixels"));
  EXPECT_TRUE(complains(with_slice("GIF89a"), "is no PNG picture"));
  // Header and zip whole, the PNG's own data cut or changed.
  EXPECT_TRUE(complains(with_slice(gray.substr(0, gray.size() - 20)), "slice/00000001.png: is a PNG picture that was"));
  EXPECT_TRUE(complains(with_slice(gray.substr(0, 40)), "slice/00000001.png: is a PNG picture that was"));
  std::string damaged = gray;
  damaged[gray.size() - 20] = static_cast<char>(~damaged[gray.size() - 20]);  // in the data, before its checksum
  EXPECT_TRUE(complains(with_slice(damaged), "slice/00000001.png: is a damaged PNG"));
}

TEST(UvjReader, RefusesBombsBeforeItUnpacksThem) {
  const TemporaryFolder folder;
  ForeignArchive slice;
  slice.add("config.json", plain_config).add_slice(0, 4, 2).add("slice/00000001.png", std::string(3000000, '\0'));
  slice.write(folder / "slice.uvj");
  EXPECT_TRUE(complains(folder / "slice.uvj", "slice/00000001.png: unpacks to 3000000 bytes"));
  ForeignArchive config;
  config.add("config.json", plain_config + std::string(200000, ' ')).add_slice(0, 4, 2).write(folder / "config.uvj");
  EXPECT_TRUE(complains(folder / "config.uvj", "config.json: unpacks to"));
  EXPECT_TRUE(
      complains(archive_of(folder, config_with("\"X\": 4, \"Y\": 2", "\"X\": 65535, \"Y\": 65535")), "up to 2^28"));
  EXPECT_TRUE(
      complains(archive_of(folder, config_with("\"Layers\": 2", "\"Layers\": 100001")), "Properties.Size.Layers"));
  ForeignArchive many;
  many.add("config.json", config_with("\"X\": 4, \"Y\": 2, \"Millimeter\": {\"X\": 0.2, \"Y\": 0.1}, \"Layers\": 2",
                                      "\"X\": 10000, \"Y\": 10000, \"Millimeter\": {\"X\": 0.2, \"Y\": 0.2}, "
                                      "\"Layers\": 43"));
  for (std::size_t i = 0; i < 43; ++i) many.add(slice_member(i), "");
  many.write(folder / "many.uvj");
  EXPECT_TRUE(complains(folder / "many.uvj", "more than 2^32 pixels"));
}

TEST(UvjReader, NamesTheValueThatIsWrong) {
  const TemporaryFolder folder;
  EXPECT_EQ(complaint(archive_of(folder, plain_config)), "");
  EXPECT_TRUE(complains(archive_of(folder, "{\"Properties\": "), "config.json: is no valid JSON"));
  EXPECT_TRUE(complains(archive_of(folder, "[]"), "must hold a JSON object"));
  EXPECT_TRUE(complains(archive_of(folder, "{}"), "\"Properties\" is missing"));
  EXPECT_TRUE(complains(archive_of(folder, config_with("\"X\": 4", "\"X\": 4.5")), "\"Properties.Size.X\" must be"));
  EXPECT_TRUE(
      complains(archive_of(folder, config_with("0.05", "\"thin\"")), "\"Properties.Size.LayerHeight\" must be"));
  EXPECT_TRUE(complains(archive_of(folder, config_with("0.05", "-1")), "must be above 0"));
  EXPECT_TRUE(complains(archive_of(folder, config_with("0.05", "1e-12")), "config.json"));  // below the file's grid
  EXPECT_TRUE(complains(archive_of(folder, config_with("11.5", "0")), "LightOnTime\" must be above 0"));
  EXPECT_TRUE(complains(archive_of(folder, config_with("\"Y\": 0.1", "\"Y\": 0.9")), "not square"));
  EXPECT_TRUE(complains(archive_of(folder, config_with("60,", "60, \"LightPWM\": 5,")), "LightPWM"));
  EXPECT_TRUE(complains(archive_of(folder, config_with("}}}", "}}, \"Layers\": [1]}")), "has 1 entries"));
  EXPECT_TRUE(complains(archive_of(folder, config_with("}}}", "}}, \"Layers\": [1, 2]}")), "must be an object"));
  EXPECT_TRUE(complains(archive_of(folder, config_with("}}}", "}}, \"Layers\": [{\"Z\": 0.1}, {\"Z\": 0.1}]}")),
                        "does not lie above"));
}

TEST(UvjReader, SurvivesScrambledConfigurations) {
  const RandomStream stream(11, RandomPurpose::Test);
  const std::string letters = "{}[]\",:0123456789.-eE nulltrue\xFF";
  const MemberPlace place{"job.uvj", "config.json"};
  std::size_t refused = 0;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    std::string config = plain_config;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto words = stream.bits4(i, k);
      config[words[0] % config.size()] = letters[words[1] % letters.size()];
    }
    // Anything but a FileError or a job of an allowed size ends the test.
    try {
      const Job job = read_config(std::as_bytes(std::span(config)), place);
      EXPECT_LE(job.columns * job.rows, largest_layer_pixels);
      EXPECT_LE(job.layers.size(), largest_layer_count);
    } catch (const FileError&) {
      ++refused;
    }
  }
  // Two thirds of the text are names and brackets that nothing may replace; three letters are replaced each time.
  EXPECT_GT(refused, 2000U);
}

TEST(UvjReader, RefusesOneNameTwice) {
  // Two readers could take two different layers for it.
  const TemporaryFolder folder;
  std::string bytes = bytes_of(archive_of(folder, plain_config));
  const std::string second = "slice/00000001.png";
  for (std::size_t at = bytes.find(second); at != std::string::npos; at = bytes.find(second)) bytes[at + 13] = '0';
  put_bytes(folder / "twice.uvj", bytes);
  EXPECT_NE(complaint(folder / "twice.uvj"), "");  // libzip or we see it first
}

TEST(UvjReader, RefusesDeepNesting) {
  const TemporaryFolder folder;
  EXPECT_TRUE(complains(archive_of(folder, std::string(60000, '[')), "is no valid JSON"));
  EXPECT_TRUE(complains(archive_of(folder, std::string(30000, '[') + std::string(30000, ']')), "must hold a JSON"));
}

TEST(UvjReader, RefusesWhatIsNoArchive) {
  const TemporaryFolder folder;
  EXPECT_TRUE(complains(folder / "absent.uvj", "no such file"));
  EXPECT_TRUE(complains(folder.path(), "is not a regular file"));
  put_bytes(folder / "text.uvj", "no zip at all");
  EXPECT_TRUE(complains(folder / "text.uvj", "is no readable zip archive"));
  put_bytes(folder / "empty.uvj", "");
  EXPECT_NE(complaint(folder / "empty.uvj"), "");
}

}  // namespace
}  // namespace mezzotint
