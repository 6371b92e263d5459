#include "experiments/texture/texture_page.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "tests/measurement/relief.h"

namespace mezzotint {
namespace {

const TextureSource source{"scan.x3p", "x3p", "", "", {{"manufacturer", "somebody"}}};

HeightField waves(std::size_t columns, std::size_t rows) {
  const HeightField noise = test::white_noise(test::micrometre_grid(columns, rows), 3);
  HeightField field = noise;
  for (std::size_t i = 0; i < field.grid().size(); ++i)
    field.heights_um()[i] +=
        3.0F * static_cast<float>(std::sin(2.0 * std::numbers::pi * static_cast<double>(i % columns) / 20.0));
  return field;
}

nlohmann::json page_of(const HeightField& field, const TextureRequest& request = {}) {
  return to_report_json(texture_page(texture_of(field, request), request, source));
}

const nlohmann::json* component_of(const nlohmann::json& page, const std::string& title) {
  for (const auto& section : page.at("sections"))
    for (const auto& component : section.at("components"))
      if (component.value("title", "") == title) return &component;
  return nullptr;
}

TEST(TexturePage, HasEveryPictureAndEveryParameter) {
  TextureRequest request;
  request.line = TextureRequest::Line{{0.0, 10.0}, {190.0, 60.0}};
  request.profile_filter = {Length::from_um(4.0), Length::from_um(40.0)};
  const nlohmann::json page = page_of(waves(200, 80), request);
  for (const char* title : {"Heights", "In three dimensions", "Material ratio curve", "Power spectral density",
                            "Power by direction", "Areal spectrum", "Autocorrelation", "Normal distribution",
                            "Steepest slopes", "Gentlest slopes", "Profile", "Profile parameters"})
    EXPECT_NE(component_of(page, title), nullptr) << title;
  const std::string text = page.dump();
  for (const char* symbol : {"Sa",  "Sq",  "Sp",   "Sv",   "Sz",  "Ssk", "Sku", "Sdq", "Sdr", "Sal", "Str", "Std", "Sk",
                             "Spk", "Svk", "Smr1", "Smr2", "Vmp", "Vmc", "Vvc", "Vvv", "Sxp", "Ra",  "Rq",  "RSm"})
    EXPECT_NE(text.find(std::string("\"cells\":[\"") + symbol + "\""), std::string::npos) << symbol;
  EXPECT_EQ(page.at("provenance").at("manufacturer"), "somebody");
  EXPECT_EQ(text.find("were filled"), std::string::npos);
}

TEST(TexturePage, DrawsTheLineWhereTheAutocorrelationFalls) {
  // Waves of 20 µm along x, and noise that is correlated with nothing: 0.2 of 5.5 is reached along x alone.
  const nlohmann::json page = page_of(waves(400, 100));
  const auto& outline = component_of(page, "Autocorrelation")->at("reliefs").at(0).at("outline");
  ASSERT_EQ(outline.size(), 720U);
  // cos(2πt/20) · 4.5/5.5 = 0.2.
  EXPECT_NEAR(outline.at(0).at(0).get<double>(), 20.0 * std::acos(0.2 * 5.5 / 4.5) / (2.0 * std::numbers::pi), 0.1);
  EXPECT_DOUBLE_EQ(outline.at(360).at(0).get<double>(), -outline.at(0).at(0).get<double>());
}

TEST(TexturePage, SaysThatMissingSamplesWereFilledForTheSpectrum) {
  HeightField field = waves(120, 80);
  for (std::size_t c = 20; c < 40; ++c)
    for (std::size_t r = 20; r < 40; ++r) field.at(c, r) = test::missing;
  const nlohmann::json page = page_of(field);
  EXPECT_NE(component_of(page, "Power spectral density")->at("caption").get<std::string>().find("4.2 %) were filled"),
            std::string::npos);
  EXPECT_NEAR(component_of(page, "Heights")->at("reliefs").at(0).at("missing_share").get<double>(), 400.0 / 9600.0,
              1e-12);
}

TEST(TexturePage, StaysSmallWhateverTheSizeOfTheScan) {
  TextureRequest request;
  request.line = TextureRequest::Line{{0.0, 0.0}, {1090.0, 540.0}};
  const std::size_t bytes = page_of(waves(1100, 550), request).dump().size();
  // 366 × 183 heights in base64 are 0.36 MB, two maps of 192² 0.4 MB.
  EXPECT_LT(bytes, 1'000'000U);
}

TEST(TexturePage, OfAFlatOrATinySurfaceIsAPageToo) {
  EXPECT_NO_THROW((void)page_of(HeightField(test::micrometre_grid(40, 40), Continuation::Mirrored)));
  EXPECT_NO_THROW((void)page_of(waves(5, 4)));
}

TEST(Texture, InJsonSaysWhatItHoldsFor) {
  TextureRequest request;
  request.s_filter = Length::from_um(5.0);
  request.l_filter = Length::from_um(60.0);
  const TextureFindings found = texture_of(waves(200, 80), request);
  const nlohmann::ordered_json json = texture_json(found, request);
  for (const char* symbol : {"Sa", "Sq", "Ssk", "Sku", "Sdq", "Sdr", "Sal", "Sk", "Vmp", "Sxp"}) {
    EXPECT_TRUE(json.at(symbol).at("standard_error").is_number()) << symbol;
    EXPECT_FALSE(json.at(symbol).at("name").get<std::string>().empty()) << symbol;
    EXPECT_FALSE(json.at(symbol).at("unit").get<std::string>().empty()) << symbol;
  }
  EXPECT_EQ(json.at("Sdq").at("shortest_wavelength").at("value"), 5.0);
  EXPECT_EQ(json.at("Sdr").at("longest_wavelength").at("value"), 60.0);
  EXPECT_FALSE(json.at("Sq").contains("shortest_wavelength"));
  EXPECT_EQ(json.at("settings").at("level"), "plane");
  EXPECT_EQ(json.at("settings").at("s_filter").at("unit"), "µm");
  EXPECT_EQ(json.at("missing_share").at("value"), 0.0);
  request.l_filter = {};
  EXPECT_TRUE(texture_json(texture_of(waves(200, 80), request), request).at("settings").at("l_filter").is_null());
}

}  // namespace
}  // namespace mezzotint
