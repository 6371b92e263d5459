#include <gtest/gtest.h>

#ifndef MEZZOTINT_HAS_UMOCKDEV

TEST(Usb, OfTheProjector) { GTEST_SKIP() << "umockdev (Debian: libumockdev-dev) is missing, or sanitizers forbid it"; }

#else

#include "fabrication/projector/dlpc900.h"
#include "fabrication/projector/usb_transport.h"
#include "tests/fabrication/projector/emulated_window.h"
#include "tests/fabrication/projector/emulator/usb_device.h"

namespace mezzotint {
namespace {

using emulator::Fault;
using std::chrono::milliseconds;

constexpr std::size_t columns = 2560, rows = 1600;

/// Unmodified libusb against the emulated device, in real time.
class Usb : public testing::Test {
protected:
  SteadyClock clock;
  emulator::DeviceModel device{clock};
  std::vector<std::uint8_t> gray = std::vector<std::uint8_t>(columns * rows, 0);

  std::unique_ptr<LightEngine> connect() {
    return make_dlpc900(dlpc900::open_usb(), clock, {.way = Dlpc900Options::Way::Upload});
  }
  [[nodiscard]] ShownPicture picture() const { return {columns, rows, gray}; }
  /// Blocks of gray across the border between the controllers.
  void draw(unsigned seed) {
    for (std::size_t i = 0; i < gray.size(); ++i) {
      const std::size_t x = i % columns, y = i / columns;
      const bool inside = x > 1100 && x < 1460 && y > 600 && y < 1000;
      gray[i] = inside ? static_cast<std::uint8_t>((x / 40 + y / 50 * 7 + seed) * 37) : std::uint8_t{0};
    }
  }
  template <typename Work>
  static LightFault fault_of(const Work& work) {
    try {
      work();
    } catch (const LightEngineError& error) {
      return error.fault();
    }
    ADD_FAILURE() << "nothing was thrown";
    return {};
  }
};

TEST_F(Usb, FindsTheDeviceAndTellsWhatItIs) {
  emulator::UsbDevice bus(device);
  const auto engine = connect();
  EXPECT_EQ(engine->identity().model, "DLP9000 (DLPC900)");
  EXPECT_EQ(engine->identity().firmware, "5.1.2");
}

TEST_F(Usb, EndpointsAreLookedUp) {
  emulator::UsbDevice bus(device, {.in_endpoint = 0x83, .out_endpoint = 0x05, .has_second_interface = true});
  EXPECT_EQ(connect()->identity().columns, columns);
}

TEST_F(Usb, OtherDescriptorsAreRefused) {
  emulator::UsbDevice bus(device, {.packet_bytes = 8});
  EXPECT_EQ(fault_of([&] { static_cast<void>(connect()); }), LightFault::Incompatible);
}

TEST_F(Usb, NoDeviceIsTold) {
  emulator::UsbDevice bus(device);
  EXPECT_EQ(fault_of([&] { static_cast<void>(dlpc900::open_usb({.place = "001:009"})); }), LightFault::Disconnected);
  EXPECT_NO_THROW(static_cast<void>(dlpc900::open_usb({.place = "001:004"})));
}

TEST_F(Usb, TheKernelsDriverIsGivenBack) {
  emulator::UsbDevice bus(device);
  {
    const auto engine = connect();
    EXPECT_FALSE(bus.kernel_driver_is_bound());
  }
  EXPECT_TRUE(bus.kernel_driver_is_bound());
}

TEST_F(Usb, SettingsAreReadBack) {
  emulator::UsbDevice bus(device);
  const auto engine = connect();
  engine->prepare({.led_amplitude = 77});
  EXPECT_EQ(device.register_value(0x0b01), (emulator::Bytes{77, 77, 77}));
  EXPECT_EQ(device.register_value(0x1a1b), emulator::Bytes{3});
  device.script({Fault::IgnoreWrite, 0x0b01, 1});
  device.script({Fault::IgnoreWrite, 0x0b01, 3});
  EXPECT_EQ(fault_of([&] { engine->prepare({.led_amplitude = 78}); }), LightFault::IgnoredSetting);
}

TEST_F(Usb, LayersAreDecodedBitForBitAndLitForTheirTime) {
  emulator::UsbDevice bus(device);
  const auto engine = connect();
  engine->prepare({});
  std::vector<std::pair<Clock::Duration, Clock::Duration>> windows;
  constexpr int layers = 3;
  for (int layer = 0; layer < layers; ++layer) {
    draw(static_cast<unsigned>(layer));
    engine->show(picture(), milliseconds(200));
    EXPECT_FALSE(device.light_is_on());
    const auto begin = clock.now();
    const auto report = engine->expose([] { return true; });
    windows.emplace_back(begin, clock.now());
    const auto log = device.light_log();
    ASSERT_EQ(log.size(), static_cast<std::size_t>(layer + 1));
    EXPECT_EQ(log.back().picture, gray) << "layer " << layer;
    EXPECT_EQ(log.back().current, 230);
    EXPECT_EQ(log.back().off - log.back().on, milliseconds(200));
    EXPECT_EQ(report.lit, milliseconds(200));
  }
  const auto log = device.light_log();
  for (int i = 0; i < layers; ++i) {
    EXPECT_GE(log[i].on, windows[i].first);
    EXPECT_LE(log[i].off, windows[i].second);
  }
}

TEST_F(Usb, LightIsGatedOverUsbWhileVideoShowsTheLayer) {
  emulator::UsbDevice bus(device);
  const auto engine =
      make_dlpc900(dlpc900::open_usb(), clock, {}, std::make_unique<EmulatedWindow>(device, columns, rows));
  engine->prepare({});
  for (int layer = 0; layer < 3; ++layer) {
    draw(static_cast<unsigned>(layer));
    engine->show(picture(), milliseconds(300));
    const auto begin = clock.now();
    const auto report = engine->expose([] { return true; });
    const auto end = clock.now();
    const auto light = device.light_log().back();
    EXPECT_EQ(light.picture, gray) << "layer " << layer;
    EXPECT_TRUE(begin <= light.on && light.off <= end);
    const auto lit = light.off - light.on;
    EXPECT_LE(std::abs((lit - report.lit).count()), report.uncertainty.count());
    // Late by what the orders and a busy computer took, and no more.
    EXPECT_GE(lit + report.uncertainty, milliseconds(300));
    EXPECT_LE(lit, milliseconds(300) + 2 * report.uncertainty + milliseconds(100));
    RecordProperty("layer_" + std::to_string(layer) + "_late_us", static_cast<int>((lit.count() - 300'000'000) / 1000));
    RecordProperty("layer_" + std::to_string(layer) + "_uncertainty_us",
                   static_cast<int>(report.uncertainty.count() / 1000));
  }
  EXPECT_EQ(device.light_log().size(), 3U);
}

TEST_F(Usb, EveryFaultOfTheWire) {
  emulator::UsbDevice bus(device);
  const auto engine = connect();
  for (const Fault fault :
       {Fault::DropReply, Fault::DropCommand, Fault::LateReply, Fault::StaleReply, Fault::StallReply}) {
    device.script({fault, 0x1a07});
    EXPECT_NO_THROW(static_cast<void>(engine->status())) << static_cast<int>(fault);
  }
  device.stall_out_report(1);
  EXPECT_NO_THROW(static_cast<void>(engine->status()));
  for (const Fault fault : {Fault::ShortReply, Fault::ZeroLength, Fault::OverLong}) {
    device.script({fault, 0x1a07});
    EXPECT_EQ(fault_of([&] { static_cast<void>(engine->status()); }), LightFault::Protocol) << static_cast<int>(fault);
  }
  device.script({Fault::Nack, 0x1a07, 1, 5});
  EXPECT_EQ(fault_of([&] { static_cast<void>(engine->status()); }), LightFault::Refused);
  EXPECT_TRUE(engine->status().ready);
  EXPECT_EQ(device.faults_left(), 0U);
}

TEST_F(Usb, APulledCableInAnExposureAndAgainWithANewOne) {
  emulator::UsbDevice bus(device);
  auto engine = connect();
  draw(1);
  engine->prepare({});
  engine->show(picture(), milliseconds(900));
  device.script({Fault::Unplug, 0x1a0c, 1});
  const auto begin = clock.now();
  EXPECT_EQ(fault_of([&] { static_cast<void>(engine->expose([] { return true; })); }), LightFault::Disconnected);
  EXPECT_LT(clock.now() - begin, milliseconds(600)) << "told at once";
  EXPECT_FALSE(engine->try_light_off());
  engine.reset();
  bus.unplug();
  EXPECT_EQ(fault_of([&] { static_cast<void>(connect()); }), LightFault::Disconnected) << "nothing is there";
  bus.plug();
  engine = connect();
  EXPECT_FALSE(device.light_is_on());
  engine->prepare({});
  engine->show(picture(), milliseconds(50));
  static_cast<void>(engine->expose([] { return true; }));
  EXPECT_EQ(device.light_log().back().picture, gray);
}

TEST_F(Usb, APulledCableInAnUpload) {
  emulator::UsbDevice bus(device);
  const auto engine = connect();
  draw(2);
  engine->prepare({});
  device.script({Fault::Unplug, 0x1a2b, 3});
  EXPECT_EQ(fault_of([&] { engine->show(picture(), milliseconds(50)); }), LightFault::Disconnected);
  EXPECT_TRUE(device.light_log().empty());
}

}  // namespace
}  // namespace mezzotint

#endif
