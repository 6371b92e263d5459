#include <cmath>
#include <limits>

#include "forward/base/error.h"
#include "measurement/formats/parsers.h"
#include "tests/measurement/formats/file_builders.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

using test::as_bytes;
using test::build_main_xml;
using test::build_zip;
using test::data_link;
using test::X3pRecipe;
using test::ZipMember;

const std::string absolute_doubles = "<AxisType>A</AxisType><DataType>D</DataType>";

SurfaceFile parse(const std::string& bytes) { return parse_x3p("test.x3p", as_bytes(bytes)); }

std::string complaint(const std::string& bytes) {
  try {
    parse(bytes);
  } catch (const FileError& error) {
    return error.what();
  }
  return "no complaint";
}

template <class Number>
std::string binary(const std::vector<Number>& values) {
  std::string bytes;
  for (const Number value : values) test::append(bytes, value);
  return bytes;
}

std::string archive_of(const X3pRecipe& recipe, const std::string& data, std::vector<ZipMember> more = {}) {
  std::vector<ZipMember> members = {{"main.xml", build_main_xml(recipe)}, {"bindata/data.bin", data}};
  members.insert(members.end(), more.begin(), more.end());
  return build_zip(members);
}

X3pRecipe three_by_two(const std::string& z_axis, const std::string& record3 = data_link()) {
  return {3, 2, z_axis, record3, "SUR", ""};
}

// 1 … 6 µm, the first row at y = 0.
void expect_one_to_six(const HeightField& field) {
  ASSERT_EQ(field.grid().size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    // Floats of micrometres about their mean, at most two roundings of them.
    EXPECT_NEAR(field.heights_um()[i] + field.datum().um(), static_cast<double>(i + 1), 1e-6) << i;
  }
}

TEST(X3p, ReadsEveryTypeOfBinaryDataWithoutAFlip) {
  const std::vector<double> metres = {1e-6, 2e-6, 3e-6, 4e-6, 5e-6, 6e-6};
  expect_one_to_six(parse(archive_of(three_by_two(absolute_doubles), binary(metres))).field);
  const std::vector<float> floats(metres.begin(), metres.end());
  expect_one_to_six(
      parse(archive_of(three_by_two("<AxisType>A</AxisType><DataType>F</DataType>"), binary(floats))).field);
  const std::string counted = "<AxisType>I</AxisType><Increment>5e-7</Increment><Offset>1.5e-5</Offset>";
  const std::vector<std::int16_t> words = {-28, -26, -24, -22, -20, -18};
  expect_one_to_six(parse(archive_of(three_by_two(counted + "<DataType>I</DataType>"), binary(words))).field);
  const std::vector<std::int32_t> longs(words.begin(), words.end());
  expect_one_to_six(parse(archive_of(three_by_two(counted + "<DataType>L</DataType>"), binary(longs))).field);
}

TEST(X3p, ReadsDeflatedMembersAndWindowsLinks) {
  auto recipe = three_by_two(absolute_doubles, "<DataLink><PointDataLink>bindata\\data.bin</PointDataLink></DataLink>");
  const auto data = binary<double>({1e-6, 2e-6, 3e-6, 4e-6, 5e-6, 6e-6});
  expect_one_to_six(parse(build_zip({{"main.xml", build_main_xml(recipe), 8}, {"bindata/data.bin", data, 8}})).field);
}

TEST(X3p, ReadsADataListWithEmptyDataAsMissing) {
  auto recipe = three_by_two("<AxisType>I</AxisType><DataType>L</DataType><Increment>1e-6</Increment>",
                             "<DataList><Datum>1</Datum><Datum/><Datum> 3 </Datum><!-- next row -->"
                             "<Datum>NaN</Datum><Datum>5E+0000</Datum><Datum>6</Datum></DataList>");
  const SurfaceFile surface = parse(build_zip({{"main.xml", build_main_xml(recipe)}}));
  EXPECT_EQ(surface.field.missing_count(), 2U);
  EXPECT_TRUE(std::isnan(surface.field.at(1, 0)));
  EXPECT_TRUE(std::isnan(surface.field.at(0, 1)));
  EXPECT_NEAR(surface.field.datum().um(), (1.0 + 3.0 + 5.0 + 6.0) / 4.0, 1e-12);
  EXPECT_NEAR(surface.field.at(2, 0), 3.0 - 3.75, 1e-6);
  EXPECT_EQ(surface.provenance.at("model"), "a microscope");
}

TEST(X3p, EveryElementMayCarryTheNamespace) {
  auto recipe = three_by_two("<x:AxisType>A</x:AxisType><x:DataType>D</x:DataType>",
                             "<x:DataLink><x:PointDataLink>bindata/data.bin</x:PointDataLink></x:DataLink>");
  recipe.prefix = "x:";
  expect_one_to_six(parse(archive_of(recipe, binary<double>({1e-6, 2e-6, 3e-6, 4e-6, 5e-6, 6e-6}))).field);
}

TEST(X3p, TheLowestBitOfTheFirstByteIsTheFirstPoint) {
  const auto recipe =
      three_by_two("<AxisType>I</AxisType><DataType>I</DataType><Increment>1e-6</Increment>", data_link("", true));
  const std::string validity(1, static_cast<char>(0b00101110));  // points 0 and 4 are invalid
  const auto data = binary<std::int16_t>({1, 2, 3, 4, 5, 6});
  const HeightField field = parse(archive_of(recipe, data, {{"bindata/valid.bin", validity}})).field;
  EXPECT_EQ(field.missing_count(), 2U);
  EXPECT_TRUE(std::isnan(field.at(0, 0)));
  EXPECT_TRUE(std::isnan(field.at(1, 1)));
}

