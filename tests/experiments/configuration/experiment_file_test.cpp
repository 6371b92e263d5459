#include "experiments/configuration/experiment_file.h"

#include <fstream>

#include <gtest/gtest.h>

#include "experiments/configuration/printer_file.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

const std::filesystem::path experiments = std::filesystem::path(MEZZOTINT_SOURCE_DIR) / "experiments";

class ExperimentFile : public testing::Test {
protected:
  std::string complaint(const std::string& text) {
    std::ofstream(folder_ / "run.toml") << text;
    try {
      (void)read_experiment(folder_ / "run.toml");
    } catch (const ConfigurationError& error) {
      const std::string message = error.what();
      return message.substr(message.find("run.toml"));
    }
    return "no complaint";
  }
  test::TemporaryFolder folder_;
};

TEST_F(ExperimentFile, EveryOneThatWeShipIsValid) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(experiments)) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_NO_THROW((void)read_experiment(entry.path())) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 3);
  for (const auto& entry : std::filesystem::directory_iterator(experiments / "patterns")) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_NO_THROW((void)read_pattern_file(entry.path())) << entry.path();
  }
}

TEST_F(ExperimentFile, TheSlidesPrinterIsTheDefaultOne) {
  const PrinterProfile read = read_printer(experiments / "printers" / "dlp9000.toml");
  const PrinterProfile built_in;
  EXPECT_EQ(read.pixels_x, built_in.pixels_x);
  EXPECT_EQ(read.pixel_pitch, built_in.pixel_pitch);
  EXPECT_EQ(read.cure.alpha, built_in.cure.alpha);
  EXPECT_EQ(read.spread.width, built_in.spread.width);
  ASSERT_EQ(read.ground.size(), built_in.ground.size());
  for (std::size_t i = 0; i < read.ground.size(); ++i) EXPECT_EQ(read.ground[i].weight, built_in.ground[i].weight);
}

TEST_F(ExperimentFile, NamesTheWidthOfABlurByItsKernel) {
  const auto printer_of = [this](const std::string& blur) {
    std::ofstream(folder_ / "printer.toml") << "[blur]\n" << blur;
    return read_printer(folder_ / "printer.toml");
  };
  const PixelSpread wide = printer_of("kernel = \"lorentzian\"\nhalf_width_um = 2.5\n").spread;
  EXPECT_EQ(wide.kernel, PixelSpread::Kernel::Lorentzian);
  EXPECT_EQ(wide.width, 2.5_um);
  EXPECT_THROW((void)printer_of("kernel = \"lorentzian\"\nsigma_um = 2.5\n"), ConfigurationError);
  EXPECT_THROW((void)printer_of("kernel = \"lorentzian\"\n"), ConfigurationError);
  EXPECT_THROW((void)printer_of("half_width_um = 2.5\n"), ConfigurationError);
}

TEST_F(ExperimentFile, LeavesThePatternToUsWithAReason) {
  std::ofstream(folder_ / "run.toml") << "[target]\nkind = \"anisotropy\"\nratio = 2.0\nmean_alpha = 0.1\n";
  const Experiment experiment = read_experiment(folder_ / "run.toml");
  EXPECT_EQ(kind_name(experiment.pattern.pattern), "noise");
  EXPECT_FALSE(experiment.pattern.reason.empty());
  EXPECT_FALSE(experiment.pattern.free.empty());
}

TEST_F(ExperimentFile, PointsToWhatContradictsItself) {
  EXPECT_EQ(complaint("[target]\nkind = \"beckmann\"\nalpha_x = 0.1\nalpha_y = 0.3\n").substr(0, 13), "run.toml:4:11");
  EXPECT_NE(complaint("[target]\nkind = \"ward\"\n").find("\"ward\" is not known"), std::string::npos);
  const std::string fine = "[target]\nkind = \"beckmann\"\nalpha_x = 0.2\nalpha_y = 0.1\n";
  EXPECT_EQ(complaint(fine), "no complaint");
  EXPECT_NE(complaint(fine + "ratio = 2.0\n").find("\"ratio\" is for the kind \"anisotropy\""), std::string::npos);
  EXPECT_NE(complaint(fine + "[search]\nalgorithm = \"LN_BOBYQ\"\n").find("did you mean \"LN_BOBYQA\"?"),
            std::string::npos);
  EXPECT_NE(complaint(fine + "[simulation]\nincidence_deg = [[95.0, 0.0]]\n").find("[0, 89]"), std::string::npos);
  EXPECT_NE(complaint(fine + "[simulation]\nmaterial = \"glass\"\n").find("run.toml:6:12"), std::string::npos);
  EXPECT_NE(complaint(fine + "[pattern]\nkind = \"noise\"\nheight_um = 3.0\n").find("no parameter"), std::string::npos);
  EXPECT_NE(complaint(fine + "[print]\npatch_pixels = 1024\nmargin_pixels = 900\n").find("the printer has"),
            std::string::npos);
}

TEST_F(ExperimentFile, APatternSurvivesItsFile) {
  const PatternFile file{Noise{.scale = 61.7_um, .stretch = 2.5, .direction = 31.0_deg, .height = 11.1_um, .seed = 9},
                         {64, 32, 2.5_um, 2.5_um}};
  std::ofstream(folder_ / "pattern.toml") << pattern_file_text(file, "a test");
  const PatternFile read = read_pattern_file(folder_ / "pattern.toml");
  EXPECT_EQ(read.grid, file.grid);
  const auto& noise = std::get<Noise>(read.pattern);
  EXPECT_EQ(noise.scale, (61.7_um));
  EXPECT_NEAR(noise.direction.degrees(), 31.0, 1e-13);
  EXPECT_EQ(noise.seed, 9U);
}

}  // namespace
}  // namespace mezzotint
