#include <gtest/gtest.h>

#include <map>
#include <random>

#include "fabrication/projector/dlpc900.h"
#include "tests/fabrication/projector/emulated_transport.h"
#include "tests/fabrication/projector/emulated_window.h"

namespace mezzotint {
namespace {

using emulator::Fault;
using Way = Dlpc900Options::Way;

constexpr std::size_t columns = 1920, rows = 1080;
const Clock::Duration exposure = std::chrono::milliseconds(1500);

/// Prints a few layers while faults of any kind strike at any message, and checks after every call what the device
/// knows of its light.
class Schedule {
public:
  Schedule(unsigned seed, Way way) : random_(seed), way_(way) {
    for (std::size_t i = 0; i < gray_.size(); ++i)
      gray_[i] = static_cast<std::uint8_t>(i / columns / 100 * 20 + seed % 5);
    for (unsigned i = draw(1, 5); i > 0; --i) device_.script(any_fault());
  }

  void print(int layers) {
    for (int attempt = 0; attempt < 40 && layers > 0; ++attempt) {
      try {
        if (!engine_) connect();
        if (print_layer())
          --layers;
        else
          return repair();  // the layer got some light: a session stops here and says so
      } catch (const LightEngineError& error) {
        ++faults_told[error.fault()];
        expect_dark();
        repair();
      }
    }
    EXPECT_EQ(layers, 0) << "not done after 40 attempts";
    completed = layers == 0;
  }
  bool completed = false;
  int exposures_failed = 0;
  std::map<LightFault, int> faults_told;

private:
  unsigned draw(unsigned low, unsigned high) { return low + static_cast<unsigned>(random_() % (high - low + 1)); }

  emulator::ScriptedFault any_fault() {
    const auto fault = static_cast<Fault>(draw(0, static_cast<unsigned>(Fault::SyncLost)));
    emulator::ScriptedFault scripted{fault, {}, static_cast<int>(draw(1, 90)), 6};
    // What has no read form and is acknowledged yet not done cannot be noticed: the documentation says so.
    if (fault == Fault::IgnoreWrite) {
      const std::uint16_t readable[] = {0x0b01, 0x1a07, 0x1a05, 0x1009, 0x1a1b, 0x1a31};
      scripted.command = readable[draw(0, 5)];
      scripted.nth = static_cast<int>(draw(1, 6));
    }
    return scripted;
  }
  void connect() {
    engine_ = make_dlpc900(std::make_unique<EmulatedTransport>(device_, clock_), clock_, {.way = way_},
                           std::make_unique<EmulatedWindow>(device_, columns, rows));
    expect_dark();
  }
  void repair() {
    engine_.reset();
    device_.plug(true);
    device_.heal_sequencer();
    clock_.sleep_for(std::chrono::seconds(5));
    prepared_ = false;
  }
  void expect_dark() { EXPECT_FALSE(device_.light_is_on() && device_.plugged()) << "light outside of an exposure"; }
  [[nodiscard]] Clock::Duration light_since(std::size_t records) {
    Clock::Duration lit{0};
    const auto log = device_.light_log();
    for (std::size_t i = records; i < log.size(); ++i) lit += log[i].off - log[i].on;
    return lit;
  }

  /// False where an exposure failed after it had begun.
  bool print_layer() {
    if (!prepared_) engine_->prepare({});
    prepared_ = true;
    expect_dark();
    engine_->show({columns, rows, gray_}, exposure);
    expect_dark();
    const std::size_t records = device_.light_log().size();
    try {
      const auto report = engine_->expose([] { return true; });
      expect_dark();
      const auto lit = light_since(records);
      EXPECT_LE(std::abs((lit - report.lit).count()), report.uncertainty.count() + 1);
      EXPECT_EQ(device_.light_log().size(), records + 1);
      EXPECT_TRUE(device_.light_log().back().picture == gray_) << "another picture was lit";
      EXPECT_EQ(device_.light_log().back().current, 230);
      return true;
    } catch (const ExposureError& error) {
      ++exposures_failed;
      EXPECT_TRUE(!error.light_is_off() || !device_.light_is_on()) << "it says dark, and there is light";
      if (error.light_is_off()) {
        EXPECT_LE(error.least_lit(), light_since(records));
        EXPECT_GE(error.most_lit(), light_since(records));
      }
      ++faults_told[error.fault()];
      return error.most_lit().count() == 0 ? (repair(), print_again()) : false;
    }
  }
  bool print_again() {
    connect();
    return print_layer();
  }

  std::mt19937 random_;
  Way way_;
  VirtualClock clock_;
  emulator::DeviceModel device_{clock_, {.mirrors = 1, .columns = columns, .rows = rows}};
  std::vector<std::uint8_t> gray_ = std::vector<std::uint8_t>(columns * rows, 0);
  std::unique_ptr<LightEngine> engine_;
  bool prepared_ = false;
};

void run_schedules(Way way, unsigned count, int layers) {
  std::map<LightFault, int> told;
  unsigned completed = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Schedule schedule(seed, way);
    schedule.print(layers);
    completed += schedule.completed ? 1U : 0U;
    for (const auto& [fault, times] : schedule.faults_told) told[fault] += times;
    if (testing::Test::HasFailure()) return;  // one seed tells enough
  }
  testing::Test::RecordProperty("completed", static_cast<int>(completed));
  std::printf("%u of %u schedules completed; faults told:", completed, count);
  for (const auto& [fault, times] : told) std::printf(" %s %d;", std::string(fault_name(fault)).c_str(), times);
  std::printf("\n");
  EXPECT_GT(completed, count / 4) << "too few schedules end well to mean anything";
  EXPECT_GE(told.size(), 5U) << "the schedules are tame";
}

TEST(FaultSchedule, LightIsOnInExposuresAloneByVideo) { run_schedules(Way::Video, 220, 2); }
TEST(FaultSchedule, LightIsOnInExposuresAloneByUpload) { run_schedules(Way::Upload, 40, 1); }

}  // namespace
}  // namespace mezzotint
