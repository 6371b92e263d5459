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

}  // namespace
}  // namespace mezzotint
