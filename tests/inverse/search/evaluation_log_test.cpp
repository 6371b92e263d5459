#include "inverse/search/evaluation_log.h"

#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "forward/base/error.h"

namespace mezzotint {
namespace {

class EvaluationLogTest : public testing::Test {
protected:
  void SetUp() override { std::filesystem::remove(file_); }
  void TearDown() override { std::filesystem::remove(file_); }
  const std::filesystem::path file_ =
      std::filesystem::temp_directory_path() /
      (std::string("evaluations-") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".jsonl");
};

TEST_F(EvaluationLogTest, GivesBackWhatItWasToldToTheLastBit) {
  const std::vector<double> values = {0.1, 1.0 / 3.0, 5e-324},
                            results = {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300 / 7.0};
  EvaluationLog(file_, "a").append({"scan", values, results});
  EvaluationLog log(file_, "a");
  EXPECT_EQ(log.found(), 1U);
  const auto again = log.replay("scan", values);
  ASSERT_TRUE(again.has_value());
  EXPECT_TRUE(std::isnan((*again)[0]));
  for (std::size_t i = 1; i < results.size(); ++i) EXPECT_EQ((*again)[i], results[i]);
  EXPECT_FALSE(log.replay("scan", values).has_value());
}

TEST_F(EvaluationLogTest, DropsALastLineThatWasCutOff) {
  {
    EvaluationLog log(file_, "a");
    log.append({"scan", {1.0}, {2.0}});
    log.append({"scan", {2.0}, {3.0}});
  }
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) - 5);
  EvaluationLog log(file_, "a");
  EXPECT_EQ(log.found(), 1U);
  EXPECT_TRUE(log.replay("scan", {1.0}).has_value());
  log.append({"scan", {2.0}, {3.0}});
  EXPECT_EQ(EvaluationLog(file_, "a").found(), 2U);
}

TEST_F(EvaluationLogTest, RefusesTheLogOfAnotherSearch) {
  EvaluationLog(file_, "a").append({"scan", {1.0}, {2.0}});
  EXPECT_THROW(EvaluationLog(file_, "b"), FileError);
  EvaluationLog log(file_, "a");
  EXPECT_THROW((void)log.replay("scan", {1.5}), FileError);
}

TEST_F(EvaluationLogTest, NamesTheLineThatIsDamaged) {
  { EvaluationLog(file_, "a").append({"scan", {1.0}, {2.0}}); }
  { std::ofstream(file_, std::ios::app) << "rubbish\n"; }
  try {
    EvaluationLog log(file_, "a");
    FAIL() << "rubbish was taken for an evaluation";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("line 3"), std::string::npos) << error.what();
  }
}

TEST_F(EvaluationLogTest, SaysThatItCannotBeWritten) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  EXPECT_THROW(EvaluationLog("/dev/full", "a"), DeviceError);
}

}  // namespace
}  // namespace mezzotint
