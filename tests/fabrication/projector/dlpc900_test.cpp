#include "fabrication/projector/dlpc900.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/fabrication/projector/emulated_transport.h"
#include "tests/fabrication/projector/emulated_window.h"

namespace mezzotint {
namespace {

using emulator::Fault;
using std::chrono::milliseconds;
using Way = Dlpc900Options::Way;

/// The smaller of the two projectors, so that pictures are cheap; the pair of controllers has tests of its own.
class Dlpc900Test : public testing::TestWithParam<Way> {
protected:
  static constexpr std::size_t columns = 1920, rows = 1080;
  VirtualClock clock;
  emulator::DeviceModel device{clock, {.mirrors = 1, .columns = columns, .rows = rows}};
  std::vector<std::uint8_t> gray = std::vector<std::uint8_t>(columns * rows, 0);
  std::unique_ptr<LightEngine> engine;
  const Clock::Duration exposure = std::chrono::seconds(3);

  void SetUp() override {
    for (std::size_t y = 200; y < 500; ++y) {
      for (std::size_t x = 300; x < 900; ++x)
        gray[y * columns + x] = static_cast<std::uint8_t>(43 + (x / 50 * y) % 213);
    }
    connect();
  }
  void connect(Dlpc900Options options = {}) {
    engine.reset();
    options.way = GetParam();
    engine = make_dlpc900(std::make_unique<EmulatedTransport>(device, clock), clock, options,
                          std::make_unique<EmulatedWindow>(device, columns, rows));
  }
  [[nodiscard]] ShownPicture picture() const { return {columns, rows, gray}; }
  void show() {
    engine->prepare({});
    engine->show(picture(), exposure);
  }
  static bool always() { return true; }

