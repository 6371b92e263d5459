#include "forward/bsdf_table/build_bsdf_table.h"
#include "forward/bsdf_table/reciprocity.h"
#include "forward/bsdf_table/symmetry_check.h"
#include "tests/stability/scene.h"

namespace mezzotint {
namespace {

constexpr const char* theme = "BSDF tables";

// Slopes up are not as slopes down: a saw whose edges are rounded.
HeightField saw() {
  const double unit = 2.0 * std::numbers::pi / 32.0;
  return test::relief(64, 64, Continuation::Periodic, [=](double c, double) {
    return 0.35 / unit * (std::sin(unit * c) + 0.3 * std::sin(2.0 * unit * c));
  });
}

HeightField sine_ridges() {
  const double unit = 2.0 * std::numbers::pi / 32.0;
  return test::relief(64, 64, Continuation::Periodic,
                      [=](double c, double) { return 0.35 / unit * std::sin(unit * c); });
}

HeightField stretched() {
  HeightField relief = test::random_relief(64, 0.5);
  HeightField oblong({64, 64, Length::from_um(1.0), Length::from_um(3.0)}, Continuation::Periodic);
  std::copy(relief.heights_um().begin(), relief.heights_um().end(), oblong.heights_um().begin());
  return oblong;
}

struct Seen {
  SymmetryCheck symmetry;
  double reciprocity = 0.0;
};

Seen table_of(const HeightField& relief, SymmetryKind kind) {
  PathTracer tracer(relief);
  const ComputeBsdf compute = [&](const DirectionAngles& to_light) {
    PathTracingOptions options = test::light_at(0.0, Mirror{}, 13);
    options.incidence = to_light;
    options.grid = {32, 32};
    return tracer.trace(options);
  };
  BsdfTableOptions options;
  options.symmetry.kind = kind;
  options.largest_theta = Angle::from_degrees(60.0);
  options.coarse_rings = 4;
  options.coarse_azimuths = 4;
  options.most_incidences = kind == SymmetryKind::Isotropic ? 4 : 13;
  options.join_tolerance = 0.0;
  const BsdfTable table = build_bsdf_table(compute, options).table;
  return {check_symmetry(table, compute), check_reciprocity(table).rms_relative};
}

TEST(AssertedSymmetry, IsFoundOutByOneMoreDirection) {
  const Seen grating = table_of(sine_ridges(), SymmetryKind::Isotropic);
  const Seen oblong = table_of(stretched(), SymmetryKind::Isotropic);
  const Seen skewed = table_of(saw(), SymmetryKind::PointAndMirror);
  for (const Seen& wrong : {grating, oblong, skewed}) EXPECT_TRUE(wrong.symmetry.is_doubtful(0.1));
  const Seen waves = table_of(test::random_relief(64, 0.5), SymmetryKind::Isotropic);
  const Seen ridges = table_of(sine_ridges(), SymmetryKind::PointAndMirror);
  for (const Seen& right : {waves, ridges}) EXPECT_FALSE(right.symmetry.is_doubtful(0.1));
  // The light of ridges lies in a line, here on the border of two rows of bins: no more than that.
  EXPECT_LT(ridges.symmetry.difference, 1.1 * ridges.symmetry.by_bins);
  const auto apart = [](const Seen& seen) { return seen.symmetry.difference; };
  test::record(
      {theme, "`bsdf-table --symmetry`", "ridges and a stretched noise called isotropic, a saw called symmetric",
       fmt::format("Light from other azimuths scatters otherwise: the maps (blurred) differ by {:.2f}, {:.2f} and "
                   "{:.2f} of their norm, where ridges whose symmetry is told rightly differ by {:.2f} and isotropic "
                   "waves by {:.2f}. Reciprocity cannot tell: of gratings it is broken by thin lines on bins either "
                   "way (rms {:.1f} and {:.1f}).",
                   apart(grating), apart(oblong), apart(skewed), apart(ridges), apart(waves), grating.reciprocity,
                   ridges.reciprocity),
       "A direction of the light that the symmetry makes unnecessary is computed and compared; above three times the "
       "tolerance (or 0.5), and what the width of bins can do, it warns.",
       "the sample does not have the symmetry \"isotropic\" that was asserted: light from beyond the computed azimuths "
       "gives a lobe that differs by … (relative L2) from the table's; use another --symmetry or --axis"});
}

}  // namespace
}  // namespace mezzotint
