#include "tests/stability/scene.h"

namespace mezzotint {
namespace {

using test::light_at;
using test::percent;

constexpr const char* theme = "Materials";

double relative_to_closed_form(const Material& material, double theta_deg) {
  const HeightField flat({8, 8, Length::from_um(1.0), Length::from_um(1.0)}, Continuation::Periodic);
  const Bsdf bsdf = trace_bsdf(flat, light_at(theta_deg, material, 10));
  const double exact = reflectance(material, std::cos(theta_deg * std::numbers::pi / 180.0));
  return std::abs(bsdf.energy.reflected.value / exact - 1.0);
}

TEST(Materials, KeepTheirReflectanceWhereTheIndexComesToOne) {
  const double off = relative_to_closed_form(Dielectric{1.0001}, 30.0),
               usual = relative_to_closed_form(Dielectric{1.5}, 30.0);
  // η is kept in single precision: 6e-8 of 1 is 6e-4 of η − 1, and R goes with its square.
  EXPECT_LT(off, 5e-3);
  EXPECT_LT(usual, 1e-5);
  const std::string told = test::refusal([] { (void)parse_material("dielectric:1.0"); });
  EXPECT_FALSE(told.empty());
  test::record(
      {theme, "Fresnel in single precision", "η → 1 (1.0001), a flat surface at 30°",
       fmt::format(
           "The reflectance of {:.1e} is off by {} ({} at η = 1.5): in single precision η − 1 keeps three digits.",
           reflectance(Dielectric{1.0001}, std::cos(std::numbers::pi / 6)), percent(off), test::below(usual)),
       "η below 1.0001 is refused.", told});
}

TEST(Materials, ConserveLightAtTheLargestIndices) {
  const HeightField relief = test::random_relief(128, 0.8);
  const Bsdf germanium = trace_bsdf(relief, light_at(30.0, Dielectric{10.0}));
  EXPECT_NEAR(test::accounted_for(germanium), 1.0, 1e-8);
  double off = 0.0;
  for (const double theta : {0.0, 60.0, 89.0}) off = std::max(off, relative_to_closed_form(Dielectric{10.0}, theta));
  EXPECT_LT(off, 1e-4);
  const std::string told = test::refusal([] { (void)parse_material("dielectric:11"); });
  EXPECT_FALSE(told.empty());
  test::record({theme, "`paths`", "η = 10, s = 0.8 at 30°",
                fmt::format("Albedo {:.3f}, all light accounted for; a flat surface at 0, 60 and 89° is off by {} from "
                            "Fresnel. It holds.",
                            germanium.energy.reflected.value, test::below(off)),
                "η above 10 is refused.", told});
}

TEST(Materials, HoldTheExtremesOfAConductor) {
  double off = 0.0;
  for (const Material& material :
       {Material(Conductor{0.2, 1e-6}), Material(Conductor{0.05, 50.0}), Material(Conductor{20.0, 50.0})}) {
    for (const double theta : {0.0, 89.0}) off = std::max(off, relative_to_closed_form(material, theta));
    const Bsdf rough = trace_bsdf(test::random_relief(64, 0.8), light_at(30.0, material, 12));
    EXPECT_NEAR(test::accounted_for(rough), 1.0, 1e-8);
  }
  EXPECT_LT(off, 1e-4);
  const std::string told = test::refusal([] { (void)parse_material("conductor:0.2,51"); });
  EXPECT_FALSE(told.empty());
  test::record({theme, "`paths`", "κ from 1e-6 to 50, η from 0.05 to 20",
                fmt::format("Flat surfaces at 0 and 89° are off by {} from the closed form, and rough ones account for "
                            "all light. It holds.",
                            test::below(off)),
                "κ above 50 is refused.", told});
}

TEST(Materials, TrapLightByTotalReflection) {
  const Bsdf bsdf = trace_bsdf(test::random_relief(128, 2.0), light_at(60.0, Dielectric{3.0}, 16));
  EXPECT_NEAR(test::accounted_for(bsdf), 1.0, 1e-8);
  EXPECT_EQ(dielectric_fresnel(std::cos(0.35), 1.0 / 3.0).reflectance, 1.0);  // beyond 19.5°
  const double interactions = test::share(bsdf, "interactions_per_path");
  EXPECT_GT(interactions, 2.0);
  EXPECT_LT(bsdf.energy.cut_off.value, 1e-3);
  test::record({theme, "`paths`", "total reflection inside: η = 3 (critical angle 19.5°), s = 2 at 60°",
                fmt::format("{:.1f} interactions a path; of the light, {} is still inside after 64. It holds.",
                            interactions, test::below(bsdf.energy.cut_off.value)),
                "`cut_off` in the audit.", "—"});
}

TEST(Materials, AbsorbAllLightThatGoesIn) {
  const HeightField relief = test::random_relief(128, 0.8);
  const Bsdf black = trace_bsdf(relief, light_at(30.0, Dielectric{1.5, 1000.0}));
  const Bsdf clear = trace_bsdf(relief, light_at(30.0, Dielectric{1.5, 0.0}));
  EXPECT_NEAR(test::accounted_for(black), 1.0, 1e-8);
  EXPECT_LT(black.energy.transmitted.value, 1e-6);  // what enters within nanometres of the lowest point is through
  EXPECT_NEAR(black.energy.reflected.value, clear.energy.reflected.value,
              5.0 * std::hypot(black.energy.reflected.standard_error, clear.energy.reflected.standard_error));
  const std::string told = test::refusal([] { (void)parse_material("dielectric:1.5,1001"); });
  EXPECT_FALSE(told.empty());
  test::record({theme, "Beer–Lambert", "an absorption of 1000 per µm, s = 0.8 at 30°",
                fmt::format("Nothing is transmitted, {:.4f} absorbed, the albedo ({:.4f}) that of a clear medium "
                            "within its error. It holds; the control variate is off, so it takes longer.",
                            black.energy.absorbed.value, black.energy.reflected.value),
                "Above 1000 it is refused.", told});
}

// Light that is reflected twice in one plane: its two polarisations keep their own reflectances.
TEST(Materials, AreUnpolarisedAtEveryInteraction) {
  const double cosine = std::sqrt(0.5), refracted = std::sqrt(1.0 - 0.5 / 2.25);
  const double s = std::pow((cosine - 1.5 * refracted) / (cosine + 1.5 * refracted), 2.0);
  const double p = std::pow((1.5 * cosine - refracted) / (1.5 * cosine + refracted), 2.0);
  const double unpolarised = reflectance(Dielectric{1.5}, cosine);
  ASSERT_NEAR(unpolarised, 0.5 * (s + p), 1e-12);
  const double truth = 0.5 * (s * s + p * p), ours = unpolarised * unpolarised;
  EXPECT_GT(truth / ours, 1.5);
  PathTracingOptions options = light_at(60.0, Dielectric{1.5}, 16);
  options.bounce_orders = 2;
  const Bsdf bsdf = trace_bsdf(test::random_relief(128, 0.8), options);
  const auto areas = projected_solid_angles(bsdf.grid);
  double again = 0.0;
  for (std::size_t k = 0; k < areas.size(); ++k) again += areas[k] * bsdf.reflection_orders[1].mean[k];
  const double bound = again / bsdf.energy.reflected.value;
  EXPECT_GT(bound, 0.0);
  EXPECT_LT(bound, 0.2);
  test::record(
      {theme, "Fresnel for natural light at every interaction", "two reflections at 45° in one plane, index 1.5",
       fmt::format("{:.5f} of the light comes back, where polarisation makes it {:.5f}: {:.0f} % too little. On a "
                   "relief of s = 0.8 at 60°, {} of the reflected light has met the surface more than once.",
                   ours, truth, 100.0 * (1.0 - ours / truth), percent(bound)),
       "Not noticed. `--bounce-orders 2` shows the light that it can concern.",
       "docs/physics.md, \"What is not modelled\""});
}

}  // namespace
}  // namespace mezzotint
