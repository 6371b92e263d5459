#include "forward/ladder/ladder.h"
#include "forward/surface/relief_warnings.h"
#include "tests/stability/scene.h"

namespace mezzotint {
namespace {

using test::light_at;
using test::percent;
using test::warning;

constexpr const char* theme = "Units and offsets";

HeightField scaled(const HeightField& relief, double factor, double offset_um = 0.0) {
  Grid grid = relief.grid();
  grid.pitch_x = grid.pitch_x * factor;
  grid.pitch_y = grid.pitch_y * factor;
  HeightField result(grid, relief.continuation());
  for (std::size_t k = 0; k < grid.size(); ++k) {
    result.heights_um()[k] = static_cast<float>(double{relief.heights_um()[k]} * factor + offset_um);
  }
  return result;
}

TEST(Units, ChangeNothingFromNanometresToMetres) {
  const HeightField relief = test::random_relief(64, 0.5);
  PathTracingOptions options = light_at(60.0, Dielectric{1.5}, 14);
  // The beam alone: where the splat is corrected depends on judgements that the last bit of a height may turn.
  options.control_variate = ControlVariate::Off;
  const Bsdf micrometres = trace_bsdf(relief, options);
  double largest = 0.0;
  for (const double factor : {1e-3, 1e6}) {
    const Bsdf other = trace_bsdf(scaled(relief, factor), options);
    largest = std::max(largest, relative_l2(options.grid, other.reflection.mean, micrometres.reflection.mean));
    EXPECT_NEAR(other.energy.reflected.value, micrometres.energy.reflected.value, 1e-5);
  }
  // The same samples; heights are rounded anew (6e-8), which moves light across the border of a bin now and then.
  EXPECT_LT(largest, 5e-3);
  LadderOptions ladder;
  ladder.incidence = options.incidence;
  PathTracer tracer(scaled(relief, 1e-3));
  const auto told = geometric_optics_warnings(tracer.facts(), ladder);
  ASSERT_FALSE(told.empty());
  test::record({theme, "`paths`", "the same relief with a pitch of 1 nm, 1 µm and 1 m",
                fmt::format("The maps differ by {} (relative L2): all is computed in cells. It holds; what breaks at "
                            "nanometres is the physics of rays.",
                            test::below(largest)),
                "Feature size and height against `--wavelength`.", told.front()});
}

TEST(Offsets, SpoilSlopesInSinglePrecision) {
  const HeightField relief = test::random_relief(64, 0.05);
  const HeightField far = scaled(relief, 1.0, 1e5);
  PathTracingOptions options = light_at(0.0);
  options.grid = {256, 256};
  PathTracer near_tracer(relief), far_tracer(far);
  const Bsdf centred = near_tracer.splat(options), shifted = far_tracer.splat(options);
  const double off = relative_l2(options.grid, shifted.reflection.mean, centred.reflection.mean);
  EXPECT_GT(off, 0.02);
  const std::string told = warning(shifted, "subtract the offset");
  EXPECT_FALSE(told.empty());
  EXPECT_TRUE(warning(centred, "subtract the offset").empty());
  test::record(
      {theme, "heights in single precision", "an offset of 0.1 m left in the heights, pitch 1 µm, s = 0.05",
       fmt::format("Heights become steps of 7.8 nm, slopes steps of 0.0078, and the lobe a comb: the map of 256 × 256 "
                   "bins is off by {} (relative L2).",
                   percent(off)),
       "The step of a float at the largest height, as a slope, against the RMS gradient; above 1 % it warns. Readers "
       "subtract the offset in double precision (`datum`), so that this concerns callers of the library.",
       told});
}

TEST(Offsets, OfAMetreWouldFlattenAReliefAltogether) {
  HeightField far = scaled(test::random_relief(64, 0.05), 1.0, 1e8);
  const double gradient = test::rms_gradient(far);
  // Steps of 8 µm: what is left of 0.05 is none or nonsense.
  EXPECT_TRUE(gradient == 0.0 || !relief_warnings(far).empty()) << gradient;
}

}  // namespace
}  // namespace mezzotint
