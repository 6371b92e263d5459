#include "experiments/configuration/target_table.h"

#include <fstream>

#include <gtest/gtest.h>

#include "experiments/configuration/experiment_file.h"
#include "tests/experiments/target_pictures.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

class TargetTable : public testing::Test {
protected:
  TargetSpecification read(const std::string& text) {
    std::ofstream(folder_ / "target.toml") << text;
    const TomlFile file(folder_ / "target.toml");
    return read_target(TomlTable(file));
  }
  std::string complaint(const std::string& text) {
    try {
      (void)read(text);
    } catch (const ConfigurationError& error) {
      return error.what();
    }
    return "no complaint";
  }
  void expect_complaint(const std::string& text, const std::string& part) {
    const std::string message = complaint(text);
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find("target.toml:"), std::string::npos) << message;
  }
  test::TemporaryFolder folder_;
};

TEST_F(TargetTable, ReadsLobes) {
  const auto ggx = read("kind = \"ggx\"\nalpha_x = 0.3\nalpha_y = 0.1\nrotation_deg = 20\ntolerance = 0.1\n");
  EXPECT_EQ(std::get<GgxLobe>(ggx.wanted).alpha_x, 0.3);
  EXPECT_EQ(std::get<GgxLobe>(ggx.wanted).rotation, 20.0_deg);
  EXPECT_EQ(ggx.tolerance, 0.1);
  EXPECT_TRUE(is_lobe_alone(ggx));
  EXPECT_FALSE(is_lobe_alone(read("kind = \"beckmann\"\nalpha_x = 0.3\nalpha_y = 0.1\n")));
}

TEST_F(TargetTable, RefusesContradictions) {
  expect_complaint("kind = \"ggx\"\nalpha_x = 0.1\nalpha_y = 0.3\n", "swap them");
  expect_complaint("kind = \"ggx\"\nalpha_x = 0.3\nalpha_y = 0.1\nratio = 3\n", "\"ratio\" is for the kind");
  expect_complaint("kind = \"beckmann\"\nalpha_x = 0.3\nalpha_y = 0.1\nmean_alpha = 0.2\n", "\"mean_alpha\" is for");
  expect_complaint("kind = \"anisotropy\"\nratio = 3\nmean_alpha = 0.2\nalpha_x = 0.3\n",
                   "\"alpha_x\" is for the kinds");
  expect_complaint("kind = \"ggx\"\nalpha_x = nan\nalpha_y = 0.1\n", "out of range");
  expect_complaint("kind = \"ggx\"\nalpha_x = 0.3\nalpha_y = 0.1\nalfa = 1\n", "unknown key \"alfa\"");
  expect_complaint("kind = \"bsdf\"\nfiles = [\"a.exr\", \"a.exr\"]\n", "twice");
  expect_complaint("kind = \"bsdf\"\nfiles = []\n", "list of files");
  expect_complaint("kind = \"bsdf\"\nfiles = [1]\n", "texts in quotes");
  expect_complaint("kind = \"bsdf\"\n", "\"files\" is missing");
  expect_complaint("kind = \"measured\"\nfile = \"x\"\nchannel = \"R\"\nwavelength_nm = 500\n", "not by both");
  expect_complaint("kind = \"image\"\n", "one of the two");
  expect_complaint("kind = \"image\"\nimage = \"a.png\"\nshape = \"ring\"\n", "one of the two");
}

TEST_F(TargetTable, ReadsFilesRelativeToTheTable) {
  const auto maps = read("kind = \"bsdf\"\nfiles = [\"a.exr\", \"/b/c.exr\"]\n");
  EXPECT_EQ(files_of(maps), (std::vector<std::filesystem::path>{folder_ / "a.exr", "/b/c.exr"}));
  const auto measured = read("kind = \"measured\"\nfile = \"m.bsdf\"\nwavelength_nm = 500\nmost_missing = 0.3\n");
  const auto& wanted = std::get<WantedMeasurement>(measured.wanted);
  EXPECT_EQ(wanted.file, folder_ / "m.bsdf");
  EXPECT_NEAR(wanted.channel.wavelength->um(), 0.5, 1e-12);
  EXPECT_EQ(wanted.most_missing, 0.3);
}

