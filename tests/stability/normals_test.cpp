#include "tests/stability/scene.h"

namespace mezzotint {
namespace {

using test::light_at;
using test::percent;
using test::warning;

constexpr const char* theme = "Normals";

TEST(InterpolatedNormals, FaceAwayFromGrazingLight) {
  std::vector<double> shares;
  Bsdf steepest;
  for (const double gradient : {0.3, 0.8, 2.0}) {
    PathTracingOptions options = light_at(80.0);
    options.normals = NormalKind::Interpolated;
    steepest = trace_bsdf(test::random_relief(128, gradient), options);
    // A normal that cannot be used is replaced, so that no light is lost.
    EXPECT_NEAR(steepest.energy.reflected.value + steepest.energy.cut_off.value, 1.0, 1e-9) << gradient;
    EXPECT_LT(steepest.energy.cut_off.value, 1e-4) << gradient;
    shares.push_back(test::share(steepest, "normal_fallback_share"));
  }
  EXPECT_LT(shares[0], shares[1]);
  EXPECT_LT(shares[1], shares[2]);
  const std::string told = warning(steepest, "an interpolated normal would have sent light through the surface");
  EXPECT_FALSE(told.empty());
  test::record({theme, "`--normals interpolated`", "s = 0.3, 0.8 and 2 at 80°",
                fmt::format("In {}, {} and {} of the interactions the normal would send light through the surface; the "
                            "facet's is taken. No light is lost.",
                            percent(shares[0]), percent(shares[1]), percent(shares[2])),
                "`normal_fallback_share`; above 1 % it warns.", told});
}

TEST(InterpolatedNormals, AreThoseOfAnotherSurfaceThanTheFacets) {
  const HeightField relief = test::random_relief(64, 0.5);
  PathTracingOptions options = light_at(60.0, Mirror{}, 17);
  options.grid = {32, 32};
  const Bsdf facets = trace_bsdf(relief, options);
  options.normals = NormalKind::Interpolated;
  const Bsdf smooth = trace_bsdf(relief, options);
  const double off = test::difference(smooth, facets);
  EXPECT_GT(off, 0.02);
  EXPECT_EQ(smooth.provenance.at("normals"), "interpolated");
  test::record(
      {theme, "`--normals interpolated`", "features of a few samples, s = 0.5 at 60°",
       fmt::format("The map converges to another one, {} from that of the facets, however many paths.", percent(off)),
       "Not a fault that a run can see: sample the relief more finely and compare. `mezzotint chart` draws the floor.",
       "provenance `normals`: interpolated"});
}

}  // namespace
}  // namespace mezzotint
