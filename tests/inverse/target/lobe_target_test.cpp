#include "inverse/target/lobe_target.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

constexpr DirectionGrid bins{16, 16};
const Material glass = Dielectric{1.5};

LobeTarget even_goal() { return lobe_target(bins, glass, {{}}, {DirectionMap(bins.size(), 1.0)}, true); }

LobeTarget brighter(double factor) {
  LobeTarget goal = even_goal();
  for (double& value : goal.maps.front()) value *= factor;
  return goal;
}

// Glass reflects ((1.5 − 1)/(1.5 + 1))² = 0.04 of what comes straight.
TEST(LobeTarget, IsPossibleUpToAllLightThatComesIn) {
  EXPECT_NO_THROW(require_possible(brighter(25.0)));
  EXPECT_THROW(require_possible(brighter(25.1)), InvalidInput);
  EXPECT_NO_THROW(require_possible(brighter(25.1), 0.01));
  EXPECT_THROW(require_possible(brighter(0.0)), InvalidInput);
  EXPECT_THROW(require_possible(brighter(-1.0)), InvalidInput);
  EXPECT_THROW(require_possible(brighter(std::numeric_limits<double>::quiet_NaN())), InvalidInput);
  LobeTarget without = even_goal();
  without.maps.clear();
  EXPECT_THROW(require_possible(without), InvalidInput);
}

TEST(LobeTarget, SaysWhereItIsNotAsBrightAsItsMaterial) {
  EXPECT_TRUE(brightness_notes(even_goal()).empty());
  EXPECT_TRUE(brightness_notes(brighter(1.04)).empty());
  for (const double factor : {0.5, 1.2}) {
    const auto notes = brightness_notes(brighter(factor));
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes.front().find("this material 0.04"), std::string::npos) << notes.front();
  }
}

}  // namespace
}  // namespace mezzotint
