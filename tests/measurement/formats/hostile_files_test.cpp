#include <sys/resource.h>
#include <algorithm>

#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "forward/base/file_output.h"
#include "forward/base/random.h"
#include "tests/measurement/formats/instrument_builders.h"
#include "tests/measurement/formats/victims.h"
#include "tests/test_data.h"

// Damaged and hostile files: the readers refuse them with a FileError or read them, and nothing else. What these
// tests look for are crashes, other exceptions and memory out of bounds; the sanitizers watch along.

namespace mezzotint {
namespace {

using test::as_bytes;
using test::gwy_field;
using test::GwyBuilder;
using test::Reader;
using test::Victim;
using test::victims;

enum class Outcome { Read, Refused };

// From a buffer of the exact size, so that a read beyond the end is found.
Outcome outcome_of(Reader reader, std::string_view bytes) {
  const std::vector<std::byte> exact(as_bytes(bytes).begin(), as_bytes(bytes).end());
  try {
    reader(exact);
    return Outcome::Read;
  } catch (const FileError& error) {
    EXPECT_GT(std::string_view(error.what()).size(), std::string_view("f: ").size());
    return Outcome::Refused;
  }
}

TEST(HostileFiles, TheVictimsAreReadWhileTheyAreWhole) {
  for (const Victim& victim : victims()) {
    EXPECT_EQ(outcome_of(victim.reader, victim.bytes), Outcome::Read) << victim.name;
  }
}

TEST(HostileFiles, AFileCutShortIsRefusedAtEveryLength) {
  for (const Victim& victim : victims()) {
    for (std::size_t length = 0; length < victim.bytes.size(); ++length) {
      const Outcome outcome = outcome_of(victim.reader, std::string_view(victim.bytes).substr(0, length));
      if (victim.any_part_may_be_whole) continue;
      const bool refused = length < victim.bytes.size() - victim.dispensable;
      ASSERT_EQ(outcome, refused ? Outcome::Refused : Outcome::Read) << victim.name << " cut at " << length;
    }
  }
}

void cut_real_file(const char* name, Reader reader, std::size_t cuts) {
  const auto path = test::external_data_folder() / "surface" / name;
  MEZZOTINT_NEEDS_DATA(path);
  const auto bytes = read_file(path);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (std::size_t i = 0; i < cuts; ++i) {
    EXPECT_EQ(outcome_of(reader, text.substr(0, text.size() * i / cuts)), Outcome::Refused) << i;
  }
}

TEST(HostileFiles, ARealX3pCutShortIsRefused) { cut_real_file("ISO5436-sample1_bin.x3p", fuzzed::x3p, 200); }
TEST(HostileFiles, ARealGwyCutShortIsRefused) { cut_real_file("tuxu_test.gwy", fuzzed::gwy, 200); }
TEST(HostileFiles, ARealSurCutShortIsRefused) { cut_real_file("sur-2.sur", fuzzed::sur, 20); }
TEST(HostileFiles, ARealOpdCutShortIsRefused) { cut_real_file("surfalize_test_2.opd", fuzzed::opd, 20); }

void change_real_file(const char* name, Reader reader) {
  const auto path = test::external_data_folder() / "surface" / name;
  MEZZOTINT_NEEDS_DATA(path);
  const auto bytes = read_file(path);
  // The first 8 kB: behind them are heights alone, of which any is as good as another.
  std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t structure = std::min<std::size_t>(text.size(), 8192);
  for (std::size_t i = 0; i < 20; ++i) {
    const std::size_t at = structure * i / 20 + i % 7;
    const char before = text[at];
    text[at] = static_cast<char>(before ^ 0x55);
    static_cast<void>(outcome_of(reader, text));
    text[at] = before;
  }
}

TEST(HostileFiles, RealFilesWithOneByteChangedAreReadOrRefused) {
  change_real_file("ISO5436-sample1_bin.x3p", fuzzed::x3p);
  change_real_file("tuxu_test.gwy", fuzzed::gwy);
  change_real_file("sdf-1.sdf", fuzzed::sdf);
  change_real_file("sur-2.sur", fuzzed::sur);
  change_real_file("surfalize_test_2.opd", fuzzed::opd);
}

// One to four bytes changed, half of the time by one bit.
std::string mutated(const std::string& bytes, std::uint64_t index) {
  const RandomStream random(20240501, RandomPurpose::Test);
  const auto head = random.bits4(index);
  std::string result = bytes;
  for (std::uint32_t change = 0; change <= head[0] % 4; ++change) {
    const auto draw = random.bits4(index, change + 1);
    char& victim = result[draw[0] % result.size()];
    victim = draw[1] % 2 == 0 ? static_cast<char>(victim ^ (1 << draw[2] % 8)) : static_cast<char>(draw[3]);
  }
  return result;
}

constexpr std::uint64_t mutations = 2000;

TEST(HostileFiles, TwoThousandMutationsOfEachFormatAreReadOrRefused) {
  for (const Victim& victim : victims()) {
    std::size_t refused = 0;
    for (std::uint64_t i = 0; i < mutations; ++i) {
      refused += outcome_of(victim.reader, mutated(victim.bytes, i)) == Outcome::Refused ? 1 : 0;
    }
    // Most of every file is structure or under a checksum: a reader that takes anything does not look.
    EXPECT_GT(refused, mutations / 10) << victim.name;
  }
}

// The archive's checksum would hide these from the reader of main.xml.
TEST(HostileFiles, MutationsInsideAWholeArchiveAreReadOrRefused) {
  for (const std::string& xml : {test::binary_xml(), test::listed_xml()}) {
    std::size_t refused = 0;
    for (std::uint64_t i = 0; i < mutations; ++i) {
      refused += outcome_of(fuzzed::x3p, test::x3p_of(mutated(xml, i), 0)) == Outcome::Refused ? 1 : 0;
    }
    EXPECT_GT(refused, mutations / 10);
  }
}

TEST(HostileFiles, RandomBytesBehindARightBeginningAreRefused) {
  const RandomStream random(7, RandomPurpose::Test);
  for (const Victim& victim : victims()) {
    if (victim.any_part_may_be_whole) continue;
    for (std::uint64_t i = 0; i < 200; ++i) {
      std::string bytes = victim.bytes.substr(0, 4 + random.bits4(i)[0] % 30);
      for (std::uint32_t draw = 0; draw < 40; ++draw) {
        for (const std::uint32_t word : random.bits4(i, draw + 1)) test::append(bytes, word);
      }
      EXPECT_EQ(outcome_of(victim.reader, bytes), Outcome::Refused) << victim.name;
    }
  }
}

long peak_memory_kib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

// 10^9 × 10^9 heights, 2 GB of data from 9 bytes, 2^28 members, 2^31 texts.
TEST(HostileFiles, APromiseCostsNoMemory) {
  const long before = peak_memory_kib();
  const test::Al3dRecipe al3d{5,    3,    std::vector<float>(15),
                              true, true, {{"Cols", "1000000000"}, {"Rows", "1000000000"}}};
  EXPECT_EQ(outcome_of(fuzzed::al3d, test::build_al3d(al3d)), Outcome::Refused);
  const auto gwy = GwyBuilder().object("/0/data", "GwyDataField", gwy_field(1000000000, 1000000000, 1, 1, {1.0}));
  EXPECT_EQ(outcome_of(fuzzed::gwy, gwy.file()), Outcome::Refused);
  std::string texts = GwyBuilder().texts("/names", {"one"}).file();
  texts[texts.size() - 5] = '\x7F';  // the highest byte of the array's length
  EXPECT_EQ(outcome_of(fuzzed::gwy, texts), Outcome::Refused);
  const std::string xml = test::build_main_xml(
      {16000, 16000, "<AxisType>A</AxisType><DataType>D</DataType>", test::data_link(), "SUR", ""});
  const test::ZipMember bomb{"bindata/data.bin", "tiny", 8, std::int64_t{16000} * 16000 * 8};
  EXPECT_EQ(outcome_of(fuzzed::x3p, test::build_zip({{"main.xml", xml}, bomb})), Outcome::Refused);
  EXPECT_EQ(outcome_of(fuzzed::x3p, test::build_zip64({{"main.xml", xml}, bomb}, std::uint64_t{1} << 28)),
            Outcome::Refused);
  EXPECT_EQ(outcome_of(fuzzed::sur, test::build_sur({30000, 30000, {1, 2}})), Outcome::Refused);
  EXPECT_EQ(outcome_of(fuzzed::sdf, test::build_sdf_header({"bISO-2.0", 30000, 30000, 7})), Outcome::Refused);
  EXPECT_EQ(outcome_of(fuzzed::sdf, test::build_text_sdf("aISO-1.0", 30000, 30000, 7, "1 2")), Outcome::Refused);
  EXPECT_EQ(outcome_of(fuzzed::png, test::build_png(30000, 30000, 16, {})), Outcome::Refused);
  EXPECT_EQ(outcome_of(fuzzed::tiff, test::build_tiff({30000, 30000, 16, false, false, {1.0}})), Outcome::Refused);
  // Six pixels, packed (tag 259: LZW, which keeps libtiff from looking), in strips of 1.3·10^9 rows (tag 278).
  std::string strips = test::build_tiff({3, 2, 32, false, true, {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}});
  const std::size_t rows_a_strip = strips.find(std::string("\x16\x01\x04\0\x01\0\0\0\x02\0\0\0", 12));
  ASSERT_NE(rows_a_strip, std::string::npos);
  strips[rows_a_strip + 11] = '\x4F';
  strips[strips.find(std::string("\x03\x01\x03\0\x01\0\0\0\x01", 9)) + 8] = '\x05';
  EXPECT_EQ(outcome_of(fuzzed::tiff, strips), Outcome::Refused);
  EXPECT_EQ(outcome_of(fuzzed::exr, test::build_exr(30000, 30000, {})), Outcome::Refused);
  std::string diagonal;
  for (int i = 0; i < 20000; i += 400) diagonal += std::to_string(i) + " " + std::to_string(i) + " 0\n1 1 0\n";
  EXPECT_EQ(outcome_of(fuzzed::xyz, diagonal), Outcome::Refused);
  // The files themselves have a few kB; the smallest of the promises would take 2 GB.
  EXPECT_LT(peak_memory_kib() - before, 64 * 1024);
}

TEST(HostileFiles, AnEmptyFileAndAnUnknownOneAreRefusedByName) {
  const test::TemporaryFolder folder;
  write_file(folder / "empty.x3p", "");
  EXPECT_THROW(static_cast<void>(read_surface(folder / "empty.x3p")), FileError);
  EXPECT_THROW(static_cast<void>(read_surface(folder / "missing.x3p")), FileError);
  write_file(folder / "picture.gwy", "\x89PNG\r\n");
  try {
    static_cast<void>(read_surface(folder / "picture.gwy"));
    FAIL() << "read a picture";
  } catch (const FileError& error) {
    EXPECT_NE(std::string_view(error.what()).find(".al3d (or its folder), .x3p"), std::string_view::npos)
        << error.what();
  }
}

TEST(HostileFiles, TheFormatIsFoundByTheFirstBytesNotByTheName) {
  const test::TemporaryFolder folder;
  write_file(folder / "relief.txt", test::small_gwy());
  EXPECT_EQ(read_surface(folder / "relief.txt").format, "gwy");
  write_file(folder / "relief.gwy", test::small_al3d());
  EXPECT_EQ(read_surface(folder / "relief.gwy").format, "al3d");
}

}  // namespace
}  // namespace mezzotint
