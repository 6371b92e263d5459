#include "experiments/report/report.h"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "experiments/report/float_array.h"
#include "experiments/report/page_template.h"
#include "forward/base/error.h"
#include "tests/experiments/report/demo_report.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

using nlohmann::json;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
  return found;
}

// What a browser would take for the data: up to the first "</script".
std::string inline_data(const std::string& html) {
  const std::string opening = "<script type=\"application/json\" id=\"report-data\">";
  const std::size_t begin = html.find(opening) + opening.size();
  return html.substr(begin, html.find("</script", begin) - begin);
}

std::string demo_page() {
  const test::TemporaryFolder folder;
  write_report(test::demo_report(), folder / "report.html");
  return text_of(folder / "report.html");
}

// An independent decoder of RFC 4648, bit by bit.
std::vector<float> decoded(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<float> values;
  std::uint32_t bits = 0;
  int held = 0, bytes = 0;
  std::uint32_t word = 0;
  for (const char c : base64) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    held += 6;
    if (held < 8) continue;
    held -= 8;
    word |= (bits >> held & 0xFFU) << (8 * bytes);
    if (++bytes < 4) continue;
    values.push_back(std::bit_cast<float>(word));
    word = 0;
    bytes = 0;
  }
  return values;
}

Panel named(const char* title) { return {title}; }

NamedMap small_map(const char* name) {
  NamedMap map;
  map.name = name;
  map.grid = {2, 2};
  map.mean = {1.0, 2.0, 3.0, 4.0};
  return map;
}

Report report_with(std::vector<json> components) {
  Report report;
  report.title = "r";
  report.sections = {{"s", "", std::move(components)}};
  return report;
}

