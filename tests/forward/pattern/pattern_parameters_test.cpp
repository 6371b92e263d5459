#include "forward/pattern/pattern_parameters.h"

#include <cmath>

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

TEST(PatternParameters, RefuseNamesOfAnotherKind) {
  EXPECT_THROW((void)get_parameter(Ridges{}, "stretch"), InvalidInput);
  EXPECT_THROW((void)default_pattern("moire"), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
