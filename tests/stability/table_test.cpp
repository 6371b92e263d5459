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
  double asymmetry = 0.0;
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
  return {check_symmetry(table, compute).difference, check_reciprocity(table).rms_relative};
}

TEST(AssertedSymmetry, IsFoundOutByOneMoreDirection) {
  const Seen grating = table_of(sine_ridges(), SymmetryKind::Isotropic);
  const Seen oblong = table_of(stretched(), SymmetryKind::Isotropic);
  const Seen skewed = table_of(saw(), SymmetryKind::PointAndMirror);
  for (const Seen& wrong : {grating, oblong, skewed}) {
    EXPECT_GT(wrong.asymmetry, 0.6);
    EXPECT_GT(wrong.reciprocity, 0.6);
  }
  // A tile of 96 random waves is not quite isotropic, and a turned lobe falls between bins.
  const Seen waves = table_of(test::random_relief(64, 0.5), SymmetryKind::Isotropic);
  EXPECT_LT(waves.asymmetry, 0.3);
  // A half turn or a mirror: noise, and light on the border of two bins.
  const Seen ridges = table_of(sine_ridges(), SymmetryKind::PointAndMirror);
  EXPECT_LT(ridges.asymmetry, 0.05);
  test::record(
      {theme, "`bsdf-table --symmetry`", "ridges and a stretched noise called isotropic, a saw called symmetric",
       fmt::format("Light from other azimuths scatters otherwise: the maps differ by {:.2f}, {:.2f} and {:.2f} "
                   "(relative L2); on ridges whose symmetry is told rightly by {:.2f}, on isotropic waves by "
                   "{:.2f}. Reciprocity is broken too (rms {:.2f}, {:.2f}, {:.2f} against {:.2f}, {:.2f}).",
                   grating.asymmetry, oblong.asymmetry, skewed.asymmetry, ridges.asymmetry, waves.asymmetry,
                   grating.reciprocity, oblong.reciprocity, skewed.reciprocity, ridges.reciprocity, waves.reciprocity),
       "A direction of the light that the symmetry makes unnecessary is computed and compared; above three times "
       "the tolerance it warns.",
       "the sample does not have the symmetry \"isotropic\" that was asserted: light from beyond the computed "
       "azimuths gives a lobe that differs by … (relative L2) from the table's; use another --symmetry or --axis"});
}

}  // namespace
}  // namespace mezzotint
