#include <algorithm>

#include <gtest/gtest.h>

#include "tests/loop/workplace.h"

namespace mezzotint::test {
namespace {

struct Refusal {
  const char* arguments;  ///< split at spaces
  const char* says;       ///< part of the message on stderr
};

std::ostream& operator<<(std::ostream& stream, const Refusal& refusal) { return stream << refusal.arguments; }

// Exit status 2, one message on stderr, nothing on stdout, no file made or changed.
void expect_refused(const Workplace& here, const Refusal& refusal) {
  const Files before = here.files();
  const Ending ending = here.mezzotint(words(refusal.arguments));
  EXPECT_EQ(ending.status, 2) << ending.err;
  EXPECT_EQ(ending.out, "");
  EXPECT_NE(ending.err.find(refusal.says), std::string::npos) << ending.err;
  // Complaints about the usage add where to find the help.
  EXPECT_LE(std::ranges::count(ending.err, '\n'), 2) << ending.err;
  EXPECT_EQ(differences(here.files(), before), "");
}

class BadUsage : public testing::TestWithParam<Refusal> {};
TEST_P(BadUsage, IsRefused) { expect_refused(Workplace(), GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    CommandLine, BadUsage,
    testing::Values(
        Refusal{"", "subcommand is required"}, Refusal{"rnu small.toml", R"(no command "rnu"; did you mean "run"?)"},
        Refusal{"roughnes scan.gwy", R"(did you mean "roughness"?)"},
        Refusal{"run small.toml --colour blue", "--colour"}, Refusal{"run", "EXPERIMENT is required"},
        Refusal{"run small.toml --threads 0", "--threads"}, Refusal{"run small.toml --threads many", "--threads"},
        Refusal{"run small.toml --set alpha", "KEY=VALUE"},
        Refusal{"run small.toml --set target.alpha_q=1", R"(did you mean "alpha_x"?)"},
        Refusal{"bsdf relief.gwy -o lobe.exr --incidence 20", "--incidence"},
        Refusal{"bsdf relief.gwy -o lobe.exr --incidence 20,0 --samples nan", "--samples"},
        Refusal{"bsdf relief.gwy -o lobe.exr --incidence 89.9,0", "THETA from 0 to 89"},
        Refusal{"bsdf relief.gwy -o lobe.exr --incidence 20,0 --periodic 9,9", "for meshes"},
        Refusal{"bsdf relief.gwy -o lobe.exr --incidence 20,0 --material dielectric:1.5/1.6", "three for R, G, B"},
        Refusal{"bsdf relief.obj -o lobe.exr --incidence 20,0 --model auto", "a mesh is traced"},
        Refusal{"bsdf relief.obj -o lobe.exr --incidence 20,0", "no such file"},
        Refusal{"bsdf relief.gwy -o lobe.png --incidence 20,0", "written as .exr"},
        Refusal{"correct relief.gwy -o corrected.gwy --outliers nan", "--outliers"},
        Refusal{"correct relief.gwy -o corrected.gwy --crop 1,2,3", "X,Y,W,H"},
        Refusal{"correct relief.gwy -o corrected.gwy --level poly:x", "poly:N"},
        Refusal{"run small.toml --set search.draws=64 --set print.patch_pixels=1024 --set print.subsamples=16", "GiB"},
        Refusal{"synthesize pattern.toml -o relief.stl", ".exr or .obj"},
        Refusal{"repair part.obj -o mended.obj", "written as .stl"},
        Refusal{"repair part.obj -o mended.stl --unit furlong", "--unit"},
        Refusal{"repair small.toml -o mended.stl", ".stl, .obj, .ply and .3mf are read"},
        Refusal{"info small.toml --unit mm", "for meshes"},
        Refusal{"print job.uvj -o printed.gwy --device dlpc900", "--device"}));

INSTANTIATE_TEST_SUITE_P(
    Files, BadUsage,
    testing::Values(Refusal{"run missing.toml", "missing.toml: no such file"}, Refusal{"run .", "not a regular file"},
                    Refusal{"info missing.gwy", "missing.gwy"}, Refusal{"roughness .", "."},
                    Refusal{"info small.toml", "small.toml"}, Refusal{"job small.toml", "small.toml"},
                    Refusal{"synthesize small.toml -o relief.gwy", "small.toml"},
                    Refusal{"run pattern.toml", R"(needs a [target] table)"},
                    Refusal{"print missing.uvj -o printed.gwy", "missing.uvj"},
                    Refusal{"validate missing.gwy --measured missing.gwy -o v", "missing.gwy"},
                    Refusal{"run small.toml --set target.kind=scan", R"("scan" is missing in [target])"},
                    Refusal{"run small.toml --out small.toml", "small.toml"},
                    Refusal{"run small.toml --out .", "no run of ours"}));

struct BadFile {
  const char* part;  ///< of small.toml …
  const char* by;    ///< … and what stands there instead
  const char* says;
};

std::ostream& operator<<(std::ostream& stream, const BadFile& bad) { return stream << bad.by; }

class BadExperiment : public testing::TestWithParam<BadFile> {};
TEST_P(BadExperiment, IsRefused) {
  const Workplace here;
  here.write("bad.toml", small_experiment(GetParam().part, GetParam().by));
  expect_refused(here, {"run bad.toml --out run", GetParam().says});
}

INSTANTIATE_TEST_SUITE_P(
    File, BadExperiment,
    testing::Values(
        BadFile{"resolution ", "resolutoin ", R"(bad.toml:19:1: unknown key "resolutoin")"},
        BadFile{"shift_x_um   = 4.0", "shift_x_mm = 0.004", R"(the unit is part of the key: "shift_x_um")"},
        BadFile{"height_um     = 14.0", "height_um = \"14 um\"", R"("height_um" must be a number in micrometres)"},
        BadFile{"height_um     = 14.0", "height_um = 1e9", "out of range"},
        BadFile{"resolution    = 16", "resolution = 16.5", R"("resolution" must be an integer)"},
        BadFile{"alpha_x   = 0.30", "alpha_x = nan", R"("alpha_x" = nan is out of range)"},
        BadFile{"free = [30.2, 200.0]", "free = [200.0, 30.2]", "scale_um"},
        BadFile{"[[20.0, 0.0]]", "[[91.0, 0.0]]", "[0, 89]"},
        BadFile{"patch_pixels = 48", "patch_pixels = 1024\nmargin_pixels = 300", "the printer has 2560 × 1600"},
        BadFile{"[measurement]", "[measurement]\npitch_um = 50.0", "samples a side"},
        BadFile{"shift_x_um   = 4.0", "shift_x_um = 300.0", "out of sight"},
        BadFile{"[print]", "[printer]\nprofile = \"none.toml\"\n[print]", "none.toml: no such file"},
        BadFile{"[print]", "[print", "not valid TOML"}));

}  // namespace
}  // namespace mezzotint::test