  template <typename Work>
  LightFault fault_of(const Work& work) {
    try {
      work();
    } catch (const ExposureError& error) {
      exposure_error.emplace(error);
      return error.fault();
    } catch (const LightEngineError& error) {
      return error.fault();
    }
    ADD_FAILURE() << "nothing was thrown";
    return {};
  }
  LightFault fault_of_exposure() {
    return fault_of([&] { static_cast<void>(engine->expose(always)); });
  }
  /// The true light of the last record lies within what the error says.
  void expect_bounds_hold() {
    ASSERT_TRUE(exposure_error);
    const auto log = device.light_log();
    const auto lit = log.empty() ? Clock::Duration(0) : log.back().off - log.back().on;
    EXPECT_LE(exposure_error->least_lit(), lit);
    EXPECT_GE(exposure_error->most_lit(), lit);
  }
  std::optional<ExposureError> exposure_error;
};

TEST_P(Dlpc900Test, TellsWhatItIs) {
  EXPECT_EQ(engine->identity().model, "DLP6500 (DLPC900)");
  EXPECT_EQ(engine->identity().firmware, "5.1.2");
  EXPECT_EQ(engine->identity().tag, "Emulated projector");
  EXPECT_EQ(engine->identity().columns, columns);
}

TEST_P(Dlpc900Test, LightsTheVeryPictureForItsTimeAndNeverElse) {
  show();
  EXPECT_TRUE(device.light_log().empty()) << "dark until it is exposed";
  const auto before = clock.now();
  const auto report = engine->expose(always);
  const auto log = device.light_log();
  ASSERT_EQ(log.size(), 1U);
  EXPECT_EQ(log[0].picture, gray);
  EXPECT_EQ(log[0].current, 230);
  EXPECT_TRUE(report.complete);
  const auto lit = log[0].off - log[0].on;
  EXPECT_LE(std::abs((lit - report.lit).count()), report.uncertainty.count() + 1);
  EXPECT_LE(std::abs((lit - exposure).count()), 2'000'000) << "two commands of a millisecond";
  EXPECT_GE(log[0].on, before);
  EXPECT_FALSE(device.light_is_on());
}

TEST_P(Dlpc900Test, WaitsForAProjectorThatHasJustGoneToStandby) {
  engine.reset();
  device.stand_by();
  const auto begin = clock.now();
  connect();
  EXPECT_NEAR(in_seconds(clock.now() - begin), 123.0, 3.0);
  show();
  static_cast<void>(engine->expose(always));
  EXPECT_EQ(device.light_log().back().picture, gray);
}

TEST_P(Dlpc900Test, APictureIsLitOnce) {
  show();
  static_cast<void>(engine->expose(always));
  EXPECT_THROW(static_cast<void>(engine->expose(always)), InvalidInput);
  engine->show(picture(), exposure);
  static_cast<void>(engine->expose(always));
  EXPECT_EQ(device.light_log().size(), 2U);
}

TEST_P(Dlpc900Test, RefusesWhatCannotBeShown) {
  EXPECT_THROW(engine->show(picture(), exposure), InvalidInput) << "not prepared";
  engine->prepare({});
  EXPECT_THROW(engine->show({columns, rows - 1, gray}, exposure), InvalidInput);
  EXPECT_THROW(engine->show(picture(), Clock::Duration(0)), InvalidInput);
  EXPECT_THROW(engine->prepare({.led_amplitude = 256}), InvalidInput);
  EXPECT_TRUE(device.light_log().empty());
}

TEST_P(Dlpc900Test, StopsWhenItIsTold) {
  show();
  const auto begin = clock.now();
  const auto report = engine->expose([&] { return clock.now() - begin < milliseconds(1000); });
  EXPECT_FALSE(report.complete);
  const auto log = device.light_log();
  ASSERT_EQ(log.size(), 1U);
  EXPECT_LT(in_seconds(log[0].off - log[0].on), 1.3);
  EXPECT_LE(std::abs((log[0].off - log[0].on - report.lit).count()), report.uncertainty.count() + 1);
  EXPECT_FALSE(device.light_is_on());
}

TEST_P(Dlpc900Test, IsDarkAfterAnExceptionOfTheCaller) {
  show();
  EXPECT_THROW(static_cast<void>(engine->expose([]() -> bool { throw std::runtime_error("stage"); })),
               std::runtime_error);
  EXPECT_FALSE(device.light_is_on());
  EXPECT_EQ(device.register_value(0x0b01), (emulator::Bytes{0, 0, 0})) << "no current either";
}

TEST_P(Dlpc900Test, IsDarkWhenItIsLetGo) {
  show();
  device.script({Fault::IgnoreWrite, 0x1a07, 2});
  engine.reset();
  EXPECT_FALSE(device.light_is_on());
  EXPECT_EQ(device.register_value(0x1a07), emulator::Bytes{0});
  EXPECT_EQ(device.register_value(0x0b01), (emulator::Bytes{0, 0, 0}));
}

TEST_P(Dlpc900Test, AnIgnoredCurrentIsFound) {
  device.script({Fault::IgnoreWrite, 0x0b01, 1});
  device.script({Fault::IgnoreWrite, 0x0b01, 3});
  EXPECT_EQ(fault_of([&] { engine->prepare({}); }), LightFault::IgnoredSetting);
}

TEST_P(Dlpc900Test, AResetBetweenLayersIsFound) {
  show();
  static_cast<void>(engine->expose(always));
  device.power_cycle();
  EXPECT_EQ(fault_of([&] { engine->show(picture(), exposure); }), LightFault::IgnoredSetting);
  show();  // prepared again, it goes on
  static_cast<void>(engine->expose(always));
  EXPECT_EQ(device.light_log().back().picture, gray);
  EXPECT_EQ(device.light_log().back().current, 230);
}

TEST_P(Dlpc900Test, ASequencerErrorEndsTheExposure) {
  for (const Fault fault : {Fault::SequencerError, Fault::SequencerAbort}) {
    show();
    device.script({fault, 0x1a0a, 4});
    EXPECT_EQ(fault_of_exposure(), LightFault::Sequencer);
    EXPECT_FALSE(device.light_is_on());
    EXPECT_TRUE(exposure_error->light_is_off());
    expect_bounds_hold();
    EXPECT_EQ(engine->status().faults, std::vector{LightFault::Sequencer});
    device.heal_sequencer();
  }
}

TEST_P(Dlpc900Test, APulledCableInAnExposureIsTold) {
  show();
  device.script({Fault::Unplug, 0x1a0c, 4});
  EXPECT_EQ(fault_of_exposure(), LightFault::Disconnected);
  EXPECT_FALSE(exposure_error->light_is_off());
  EXPECT_GT(in_seconds(exposure_error->least_lit()), 0.3);
  engine.reset();
  clock.sleep_for(std::chrono::seconds(10));
  // The light that the host gates stays on: that is why the platform has to move. The device's own time ends.
  EXPECT_EQ(device.light_is_on(), GetParam() == Way::Video);
  device.plug(true);
  connect();
  EXPECT_FALSE(device.light_is_on()) << "connecting puts it off";
  show();
  static_cast<void>(engine->expose(always));
  EXPECT_EQ(device.light_log().back().picture, gray);
}

TEST_P(Dlpc900Test, ALostAcknowledgementOfLightIsResolvedByReadingBack) {
  show();
  device.script({Fault::DropReply, 0x1a07, 1});
  const auto report = engine->expose(always);
  const auto log = device.light_log();
  ASSERT_EQ(log.size(), 1U);
  EXPECT_LE(std::abs((log[0].off - log[0].on - report.lit).count()), report.uncertainty.count() + 1);
}

TEST_P(Dlpc900Test, AnOrderToGoDarkThatIsIgnoredIsGivenAgain) {
  show();
  device.script({Fault::IgnoreWrite, 0x1a07, 3});  // on, its reading back, off
  static_cast<void>(engine->expose(always));
  EXPECT_FALSE(device.light_is_on());
}

TEST_P(Dlpc900Test, LightThatDoesNotComeOnIsNoExposure) {
  show();
  for (int i = 0; i < 3; ++i) device.script({Fault::IgnoreWrite, 0x1a07, 1 + i * 2});
  EXPECT_EQ(fault_of_exposure(), LightFault::IgnoredSetting);
  EXPECT_TRUE(device.light_log().empty());
  EXPECT_EQ(exposure_error->least_lit().count(), 0);
  EXPECT_TRUE(exposure_error->light_is_off());
}

TEST_P(Dlpc900Test, LostStatusAnswersDoNotLengthenTheLight) {
  show();
  for (int i = 0; i < 4; ++i) device.script({Fault::DropReply, 0x1a0c, 2 + i});
  const auto report = engine->expose(always);
  const auto log = device.light_log();
  EXPECT_TRUE(report.complete);
  EXPECT_LE(std::abs((log[0].off - log[0].on - exposure).count()), 2'000'000);
}

TEST_P(Dlpc900Test, StatusSaysWhatTheDeviceSays) {
  show();
  EXPECT_FALSE(engine->status().light_on);
  bool seen = false;
  static_cast<void>(engine->expose([&] { return seen = engine->status().light_on || seen, true; }));
  EXPECT_TRUE(seen);
  EXPECT_FALSE(engine->status().light_on);
  EXPECT_TRUE(engine->status().ready);
}

INSTANTIATE_TEST_SUITE_P(Ways, Dlpc900Test, testing::Values(Way::Video, Way::Upload),
                         [](const auto& instance) { return instance.param == Way::Video ? "Video" : "Upload"; });

using Dlpc900Video = Dlpc900Test;
INSTANTIATE_TEST_SUITE_P(Video, Dlpc900Video, testing::Values(Way::Video));

TEST_P(Dlpc900Video, LostSyncPutsTheLightOffWithinAPoll) {
  show();
  device.script({Fault::SyncLost, 0x1a0c, 3});
  EXPECT_EQ(fault_of_exposure(), LightFault::LostSync);
  EXPECT_FALSE(device.light_is_on());
  expect_bounds_hold();
  EXPECT_EQ(fault_of([&] { show(); }), LightFault::LostSync);
  device.lock_video(true);
  show();
  EXPECT_NO_THROW(static_cast<void>(engine->expose(always)));
}

TEST_P(Dlpc900Video, RefusesAWindowOfAnotherSize) {
  const auto make = [&] {
    return make_dlpc900(std::make_unique<EmulatedTransport>(device, clock), clock, {},
                        std::make_unique<EmulatedWindow>(device, columns, rows - 1));
  };
  EXPECT_EQ(fault_of([&] { static_cast<void>(make()); }), LightFault::Incompatible);
}

TEST_P(Dlpc900Video, PlainVideoWorksToo) {
  connect({.video_by_sequencer = false});
  show();
  static_cast<void>(engine->expose(always));
  EXPECT_EQ(device.light_log().back().picture, gray);
}

using Dlpc900Upload = Dlpc900Test;
INSTANTIATE_TEST_SUITE_P(Upload, Dlpc900Upload, testing::Values(Way::Upload));

TEST_P(Dlpc900Upload, TakesAtLeastItsEstimate) {
  engine->prepare({});
  const auto estimate = engine->estimate(picture());
  const auto begin = clock.now();
  engine->show(picture(), exposure);
  EXPECT_GE(clock.now() - begin, estimate.duration);
  EXPECT_LE(clock.now() - begin, estimate.duration * 11 / 10 + milliseconds(100));
}

TEST_P(Dlpc900Upload, RefusesNoiseUnlessForced) {
  std::uint32_t state = 1;
  for (auto& value : gray) value = static_cast<std::uint8_t>((state = state * 1664525U + 1013904223U) >> 24);
  engine->prepare({});
  EXPECT_GT(in_seconds(engine->estimate(picture()).duration), 3.0 * columns * rows / 64e3);
  EXPECT_THROW(engine->show(picture(), exposure), InvalidInput);
  connect({.force_upload = true});
  show();
  static_cast<void>(engine->expose(always));
  EXPECT_EQ(device.light_log().back().picture, gray);
}

TEST_P(Dlpc900Upload, AnExposureLongerThanTheTableHasRoomFor) {
  engine->prepare({});
  engine->show(picture(), std::chrono::seconds(40));
  static_cast<void>(engine->expose(always));
  EXPECT_NEAR(in_seconds(device.light_log()[0].off - device.light_log()[0].on), 40.0, 1e-5);
}

TEST_P(Dlpc900Upload, ASequenceThatEndsEarlyOrRunsOnIsFound) {
  for (const Fault fault : {Fault::SequenceEndsEarly, Fault::SequenceRunsOn}) {
    show();
    device.script({fault, 0x1a0a, 3});
    EXPECT_EQ(fault_of_exposure(), LightFault::Sequencer);
    EXPECT_FALSE(device.light_is_on());
  }
}

TEST_P(Dlpc900Upload, AStartIsNeverGivenTwice) {
  show();
  device.script({Fault::DropReply, 0x1a24});
  EXPECT_NO_THROW(static_cast<void>(engine->expose(always))) << "it runs, so it was heard";
  EXPECT_EQ(device.light_log().size(), 1U);
  show();
  device.script({Fault::DropCommand, 0x1a24});
  EXPECT_EQ(fault_of_exposure(), LightFault::Timeout);
  EXPECT_EQ(device.light_log().size(), 1U) << "never lit";
}

TEST_P(Dlpc900Upload, ALostPieceOfAnImageIsLoadedAnew) {
  engine->prepare({});
  device.script({Fault::DropCommand, 0x1a2b, 5});
  engine->show(picture(), exposure);
  static_cast<void>(engine->expose(always));
  EXPECT_EQ(device.light_log().back().picture, gray);
}

TEST_P(Dlpc900Upload, APulledCableInAnUploadIsTold) {
  engine->prepare({});
  device.script({Fault::Unplug, 0x1a2b, 5});
  EXPECT_EQ(fault_of([&] { engine->show(picture(), exposure); }), LightFault::Disconnected);
  device.plug(true);
  connect();
  show();
  static_cast<void>(engine->expose(always));
  EXPECT_EQ(device.light_log().size(), 1U);
}

TEST_P(Dlpc900Upload, EveryFirmwareShowsTheLayerOnce) {
  for (const std::uint8_t major : std::initializer_list<std::uint8_t>{4, 5, 6}) {
    emulator::DeviceModel other{clock, {.mirrors = 1, .firmware_major = major, .columns = columns, .rows = rows}};
    auto its = make_dlpc900(std::make_unique<EmulatedTransport>(other, clock), clock, {.way = Way::Upload});
    its->prepare({});
    its->show(picture(), std::chrono::seconds(20));
    static_cast<void>(its->expose(always));
    ASSERT_EQ(other.light_log().size(), 1U);
    EXPECT_NEAR(in_seconds(other.light_log()[0].off - other.light_log()[0].on), 20.0, 1e-5);
  }
}

TEST(Dlpc900Pair, BothHalvesReachTheirControllers) {
  constexpr std::size_t columns = 2560, rows = 1600;
  VirtualClock clock;
  emulator::DeviceModel device{clock};
  auto engine = make_dlpc900(std::make_unique<EmulatedTransport>(device, clock), clock, {.way = Way::Upload});
  std::vector<std::uint8_t> gray(columns * rows);
  for (std::size_t i = 0; i < gray.size(); ++i)
    gray[i] = static_cast<std::uint8_t>(i % columns / 160 * 16 + i / columns / 400);
  engine->prepare({.led_amplitude = 200, .flip_columns = true});
  engine->show({columns, rows, gray}, std::chrono::seconds(1));
  static_cast<void>(engine->expose([] { return true; }));
  ASSERT_EQ(device.light_log().size(), 1U);
  const auto picture = device.light_log()[0].picture;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < gray.size(); ++i)
    wrong += picture[i] != gray[i - i % columns + columns - 1 - i % columns];
  EXPECT_EQ(wrong, 0U) << "mirrored left to right";
  EXPECT_EQ(device.light_log()[0].current, 200);
  engine->prepare({.flip_rows = true});
  engine->show({columns, rows, gray}, std::chrono::seconds(1));
  static_cast<void>(engine->expose([] { return true; }));
  wrong = 0;
  const auto second = device.light_log()[1].picture;
  for (std::size_t i = 0; i < gray.size(); ++i)
    wrong += second[i] != gray[(rows - 1 - i / columns) * columns + i % columns];
  EXPECT_EQ(wrong, 0U) << "mirrored top to bottom";
}

TEST(Dlpc900Pair, AMissingSecondaryControllerIsRefused) {
  VirtualClock clock;
  emulator::DeviceModel device{clock};
  device.script({Fault::SecondaryMissing});
  try {
    static_cast<void>(make_dlpc900(std::make_unique<EmulatedTransport>(device, clock), clock, {.way = Way::Upload}));
    FAIL();
  } catch (const LightEngineError& error) {
    EXPECT_EQ(error.fault(), LightFault::MissingSecondary);
  }
}

TEST(Dlpc900Pair, OtherMirrorsAreRefused) {
  VirtualClock clock;
  emulator::DeviceModel device{clock, {.mirrors = 3, .columns = 2716, .rows = 1600}};
  EXPECT_THROW(
      static_cast<void>(make_dlpc900(std::make_unique<EmulatedTransport>(device, clock), clock, {.way = Way::Upload})),
      LightEngineError);
}

}  // namespace
}  // namespace mezzotint
