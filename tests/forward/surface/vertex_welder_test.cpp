#include "forward/surface/vertex_welder.h"

#include <map>

#include <gtest/gtest.h>

#include "forward/base/random.h"

namespace mezzotint {
namespace {

TEST(VertexWelder, GivesThePlacesTheNumbersOfAMap) {
  const RandomStream random(3, RandomPurpose::Test);
  std::map<VertexWelder::Place, std::uint32_t> known;
  VertexWelder welder;
  for (std::uint64_t k = 0; k < 40000; ++k) {  // on a lattice of 27³ places, so that most come again
    const auto draw = random.uniform4(k);
    VertexWelder::Place place{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      place[axis] = 0.1 * static_cast<double>(static_cast<int>(draw[axis] * 27.0) - 13);
    const auto [found, is_new] = known.try_emplace(place, static_cast<std::uint32_t>(known.size()));
    const VertexWelder::Number number = welder.number(place);
    ASSERT_EQ(number.value, found->second);
    ASSERT_EQ(number.is_new, is_new);
  }
  ASSERT_EQ(welder.vertices().size(), known.size());
  for (const auto& [place, number] : known) EXPECT_EQ(welder.vertices()[number], place);
}

TEST(VertexWelder, TakesMinusZeroForZero) {
  VertexWelder welder;
  EXPECT_EQ(welder.number({0.0, -0.0, 1.0}).value, 0U);
  EXPECT_EQ(welder.number({-0.0, 0.0, 1.0}).value, 0U);
}

}  // namespace
}  // namespace mezzotint
