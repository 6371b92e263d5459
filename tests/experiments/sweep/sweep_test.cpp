#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "experiments/sweep/ranks.h"

namespace mezzotint {
namespace {

TEST(Sweep, GivesResultsInTheOrderOfTheTasks) {
  Ranks ranks;
  const auto results = sweep(
      ranks, 50, [](std::size_t index) { return std::to_string(index * index); }, {}, "squares");
  ASSERT_EQ(results.size(), 50U);
  for (std::size_t i = 0; i < results.size(); ++i) EXPECT_EQ(results[i], std::to_string(i * i));
  EXPECT_TRUE(sweep(
                  ranks, 0, [](std::size_t) { return std::string(); }, {}, "nothing")
                  .empty());
}

TEST(Sweep, ReportsProgressToItsEnd) {
  Ranks ranks;
  double last = -1.0;
  const Progress progress = [&](const ProgressEvent& event) {
    EXPECT_GE(event.fraction, last);
    last = event.fraction;
  };
  (void)sweep(
      ranks, 8, [](std::size_t) { return std::string("x"); }, progress, "sweep");
  EXPECT_DOUBLE_EQ(last, 1.0);
}

TEST(Sweep, ThrowsWhatATaskThrewAndBeginsNoMore) {
  Ranks ranks;
  std::atomic<int> begun{0};
  const SweepTask task = [&](std::size_t index) -> std::string {
    ++begun;
    if (index == 3) throw InvalidInput("the third is wrong");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return {};
  };
  EXPECT_THROW((void)sweep(ranks, 10000, task, {}, "sweep"), InvalidInput);
  EXPECT_LT(begun, 1000);
}

TEST(Sweep, StopsWhereTheProgressThrows) {
  Ranks ranks;
  const Progress progress = [](const ProgressEvent&) { throw Interrupted(); };
  const SweepTask task = [](std::size_t) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return std::string();
  };
  EXPECT_THROW((void)sweep(ranks, 10000, task, progress, "sweep"), Interrupted);
}

TEST(Sweep, KeepsTheBitsOfNumbers) {
  const std::vector<double> values = {0.1, -0.0, 1e-310, 3.0};
  EXPECT_EQ(doubles_of(bytes_of(values)), values);
  EXPECT_TRUE(doubles_of("").empty());
  EXPECT_THROW((void)doubles_of("abc"), InvalidInput);
}

}  // namespace
}  // namespace mezzotint
