#include "forward/base/random.h"

#include <cmath>

#include <gtest/gtest.h>

namespace mezzotint {
namespace {

TEST(RandomStream, IsTheReferenceGenerator) {
  // Known answers of Random123 (kat_vectors, philox 4x32 10): counter and key all zero.
  // Purpose is part of the counter, so the zero vector is reached through a purpose of value 0.
  const RandomStream stream(0, static_cast<RandomPurpose>(0));
  const auto words = stream.bits4(0, 0);
  EXPECT_EQ(words[0], 0x6627e8d5U);
  EXPECT_EQ(words[1], 0xe169c58dU);
  EXPECT_EQ(words[2], 0xbc57ac4cU);
  EXPECT_EQ(words[3], 0x9b00dbd8U);
}

TEST(RandomStream, IsAFunctionOfItsIndicesAlone) {
  const RandomStream stream(42, RandomPurpose::Test);
  const auto later = stream.uniform4(1'000'000'007, 3);
  (void)stream.uniform4(5);
  EXPECT_EQ(later, stream.uniform4(1'000'000'007, 3));
  EXPECT_NE(later, RandomStream(43, RandomPurpose::Test).uniform4(1'000'000'007, 3));
  EXPECT_NE(later, RandomStream(42, RandomPurpose::RayPosition).uniform4(1'000'000'007, 3));
  EXPECT_NE(later, stream.uniform4(1'000'000'007, 4));
}

TEST(RandomStream, IsUniformAndNormalWhereItSaysSo) {
  const RandomStream stream(1, RandomPurpose::Test);
  constexpr int calls = 50'000;
  double mean = 0.0, square = 0.0, normal_mean = 0.0, normal_square = 0.0, normal_fourth = 0.0;
  for (int i = 0; i < calls; ++i) {
    for (const double u : stream.uniform4(static_cast<std::uint64_t>(i))) {
      ASSERT_GE(u, 0.0);
      ASSERT_LT(u, 1.0);
      mean += u;
      square += u * u;
    }
    for (const double g : stream.normal4(static_cast<std::uint64_t>(i), 1)) {
      normal_mean += g;
      normal_square += g * g;
      normal_fourth += g * g * g * g;
    }
  }
  const double n = 4.0 * calls;
  // Five standard errors: √(1/12n), √(4/45n); 1/√n, √(2/n), √(96/n). False alarm 3e-6 in all.
  EXPECT_NEAR(mean / n, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / n));
  EXPECT_NEAR(square / n, 1.0 / 3.0, 5.0 * std::sqrt(4.0 / 45.0 / n));
  EXPECT_NEAR(normal_mean / n, 0.0, 5.0 / std::sqrt(n));
  EXPECT_NEAR(normal_square / n, 1.0, 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(normal_fourth / n, 3.0, 5.0 * std::sqrt(96.0 / n));
}

}  // namespace
}  // namespace mezzotint
