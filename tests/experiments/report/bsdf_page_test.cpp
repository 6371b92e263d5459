#include "experiments/report/bsdf_page.h"

#include <gtest/gtest.h>

#include "experiments/report/bsdf_components.h"
#include "forward/base/error.h"

namespace mezzotint {
namespace {

Bsdf traced() {
  Bsdf bsdf{.incidence = {Angle::from_degrees(30.0), Angle::from_degrees(0.0)}, .grid = {4, 4}};
  const DirectionMap ones(16, 1.0), none(16, 0.0);
  bsdf.reflection = {ones, DirectionMap(16, 0.02), ones, ones};
  bsdf.transmission = {none, none, none, none};
  bsdf.energy.reflected = {0.9, 0.001};
  bsdf.energy.absorbed = {0.1, 0.001};
  bsdf.provenance = {{"model", "paths"},          {"material", "mirror"}, {"samples", "4096"},
                     {"choice", "why, in words"}, {"warnings", "beware"}, {"convergence", "1024:0.04 4096:2e-2"}};
  return bsdf;
}

const nlohmann::json* component_of(const nlohmann::json& page, const std::string& title) {
  for (const auto& section : page.at("sections"))
    for (const auto& component : section.at("components"))
      if (component.value("title", "") == title) return &component;
  return nullptr;
}

TEST(Convergence, IsReadFromTheProvenance) {
  const Series curve = convergence_of("map", traced());
  EXPECT_EQ(curve.x, (std::vector<double>{1024.0, 4096.0}));
  EXPECT_EQ(curve.y, (std::vector<double>{0.04, 0.02}));
}

TEST(Convergence, IsEmptyWithoutPathsAndRefusedWhereItIsDamaged) {
  Bsdf bsdf = traced();
  for (const char* damaged : {"1024", "1024:", "x:0.1", "1024;0.1"}) {
    bsdf.provenance["convergence"] = damaged;
    EXPECT_THROW((void)convergence_of("map", bsdf), InvalidInput) << damaged;
  }
  bsdf.provenance.erase("convergence");
  EXPECT_TRUE(convergence_of("map", bsdf).x.empty());
  EXPECT_FALSE(convergence_chart({.title = "t"}, {convergence_of("map", bsdf)}, 0.1).has_value());
}

TEST(BsdfPage, ShowsMapEnergyCurveChoiceAndWarnings) {
  const nlohmann::json page = to_report_json(bsdf_page(traced(), {"relief.gwy", 0.03, 0.02}));
  ASSERT_NE(component_of(page, "Reflection"), nullptr);
  EXPECT_EQ(component_of(page, "Reflection")->at("scale"), "log");
  EXPECT_EQ(component_of(page, "Transmission"), nullptr);  // nothing is transmitted
  const nlohmann::json* energy = component_of(page, "Energy audit");
  ASSERT_NE(energy, nullptr);
  EXPECT_DOUBLE_EQ(energy->at("rows").back().at("cells").at(1).at("value").get<double>(), 1.0);
  const nlohmann::json* curve = component_of(page, "Standard error while it was traced");
  ASSERT_NE(curve, nullptr);
  EXPECT_NE(curve->dump().find("tolerance"), std::string::npos);
  const std::string text = page.dump();
  EXPECT_NE(text.find("why, in words"), std::string::npos);
  EXPECT_NE(text.find("beware"), std::string::npos);
}

TEST(BsdfPage, JudgesTheTolerance) {
  EXPECT_EQ(bsdf_page(traced(), {"r", 0.03, 0.02}).verdict.outcome, Outcome::Met);
  EXPECT_EQ(bsdf_page(traced(), {"r", 0.01, 0.02}).verdict.outcome, Outcome::Missed);
  EXPECT_EQ(bsdf_page(traced(), {"r", 0.0, 0.02}).verdict.outcome, Outcome::Information);
  Bsdf splat = traced();
  splat.provenance.erase("convergence");
  splat.provenance["model"] = "slopes";
  EXPECT_EQ(bsdf_page(splat, {"r", 0.01, 0.0}).verdict.outcome, Outcome::Information);
}

}  // namespace
}  // namespace mezzotint
