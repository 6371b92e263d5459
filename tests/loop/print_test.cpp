#include <chrono>
#include <csignal>
#include <thread>

#include <gtest/gtest.h>

#include "fabrication/job/job.h"
#include "fabrication/session/journal.h"
#include "tests/loop/workplace.h"

namespace mezzotint::test {
namespace {

using namespace std::chrono_literals;

// Six layers of 3 s, and a machine of short waits: 30 s of its time.
class PrintCommand : public ::testing::Test {
protected:
  PrintCommand() {
    const GrayImage relief{8, 8, std::vector<float>(64, 0.8F)};
    write_uvj(make_patch_job("patch", relief, PrinterProfile{}), here / "job.uvj");
    here.write("machine.toml", "[stage]\nhighest_um = 5000\n[wait]\nbefore_exposure_s = 0.2\n[lift]\nfast_um = 2000\n");
  }

  std::vector<std::string> print(const std::string& more) const {
    return words("print job.uvj --machine machine.toml " + more);
  }
  JournalState journal() const { return read_journal(here / "job.uvj.journal"); }
  /// Waits until a layer's exposure is in the journal and not yet its end.
  void wait_for_exposure(RunningProgram& program, std::size_t layer) const {
    ASSERT_TRUE(program.wait_for(here / "job.uvj.journal"));
    for (int i = 0; i < 20000; ++i) {
      const JournalState state = journal();
      if (state.done == layer && state.open) return;
      std::this_thread::sleep_for(1ms);
    }
    FAIL() << "layer " << layer << " was never exposed";
  }

  Workplace here;
};

TEST_F(PrintCommand, ByAMachineGivesTheVirtualPrintersReliefBitForBit) {
  const Ending plain = here.mezzotint(words("print job.uvj -o plain.gwy --seed 3"));
  ASSERT_EQ(plain.status, 0) << plain.err;
  const Ending machine = here.mezzotint(print("-o machine.gwy --seed 3 --json"));
  ASSERT_EQ(machine.status, 0) << machine.err;
  EXPECT_EQ(here.read("plain.gwy"), here.read("machine.gwy"));
  const auto json = nlohmann::json::parse(machine.out);
  EXPECT_EQ(json["done"], 6);
  EXPECT_EQ(json["finished"], true);
  for (const double lit : journal().lit_s) EXPECT_DOUBLE_EQ(lit, 3.0);
}

TEST_F(PrintCommand, RehearsesDryWithoutLeavingAnything) {
  const Files before = here.files();
  const Ending dry = here.mezzotint(print("--dry-run --json"));
  ASSERT_EQ(dry.status, 0) << dry.err;
  EXPECT_EQ(here.files(), before);
  const auto times = nlohmann::json::parse(dry.out)["times"];
  EXPECT_NEAR(times["light_s"], 6 * 3.0, 1e-9);
  EXPECT_NEAR(times["moving_s"], 6 * 2 * (1000 / 500.0 + 2000 / 2500.0), 1e-9);
  EXPECT_NEAR(times["waiting_s"], 6 * (0.2 + 0.5 + 0.5), 1e-9);
}

TEST_F(PrintCommand, FinishesTheLayerAtCtrlCAndGoesOn) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    std::filesystem::remove(here / "job.uvj.journal");
    RunningProgram program(here.path(), print("--pace 20"));
    wait_for_exposure(program, 1);
    program.send(signal);
    const Ending stopped = program.wait();
    EXPECT_EQ(stopped.status, 1) << stopped.err;
    EXPECT_NE(stopped.out.find("--resume"), std::string::npos);
    EXPECT_EQ(journal().done, 2U);
    EXPECT_FALSE(journal().open) << "the exposure was finished";
    const Ending again = here.mezzotint(print(""));
    EXPECT_EQ(again.status, 2) << "a begun print is not begun anew by mistake";
    EXPECT_NE(again.err.find("--resume"), std::string::npos);
    const Ending resumed = here.mezzotint(print("--resume"));
    EXPECT_EQ(resumed.status, 0) << resumed.err;
    for (const double lit : journal().lit_s) EXPECT_NEAR(lit, 3.0, 1e-6);
  }
}

