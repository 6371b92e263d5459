#include "tests/stability/scene.h"

namespace mezzotint {
namespace {

using test::light_at;
using test::percent;

constexpr const char* theme = "Placement of samples";

// sin·sin with 16 waves a side: 256 × 256 lattice points meet each at the same 16 × 16 places.
HeightField waves() {
  const double unit = 2.0 * std::numbers::pi / 16.0;
  return test::relief(256, 256, Continuation::Periodic,
                      [=](double c, double r) { return 0.4 / unit * std::sin(unit * c) * std::sin(unit * r); });
}

TEST(LatticePlacement, AliasesWithAPeriodicPattern) {
  PathTracer tracer(waves());
  PathTracingOptions options = light_at(20.0, Mirror{}, 19);
  const Bsdf exact = tracer.splat(options);  // nothing shadows at 20°: the splat is the truth
  options.control_variate = ControlVariate::Off;
  const auto run = [&](Placement placement) {
    options.placement = placement;
    return tracer.trace(options);
  };
  const Bsdf strata = run(Placement::Strata), lattice = run(Placement::Lattice), random = run(Placement::Random);
  const auto error = [&](const Bsdf& bsdf) {
    return relative_l2(options.grid, bsdf.reflection.mean, exact.reflection.mean);
  };
  const auto stated = [&](const Bsdf& bsdf) { return relative_error(options.grid, bsdf.reflection); };
  EXPECT_GT(error(lattice), 2.0 * error(random));
  EXPECT_LT(error(strata), error(random) * 1.1);
  // Each batch has a shift of its own, so that the spread between batches shows what aliasing does. 8 batches know
  // their spread to 27 %: a factor of 2 is 3 of its errors.
  EXPECT_GT(stated(lattice), 0.5 * error(lattice));
  test::record(
      {theme, "`Placement::Lattice`", "sin·sin with 16 waves a side, 256 × 256 points a batch",
       fmt::format(
           "All waves are met at the same 256 places: the error is {}, where strata give {} and random points {}.",
           percent(error(lattice)), percent(error(strata)), percent(error(random))),
       fmt::format("Batches have shifts of their own, so the standard error tells ({} stated).",
                   percent(stated(lattice))),
       "the relative standard error of the map; the program itself places samples in strata"});
}

TEST(SampleBudget, IsRoundedUpToWholeStrata) {
  PathTracingOptions options = light_at(20.0);
  options.samples = 1000;
  const Bsdf bsdf = trace_bsdf(test::random_relief(32, 0.2), options);
  EXPECT_EQ(bsdf.provenance.at("samples"), "1024");
  test::record({theme, "strata along a Morton curve", "1000 samples",
                "Strata are powers of two; fewer samples would leave a part of the patch dark. 1000 become 1024 (8 "
                "batches of 128), at most they double.",
                "Always rounded up.", "provenance `samples`: 1024"});
}

}  // namespace
}  // namespace mezzotint
