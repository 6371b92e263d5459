#include <gtest/gtest.h>

#include "tests/loop/workplace.h"

namespace mezzotint::test {
namespace {

// The workplace's part is a tetrahedron of a sixth of a cubic millimetre, without its base.
TEST(RepairCommand, ClosesAPartAndSaysWhatItDid) {
  const Workplace here;
  const Ending ending = here.mezzotint(words("repair part.obj -o part.stl --json"));
  ASSERT_EQ(ending.status, 0) << ending.err;
  const nlohmann::json json = nlohmann::json::parse(ending.out);
  EXPECT_EQ(json.at("holes_filled"), 1);
  EXPECT_EQ(json.at("triangles_added"), 1);
  EXPECT_EQ(json.at("self_intersections"), 0);
  EXPECT_EQ(json.at("before").at("boundary_edges"), 3);
  EXPECT_EQ(json.at("after").at("watertight"), true);
  EXPECT_NEAR(json.at("after").at("volume").at("value").get<double>(), 1.0 / 6.0, 1e-12);
  EXPECT_FALSE(json.at("warnings").empty());  // the unit was assumed
}

TEST(RepairCommand, TellsTheSameInWords) {
  const Workplace here;
  const Ending ending = here.mezzotint(words("repair part.obj -o part.stl --unit cm"));
  EXPECT_EQ(ending.status, 0);
  EXPECT_NE(ending.out.find("1 hole filled"), std::string::npos) << ending.out;
  EXPECT_NE(ending.out.find("166.666667 mm³"), std::string::npos) << ending.out;
  const Ending again = here.mezzotint(words("repair part.stl -o again.stl"));
  EXPECT_NE(again.out.find("nothing to mend"), std::string::npos) << again.out;
}

TEST(InfoCommand, TellsWhatAPartIs) {
  const Workplace here;
  ASSERT_EQ(here.mezzotint(words("repair part.obj -o part.stl")).status, 0);
  const nlohmann::json json = nlohmann::json::parse(here.mezzotint(words("info part.stl --unit in --json")).out);
  EXPECT_EQ(json.at("part").at("bodies"), 1);
  EXPECT_NEAR(json.at("part").at("height").at("value").get<double>(), 25.4, 1e-9);
  EXPECT_EQ(json.at("part").at("watertight"), true);
}

TEST(RepairCommand, RefusesASheetWithTheReasonAndWritesNothing) {
  const Workplace here;
  ASSERT_EQ(here.mezzotint(words("synthesize pattern.toml -o relief.gwy")).status, 0);
  ASSERT_EQ(here.mezzotint(words("mesh relief.gwy -o sheet.obj")).status, 0);
  const Files before = here.files();
  const Ending ending = here.mezzotint(words("repair sheet.obj -o part.stl -q"));
  EXPECT_EQ(ending.status, 1);
  EXPECT_NE(ending.err.find("sheets"), std::string::npos) << ending.err;
  EXPECT_EQ(differences(here.files(), before), "");
}

}  // namespace
}  // namespace mezzotint::test
