#include "fabrication/session/print_session.h"

#include <set>

#include <gtest/gtest.h>

#include "tests/fabrication/session/printing.h"

namespace mezzotint {
namespace {

using namespace test;

struct Bench {
  World world;
  LayerSource job = small_job(8);
  MachineProfile machine = small_machine();
  std::optional<SessionControl> control{std::in_place};
  JournalFolder folder;
  std::vector<SessionEvent> events;

  Attempt print(bool resume = false, UncertainPolicy policy = UncertainPolicy::Stop) {
    SessionOptions options{folder / "journal", resume, policy};
    options.event = [this](const SessionEvent& event) {
      events.push_back(event);
      if (each_event) each_event(event);
    };
    return attempt(world, job, machine, options, *control);
  }
  void expect_whole() const {
    const Vat wanted = expected_vat(plan_print(job.frame, machine));
    for (std::size_t h = 0; h < most_layers; ++h) {
      for (std::size_t p = 0; p < most_layers; ++p) {
        EXPECT_NEAR(world.vat->lit_s[h][p], wanted.lit_s[h][p], 0.012 * wanted.lit_s[h][p]) << h << ' ' << p;
      }
    }
    EXPECT_EQ(world.vat->elsewhere_s, 0.0);
    EXPECT_TRUE(world.violations.empty());
    EXPECT_FALSE(world.light);
  }
  std::function<void(const SessionEvent&)> each_event;
};

TEST(PrintSession, ExposesEveryLayerOnceAtItsHeight) {
  Bench bench;
  const Attempt done = bench.print();
  EXPECT_EQ(done.end, SessionEnd::Finished) << done.error;
  bench.expect_whole();
  EXPECT_TRUE(read_journal(bench.folder / "journal").finished);
}

// The slides' layer: 18 µm; bottom exposure, then linearly down to the job's own.
TEST(PrintSession, PlansBottomAndTransitionLayers) {
  const PrintPlan plan = plan_print(small_job(8).frame, small_machine());
  const std::vector<double> wanted = {4.0, 4.0, 4.0 + (1.5 - 4.0) / 3.0, 4.0 + (1.0 - 4.0) * 2.0 / 3.0, 1.25, 1.5,
                                      1.0, 1.25};
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(plan.layers[i].exposure_s, wanted[i], 1e-12) << i;
    EXPECT_EQ(plan.layers[i].height_um, 18 * std::int64_t(i + 1));
  }
}

TEST(PrintSession, RoundsEachHeightByItself) {
  LayerSource job = small_job(8);
  for (std::size_t i = 0; i < 8; ++i) job.frame.layers[i].top = Length::from_um(17.81 * double(i + 1));
  const PrintPlan plan = plan_print(job.frame, small_machine());
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(double(plan.layers[i].height_um), 17.81 * double(i + 1), 0.5);
  EXPECT_GT(plan.largest_rounding_um, 0.1);
  job.frame.layers[1].top = Length::from_um(17.82);
  EXPECT_THROW(plan_print(job.frame, small_machine()), InvalidInput) << "no step of 1 µm between two layers";
  MachineProfile low = small_machine();
  low.highest_um = 4100;
  EXPECT_THROW(plan_print(small_job(8).frame, low), InvalidInput) << "the lift ends over the stage's travel";
}

TEST(PrintSession, ExpectsTheTimeThatItTakes) {
  Bench bench;
  ASSERT_EQ(bench.print().end, SessionEnd::Finished);
  const double expected = expected_times(plan_print(bench.job.frame, bench.machine), bench.machine).total_s();
  const double homing = 10.0 + (100000.0 - 4018.0) / 2500.0, showing = 8 * 0.05;
  EXPECT_NEAR(in_seconds(bench.world.clock.now()), expected + homing + showing, 0.01 * expected);
  for (std::size_t i = 1; i < bench.events.size(); ++i) {
    EXPECT_LE(bench.events[i].left_s, bench.events[i - 1].left_s + 8 * 0.06);
  }
}

TEST(PrintSession, FinishesTheExposureAtTheFirstWordAndCutsItAtTheSecond) {
  for (const int words : {1, 2}) {
    Bench bench;
    int lit_events = 0;
    bench.each_event = [&](const SessionEvent& event) {
      if (event.state == SessionState::Exposing && event.layer == 4 && ++lit_events == 20) {
        for (int i = 0; i < words; ++i) bench.control->ask_to_stop();
      }
    };
    EXPECT_EQ(bench.print().end, SessionEnd::Stopped);
    EXPECT_FALSE(bench.world.light);
    EXPECT_GE(bench.world.height_um, 5 * 18 + 4000) << "lifted";
    const double lit = bench.world.vat->lit_s[4][4];
    if (words == 1) {
      EXPECT_NEAR(lit, 1.25, 1e-9);
    } else {
      EXPECT_NEAR(lit, 0.38, 0.03);
    }
    bench.control.emplace();
    bench.each_event = nullptr;
    EXPECT_EQ(bench.print(true).end, SessionEnd::Finished);
    bench.expect_whole();
  }
}

TEST(PrintSession, PausesInTheDarkWithThePlatformLifted) {
  Bench bench;
  std::size_t slices = 0;
  bench.each_event = [&](const SessionEvent& event) {
    if (event.state == SessionState::Exposing && event.layer == 2) bench.control->ask_to_pause();
    if (event.state == SessionState::Paused) {
      EXPECT_FALSE(bench.world.light);
      EXPECT_GE(bench.world.height_um, 3 * 18 + 4000);
      EXPECT_EQ(event.layer, 3U);
      ++slices;
      bench.control->ask_to_pause(false);
    }
  };
  EXPECT_EQ(bench.print().end, SessionEnd::Finished);
  EXPECT_EQ(slices, 1U);
  bench.expect_whole();
}

TEST(PrintSession, MovesAwayFromALightThatStaysOnAndSaysSo) {
  Bench bench;
  bench.each_event = [&](const SessionEvent& event) {
    if (event.state == SessionState::Exposing && event.layer == 3) bench.world.faults[0] = Fault::LightGone;
  };
  const Attempt gone = bench.print();
  EXPECT_TRUE(gone.said_light_may_be_on);
  EXPECT_NE(gone.error.find("THE LIGHT COULD NOT BE SWITCHED OFF"), std::string::npos) << gone.error;
  EXPECT_TRUE(gone.said_away);
  EXPECT_GE(bench.world.height_um, 4 * 18 + 4000);
  mend(bench.world);
  bench.each_event = nullptr;
  const Attempt asked = bench.print(true);
  EXPECT_TRUE(asked.refused);
  EXPECT_NE(asked.error.find("layer 4 "), std::string::npos) << asked.error;
  EXPECT_NE(asked.error.find("--uncertain"), std::string::npos);
  EXPECT_EQ(bench.print(true, UncertainPolicy::Skip).end, SessionEnd::Finished);
}

TEST(PrintSession, SaysWhatIsLeftToDoWhereNothingCanBeReached) {
  Bench bench;
  bench.each_event = [&](const SessionEvent& event) {
    if (event.state != SessionState::Exposing || event.layer != 3) return;
    bench.world.stage_reachable = bench.world.homed = false;
    bench.world.faults[0] = Fault::LightGone;
  };
  const Attempt gone = bench.print();
  EXPECT_TRUE(gone.said_light_may_be_on);
  EXPECT_FALSE(gone.said_away);
  EXPECT_NE(gone.error.find("cut the light engine's power"), std::string::npos);
  EXPECT_NE(gone.error.find("could not be moved"), std::string::npos);
}

TEST(PrintSession, CoolsDownAndCompletesTheExposure) {
  Bench bench;
  bench.world.faults[150] = Fault::LightTooHot;
  EXPECT_EQ(bench.print().end, SessionEnd::Finished);
  bench.expect_whole();
  std::set<SessionState> states;
  for (const auto& event : bench.events) states.insert(event.state);
  EXPECT_TRUE(states.contains(SessionState::Cooling));
}

TEST(PrintSession, NeverLightsWhereTheBoardRestartedWhileThePlatformWaited) {
  Bench bench;
  bench.each_event = [&](const SessionEvent& event) {
    if (event.state == SessionState::Waiting && event.layer == 5) bench.world.homed = false;
  };
  const Attempt lost = bench.print();
  EXPECT_FALSE(lost.end);
  EXPECT_EQ(bench.world.vat->lit_s[5][5], 0.0);
  bench.each_event = nullptr;
  EXPECT_EQ(bench.print(true).end, SessionEnd::Finished);
  bench.expect_whole();
}

TEST(PrintSession, DoesNotPressABegunPartIntoTheVat) {
  Bench bench;
  bench.machine.home_at = HomeAt::Bottom;
  bench.each_event = [&](const SessionEvent& event) {
    if (event.layer == 2) bench.control->ask_to_stop();
  };
  EXPECT_EQ(bench.print().end, SessionEnd::Stopped);
  bench.control.emplace();
  const auto height = bench.world.height_um;
  const Attempt again = bench.print(true);
  EXPECT_TRUE(again.refused) << again.error;
  EXPECT_EQ(bench.world.height_um, height);
}

TEST(PrintSession, ExposesNothingWithoutAJournal) {
  Bench bench;
  bench.job = small_job(8);
  SessionOptions options{"/dev/full"};
  const Attempt full = attempt(bench.world, bench.job, bench.machine, options, *bench.control);
  EXPECT_FALSE(full.end);
  for (const auto& layer : bench.world.vat->lit_s) {
    for (const double lit : layer) EXPECT_EQ(lit, 0.0);
  }
}

}  // namespace
}  // namespace mezzotint