TEST_F(PrintCommand, CutsTheExposureAtTheSecondCtrlCAndCompletesItLater) {
  RunningProgram program(here.path(), print("--pace 10"));
  wait_for_exposure(program, 1);
  program.send(SIGINT);
  std::this_thread::sleep_for(50ms);
  program.send(SIGINT);
  EXPECT_EQ(program.wait().status, 1);
  const JournalState state = journal();
  ASSERT_EQ(state.done, 1U);
  ASSERT_TRUE(state.open);
  EXPECT_TRUE(state.open->certain);
  EXPECT_LT(state.open->most_s, 3.0);
  EXPECT_EQ(here.mezzotint(print("--resume")).status, 0);
  EXPECT_NEAR(journal().lit_s[1], 3.0, 1e-6);
}

TEST_F(PrintCommand, AsksWhatHappensToALayerThatAKillLeftUncertain) {
  RunningProgram program(here.path(), print("--pace 10"));
  wait_for_exposure(program, 2);
  program.send(SIGKILL);
  EXPECT_EQ(program.wait().status, 128 + SIGKILL);
  const Ending asked = here.mezzotint(print("--resume"));
  EXPECT_EQ(asked.status, 2);
  EXPECT_NE(asked.err.find("layer 3 "), std::string::npos) << asked.err;
  EXPECT_NE(asked.err.find("--uncertain"), std::string::npos);
  const Ending resumed = here.mezzotint(print("--resume --uncertain repeat --json"));
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_EQ(nlohmann::json::parse(resumed.out)["uncertain_layers"], nlohmann::json::array({2}));
}

TEST_F(PrintCommand, PausesAtCtrlZ) {
  RunningProgram program(here.path(), print("--pace 20"));
  wait_for_exposure(program, 1);
  program.send(SIGTSTP);
  std::this_thread::sleep_for(800ms);
  EXPECT_EQ(journal().done, 2U) << "after the layer it waits";
  for (int i = 0; i < 12; ++i) {  // on a busy machine it may come to its pause late
    program.send(SIGCONT);
    std::this_thread::sleep_for(100ms);
  }
  const Ending end = program.wait();
  EXPECT_EQ(end.status, 0) << end.err;
  EXPECT_NE(end.err.find("paused"), std::string::npos);
}

TEST_F(PrintCommand, RefusesWhatMakesNoSense) {
  for (const char* line : {"print job.uvj", "print job.uvj --device dlpc900", "print job.uvj -o r.gwy --resume",
                           "print job.uvj --machine machine.toml --uncertain skip",
                           "print job.uvj --machine machine.toml --device dlpc900 -o r.gwy",
                           "print job.uvj --machine machine.toml --resume", "print job.uvj --machine none.toml"}) {
    EXPECT_EQ(here.mezzotint(words(line)).status, 2) << line;
  }
  here.write("machine.toml", "[lift]\nslow_mm = 1\n");
  const Ending unknown = here.mezzotint(print("--dry-run"));
  EXPECT_EQ(unknown.status, 2);
  EXPECT_NE(unknown.err.find("slow_mm"), std::string::npos) << unknown.err;
}

// No projector is here, or none that may be opened: it says so, and nothing was exposed.
TEST_F(PrintCommand, SaysThatThereIsNoProjector) {
  here.write("machine.toml", "[projector]\nway = \"upload\"\n[stage]\nport = \"/dev/ttyNoSuchPort\"\n");
  const Ending none = here.mezzotint(print("--device dlpc900"));
  EXPECT_EQ(none.status, 1) << none.err;
  EXPECT_NE(none.err.find("/dev/ttyNoSuchPort"), std::string::npos) << none.err;
  EXPECT_FALSE(std::filesystem::exists(here / "job.uvj.journal"));
}

}  // namespace
}  // namespace mezzotint::test
