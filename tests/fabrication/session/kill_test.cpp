#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

#include "forward/base/random.h"
#include "tests/fabrication/session/printing.h"

namespace mezzotint {
namespace {

using namespace test;

constexpr int kills = 100;
constexpr std::size_t layers = 6;

/// A vat that outlives the process that prints into it.
class SharedVat {
public:
  SharedVat() {
    void* place = ::mmap(nullptr, sizeof(Vat), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (place == MAP_FAILED) throw std::runtime_error("no shared memory");
    vat_ = new (place) Vat;
  }
  ~SharedVat() { ::munmap(vat_, sizeof(Vat)); }
  SharedVat(const SharedVat&) = delete;
  SharedVat& operator=(const SharedVat&) = delete;
  Vat* get() { return vat_; }

private:
  Vat* vat_;
};

Attempt print_into(Vat* vat, const std::filesystem::path& journal, bool resume, UncertainPolicy policy,
                   const std::function<void()>& each_moment = {}) {
  World world;
  world.vat = vat;
  world.each_moment = each_moment;
  SessionControl control;
  return attempt(world, small_job(layers), small_machine(), {journal, resume, policy}, control);
}

bool has_begun(const std::filesystem::path& journal) {
  return std::filesystem::exists(journal) && std::filesystem::file_size(journal) > 0 &&
         read_journal(journal).layers > 0;
}

// A child prints at about 30 µs a moment, and is killed after `delay_us`; true where it was killed while printing.
bool print_and_kill(Vat* vat, const std::filesystem::path& journal, bool resume, useconds_t delay_us) {
  const pid_t child = ::fork();
  if (child == 0) {
    const Attempt end = print_into(vat, journal, resume, UncertainPolicy::Stop, [] { ::usleep(10); });
    ::_exit(end.end == SessionEnd::Finished ? 0 : 1);
  }
  ::usleep(delay_us);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFSIGNALED(status);
}

UncertainPolicy look_into(const Vat& vat, std::size_t layer, double wanted_s) {
  const double lit = vat.lit_s[layer][layer];
  if (lit == 0.0) return UncertainPolicy::Repeat;
  return lit >= 0.99 * wanted_s ? UncertainPolicy::Skip : UncertainPolicy::Complete;
}

struct Tally {
  int killed = 0, before_begin = 0, certain = 0, uncertain = 0, after_end = 0;
};

void check_killed_print(int number, const JournalFolder& folder, Tally& tally) {
  const auto journal = folder / ("kill" + std::to_string(number));
  const PrintPlan plan = plan_print(small_job(layers).frame, small_machine());
  SharedVat vat;
  const double share = RandomStream(1, RandomPurpose::Test).uniform4(std::uint64_t(number))[0];
  const bool killed = print_and_kill(vat.get(), journal, false, static_cast<useconds_t>(65000.0 * share));
  tally.killed += killed;
  if (!killed) {
    ++tally.after_end;
    EXPECT_TRUE(read_journal(journal).finished);
    return;
  }
  const bool begun = has_begun(journal);
  double known_lit = 0.0;
  std::optional<std::size_t> uncertain;
  if (!begun) {
    ++tally.before_begin;
    std::filesystem::remove(journal);
  } else {
    const JournalState state = read_journal(journal);
    if (state.finished) return void(++tally.after_end);
    if (state.open && !state.open->certain) {
      uncertain = state.done;
      known_lit = vat.get()->lit_s[*uncertain][*uncertain];
      const Attempt asked = print_into(vat.get(), journal, true, UncertainPolicy::Stop);
      EXPECT_TRUE(asked.refused) << asked.error;
      EXPECT_NE(asked.error.find("layer " + std::to_string(*uncertain + 1) + " "), std::string::npos);
    }
  }
  (uncertain ? tally.uncertain : tally.certain) += 1;
  const auto policy =
      uncertain ? look_into(*vat.get(), *uncertain, plan.layers[*uncertain].exposure_s) : UncertainPolicy::Stop;
  const Attempt end = print_into(vat.get(), journal, begun, policy);
  EXPECT_EQ(end.end, SessionEnd::Finished) << end.error;
  for (std::size_t i = 0; i < layers; ++i) {
    const double wanted = plan.layers[i].exposure_s;
    // After a kill nobody knows how long the layer was lit: completed by the least that is known, it got that twice.
    const bool twice = uncertain == i && policy == UncertainPolicy::Complete;
    EXPECT_NEAR(vat.get()->lit_s[i][i], wanted + (twice ? known_lit : 0.0), 0.01 * wanted) << "layer " << i;
  }
}

TEST(KilledPrints, GoOnWithNoLayerLostOrDoubledUnsaid) {
  const JournalFolder folder;
  Tally tally;
  for (int number = 0; tally.killed < kills && number < 2 * kills && !::testing::Test::HasFailure(); ++number) {
    SCOPED_TRACE(number);
    check_killed_print(number, folder, tally);
  }
  std::printf(
      "%d prints killed: %d before their journal, %d with an uncertain layer that was said, %d between layers; %d "
      "had ended\n",
      tally.killed, tally.before_begin, tally.uncertain, tally.certain - tally.before_begin, tally.after_end);
  EXPECT_EQ(tally.killed, kills);
  EXPECT_GT(tally.uncertain, kills / 10) << "the kills miss the exposures";
}

// Whatever line a print dies after, and dies again after while it goes on.
TEST(KilledPrints, SurviveKillAfterKill) {
  const JournalFolder folder;
  const auto journal = folder / "again";
  const PrintPlan plan = plan_print(small_job(layers).frame, small_machine());
  SharedVat vat;
  const RandomStream random(2, RandomPurpose::Test);
  std::vector<double> said(layers, 0.0);
  for (std::uint64_t number = 0; number < 200; ++number) {
    const bool begun = has_begun(journal);
    if (!begun) std::filesystem::remove(journal);
    if (begun) {
      const JournalState state = read_journal(journal);
      if (state.finished) break;
      if (state.open && !state.open->certain) {
        // The user takes it as done where it got its light, and else has it exposed anew.
        const double lit = vat.get()->lit_s[state.done][state.done], wanted = plan.layers[state.done].exposure_s;
        const bool whole = lit - said[state.done] >= 0.99 * wanted;
        Journal resumed = Journal::resume(journal, small_job(layers).identity, identity(plan));
        resumed.decide(state.done, whole ? "skip" : "repeat");
        if (!whole) said[state.done] = lit;
      }
    }
    [[maybe_unused]] const bool killed = print_and_kill(
        vat.get(), journal, begun, static_cast<useconds_t>(5000.0 + 40000.0 * random.uniform4(number)[0]));
  }
  EXPECT_TRUE(read_journal(journal).finished);
  for (std::size_t i = 0; i < layers; ++i) {
    EXPECT_NEAR(vat.get()->lit_s[i][i] - said[i], plan.layers[i].exposure_s, 0.01 * plan.layers[i].exposure_s) << i;
  }
}

}  // namespace
}  // namespace mezzotint