TEST_F(TargetTable, ReadsShapesAndKeepsThemAboveTheHorizon) {
  const auto ring = read("kind = \"image\"\nshape = \"ring\"\nradius = 0.3\nincidence_deg = [[10, 0], [20, 90]]\n");
  const auto& painting = std::get<WantedPainting>(ring.wanted);
  EXPECT_EQ(std::get<RingShape>(painting.lobe).radius, 0.3);
  EXPECT_EQ(painting.incidences.size(), 2U);
  expect_complaint("kind = \"image\"\nshape = \"ring\"\nradius = 0.97\n", "below the horizon");
  expect_complaint("kind = \"image\"\nshape = \"square\"\nhalf_width = 0.3\nincidence_deg = [[50, 0]]\n",
                   "for light at (50°, 0°) the shape reaches 1.19");
  expect_complaint("kind = \"image\"\nshape = \"tilt\"\n", "lies off the mirrored direction");
  expect_complaint("kind = \"image\"\nshape = \"ring\"\nradius = 0.1\nwidth = 0.3\n", "twice as wide");
  expect_complaint("kind = \"image\"\nshape = \"square\"\n", "\"half_width\" is missing");
  expect_complaint("kind = \"image\"\nshape = \"square\"\nhalf_width = 0.1\nradius = 0.2\n", "unknown key \"radius\"");
  expect_complaint("kind = \"image\"\nshape = \"star\"\n", "\"star\" is not known");
}

TEST_F(TargetTable, DecodesPaintedLobes) {
  // 16 pixels a side; one bright pixel right of the middle, in the upper half as one looks at it.
  std::vector<std::uint8_t> gray(16 * 16, 0);
  gray[4 * 16 + 10] = 188;
  test::write_png(folder_ / "dot.png", 16, 1, gray);
  const auto image = read("kind = \"image\"\nimage = \"dot.png\"\n");
  const LobePicture& picture = std::get<LobePicture>(std::get<WantedPainting>(image.wanted).lobe);
  const double x = 2.0 * 10.5 / 16.0 - 1.0, y = 1.0 - 2.0 * 4.5 / 16.0;
  // sRGB 188/255 is linear 0.503 (IEC 61966-2-1).
  EXPECT_NEAR(light_at(picture, x, y), 0.5029, 1e-3);
  EXPECT_EQ(light_at(picture, x, -y), 0.0);
  const auto linear = read("kind = \"image\"\nimage = \"dot.png\"\nencoding = \"linear\"\n");
  EXPECT_NEAR(light_at(std::get<LobePicture>(std::get<WantedPainting>(linear.wanted).lobe), x, y), 188.0 / 255.0, 1e-6);
  std::vector<std::uint8_t> green(16 * 16 * 3, 0);
  green[(4 * 16 + 10) * 3 + 1] = 255;
  test::write_png(folder_ / "green.png", 16, 3, green);
  const auto colour = read("kind = \"image\"\nimage = \"green.png\"\n");
  EXPECT_NEAR(light_at(std::get<LobePicture>(std::get<WantedPainting>(colour.wanted).lobe), x, y), 0.7152, 1e-5);
  EXPECT_EQ(files_of(colour), std::vector<std::filesystem::path>{folder_ / "green.png"});
}

