#include <sys/resource.h>
#include <cmath>

#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "forward/base/file_output.h"
#include "forward/base/random.h"
#include "measurement/formats/parsers.h"
#include "tests/measurement/formats/file_builders.h"
#include "tests/test_data.h"

// Damaged and hostile files: the readers refuse them with a FileError or read them, and nothing else. What these
// tests look for are crashes, other exceptions and memory out of bounds; the sanitizers watch along.

namespace mezzotint {
namespace {

using test::as_bytes;
using test::gwy_field;
using test::GwyBuilder;
using Parser = SurfaceFile (*)(const std::filesystem::path&, std::span<const std::byte>);

enum class Outcome { Read, Refused };

// From a buffer of the exact size, so that a read beyond the end is found.
Outcome outcome_of(Parser parser, std::string_view bytes) {
  const std::vector<std::byte> exact(as_bytes(bytes).begin(), as_bytes(bytes).end());
  try {
    const SurfaceFile surface = parser("hostile", exact);
    EXPECT_EQ(surface.field.heights_um().size(), surface.field.grid().size());
    return Outcome::Read;
  } catch (const FileError& error) {
    EXPECT_GT(std::string_view(error.what()).size(), std::string_view("hostile: ").size());
    return Outcome::Refused;
  }
}

std::string small_al3d() {
  std::vector<float> heights_m;
  for (int i = 0; i < 15; ++i) heights_m.push_back(0.0763F + 1e-6F * static_cast<float>(i));
  heights_m[4] = 3.000000028082e+15F;
  return test::build_al3d({5, 3, heights_m, true, true, {}});
}

std::string small_gwy() {
  GwyBuilder container;
  container.object("/0/data", "GwyDataField", gwy_field(3, 2, 6e-6, 8e-6, {1e-6, 2e-6, 3e-6, 7e-6, 8e-6, 9e-6}));
  container.object("/0/mask", "GwyDataField", gwy_field(3, 2, 1.0, 1.0, {0, 0, 0, 1, 0, 0}));
  container.text("/0/data/title", "relief").texts("/names", {"one", "two"});
  container.objects("/selections", "GwySelectionPoint", {GwyBuilder().real("x", 1.0), GwyBuilder()});
  container.object("/0/meta", "GwyContainer", GwyBuilder().text("Mezzotint continuation", "periodic, 3 x 2 samples"));
  return container.file();
}

std::string binary_xml() {
  return test::build_main_xml({3, 2, "<AxisType>I</AxisType><DataType>I</DataType><Increment>1e-6</Increment>",
                               test::data_link("", true), "SUR", ""});
}

std::string listed_xml() {
  return test::build_main_xml({2, 2, "<AxisType>A</AxisType><DataType>D</DataType>",
                               "<DataList><Datum>1e-6</Datum><Datum/><Datum>2</Datum><Datum>3</Datum></DataList>",
                               "SUR", ""});
}

std::string x3p_of(const std::string& xml, std::uint16_t method) {
  return test::build_zip({{"main.xml", xml, method},
                          {"bindata/data.bin", std::string("\1\0\2\0\3\0\4\0\5\0\6\0", 12), method},
                          {"bindata/valid.bin", "\x3D", method}});
}

struct Victim {
  const char* name;
  Parser parser;
  std::string bytes;
};

std::vector<Victim> victims() {
  return {{"al3d", parse_al3d, small_al3d()},
          {"gwy", parse_gwy, small_gwy()},
          {"x3p, stored", parse_x3p, x3p_of(binary_xml(), 0)},
          {"x3p, deflated", parse_x3p, x3p_of(binary_xml(), 8)},
          {"x3p, listed", parse_x3p, x3p_of(listed_xml(), 0)}};
}

TEST(HostileFiles, TheVictimsAreReadWhileTheyAreWhole) {
  for (const Victim& victim : victims())
    EXPECT_EQ(outcome_of(victim.parser, victim.bytes), Outcome::Read) << victim.name;
}

// What may be cut off without harm to the heights: the texture of an .al3d (5 columns padded to 8, 3 rows).
TEST(HostileFiles, AFileCutShortIsRefusedAtEveryLength) {
  for (const Victim& victim : victims()) {
    const std::size_t dispensable = victim.parser == parse_al3d ? 24 : 0;
    for (std::size_t length = 0; length < victim.bytes.size(); ++length) {
      const Outcome outcome = outcome_of(victim.parser, std::string_view(victim.bytes).substr(0, length));
      const bool refused = length < victim.bytes.size() - dispensable;
      ASSERT_EQ(outcome, refused ? Outcome::Refused : Outcome::Read) << victim.name << " cut at " << length;
    }
  }
}

void cut_real_file(const char* name, Parser parser) {
  const auto path = test::external_data_folder() / "surface" / name;
  MEZZOTINT_NEEDS_DATA(path);
  const auto bytes = read_file(path);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  constexpr std::size_t cuts = 200;
  for (std::size_t i = 0; i < cuts; ++i) {
    EXPECT_EQ(outcome_of(parser, text.substr(0, text.size() * i / cuts)), Outcome::Refused) << i;
  }
}

TEST(HostileFiles, ARealX3pCutShortIsRefused) { cut_real_file("ISO5436-sample1_bin.x3p", parse_x3p); }
TEST(HostileFiles, ARealGwyCutShortIsRefused) { cut_real_file("tuxu_test.gwy", parse_gwy); }

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
      refused += outcome_of(victim.parser, mutated(victim.bytes, i)) == Outcome::Refused ? 1 : 0;
    }
    // Most of every file is structure or under a checksum: a reader that takes anything does not look.
    EXPECT_GT(refused, mutations / 10) << victim.name;
  }
}

