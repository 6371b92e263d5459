#include "forward/optics/material.h"

#include <gtest/gtest.h>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

TEST(Material, IsReadFromItsThreeForms) {
  EXPECT_TRUE(std::holds_alternative<Mirror>(parse_material("mirror")));
  EXPECT_EQ(std::get<Dielectric>(parse_material("dielectric:1.33")).eta, 1.33);
  EXPECT_EQ(std::get<Conductor>(parse_material("conductor:0.2,3.0")).eta, 0.2);
  EXPECT_EQ(std::get<Conductor>(parse_material("conductor:0.2,3.0")).kappa, 3.0);
}

TEST(Material, MakesTheRoundTripThroughText) {
  for (const char* text : {"mirror", "dielectric:1.5", "dielectric:1.3333333333333333", "conductor:0.2,3.25"}) {
    EXPECT_EQ(to_string(parse_material(text)), text);
  }
}

TEST(Material, RefusesWhatItDoesNotUnderstandAndSaysWhatItWould) {
  for (const char* text : {"",
                           "glass",
                           "Mirror",
                           "mirror ",
                           "dielectric",
                           "dielectric:",
                           "dielectric:1",
                           "dielectric:11",
                           "dielectric:nan",
                           "dielectric:inf",
                           "dielectric:1.5x",
                           "dielectric: 1.5",
                           "dielectric:1.5,-1",
                           "dielectric:-1.5",
                           "conductor:1.5",
                           "conductor:0,3",
                           "conductor:1,0",
                           "conductor:21,3",
                           "conductor:1,51",
                           "conductor:1,2,3",
                           "conductor:nan,2",
                           "conductor:,"}) {
    try {
      (void)parse_material(text);
      ADD_FAILURE() << text;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find("conductor:ETA,KAPPA"), std::string::npos);
    }
  }
}

TEST(Material, MayAbsorbInside) {
  const Material clear = parse_material("dielectric:1.5,0.002");
  EXPECT_EQ(std::get<Dielectric>(clear).absorption_per_um, 0.002);
  EXPECT_EQ(to_string(clear), "dielectric:1.5,0.002");
  EXPECT_EQ(to_string(parse_material("dielectric:1.5,0")), "dielectric:1.5");
}

TEST(Material, MayBeGivenForThreeChannels) {
  const std::vector<Material> glass = parse_materials("dielectric:1.51/1.52,0.1/1.53");
  ASSERT_EQ(glass.size(), 3U);
  EXPECT_EQ(to_string(glass[0]), "dielectric:1.51");
  EXPECT_EQ(to_string(glass[1]), "dielectric:1.52,0.1");
  EXPECT_EQ(to_string(glass[2]), "dielectric:1.53");
  EXPECT_EQ(to_string(parse_materials("conductor:0.2,3.9/0.9,2.4/1.1,1.9")[2]), "conductor:1.1,1.9");
  EXPECT_EQ(parse_materials("mirror").size(), 1U);
  for (const char* text :
       {"", "dielectric:1.5/1.6", "dielectric:1.5/1.6/1.7/", "dielectric:1.5/1.6/", "dielectric:1.5//1.6",
        "dielectric:1/2/3/4", "conductor:1,2/mirror/1,2", "mirror/mirror/mirror", "/", ":", "dielectric:"}) {
    EXPECT_THROW((void)parse_materials(text), InvalidInput) << text;
  }
}

}  // namespace
}  // namespace mezzotint
