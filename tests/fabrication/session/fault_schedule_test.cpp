#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

#include "forward/base/random.h"
#include "tests/fabrication/session/printing.h"

namespace mezzotint {
namespace {

using namespace test;

constexpr std::uint64_t schedules = 400;
constexpr std::size_t layers = 10;
constexpr int most_attempts = 12;

struct Tally {
  int undisturbed = 0, resumed = 0, said_uncertain = 0, light_left_on = 0, attempts = 0, faults = 0;
};

// One to three faults, anywhere in the some 1000 moments of the print.
std::map<int, Fault> draw_faults(std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::Test);
  const auto first = random.uniform4(0);
  std::map<int, Fault> faults;
  const int count = 1 + static_cast<int>(3.0 * first[0]);
  for (int i = 0; i < count; ++i) {
    const auto draw = random.uniform4(static_cast<std::uint64_t>(1 + i));
    faults[static_cast<int>(1300.0 * draw[0])] = static_cast<Fault>(1 + static_cast<int>((fault_kinds - 1) * draw[1]));
  }
  return faults;
}

class Schedule {
public:
  explicit Schedule(std::uint64_t seed) : seed_(seed) { world_.faults = draw_faults(seed); }

  void run(const JournalFolder& folder, Tally& tally) {
    const std::filesystem::path path = folder / std::to_string(seed_);
    tally.faults += static_cast<int>(world_.faults.size());
    UncertainPolicy policy = UncertainPolicy::Stop;
    for (int number = 1; number <= most_attempts; ++number) {
      ++tally.attempts;
      SessionControl control;
      SessionOptions options{path, std::filesystem::exists(path) && std::filesystem::file_size(path) > 0, policy};
      options.event = [&](const SessionEvent& event) { user(event, control); };
      const Attempt end = attempt(world_, job_, machine_, options, control);
      policy = UncertainPolicy::Stop;
      check_safety(end, tally);
      if (end.end == SessionEnd::Finished) {
        (number == 1 ? tally.undisturbed : tally.resumed) += 1;
        return check_result(path, tally);
      }
      mend(world_);
      if (end.refused) policy = word_on_uncertain(end, path);
    }
    ADD_FAILURE() << "never finished";
  }

private:
  void user(const SessionEvent&, SessionControl& control) {
    switch (world_.next({Fault::UserStops, Fault::UserStopsNow, Fault::EventThrows})) {
      case Fault::UserStops:
        control.ask_to_stop();
        break;
      case Fault::UserStopsNow:
        control.ask_to_stop();
        control.ask_to_stop();
        break;
      case Fault::EventThrows:
        throw std::runtime_error("someone's progress window crashed");
      default:
        break;
    }
  }

  // The invariant, after every way out.
  void check_safety(const Attempt& end, Tally& tally) {
    world_.settle_light();
    EXPECT_TRUE(world_.violations.empty()) << world_.violations.front();
    if (world_.light) {
      ++tally.light_left_on;
      EXPECT_FALSE(world_.light_reachable) << "the light was left on though it could be switched off: " << end.error;
      EXPECT_TRUE(end.said_light_may_be_on) << end.error;
      EXPECT_NE(end.error.find("THE LIGHT"), std::string::npos) << end.error;
      if (world_.stage_reachable && world_.homed) {
        EXPECT_TRUE(end.said_away) << end.error;
        EXPECT_GT(world_.height_um, std::int64_t(layers) * 18 + 1000);
      }
    } else if (!light_was_left_on_) {
      EXPECT_EQ(world_.vat->elsewhere_s, 0.0) << "light outside of an exposure: " << end.error;
    }
    light_was_left_on_ = light_was_left_on_ || world_.light;
  }

  // The user looks at the part: here, into the vat.
  UncertainPolicy word_on_uncertain(const Attempt& end, const std::filesystem::path& path) {
    const JournalState state = read_journal(path);
    EXPECT_TRUE(state.open && !state.open->certain) << end.error;
    EXPECT_NE(end.error.find("layer " + std::to_string(state.done + 1) + " "), std::string::npos) << end.error;
    const double wanted = plan_.layers[state.done].exposure_s, lit = world_.vat->lit_s[state.done][state.done];
    EXPECT_GE(lit, state.open->least_s - 1e-6);
    if (world_.light_reachable && !light_was_left_on_) {
      EXPECT_LE(lit, state.open->most_s + 1e-6);
    }
    if (lit == 0.0) return UncertainPolicy::Repeat;
    return lit >= 0.99 * wanted ? UncertainPolicy::Skip : UncertainPolicy::Complete;
  }

  void check_result(const std::filesystem::path& path, Tally& tally) {
    const JournalState state = read_journal(path);
    EXPECT_TRUE(state.finished);
    if (!state.decided.empty()) ++tally.said_uncertain;
    const Vat wanted = expected_vat(plan_);
    for (std::size_t h = 0; h < most_layers; ++h) {
      for (std::size_t p = 0; p < most_layers; ++p) {
        const double lit = world_.vat->lit_s[h][p], want = wanted.lit_s[h][p];
        const auto said = h == p ? std::count(state.decided.begin(), state.decided.end(), h) : 0;
        if (said == 0) {
          EXPECT_NEAR(lit, want, 0.035 * want) << "layer " << h << " picture " << p;
        } else {
          EXPECT_GE(lit, 0.96 * want) << "an uncertain layer got too little: " << h;
          if (!light_was_left_on_) {
            EXPECT_LE(lit, 1.04 * want + 1.0 * double(said));
          }
        }
      }
    }
  }

  std::uint64_t seed_;
  World world_;
  LayerSource job_ = small_job(layers);
  MachineProfile machine_ = small_machine();
  PrintPlan plan_ = plan_print(job_.frame, machine_);
  bool light_was_left_on_ = false;
};

TEST(FaultSchedules, EndDarkAndResumeToTheSamePart) {
  const JournalFolder folder;
  Tally tally;
  for (std::uint64_t seed = 1; seed <= schedules; ++seed) {
    SCOPED_TRACE(seed);
    Schedule(seed).run(folder, tally);
    if (HasFailure()) break;
  }
  std::printf(
      "%d schedules with %d faults in %d attempts: %d prints never stopped, %d stopped and resumed to the same "
      "part; %d of them had a layer said to be uncertain; the light was left on behind a lost cable %d times\n",
      int(schedules), tally.faults, tally.attempts, tally.undisturbed, tally.resumed, tally.said_uncertain,
      tally.light_left_on);
  EXPECT_GT(tally.resumed, int(schedules) / 2) << "the faults miss the print";
  EXPECT_GT(tally.light_left_on, 0);
}

}  // namespace
}  // namespace mezzotint