TEST(X3p, InfiniteAndUndefinedPointsAreMissing) {
  const double infinity = std::numeric_limits<double>::infinity();
  const auto data = binary<double>({infinity, -infinity, std::nan(""), 1e-6, 2e-6, 3e-6});
  const HeightField field = parse(archive_of(three_by_two(absolute_doubles), data)).field;
  EXPECT_EQ(field.missing_count(), 3U);
  EXPECT_NEAR(field.datum().um(), 2.0, 1e-12);
}

TEST(X3p, ComparesTheChecksumOfTheDataInEitherCase) {
  const std::string data(48, '\0');
  const std::string md5 = "b203621a65475445e6fcdca717c667b5";  // of 48 zero bytes, by md5sum
  std::string upper = md5;
  for (char& c : upper) c = static_cast<char>(std::toupper(c));
  EXPECT_EQ(parse(archive_of(three_by_two(absolute_doubles, data_link(md5)), data)).field.missing_count(), 0U);
  EXPECT_EQ(parse(archive_of(three_by_two(absolute_doubles, data_link(upper)), data)).field.missing_count(), 0U);
  std::string other = data;
  other[7] = '\x01';
  const std::string message = complaint(archive_of(three_by_two(absolute_doubles, data_link(md5)), other));
  EXPECT_NE(message.find("bindata/data.bin: its MD5 is"), std::string::npos) << message;
}

TEST(X3p, SaysWhereTheChecksumOfTheDocumentDiffers) {
  const auto archive = archive_of(three_by_two(absolute_doubles), std::string(48, '\0'),
                                  {{"md5checksum.hex", std::string(32, '0') + " *main.xml"}});
  EXPECT_EQ(parse(archive).provenance.count("checksum of main.xml"), 1U);
}

TEST(X3p, RefusesDataThatDoNotFitTheMatrix) {
  const std::string message = complaint(archive_of(three_by_two(absolute_doubles), std::string(47, '\0')));
  EXPECT_NE(message.find("bindata/data.bin: has 47 bytes; 3 × 2 points of type D need 48"), std::string::npos)
      << message;
  auto recipe = three_by_two(absolute_doubles);
  recipe.columns = recipe.rows = 1000000000;
  EXPECT_NE(complaint(archive_of(recipe, std::string(48, '\0'))), "no complaint");
  recipe.columns = recipe.rows = 30000;
  EXPECT_NE(complaint(archive_of(recipe, std::string(48, '\0'))), "no complaint");
  recipe = three_by_two(absolute_doubles, "<DataList><Datum>1</Datum></DataList>");
  EXPECT_NE(complaint(archive_of(recipe, "")).find("holds 1 values; 3 × 2 points need 6"), std::string::npos);
}

TEST(X3p, RefusesWhatIsNoSurfaceWithItsPlaceInTheDocument) {
  const std::string data(48, '\0');
  auto recipe = three_by_two(absolute_doubles);
  recipe.feature = "PRF";
  EXPECT_NE(complaint(archive_of(recipe, data)).find("main.xml, Record1/FeatureType: is \"PRF\"; SUR"),
            std::string::npos);
  recipe = three_by_two("<AxisType>I</AxisType><DataType>I</DataType>");
  EXPECT_NE(complaint(archive_of(recipe, data)).find("CZ/Increment: is missing; a number"), std::string::npos);
  recipe = three_by_two("<AxisType>A</AxisType><DataType>X</DataType>");
  EXPECT_NE(complaint(archive_of(recipe, data)).find("is \"X\"; I (int16)"), std::string::npos);
  EXPECT_NE(complaint(build_zip({{"slice.png", data}})).find("no member main.xml"), std::string::npos);
  EXPECT_NE(complaint(build_zip({{"main.xml", "<html/>"}})).find("ISO5436_2 belongs there"), std::string::npos);
  EXPECT_NE(complaint(build_zip({{"main.xml", "<html"}})).find("is no XML"), std::string::npos);
}

TEST(X3p, RefusesAMemberThatClaimsMoreThanItCanHold) {
  auto recipe = three_by_two(absolute_doubles);
  recipe.columns = recipe.rows = 16000;  // 2.0 GB of doubles from a few bytes
  const ZipMember bomb{"bindata/data.bin", "tiny", 8, std::int64_t{16000} * 16000 * 8};
  const std::string message = complaint(build_zip({{"main.xml", build_main_xml(recipe)}, bomb}));
  EXPECT_NE(message.find("deflate cannot do"), std::string::npos) << message;
}

TEST(X3p, RefusesAMemberThatHoldsOtherThanItClaims) {
  const std::string xml = build_main_xml(three_by_two(absolute_doubles));
  for (const std::size_t actual : {std::size_t{40}, std::size_t{56}}) {
    const ZipMember liar{"bindata/data.bin", std::string(actual, '\0'), 8, 48};
    EXPECT_NE(complaint(build_zip({{"main.xml", xml}, liar})).find("bindata/data.bin"), std::string::npos) << actual;
  }
}

TEST(X3p, RefusesAnArchiveThatPromisesMoreMembersThanItHasBytes) {
  const std::vector<ZipMember> members = {{"main.xml", build_main_xml(three_by_two(absolute_doubles))},
                                          {"bindata/data.bin", std::string(48, '\0')}};
  EXPECT_EQ(parse(test::build_zip64(members, 2)).field.missing_count(), 0U);
  for (const std::uint64_t promise : {std::uint64_t{1} << 28, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    EXPECT_NE(complaint(test::build_zip64(members, promise)).find("no whole zip archive"), std::string::npos);
  }
}

}  // namespace
}  // namespace mezzotint