TEST_F(TargetTable, RefusesPicturesThatAreNoLobes) {
  const auto with = [&](int side, int channels, std::vector<std::uint8_t> pixels) {
    test::write_png(folder_ / "p.png", side, channels, pixels);
    return std::string("kind = \"image\"\nimage = \"p.png\"\n");
  };
  expect_complaint(with(16, 1, std::vector<std::uint8_t>(256, 255)), "outside of the disc, which is below the horizon");
  expect_complaint(with(16, 1, std::vector<std::uint8_t>(256, 0)), "dark everywhere");
  expect_complaint(with(16, 4, std::vector<std::uint8_t>(1024, 255)), "without transparency");
  expect_complaint(with(4, 1, std::vector<std::uint8_t>(16, 9)), "4 x 4 pixels");
  expect_complaint("kind = \"image\"\nimage = \"none.png\"\n", "no such file");
  std::ofstream(folder_ / "cut.png") << "no picture";
  expect_complaint("kind = \"image\"\nimage = \"cut.png\"\n", "is no PNG picture");
}

TEST_F(TargetTable, GivesEveryGrayValueOneTarget) {
  std::vector<std::uint8_t> labels(64, 0);
  labels[10] = 255;
  test::write_png(folder_ / "labels.png", 8, 1, labels);
  const std::string head = "kind = \"regions\"\nlabels = \"labels.png\"\npixel_um = 50\n";
  const std::string smooth = "[[region]]\nlabel = 0\nkind = \"beckmann\"\nalpha_x = 0.1\nalpha_y = 0.1\n";
  const std::string rough = "[[region]]\nlabel = 255\nkind = \"ggx\"\nalpha_x = 0.3\nalpha_y = 0.1\n";
  const auto target = read(head + smooth + rough);
  const auto& wanted = std::get<WantedRegions>(target.wanted);
  ASSERT_EQ(wanted.regions.size(), 2U);
  EXPECT_EQ(wanted.picture.columns, 8U);
  EXPECT_EQ(wanted.picture.pixel, 50.0_um);
  EXPECT_EQ(wanted.regions[1].label, 255);
  EXPECT_EQ(std::get<GgxLobe>(wanted.regions[1].target.wanted).alpha_x, 0.3);
  EXPECT_TRUE(is_lobe_alone(target));
  EXPECT_FALSE(is_lobe_alone(wanted.regions[0].target));
  expect_complaint(head + smooth, "1 pixels of the picture have the gray value 255, and no region has that label");
  expect_complaint(head + smooth + rough + "[[region]]\nlabel = 7\nkind = \"beckmann\"\nalpha_x = 0.1\nalpha_y = 0.1\n",
                   "label 7, which no pixel of the picture has; its gray values are 0, 255");
  expect_complaint(head + smooth + rough + rough, "two regions have the label 255");
  expect_complaint(head + smooth + "[[region]]\nlabel = 255\nkind = \"regions\"\n", "\"regions\" is not known");
  expect_complaint(head + smooth + "[[region]]\nlabel = 255\nkind = \"ggx\"\nalpha_x = 0.3\nalpha_y = 0.1\nlabls = 1\n",
                   "unknown key \"labls\" in [region]");
}

TEST_F(TargetTable, LobesAreSearchedForAsLobes) {
  const auto experiment = [&](const std::string& text) {
    std::ofstream(folder_ / "run.toml") << text;
    return read_experiment(folder_ / "run.toml");
  };
  const std::string ggx = "[target]\nkind = \"ggx\"\nalpha_x = 0.3\nalpha_y = 0.1\n";
  EXPECT_TRUE(is_lobe_alone(experiment(ggx).target));
  EXPECT_TRUE(experiment(ggx).search.objective.empty()) << "the search chooses";
  EXPECT_FALSE(experiment(ggx).simulation.incidences_given);
  EXPECT_TRUE(experiment(ggx + "[simulation]\nincidence_deg = [[10, 0]]\n").simulation.incidences_given);
  EXPECT_THROW((void)experiment(ggx + "[search]\nobjective = \"cube_rot\"\n"), ConfigurationError);
  EXPECT_TRUE(experiment(ggx + "[search]\nobjective = { cube_root = 1.0, moments = 0.5 }\n").search.by_light());
  EXPECT_THROW((void)experiment(ggx + "[search]\nobjective = { moments = 0.0 }\n"), ConfigurationError);
}

}  // namespace
}  // namespace mezzotint