// The archive's checksum would hide these from the reader of main.xml.
TEST(HostileFiles, MutationsInsideAWholeArchiveAreReadOrRefused) {
  for (const std::string& xml : {binary_xml(), listed_xml()}) {
    std::size_t refused = 0;
    for (std::uint64_t i = 0; i < mutations; ++i) {
      refused += outcome_of(parse_x3p, x3p_of(mutated(xml, i), 0)) == Outcome::Refused ? 1 : 0;
    }
    EXPECT_GT(refused, mutations / 10);
  }
}

TEST(HostileFiles, RandomBytesBehindARightBeginningAreRefused) {
  const RandomStream random(7, RandomPurpose::Test);
  for (const Victim& victim : victims()) {
    for (std::uint64_t i = 0; i < 200; ++i) {
      std::string bytes = victim.bytes.substr(0, 4 + random.bits4(i)[0] % 30);
      for (std::uint32_t draw = 0; draw < 40; ++draw) {
        for (const std::uint32_t word : random.bits4(i, draw + 1)) test::append(bytes, word);
      }
      EXPECT_EQ(outcome_of(victim.parser, bytes), Outcome::Refused) << victim.name;
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
  EXPECT_EQ(outcome_of(parse_al3d, test::build_al3d(al3d)), Outcome::Refused);
  const auto gwy = GwyBuilder().object("/0/data", "GwyDataField", gwy_field(1000000000, 1000000000, 1, 1, {1.0}));
  EXPECT_EQ(outcome_of(parse_gwy, gwy.file()), Outcome::Refused);
  std::string texts = GwyBuilder().texts("/names", {"one"}).file();
  texts[texts.size() - 5] = '\x7F';  // the highest byte of the array's length
  EXPECT_EQ(outcome_of(parse_gwy, texts), Outcome::Refused);
  const std::string xml = test::build_main_xml(
      {16000, 16000, "<AxisType>A</AxisType><DataType>D</DataType>", test::data_link(), "SUR", ""});
  const test::ZipMember bomb{"bindata/data.bin", "tiny", 8, std::int64_t{16000} * 16000 * 8};
  EXPECT_EQ(outcome_of(parse_x3p, test::build_zip({{"main.xml", xml}, bomb})), Outcome::Refused);
  EXPECT_EQ(outcome_of(parse_x3p, test::build_zip64({{"main.xml", xml}, bomb}, std::uint64_t{1} << 28)),
            Outcome::Refused);
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
  write_file(folder / "relief.txt", small_gwy());
  EXPECT_EQ(read_surface(folder / "relief.txt").format, "gwy");
  write_file(folder / "relief.gwy", small_al3d());
  EXPECT_EQ(read_surface(folder / "relief.gwy").format, "al3d");
}

}  // namespace
}  // namespace mezzotint
