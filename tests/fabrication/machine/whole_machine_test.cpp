#include <gtest/gtest.h>

#ifndef MEZZOTINT_HAS_UMOCKDEV

TEST(WholeMachine, PrintsAJob) {
  GTEST_SKIP() << "umockdev (Debian: libumockdev-dev) is missing, or sanitizers forbid it";
}

#else

#include "fabrication/projector/dlpc900.h"
#include "fabrication/projector/usb_transport.h"
#include "fabrication/session/print_session.h"
#include "fabrication/stage/marlin_stage.h"
#include "tests/fabrication/projector/emulator/usb_device.h"
#include "tests/fabrication/stage/emulated_board.h"

namespace mezzotint {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t columns = 2560, rows = 1600, layers = 20;
constexpr double exposure_s = 0.06;

// Gray blocks across the border between the controllers, others on every layer; no symmetry that a flip could hide.
std::vector<std::uint8_t> slice(std::size_t layer) {
  std::vector<std::uint8_t> gray(columns * rows, 0);
  for (std::size_t y = 300; y < 700; ++y) {
    for (std::size_t x = 1180; x < 1480; ++x) {
      gray[y * columns + x] = static_cast<std::uint8_t>((x / 30 + y / 40 * 7 + layer * 11) * 37);
    }
  }
  return gray;
}

LayerSource job() {
  LayerSource source;
  source.identity = "blocks";
  source.frame.columns = columns;
  source.frame.rows = rows;
  source.frame.led_amplitude = 230;
  for (std::size_t i = 0; i < layers; ++i) {
    source.frame.layers.push_back({{}, exposure_s, Length::from_um(18.0 * double(i + 1))});
  }
  source.read = slice;
  return source;
}

MachineProfile quick_machine() {
  MachineProfile machine;
  machine.before_exposure_s = machine.after_exposure_s = machine.after_lift_s = 0.001;
  machine.slow_lift_um_per_s = machine.fast_lift_um_per_s = 1e5;
  machine.exposure_tolerance = 0.5;  // a busy machine's jitter against 60 ms
  return machine;
}

class WholeMachine : public testing::Test {
protected:
  SteadyClock clock;
  emulator::DeviceModel device{clock};
  emulator::UsbDevice bus{device};
  test::EmulatedBoard board;
  test::TemporaryFolder folder;
  LayerSource source = job();
  SessionControl control;

  SessionEnd print(bool resume = false, UncertainPolicy policy = UncertainPolicy::Stop) {
    MarlinSettings settings;
    settings.port = board.port();
    MarlinStage stage(settings);
    const auto light =
        make_dlpc900(dlpc900::open_usb(), clock, {.way = Dlpc900Options::Way::Upload, .poll = milliseconds(5)});
    SessionOptions options;
    options.journal = folder / "journal";
    options.resume = resume;
    options.uncertain = policy;
    options.event = [this](const SessionEvent& event) {
      if (each_event) each_event(event);
    };
    PrintSession session(source, quick_machine(), *light, stage, clock, control, options);
    return session.run();
  }
  std::function<void(const SessionEvent&)> each_event;

  // The platform's last move before the light, and none while it is on.
  void expect_at_rest(const emulator::LightRecord& light, std::int64_t height_um) const {
    std::int64_t before = -1;
    for (const auto& move : board.moves()) {
      const Clock::Duration at = move.at.time_since_epoch();
      if (at < light.on) before = move.height_um;
      EXPECT_FALSE(at >= light.on && at <= light.off) << "moved in the light";
    }
    EXPECT_EQ(before, height_um);
  }
  // Bit for bit; the job's row 0 is the picture's last.
  static bool shows(const emulator::LightRecord& light, std::size_t layer) {
    const std::vector<std::uint8_t> gray = slice(layer);
    for (std::size_t row = 0; row < rows; ++row) {
      if (!std::equal(gray.begin() + std::ptrdiff_t(row * columns), gray.begin() + std::ptrdiff_t((row + 1) * columns),
                      light.picture.begin() + std::ptrdiff_t((rows - 1 - row) * columns))) {
        return false;
      }
    }
    return true;
  }
};

TEST_F(WholeMachine, PrintsAJobBitForBitWithTheLightInItsWindows) {
  ASSERT_EQ(print(), SessionEnd::Finished);
  const auto log = device.light_log();
  ASSERT_EQ(log.size(), layers);
  for (std::size_t i = 0; i < layers; ++i) {
    EXPECT_TRUE(shows(log[i], i)) << "layer " << i;
    EXPECT_EQ(log[i].current, 230);
    EXPECT_NEAR(in_seconds(log[i].off - log[i].on), exposure_s, 1e-3) << "the device times it";
    expect_at_rest(log[i], 18 * std::int64_t(i + 1));
  }
  EXPECT_FALSE(device.light_is_on());
  EXPECT_TRUE(read_journal(folder / "journal").finished);
}

TEST_F(WholeMachine, MovesAwayFromAnUnpluggedProjectorAndGoesOn) {
  each_event = [this](const SessionEvent& event) {
    if (event.state == SessionState::Exposing && event.layer == 4) device.script({emulator::Fault::Unplug, {}, 3});
  };
  try {
    static_cast<void>(print());
    ADD_FAILURE() << "nothing was thrown";
  } catch (const PrintError& error) {
    EXPECT_FALSE(error.light_is_off()) << error.what();
    EXPECT_TRUE(error.platform_is_away());
    EXPECT_NE(std::string(error.what()).find("THE LIGHT"), std::string::npos);
  }
  EXPECT_EQ(board.height_um(), 5 * 18 + 4000);
  each_event = nullptr;
  device.power_cycle();
  bus.plug();
  EXPECT_THROW(static_cast<void>(print(true)), InvalidInput) << "layer 5 is uncertain";
  ASSERT_EQ(print(true, UncertainPolicy::Skip), SessionEnd::Finished);
  const auto log = device.light_log();
  EXPECT_TRUE(shows(log.back(), layers - 1));
  EXPECT_EQ(read_journal(folder / "journal").decided, std::vector<std::size_t>{4});
}

TEST_F(WholeMachine, GoesOnAfterTheStageRestarted) {
  each_event = [this](const SessionEvent& event) {
    if (event.state == SessionState::Moving && event.layer == 3) board.set({.reboot_after = 2});
  };
  EXPECT_THROW(static_cast<void>(print()), PrintError);
  EXPECT_EQ(device.light_log().size(), 3U);
  EXPECT_FALSE(device.light_is_on());
  each_event = nullptr;
  board.set({});
  ASSERT_EQ(print(true), SessionEnd::Finished);
  const auto log = device.light_log();
  ASSERT_EQ(log.size(), layers) << "no layer lost or doubled";
  for (std::size_t i = 0; i < layers; ++i) {
    EXPECT_TRUE(shows(log[i], i)) << "layer " << i;
    expect_at_rest(log[i], 18 * std::int64_t(i + 1));
  }
}

}  // namespace
}  // namespace mezzotint

#endif
