#include <gtest/gtest.h>

#include <random>

#include "fabrication/projector/dlpc900_link.h"
#include "tests/fabrication/projector/emulated_transport.h"

namespace mezzotint::dlpc900 {
namespace {

using emulator::Fault;

/// The fault table, row by row, on the wire: what the host makes of it.
class LinkFaults : public testing::Test {
protected:
  VirtualClock clock;
  emulator::DeviceModel device{clock};
  Link link{std::make_unique<EmulatedTransport>(device, clock), clock};

  template <typename Work>
  LightFault fault_of(const Work& work) {
    try {
      work();
    } catch (const LightEngineError& error) {
      message = error.what();
      code = error.device_code();
      return error.fault();
    }
    ADD_FAILURE() << "nothing was thrown";
    return {};
  }
  void read_polarity() { static_cast<void>(link.read(Command::LedPolarity, 1)); }

  std::string message;
  std::optional<int> code;
};

TEST_F(LinkFaults, NoneAtAll) {
  EXPECT_EQ(link.read(Command::LedCurrents, 3), (std::vector<std::uint8_t>{0x97, 0x78, 0x7d}));
  link.set(Command::LedCurrents, {230, 230, 230});
  EXPECT_EQ(device.register_value(0x0b01), (emulator::Bytes{230, 230, 230}));
}

TEST_F(LinkFaults, ALongAnswerComesInSeveralReports) {
  const auto text = link.read(Command::ErrorText, 128);
  EXPECT_EQ(std::string(text.begin(), text.begin() + 16), "emulated error 0");
}

TEST_F(LinkFaults, RefusalTellsCodeAndText) {
  device.script({Fault::Nack, 0x1a24, 1, 14});
  EXPECT_EQ(fault_of([&] { link.order(Command::Sequence, {2}); }), LightFault::Refused);
  EXPECT_EQ(code, 14);
  EXPECT_NE(message.find("code 14, exposure out of range (\"emulated error 14\")"), std::string::npos) << message;
}

TEST_F(LinkFaults, RefusalOfTheQuestionForTheReasonIsBorne) {
  device.script({Fault::Nack, 0x1a24});
  device.script({Fault::Nack, 0x0100, 1, 3});
  device.script({Fault::Nack, 0x0101, 1, 3});
  EXPECT_EQ(fault_of([&] { link.order(Command::Sequence, {2}); }), LightFault::Refused);
  EXPECT_FALSE(code);
}

TEST_F(LinkFaults, AReadIsAskedAgain) {
  device.script({Fault::DropReply, 0x1a05, 1});
  device.script({Fault::DropCommand, 0x1a05, 2});
  read_polarity();
  EXPECT_EQ(device.commands_seen().size(), 3U);
}

TEST_F(LinkFaults, ASilentDeviceIsATimeoutAfterThreeQuestions) {
  for (int i = 0; i < 3; ++i) device.script({Fault::DropReply, 0x1a05, 1 + i});
  EXPECT_EQ(fault_of([&] { read_polarity(); }), LightFault::Timeout);
  EXPECT_EQ(device.commands_seen().size(), 3U);
  EXPECT_NEAR(in_seconds(clock.now()), 1.5, 0.01);
}

TEST_F(LinkFaults, AnOrderIsNotGivenTwice) {
  device.script({Fault::DropReply, 0x1a24});
  EXPECT_EQ(fault_of([&] { link.order(Command::Sequence, {0}); }), LightFault::Timeout);
  EXPECT_EQ(device.commands_seen().size(), 1U);
}

TEST_F(LinkFaults, ASettingWhoseAnswerIsLostIsReadBack) {
  device.script({Fault::DropReply, 0x0b01});
  link.set(Command::LedCurrents, {1, 2, 3});
  EXPECT_EQ(device.commands_seen(), (std::vector<std::uint16_t>{0x0b01, 0x0b01})) << "an order and a question";
}

TEST_F(LinkFaults, ASettingThatIsLostIsGivenAgain) {
  device.script({Fault::DropCommand, 0x0b01});
  link.set(Command::LedCurrents, {1, 2, 3});
  EXPECT_EQ(device.register_value(0x0b01), (emulator::Bytes{1, 2, 3}));
}

TEST_F(LinkFaults, ALateAnswerIsDroppedAndTheRightOneTaken) {
  device.script({Fault::LateReply, 0x0b01});
  EXPECT_EQ(link.read(Command::LedCurrents, 3), (std::vector<std::uint8_t>{0x97, 0x78, 0x7d}));
  device.script({Fault::LateReply, 0x0b01, 1});
  link.set(Command::LedCurrents, {9, 9, 9});
  EXPECT_EQ(link.read(Command::LedPolarity, 1), (std::vector<std::uint8_t>{0}));
}

TEST_F(LinkFaults, AStaleAnswerIsDropped) {
  device.script({Fault::StaleReply, 0x0b01});
  EXPECT_EQ(link.read(Command::LedCurrents, 3), (std::vector<std::uint8_t>{0x97, 0x78, 0x7d}));
}

TEST_F(LinkFaults, AStaleAnswerAloneIsATimeout) {
  device.script({Fault::StaleReply, 0x1a05});
  static_cast<void>(link.read_before(Command::LedPolarity, 1, clock.now() + std::chrono::milliseconds(50)));
  device.script({Fault::LateReply, 0x1a05});
  const auto read_once = [&] {
    static_cast<void>(link.read_before(Command::LedPolarity, 1, clock.now() + std::chrono::milliseconds(50)));
  };
  EXPECT_EQ(fault_of(read_once), LightFault::Timeout);
}

TEST_F(LinkFaults, WhatAnotherProgramLeftIsDrained) {
  for (int i = 0; i < 3; ++i) {
    auto question = encode_message({.read = true, .sequence = 1, .command = 0x0b01})[0];
    static_cast<void>(device.receive_report({question.begin(), question.end()}));
  }
  link.drain();
  EXPECT_EQ(link.read(Command::LedPolarity, 1), (std::vector<std::uint8_t>{0}));
}

TEST_F(LinkFaults, ShortEmptyAndOverLongAnswersAreProtocolErrors) {
  for (const Fault fault : {Fault::ShortReply, Fault::ZeroLength, Fault::OverLong}) {
    device.script({fault, 0x1a05});
    EXPECT_EQ(fault_of([&] { read_polarity(); }), LightFault::Protocol) << message;
    read_polarity();  // and the next is right again
  }
}

TEST_F(LinkFaults, AStallIsClearedAndTriedAgain) {
  device.script({Fault::StallReply, 0x1a05});
  read_polarity();
  device.stall_out_report(1);
  read_polarity();
}

TEST_F(LinkFaults, APulledCableIsTold) {
  device.script({Fault::Unplug, 0x1a05});
  EXPECT_EQ(fault_of([&] { read_polarity(); }), LightFault::Disconnected);
  EXPECT_EQ(fault_of([&] { read_polarity(); }), LightFault::Disconnected);
}

TEST_F(LinkFaults, AnIgnoredSettingIsFound) {
  device.script({Fault::IgnoreWrite, 0x0b01});
  EXPECT_NO_THROW(link.set(Command::LedCurrents, {1, 2, 3})) << "the second order is heard";
  device.script({Fault::IgnoreWrite, 0x0b01, 1});
  device.script({Fault::IgnoreWrite, 0x0b01, 3});
  EXPECT_EQ(fault_of([&] { link.set(Command::LedCurrents, {4, 5, 6}); }), LightFault::IgnoredSetting);
  EXPECT_NE(message.find("01 02 03"), std::string::npos) << message;
}

/// Says anything at all, most of it nearly right.
class Babble final : public ReportTransport {
public:
  Babble(unsigned seed, Clock& clock) : random_(seed), clock_(clock) {}
  void send(const Report& report, Clock::Duration) override { sequence_ = report[1]; }
  std::optional<ReceivedReport> receive(Clock::Duration timeout) override {
    clock_.sleep_for(std::min<Clock::Duration>(timeout, std::chrono::milliseconds(1)));
    if (random_() % 8 == 0) return {};
    ReceivedReport report;
    report.size = random_() % 4 == 0 ? random_() % (report_bytes + 1) : report_bytes;
    for (auto& byte : report.bytes) byte = static_cast<std::uint8_t>(random_());
    if (random_() % 2 == 0) report.bytes[1] = sequence_;
    if (random_() % 2 == 0) report.bytes[2] = static_cast<std::uint8_t>(random_() % 140), report.bytes[3] = 0;
    return report;
  }

private:
  std::mt19937 random_;
  Clock& clock_;
  std::uint8_t sequence_ = 0;
};

TEST(Link, ThatHearsAnythingReadsWhatItAskedForOrThrows) {
  VirtualClock clock;
  int answered = 0, refused = 0;
  for (unsigned seed = 0; seed < 2000; ++seed) {
    Link link(std::make_unique<Babble>(seed, clock), clock);
    const std::size_t bytes = seed % 3 == 0 ? 128 : 1;
    try {
      EXPECT_EQ(link.read(bytes == 1 ? Command::LedPolarity : Command::ErrorText, bytes).size(), bytes);
      ++answered;
    } catch (const LightEngineError&) {
      ++refused;
    }
  }
  EXPECT_GT(answered, 0);
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace mezzotint::dlpc900
