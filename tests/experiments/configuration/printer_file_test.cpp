#include "experiments/configuration/printer_file.h"

#include <fstream>

#include <gtest/gtest.h>

#include "experiments/configuration/toml_table.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

class PrinterFile : public testing::Test {
protected:
  std::filesystem::path written(const std::string& text) const {
    std::ofstream(folder_ / "printer.toml") << text;
    return folder_ / "printer.toml";
  }

private:
  test::TemporaryFolder folder_;
};

CureRecord record() {
  return {"steps \"a\".csv", std::string(64, 'a'), 18, {17.5, 17.9}, {10.1, {}}, {{}, -0.001}, false, 12.25, 9};
}

TEST_F(PrinterFile, ComesBackToTheLastBit) {
  PrinterProfile profile;
  profile.name = "of \"ours\"";
  profile.layer = Length::from_um(1.0 / 3.0 * 60.0);
  profile.exposure_s = 2.0;
  profile.cure = {Length::from_um(17.123456789012345), Length::from_um(10.0), -0.0123456789012345678};
  profile.spread = {PixelSpread::Kernel::Lorentzian, Length::from_um(2.7), true};
  profile.ground = {{0.1, Length::from_um(33.3)}};
  const auto path = written(printer_file_text(profile, record(), "one\ntwo"));
  const PrinterProfile back = read_printer(path);
  EXPECT_EQ(back.name, profile.name);
  EXPECT_EQ(back.layer, profile.layer);
  EXPECT_EQ(back.exposure_s, 2.0);
  EXPECT_EQ(back.cure.alpha, profile.cure.alpha);
  EXPECT_EQ(back.cure.beta, profile.cure.beta);
  EXPECT_EQ(back.cure.gamma, profile.cure.gamma);
  EXPECT_EQ(back.spread.kernel, PixelSpread::Kernel::Lorentzian);
  EXPECT_EQ(back.spread.width, profile.spread.width);
  EXPECT_TRUE(back.spread.calibrated);
  ASSERT_EQ(back.ground.size(), 1U);
  EXPECT_EQ(back.ground[0].scale, profile.ground[0].scale);
}

TEST_F(PrinterFile, KeepsWhatIsKnownOfTheCalibration) {
  const auto back = read_cure_record(written(printer_file_text({}, record(), "")));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->source, record().source);
  EXPECT_EQ(back->alpha_um.high, 17.9);
  EXPECT_FALSE(back->beta_um.high.has_value());
  EXPECT_FALSE(back->gamma.low.has_value());
  EXPECT_EQ(back->gamma.high, -0.001);
  EXPECT_FALSE(back->gamma_determined);
  EXPECT_EQ(back->degrees_of_freedom, 9);
  EXPECT_FALSE(read_cure_record(written(printer_file_text({}, {}, ""))).has_value());
}

TEST_F(PrinterFile, RefusesAnUnknownKeyOrAWrongHashInTheCalibration) {
  std::string text = printer_file_text({}, record(), "");
  const auto at = text.find("steps ");
  EXPECT_THROW((void)read_printer(written(std::string(text).insert(text.find("steps    "), "stepps = 3\n"))),
               ConfigurationError);
  ASSERT_NE(at, std::string::npos);
  EXPECT_THROW((void)read_printer(written(text.replace(text.find("aaaa"), 1, "X"))), ConfigurationError);
}

}  // namespace
}  // namespace mezzotint
