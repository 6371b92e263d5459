#include "forward/pattern/pattern_parameters.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

TEST(PatternParameters, AreReadBackAsTheyWereSetForEveryKind) {
  for (const auto kind : pattern_kinds()) {
    Pattern pattern = default_pattern(kind);
    EXPECT_EQ(kind_name(pattern), kind);
    double value = 0.5;
    const auto next = [&value](const PatternParameter& parameter) {
      value += 0.0625;
      return parameter.whole ? std::round(10.0 * value) : value;
    };
    for (const auto& parameter : pattern_parameters(pattern)) set_parameter(pattern, parameter.name, next(parameter));
    value = 0.5;
    for (const auto& parameter : pattern_parameters(pattern)) {
      // Degrees pass through radians.
      EXPECT_NEAR(get_parameter(pattern, parameter.name), next(parameter), 1e-12) << kind << " " << parameter.name;
    }
  }
}

TEST(PatternParameters, NameTheMemberThatTheFileFormatNames) {
  Pattern pattern = Noise{};
  set_parameter(pattern, "scale_um", 42.0);
  set_parameter(pattern, "direction_deg", 90.0);
  EXPECT_DOUBLE_EQ(std::get<Noise>(pattern).scale.um(), 42.0);
  EXPECT_NEAR(std::get<Noise>(pattern).direction.radians(), 1.5707963267948966, 1e-15);
}

// A sum of ridges and of a turned product, next to a mask.
Pattern nested() {
  const Pattern product = PatternProduct{12.0_um, {{Noise{}}, {Ridges{}}}};
  return PatternSum{{{Ridges{.wavelength = 60.0_um}},
                     {TurnedPattern{30.0_deg, {}, {{product}}}},
                     {MaskedPattern{.parts = {{Noise{}}, {Sinusoid{}}, {Noise{.scale = 500.0_um}}}}}}};
}

std::string complaint(const std::function<void()>& act) {
  try {
    act();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "no complaint";
}

TEST(ParametersOfAComposition, AreReadBackAsTheyWereSetUnderTheirPaths) {
  Pattern pattern = nested();
  const std::vector<PatternParameter> all = all_parameters(pattern);
  double value = 1.0;
  for (const auto& parameter : all) set_parameter(pattern, parameter.name, value += 0.0625);
  value = 1.0;
  for (const auto& parameter : all) {
    EXPECT_NEAR(get_parameter(pattern, parameter.name), value += 0.0625, 1e-12) << parameter.name;
  }
}

TEST(ParametersOfAComposition, NameTheMembersThatTheFileNests) {
  Pattern pattern = nested();
  set_parameter(pattern, "parts[1].part.parts[0].scale_um", 42.0);
  set_parameter(pattern, "parts[2].mask.scale_um", 321.0);
  const auto& parts = *parts_of(pattern);
  EXPECT_EQ(std::get<Noise>((*parts_of((*parts_of(parts[1].pattern))[0].pattern))[0].pattern).scale, 42.0_um);
  EXPECT_EQ(std::get<Noise>((*parts_of(parts[2].pattern))[2].pattern).scale, 321.0_um);
  EXPECT_EQ(get_parameter(pattern, "parts[0].wavelength_um"), 60.0);
  EXPECT_EQ(last_name("parts[2].mask.scale_um"), "scale_um");
  EXPECT_EQ(last_name("scale_um"), "scale_um");
}

TEST(ParametersOfAComposition, LeaveOutHeightsThatMeanNothing) {
  std::vector<std::string> heights;
  for (const auto& parameter : all_parameters(nested())) {
    if (parameter.name.ends_with("height_um")) heights.push_back(parameter.name);
  }
  const std::vector<std::string> expected = {"parts[0].height_um", "parts[1].part.height_um",
                                             "parts[2].inside.height_um", "parts[2].outside.height_um"};
  EXPECT_EQ(heights, expected);
  const Pattern turned_factor =
      PatternProduct{5.0_um, {{TurnedPattern{.parts = {{Ridges{}}}}}, {PatternSum{{{Noise{}}, {Noise{}}}}}}};
  EXPECT_NE(complaint([&] { (void)find_parameter(turned_factor, "parts[0].part.height_um"); }).find("shape alone"),
            std::string::npos);
  EXPECT_EQ(find_parameter(turned_factor, "parts[1].parts[1].height_um").name, "parts[1].parts[1].height_um")
      << "within a sum, a height counts against those of the other parts";
}

TEST(ParametersOfAComposition, SayWhichOfThemASearchCannotChange) {
  EXPECT_NE(why_fixed(find_parameter(nested(), "parts[0].phase")).find("drawn anew"), std::string::npos);
  EXPECT_NE(why_fixed(find_parameter(Turbulence{}, "octaves")).find("whole number"), std::string::npos);
  EXPECT_EQ(why_fixed(find_parameter(nested(), "parts[0].skew")), "");
}

TEST(ParametersOfAComposition, SayWhatIsThereWhereANameIsNot) {
  const Pattern pattern = nested();
  const auto asked = [&](const char* path) { return complaint([&] { (void)get_parameter(pattern, path); }); };
  EXPECT_EQ(asked("parts[3].height_um"),
            "a pattern of kind \"sum\" has no \"parts[3]\"; it has parts[0].…, parts[1].…, parts[2].…");
  EXPECT_EQ(asked("parts[0].stretch"),
            "a pattern of kind \"ridges\" has no \"stretch\"; it has wavelength_um, direction_deg, height_um, "
            "skew, phase");
  EXPECT_NE(asked("parts[2].inner.scale_um").find("inside.…, outside.…, mask.…"), std::string::npos);
  for (const char* path : {"", ".", "parts[0]", "parts[0].", "parts[0].skew.x", "parts[-1].skew", "parts[00].skew"}) {
    EXPECT_NE(asked(path), "no complaint") << path;
    Pattern copy = pattern;
    EXPECT_THROW(set_parameter(copy, path, 1.0), InvalidInput) << path;
    EXPECT_THROW((void)find_parameter(pattern, path), InvalidInput) << path;
  }
  EXPECT_NE(complaint([] { (void)get_parameter(PatternSum{}, "height_um"); }).find("it has nothing yet"),
            std::string::npos);
}

TEST(PatternParameters, RefuseNamesOfAnotherKind) {
  EXPECT_THROW((void)get_parameter(Ridges{}, "stretch"), InvalidInput);
  EXPECT_THROW((void)default_pattern("moire"), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
