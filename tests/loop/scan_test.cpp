#include <gtest/gtest.h>

#include "tests/loop/workplace.h"

namespace mezzotint::test {
namespace {

std::filesystem::path rubber_scan() { return external_data_folder() / "surface" / "KautschukInfiniteFocus.x3p"; }

// The small loop with a measured surface in place of the lobe.
std::string scan_experiment() {
  return small_experiment("kind      = \"beckmann\"\nalpha_x   = 0.30\nalpha_y   = 0.15\n",
                          "kind = \"scan\"\nscan = \"scan.x3p\"\n");
}

TEST(Scan, IsATargetOfTheWholeLoop) {
  MEZZOTINT_NEEDS_DATA(rubber_scan());
  const Workplace here;
  here.write("scan.toml", scan_experiment());
  std::filesystem::create_symlink(rubber_scan(), here / "scan.x3p");
  const Ending ending = here.mezzotint({"run", "scan.toml", "--out", "run"});
  EXPECT_EQ(ending.status, 0) << ending.err;
  const auto summary = here.read_json("run/summary.json");
  EXPECT_EQ(summary.at("target").at("kind"), "scan");
  EXPECT_TRUE(here.files("run").contains("target.gwy"));
  EXPECT_TRUE(here.files("run").contains("bsdf_target_0.exr"));
}

TEST(Scan, WithOtherContentIsAnotherExperiment) {
  const Workplace here;
  here.write("scan.toml", scan_experiment());
  ASSERT_EQ(here.mezzotint(words("synthesize pattern.toml -o scan.x3p.gwy")).status, 0);
  std::filesystem::rename(here / "scan.x3p.gwy", here / "scan.x3p");  // the content tells the format
  const Ending first = here.mezzotint({"design", "scan.toml", "--out", "run"});
  ASSERT_TRUE(first.status == 0 || first.status == 3) << first.err;
  ASSERT_EQ(here.mezzotint(words("synthesize pattern.toml -o other.gwy --set pattern.height_um=5")).status, 0);
  std::filesystem::rename(here / "other.gwy", here / "scan.x3p");
  EXPECT_EQ(here.mezzotint({"run", "scan.toml", "--out", "run", "--resume"}).status, 2);
}

}  // namespace
}  // namespace mezzotint::test
