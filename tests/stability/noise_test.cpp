#include "forward/pattern/pattern.h"
#include "forward/pattern/sparse_noise.h"
#include "tests/stability/scene.h"

namespace mezzotint {
namespace {

constexpr const char* theme = "Noise";

TEST(SlidesHash, RepeatsTheNoise33CellsAway) {
  double slides = 0.0, integer = 0.0, spread = 0.0;
  const RandomStream random(3, RandomPurpose::Test);
  for (std::uint64_t k = 0; k < 200; ++k) {
    const auto u = random.uniform4(k);
    const double x = 20.0 * u[0], y = 20.0 * u[1], z = u[2];
    const auto apart = [&](CellHash hash) {
      return std::abs(sparse_noise(x + 32.0, y + 4.0, z - 7.0, 1, hash) - sparse_noise(x, y, z, 1, hash));
    };
    slides = std::max(slides, apart(CellHash::Slides));
    integer = std::max(integer, apart(CellHash::Integer));
    spread = std::max(spread, std::abs(sparse_noise(x, y, z, 1, CellHash::Integer)));
  }
  EXPECT_LT(slides, 1e-12);
  EXPECT_GT(integer, 0.1);
  test::record(
      {theme, "`hash = \"slides\"` (cell number x + 1000 y + 576 z)", "a point and the one (32, 4, −7) cells away",
       fmt::format("The noise is the same at 200 points of 200 ({} apart): a solid or an oblique slice repeats within "
                   "33 cells, a plane after (1000, −1). By the integer hash they differ by up to {:.2f}.",
                   test::below(slides), integer),
       "Not looked for: it is there to reproduce the slides. The default hash has no period within 2^20 cells.",
       "docs/experiment-files.md#pattern-files"});
}

// Our own sum with any number of impulses; the product has 30.
double noise_of(int impulses, double x, double y, double z) {
  const RandomStream random(9, RandomPurpose::Test);
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const double cx = std::floor(x - 0.5) + (corner & 1), cy = std::floor(y - 0.5) + (corner >> 1 & 1);
    const double cz = std::floor(z - 0.5) + (corner >> 2);
    const auto cell = static_cast<std::uint64_t>(cx + 512.0 + 1024.0 * (cy + 512.0 + 1024.0 * (cz + 512.0)));
    for (int j = 1; j <= impulses; ++j) {
      const auto u = random.uniform4(cell, static_cast<std::uint32_t>(j));
      const double dx = cx + u[0] - x, dy = cy + u[1] - y, dz = cz + u[2] - z;
      const double falloff = std::max(0.0, 1.0 - 4.0 * (dx * dx + dy * dy + dz * dz));
      sum += u[3] * (1 - 2 * (j % 2)) * falloff * falloff * falloff;
    }
  }
  return 4.0 / (5.0 * std::cbrt(static_cast<double>(impulses))) * sum;
}

TEST(OddImpulses, LeaveAMeanOffset) {
  const auto mean = [](int impulses) {
    double sum = 0.0;
    constexpr int points = 20000;
    const RandomStream random(4, RandomPurpose::Test);
    for (std::uint64_t k = 0; k < points; ++k) {
      const auto u = random.uniform4(k);
      sum += noise_of(impulses, 400.0 * u[0], 400.0 * u[1], 400.0 * u[2]);
    }
    return sum / points;
  };
  const double one = mean(1), four = mean(4), five = mean(5);
  // One impulse is left over, of mean weight −½: −½·c·∫k, ∫k = 0.079786. The noise has a standard deviation of about
  // 0.1, so the mean of 20 000 points is known to 0.0008; 4 of that.
  EXPECT_NEAR(one, -0.5 * 0.8 * 0.079786, 0.0032);
  EXPECT_NEAR(five, -0.5 * 0.8 / std::cbrt(5.0) * 0.079786, 0.0032);
  EXPECT_NEAR(four, 0.0, 0.0032);
  test::record({theme, "sparse convolution noise", "an odd number of impulses a cell",
                fmt::format("The mean is {:.3f} with 1 impulse and {:.3f} with 5 (closed form −0.032 and −0.019), and "
                            "{} with 4: signs alternate, and one is left over.",
                            one, five, std::abs(four) < 0.001 ? "less than 0.001" : "another"),
                "Does not happen: the number is 30, and no setting changes it.", "—"});
}

TEST(NoiseLattice, EndsAt2ToThe20Cells) {
  const std::string told = test::refusal([] {
    const Grid grid{16, 16, Length::from_um(1.0), Length::from_um(1.0)};
    (void)synthesize(Noise{.scale = Length::from_um(1.0)}, grid, {Length::from_um(1048570.0), Length::from_um(0.0)});
  });
  EXPECT_FALSE(told.empty());
  test::record({theme, "sparse convolution noise", "a patch beyond 2^20 cells",
                "Nothing is made: cell numbers would wrap, and the noise repeat.",
                "Bounds are checked before memory is taken.", told});
}

}  // namespace
}  // namespace mezzotint