TEST(Base64, MatchesTheVectorsOfRfc4648) {
  const auto encoded = [](const std::string& text) {
    return to_base64({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(FloatArray, IsLittleEndianAndKeepsNaN) {
  // 1.0f is 0x3F800000: bytes 00 00 80 3F, "AACAPw==" in base64.
  EXPECT_EQ(float_array(std::vector<float>{1.0F})["float32"], "AACAPw==");
  const std::vector<float> values = {-2.5F, std::nanf(""), 1e-30F};
  const std::vector<float> back = decoded(float_array(values)["float32"]);
  ASSERT_EQ(back.size(), 3U);
  EXPECT_EQ(back[0], values[0]);
  EXPECT_TRUE(std::isnan(back[1]));
  EXPECT_EQ(back[2], values[2]);
}

TEST(Report, DataRoundTripThroughThePage) {
  const json data = json::parse(inline_data(demo_page()));
  EXPECT_EQ(data, json::parse(to_report_json(test::demo_report()).dump()));
  EXPECT_EQ(data["format"], "mezzotint-report");
  EXPECT_EQ(data["key_figures"][0]["value"], 0.0476);
  EXPECT_EQ(data["key_figures"][0]["standard_error"], 0.0021);
  EXPECT_EQ(data["provenance"]["seed"], "1");
}

TEST(Report, HostileTextIsInert) {
  const std::string html = demo_page();
  EXPECT_EQ(html.find("<b id=\"broken-out\">"), std::string::npos);
  EXPECT_EQ(inline_data(html).find('<'), std::string::npos);
  // The page's own script elements: the data, the program. A third would be one that broke out.
  EXPECT_EQ(count(html, "</script"), 2U);
  EXPECT_EQ(json::parse(inline_data(html))["provenance"]["hostile"], test::hostile_text);
}

TEST(Report, TextThatIsNotUtf8DoesNotStopThePage) {
  Report report = report_with({});
  report.subtitle = "caf\xE9";
  const test::TemporaryFolder folder;
  EXPECT_NO_THROW(write_report(report, folder / "report.html"));
}

TEST(Report, LoadsNothingFromElsewhere) {
  std::string html = demo_page();
  EXPECT_EQ(count(html, "<link"), 0U);
  EXPECT_EQ(count(html, "@import"), 0U);
  EXPECT_EQ(count(html, "<script src"), 0U);
  EXPECT_EQ(count(html, "url(http"), 0U);
  EXPECT_EQ(count(html, "src=\"http"), 0U);
  // The browser itself refuses every connection: only what is inside of the file may run.
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(count(html, "connect-src"), 0U);
}

TEST(Report, ValuesThatAreNotFiniteBecomeNull) {
  Report report = report_with({vega_lite_chart(named("c"), {{"data", {{"values", {NAN, INFINITY, 1.0}}}}})});
  KeyFigure& lost = report.key_figures.emplace_back();
  lost.name = "lost";
  lost.quantity = {NAN, "um", INFINITY};
  const json data = json::parse(to_report_json(report).dump());
  EXPECT_TRUE(data["key_figures"][0]["value"].is_null());
  EXPECT_TRUE(data["key_figures"][0]["standard_error"].is_null());
  EXPECT_EQ(data["sections"][0]["components"][0]["spec"]["data"]["values"], json({nullptr, nullptr, 1.0}));
}

TEST(Report, StoresASharedArrayOnce) {
  const NamedMap map = small_map("m");
  const json data =
      to_report_json(report_with({direction_maps(named("flat"), {map}), lobe_viewer(named("3-D"), {map})}));
  const json& components = data["sections"][0]["components"];
  EXPECT_EQ(data["arrays"].size(), 1U);
  EXPECT_EQ(components[0]["maps"][0]["values"], components[1]["maps"][0]["values"]);
  const std::string id = components[0]["maps"][0]["values"]["array"];
  EXPECT_EQ(decoded(data["arrays"][id]), (std::vector<float>{1, 2, 3, 4}));
}

TEST(Report, NeedsTitles) {
  EXPECT_THROW((void)to_report_json(Report{}), InvalidInput);
  Report report = report_with({});
  report.sections[0].title.clear();
  EXPECT_THROW((void)to_report_json(report), InvalidInput);
}

TEST(DirectionMaps, RefuseAMapThatDoesNotFitItsGrid) {
  NamedMap map = small_map("m");
  map.mean.pop_back();
  EXPECT_THROW((void)direction_maps(named("p"), {map}), InvalidInput);
  EXPECT_THROW((void)direction_maps(named("p"), {}), InvalidInput);
  map = small_map("m");
  map.standard_error = {0.1};
  EXPECT_THROW((void)lobe_viewer(named("p"), {map}), InvalidInput);
}

TEST(DifferenceMap, AddsErrorsInQuadrature) {
  NamedMap a = small_map("a"), b = small_map("b");
  a.standard_error = {3.0, 0.0, 1.0, 0.0};
  b.standard_error = {4.0, 2.0, 0.0, 0.0};
  b.mean = {0.5, 2.5, 3.0, 0.0};
  const NamedMap difference = difference_map("a − b", a, b);
  EXPECT_EQ(difference.mean, (DirectionMap{0.5, -0.5, 0.0, 4.0}));
  EXPECT_EQ(difference.standard_error, (DirectionMap{5.0, 2.0, 1.0, 0.0}));  // 3-4-5
  EXPECT_TRUE(difference.difference);
  b.grid = {4, 1};
  EXPECT_THROW((void)difference_map("d", a, b), InvalidInput);
}

TEST(ReliefMaps, ReduceABigReliefByBlockMeansAndSaySo) {
  // 1024 columns: blocks of 2 × 2. Column pairs hold 4k and 4k + 2, so every mean is 4k + 1; the first block has two
  // gaps, the second nothing but gaps, and the third three: less than half of it was seen.
  HeightField field({1024, 2, Length::from_um(0.5), Length::from_um(2.0)}, Continuation::Mirrored);
  for (std::size_t c = 0; c < 1024; ++c) field.at(c, 0) = field.at(c, 1) = static_cast<float>(2 * c);
  field.at(1, 0) = field.at(0, 1) = NAN;
  field.at(2, 0) = field.at(3, 0) = field.at(2, 1) = field.at(3, 1) = NAN;
  field.at(4, 0) = field.at(5, 0) = field.at(4, 1) = NAN;
  const json component = relief_maps(named("p"), {{"r", field}});
  const json& relief = component["reliefs"][0];
  EXPECT_EQ(relief["block"], 2);
  EXPECT_EQ(relief["columns"], 512);
  EXPECT_EQ(relief["rows"], 1);
  EXPECT_EQ(relief["pitch_x_um"], 1.0);
  EXPECT_EQ(relief["pitch_y_um"], 4.0);
  const std::vector<float> heights_um = decoded(relief["heights"]["float32"]);
  ASSERT_EQ(heights_um.size(), 512U);
  EXPECT_EQ(heights_um[0], 1.0F);
  EXPECT_TRUE(std::isnan(heights_um[1]));
  EXPECT_TRUE(std::isnan(heights_um[2]));
  for (std::size_t k = 3; k < 512; ++k) ASSERT_EQ(heights_um[k], static_cast<float>(4 * k + 1));
  EXPECT_DOUBLE_EQ(relief["missing_share"].get<double>(), 9.0 / 2048.0);
}

TEST(Table, RefusesARowOfAnotherLength) {
  EXPECT_THROW((void)table(named("t"), {"a", "b"}, {{{"one"}}}), InvalidInput);
  EXPECT_THROW((void)table(named("t"), {}, {}), InvalidInput);
}

TEST(LineChart, LeavesOutWhatALogarithmicAxisCannotShow) {
  const Series series{"s", {1.0, 2.0, 3.0, 0.0, 5.0}, {1.0, 0.0, NAN, 4.0, 5.0}, {}, false};
  const json log = line_chart(named("c"), {"x", "y", true, true}, {series});
  EXPECT_EQ(log["spec"]["data"]["values"].size(), 2U);  // (1, 1) and (5, 5)
  const json linear = line_chart(named("c"), {"x", "y"}, {series});
  EXPECT_EQ(linear["spec"]["data"]["values"].size(), 4U);  // all but the NaN
  EXPECT_THROW((void)line_chart(named("c"), {"x", "y"}, {{"s", {1.0}, {}, {}, false}}), InvalidInput);
}

TEST(SearchHistory, KeepsTheBestSoFar) {
  const json chart = search_history(named("c"), {3.0, 5.0, NAN, 2.0, 0.0, 4.0});
  const json& rows = chart["spec"]["data"]["values"];
  std::vector<double> best;
  for (const json& row : rows) best.push_back(row["best"]);
  EXPECT_EQ(best, (std::vector<double>{3.0, 3.0, 2.0, 2.0}));
  EXPECT_EQ(rows.back()["evaluation"], 6);
}

TEST(SlopeEllipses, LieOnTheCovariance) {
  const SlopeAxes axes{0.2, 0.1, Angle::from_degrees(30.0)};
  const json chart = slope_ellipses(named("c"), {{"one", axes, false}});
  const SlopeCovariance c{0.2 * 0.2 * 0.75 + 0.1 * 0.1 * 0.25, 0.2 * 0.2 * 0.25 + 0.1 * 0.1 * 0.75,
                          (0.2 * 0.2 - 0.1 * 0.1) * std::sqrt(0.75) * 0.5};
  const double determinant = c.xx * c.yy - c.xy * c.xy;
  for (const json& row : chart["spec"]["layer"][0]["data"]["values"]) {
    const double x = row["x"], y = row["y"];
    // xᵀ C⁻¹ x = 1 on the 1 σ ellipse; rounding of doubles only.
    EXPECT_NEAR((c.yy * x * x - 2.0 * c.xy * x * y + c.xx * y * y) / determinant, 1.0, 1e-12);
  }
  EXPECT_EQ(chart["spec"]["width"], chart["spec"]["height"]);
}

TEST(SlopeHistogram, NeedsOneEdgeMoreThanDensities) {
  EXPECT_THROW((void)slope_histogram(named("c"), {"h", {0.0, 1.0}, {1.0, 2.0}}, {}), InvalidInput);
}

// The browser test opens what this one writes (see report_browser/).
TEST(Report, WritesTheDemoPage) {
  const test::TemporaryFolder folder;
  const char* wanted = std::getenv("MEZZOTINT_DEMO_REPORT");
  const std::filesystem::path path = wanted != nullptr ? std::filesystem::path(wanted) : folder / "demo.html";
  write_report(test::demo_report(), path);
  // The page with its libraries has about 1.7 MB; four reliefs and three maps add at most a few more.
  EXPECT_GT(std::filesystem::file_size(path), page_template().size());
  EXPECT_LT(std::filesystem::file_size(path), page_template().size() + 4'000'000);
}

}  // namespace
}  // namespace mezzotint
