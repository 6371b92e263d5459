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

constexpr double exposure_s = 0.06;

/// A projector's mirrors, and how many layers are printed with it.
struct Kind {
  std::uint8_t mirrors;
  std::size_t columns, rows, layers;
};

// Gray blocks across the middle, where two controllers meet, others on every layer; no symmetry that a flip could hide.
std::vector<std::uint8_t> slice(const Kind& kind, std::size_t layer) {
  std::vector<std::uint8_t> gray(kind.columns * kind.rows, 0);
  for (std::size_t y = 300; y < 400; ++y) {
    for (std::size_t x = kind.columns / 2 - 45; x < kind.columns / 2 + 65; ++x) {
      gray[y * kind.columns + x] = static_cast<std::uint8_t>((x / 22 + y / 25 * 7 + layer * 11) * 37);
    }
  }
  return gray;
}

LayerSource job(const Kind& kind) {
  LayerSource source;
  source.identity = "blocks";
  source.frame.columns = kind.columns;
  source.frame.rows = kind.rows;
  source.frame.led_amplitude = 230;
  for (std::size_t i = 0; i < kind.layers; ++i) {
    source.frame.layers.push_back({{}, exposure_s, Length::from_um(18.0 * double(i + 1))});
  }
  source.read = [kind](std::size_t index) { return slice(kind, index); };
  return source;
}

MachineProfile quick_machine() {
  MachineProfile machine;
  machine.before_exposure_s = machine.after_exposure_s = machine.after_lift_s = 0.001;
  machine.slow_lift_um_per_s = machine.fast_lift_um_per_s = 1e5;
  machine.exposure_tolerance = 0.5;  // a busy machine's jitter against 60 ms
  return machine;
}

MarlinSettings marlin_settings(const test::EmulatedBoard& board) {
  MarlinSettings settings;
  settings.port = board.port();
  return settings;
}

class WholeMachine : public testing::TestWithParam<Kind> {
protected:
  const Kind kind = GetParam();
  // The stage is opened first: where the bus is emulated, so are /dev and /sys.
  test::EmulatedBoard board;
  MarlinStage stage{marlin_settings(board)};
  SteadyClock clock;
  emulator::DeviceModel device{clock, {kind.mirrors, 5, kind.columns, kind.rows}};
  emulator::UsbDevice bus{device};
  test::TemporaryFolder folder;
  LayerSource source = job(kind);
  SessionControl control;

  SessionEnd print(bool resume = false, UncertainPolicy policy = UncertainPolicy::Stop) {
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
  bool shows(const emulator::LightRecord& light, std::size_t layer) const {
    const std::vector<std::uint8_t> gray = slice(kind, layer);
    const std::size_t columns = kind.columns, rows = kind.rows;
    for (std::size_t row = 0; row < rows; ++row) {
      if (!std::equal(gray.begin() + std::ptrdiff_t(row * columns), gray.begin() + std::ptrdiff_t((row + 1) * columns),
                      light.picture.begin() + std::ptrdiff_t((rows - 1 - row) * columns))) {
        return false;
      }
    }
    return true;
  }
};

TEST_P(WholeMachine, PrintsAJobBitForBitWithTheLightInItsWindows) {
  ASSERT_EQ(print(), SessionEnd::Finished);
  const auto log = device.light_log();
  ASSERT_EQ(log.size(), kind.layers);
  for (std::size_t i = 0; i < kind.layers; ++i) {
    EXPECT_TRUE(shows(log[i], i)) << "layer " << i;
    EXPECT_EQ(log[i].current, 230);
    EXPECT_NEAR(in_seconds(log[i].off - log[i].on), exposure_s, 1e-3) << "the device times it";
    expect_at_rest(log[i], 18 * std::int64_t(i + 1));
  }
  EXPECT_FALSE(device.light_is_on());
  EXPECT_TRUE(read_journal(folder / "journal").finished);
}

class WholeMachineInTrouble : public WholeMachine {};

TEST_P(WholeMachineInTrouble, MovesAwayFromAnUnpluggedProjectorAndGoesOn) {
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
  EXPECT_TRUE(shows(log.back(), kind.layers - 1));
  EXPECT_EQ(read_journal(folder / "journal").decided, std::vector<std::size_t>{4});
}

TEST_P(WholeMachineInTrouble, GoesOnAfterTheStageRestarted) {
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
  ASSERT_EQ(log.size(), kind.layers) << "no layer lost or doubled";
  for (std::size_t i = 0; i < kind.layers; ++i) {
    EXPECT_TRUE(shows(log[i], i)) << "layer " << i;
    expect_at_rest(log[i], 18 * std::int64_t(i + 1));
  }
}

// Over the emulated bus a layer of the DLP9000 takes 1.5 s, most of it reports on their way to the emulator's thread.
INSTANTIATE_TEST_SUITE_P(Dlp6500, WholeMachine, testing::Values(Kind{1, 1920, 1080, 20}));
INSTANTIATE_TEST_SUITE_P(Dlp9000, WholeMachine, testing::Values(Kind{2, 2560, 1600, 5}));
INSTANTIATE_TEST_SUITE_P(Dlp6500, WholeMachineInTrouble, testing::Values(Kind{1, 1920, 1080, 7}));

}  // namespace
}  // namespace mezzotint

#endif
