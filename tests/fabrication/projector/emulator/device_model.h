#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "fabrication/device/clock.h"
#include "tests/fabrication/projector/emulator/image_decoder.h"

namespace mezzotint::emulator {

using Bytes = std::vector<std::uint8_t>;

enum class Fault {
  Nack,            ///< refused with `value` as code
  DropCommand,     ///< lost on its way: neither done nor answered
  DropReply,       ///< done, not answered
  LateReply,       ///< done; the answer comes before the next one
  StaleReply,      ///< an answer with the previous number comes first
  ShortReply,      ///< three bytes
  ZeroLength,      ///< an answer without data
  OverLong,        ///< claims 200 bytes
  StallReply,      ///< the endpoint stalls, then gives the answer
  IgnoreWrite,     ///< acknowledged, not done
  Unplug,          ///< the cable is pulled before the command is done; the device goes on by itself
  Reset,           ///< back to its defaults before the command is done
  SequencerError,  ///< the sequencer fails before the command is done
  SequencerAbort,
  SequenceEndsEarly,  ///< stops without a word
  SequenceRunsOn,     ///< never ends
  SecondaryMissing,
  SyncLost
};

/// At the n-th message from now on (of one command, or of any).
struct ScriptedFault {
  Fault fault = Fault::Nack;
  std::optional<std::uint16_t> command;
  int nth = 1;
  std::uint8_t value = 6;
};

/// The light was on, and this is what the mirrors showed when it came on.
struct LightRecord {
  Clock::Duration on{0}, off{0};
  std::uint8_t current = 0;
  Bytes picture;  ///< rows × columns; what a missing image leaves is 0x55
};

/// An emulated DLPC900 with its mirrors: registers, pattern table, image memory of both controllers, sequencer, LED.
/// Written from the protocol sheet; it includes nothing of the driver. Any thread may call it.
class DeviceModel {
public:
  struct Kind {
    std::uint8_t mirrors = 2;  ///< 1 DLP6500, 2 DLP9000
    std::uint8_t firmware_major = 5;
    std::size_t columns = 2560, rows = 1600;
  };
  explicit DeviceModel(Clock& clock) : DeviceModel(clock, Kind{}) {}
  DeviceModel(Clock& clock, Kind kind);

  // The cable.
  /// False: unplugged, or the endpoint stalls for once.
  enum class Taken { Yes, Stalled, Gone };
  Taken receive_report(const Bytes& report);
  /// The next report for the host, if there is one. `Stalled` once where that was scripted.
  Taken next_report(std::optional<Bytes>& report);
  [[nodiscard]] bool plugged();
  void plug(bool in);
  /// Called when a script pulls the cable, with the model's lock held.
  void on_unplug(std::function<void()> told) { told_unplugged_ = std::move(told); }

  // The script.
  void script(const ScriptedFault& fault);
  void stall_out_report(int nth) { stall_out_in_ = nth; }
  [[nodiscard]] std::size_t faults_left();
  void power_cycle();
  void stand_by();
  void heal_sequencer();
  void show_video(const Bytes& picture);
  void lock_video(bool locked);

  // What it knows.
  [[nodiscard]] std::vector<LightRecord> light_log();
  [[nodiscard]] bool light_is_on();
  [[nodiscard]] Bytes register_value(std::uint16_t command);
  [[nodiscard]] std::vector<std::uint16_t> commands_seen();

private:
  struct Answer {
    std::uint8_t error = 0;  ///< 0: done
    Bytes data;
  };
  struct Entry {
    std::uint32_t exposure_us = 0, dark_us = 0;
    unsigned leds = 0, image = 0, bit = 0;
  };
  struct Loading {
    unsigned index = 0;
    std::size_t total = 0;
    Bytes bytes;
    bool active = false;
  };

  void defaults();
  void handle(const Bytes& message);
  [[nodiscard]] std::optional<ScriptedFault> due_fault(std::uint16_t command);
  /// False: the message goes no further.
  bool disturb(const ScriptedFault& fault, std::uint16_t command);
  void reply(std::uint8_t flags, std::uint8_t sequence, const Answer& answer, std::optional<Fault> fault);
  void send(const Bytes& bytes);
  [[nodiscard]] Answer read(std::uint16_t command);
  [[nodiscard]] std::uint8_t write(std::uint16_t command, const Bytes& data);
  [[nodiscard]] std::uint8_t write_mode(std::uint8_t mode);
  [[nodiscard]] std::uint8_t write_entry(const Bytes& data);
  [[nodiscard]] std::uint8_t write_table(const Bytes& data);
  [[nodiscard]] std::uint8_t start_or_stop(std::uint8_t action);
  [[nodiscard]] std::uint8_t start_image(std::size_t controller, const Bytes& data);
  [[nodiscard]] std::uint8_t load_image(std::size_t controller, const Bytes& data);
  [[nodiscard]] std::uint8_t hardware_byte() const;
  [[nodiscard]] std::uint8_t status_byte() const;
  [[nodiscard]] std::size_t controllers() const { return kind_.mirrors == 2 ? 2 : 1; }
  [[nodiscard]] std::uint8_t mode() const { return registers_.at(0x1a1b)[0]; }
  [[nodiscard]] bool lit() const;
  [[nodiscard]] Bytes mirrors() const;
  void advance();
  void stop_sequence(Clock::Duration at);
  void update_light(Clock::Duration at);

  std::recursive_mutex mutex_;
  Clock& clock_;
  Kind kind_;
  bool plugged_ = true;
  std::function<void()> told_unplugged_;

  std::map<std::uint16_t, Bytes> registers_;
  std::map<std::size_t, Entry> entries_;
  bool table_is_current_ = false;
  std::array<std::map<unsigned, DecodedImage>, 2> memory_;
  std::array<Loading, 2> loading_;
  bool runs_ = false;
  std::optional<Clock::Duration> sequence_end_;
  Clock::Duration mode_settles_{0}, parked_at_{0};
  std::uint8_t mode_before_ = 1;
  bool sequencer_error_ = false, sequencer_abort_ = false, secondary_ = true, locked_ = true;
  bool runs_on_ = false;
  std::uint8_t last_error_ = 0;
  Bytes video_;

  Bytes message_;
  std::size_t expected_ = 0;
  std::deque<Bytes> outgoing_;
  std::optional<Bytes> late_;
  bool stall_in_ = false;
  int stall_out_in_ = 0;
  std::vector<ScriptedFault> faults_;
  std::vector<LightRecord> log_;
  bool light_is_on_ = false;
  std::vector<std::uint16_t> seen_;
};

}  // namespace mezzotint::emulator
