#include "tests/fabrication/projector/emulator/device_model.h"

#include <algorithm>
#include <string>

namespace mezzotint::emulator {
namespace {

using Lock = std::lock_guard<std::recursive_mutex>;

constexpr std::uint8_t default_image = 0x55;
constexpr std::uint8_t not_in_this_mode = 5, bad_parameter = 6, bad_compression = 9, bad_bit = 10, bad_exposure = 14,
                       bad_pattern_count = 15, bad_pattern = 16, bad_command = 3;

std::uint32_t little(const Bytes& bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = value * 256 + bytes.at(at + i);
  return value;
}

/// Bytes that a plain register takes; 0 for what is none.
std::size_t register_size(std::uint16_t command) {
  switch (command) {
    case 0x0b01:
      return 3;
    case 0x0200:
    case 0x1008:
    case 0x1009:
    case 0x1a00:
    case 0x1a01:
    case 0x1a05:
    case 0x1a07:
    case 0x1a1b:
      return 1;
    case 0x1a31:
      return 6;
    default:
      return 0;
  }
}

}  // namespace

DeviceModel::DeviceModel(Clock& clock, Kind kind) : clock_(clock), kind_(kind) { defaults(); }

void DeviceModel::defaults() {
  registers_ = {{0x0200, {0}}, {0x0b01, {0x97, 0x78, 0x7d}},
                {0x1008, {0}}, {0x1009, {0}},
                {0x1a00, {0}}, {0x1a01, {0}},
                {0x1a05, {0}}, {0x1a07, {8}},
                {0x1a1b, {1}}, {0x1a31, {0, 0, 0, 0, 0, 0}}};
  entries_.clear();
  table_is_current_ = false;
  memory_ = {};
  loading_ = {};
  runs_ = runs_on_ = false;
  sequence_end_.reset();
  mode_settles_ = {};
  sequencer_error_ = sequencer_abort_ = false;
  message_.clear();
  expected_ = 0;
  outgoing_.clear();
  late_.reset();
}

DeviceModel::Taken DeviceModel::receive_report(const Bytes& report) {
  const Lock lock(mutex_);
  if (!plugged_) return Taken::Gone;
  if (stall_out_in_ > 0 && --stall_out_in_ == 0) return Taken::Stalled;
  if (message_.empty()) expected_ = 4 + little(report, 2, 2);
  message_.insert(message_.end(), report.begin(), report.end());
  if (message_.size() < expected_) return Taken::Yes;
  Bytes message(message_.begin(), message_.begin() + static_cast<std::ptrdiff_t>(expected_));
  message_.clear();
  handle(message);
  return plugged_ ? Taken::Yes : Taken::Gone;
}

DeviceModel::Taken DeviceModel::next_report(std::optional<Bytes>& report) {
  const Lock lock(mutex_);
  report.reset();
  if (!plugged_) return Taken::Gone;
  if (outgoing_.empty()) return Taken::Yes;
  if (stall_in_) {
    stall_in_ = false;
    return Taken::Stalled;
  }
  report = outgoing_.front();
  outgoing_.pop_front();
  return Taken::Yes;
}

void DeviceModel::handle(const Bytes& message) {
  advance();
  const std::uint8_t flags = message[0], sequence = message[1];
  const auto command = static_cast<std::uint16_t>(little(message, 4, 2));
  seen_.push_back(command);
  const auto fault = due_fault(command);
  if (fault && !disturb(*fault, command)) return;

  Answer answer;
  if (fault && fault->fault == Fault::Nack) {
    answer.error = fault->value;
  } else if ((flags & 0x80) != 0) {
    answer = read(command);
  } else if (!fault || fault->fault != Fault::IgnoreWrite) {
    answer.error = write(command, Bytes(message.begin() + 6, message.end()));
  }
  update_light(clock_.now());
  if (command != 0x0100 && command != 0x0101) last_error_ = answer.error;
  if ((flags & 0x40) != 0) reply(flags, sequence, answer, fault ? std::optional(fault->fault) : std::nullopt);
}

std::optional<ScriptedFault> DeviceModel::due_fault(std::uint16_t command) {
  std::optional<ScriptedFault> due;
  for (auto it = faults_.begin(); it != faults_.end();) {
    const bool matches = !it->command || *it->command == command;
    if (matches && --it->nth <= 0 && !due) {
      due = *it;
      it = faults_.erase(it);
    } else {
      ++it;
    }
  }
  return due;
}

bool DeviceModel::disturb(const ScriptedFault& fault, std::uint16_t) {
  switch (fault.fault) {
    case Fault::DropCommand:
      return false;
    case Fault::Unplug:
      plugged_ = false;
      outgoing_.clear();
      if (told_unplugged_) told_unplugged_();
      return false;
    case Fault::Reset:
      power_cycle();
      return true;
    case Fault::SequencerError:
    case Fault::SequencerAbort:
      (fault.fault == Fault::SequencerError ? sequencer_error_ : sequencer_abort_) = true;
      stop_sequence(clock_.now());
      return true;
    case Fault::SequenceEndsEarly:
      stop_sequence(clock_.now());
      return true;
    case Fault::SequenceRunsOn:
      runs_on_ = true;
      sequence_end_.reset();
      return true;
    case Fault::SecondaryMissing:
      secondary_ = false;
      return true;
    case Fault::SyncLost:
      locked_ = false;
      return true;
    case Fault::StallReply:
      stall_in_ = true;
      return true;
    default:
      return true;
  }
}

void DeviceModel::reply(std::uint8_t flags, std::uint8_t sequence, const Answer& answer, std::optional<Fault> fault) {
  Bytes bytes = {static_cast<std::uint8_t>(flags | (answer.error != 0 ? 0x20 : 0)), sequence,
                 static_cast<std::uint8_t>(answer.data.size()), static_cast<std::uint8_t>(answer.data.size() >> 8)};
  bytes.insert(bytes.end(), answer.data.begin(), answer.data.end());
  bytes.resize((bytes.size() + 63) / 64 * 64, 0);
  if (fault == Fault::DropReply) return;
  if (fault == Fault::LateReply) {
    late_ = bytes;
    return;
  }
  if (fault == Fault::ZeroLength) bytes[2] = bytes[3] = 0;
  if (fault == Fault::OverLong) bytes[2] = 200;
  if (fault == Fault::ShortReply) bytes.resize(3);
  if (late_) send(*late_);
  late_.reset();
  if (fault == Fault::StaleReply) {
    Bytes stale = bytes;
    --stale[1];
    stale[4] ^= 0xff;
    send(stale);
  }
  send(bytes);
}

void DeviceModel::send(const Bytes& bytes) {
  for (std::size_t at = 0; at < bytes.size(); at += 64) {
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    outgoing_.emplace_back(first, first + static_cast<std::ptrdiff_t>(std::min<std::size_t>(64, bytes.size() - at)));
  }
}

DeviceModel::Answer DeviceModel::read(std::uint16_t command) {
  const auto padded = [](std::string text, std::size_t size) {
    text.resize(size, '\0');
    return Bytes(text.begin(), text.end());
  };
  switch (command) {
    case 0x0100:
      return {0, {last_error_}};
    case 0x0101:
      return {0, padded("emulated error " + std::to_string(last_error_), 128)};
    case 0x0205: {
      Bytes version(16, 0);
      version[3] = kind_.firmware_major;  // the application: patch 2, minor 1
      version[2] = 1;
      version[0] = 2;
      return {0, version};
    }
    case 0x0206: {
      Bytes hardware = padded("?Emulated projector", 33);
      hardware[0] = kind_.mirrors;
      return {0, hardware};
    }
    case 0x1a0a:
      return {0, {hardware_byte()}};
    case 0x1a0c:
      return {0, {status_byte()}};
    case 0x1a1b:
      return {0, {clock_.now() < mode_settles_ ? mode_before_ : mode()}};
    default:
      if (register_size(command) == 0) return {bad_command, {}};
      return {0, registers_.at(command)};
  }
}

std::uint8_t DeviceModel::write(std::uint16_t command, const Bytes& data) {
  if (registers_[0x0200][0] == 1 && command != 0x0200) return not_in_this_mode;
  switch (command) {
    case 0x0200:
      if (data.size() != 1 || data[0] > 1) return bad_parameter;
      // Parking takes two minutes and three seconds, and is not interrupted.
      if (data[0] == 0 && clock_.now() < parked_at_) return not_in_this_mode;
      if (data[0] == 1) parked_at_ = clock_.now() + std::chrono::seconds(123);
      registers_[0x0200] = data;
      return 0;
    case 0x1a1b:
      return data.size() == 1 ? write_mode(data[0]) : bad_parameter;
    case 0x1a24:
      return data.size() == 1 ? start_or_stop(data[0]) : bad_parameter;
    case 0x1a2a:
    case 0x1a2c:
      return start_image(command == 0x1a2a ? 0 : 1, data);
    case 0x1a2b:
    case 0x1a2d:
      return load_image(command == 0x1a2b ? 0 : 1, data);
    case 0x1a31:
      return write_table(data);
    case 0x1a34:
      return write_entry(data);
    case 0x1a3b:
      return kind_.firmware_major >= 6 && data.size() == 2 ? 0 : bad_command;
    default:
      break;
  }
  if (register_size(command) == 0) return bad_command;
  if (data.size() != register_size(command)) return bad_parameter;
  if (command == 0x1008 && controllers() == 2 && data[0] != 0) return bad_command;  // no such flip with a pair
  if (command == 0x1a01 && mode() != 0) return not_in_this_mode;
  if (command == 0x1a00 && mode() != 0 && mode() != 2) return not_in_this_mode;
  registers_[command] = data;
  return 0;
}

std::uint8_t DeviceModel::write_mode(std::uint8_t wanted) {
  if (runs_) return not_in_this_mode;
  if (wanted > 3) return bad_parameter;
  if (wanted == 2 && mode() != 0 && mode() != 2) return not_in_this_mode;
  if (wanted == 2 && !locked_) return not_in_this_mode;
  mode_before_ = mode();
  if (wanted == 2 && mode() != 2) mode_settles_ = clock_.now() + std::chrono::milliseconds(300);
  if (wanted != mode()) table_is_current_ = false;
  registers_[0x1a1b] = {wanted};
  return 0;
}

std::uint8_t DeviceModel::write_entry(const Bytes& data) {
  if (mode() != 2 && mode() != 3) return not_in_this_mode;
  if (runs_) return not_in_this_mode;
  if (data.size() != 12) return bad_parameter;
  const unsigned depth = (data[5] >> 1 & 7) + 1;
  Entry entry{little(data, 2, 3), little(data, 6, 3), static_cast<unsigned>(data[5] >> 4 & 7),
              little(data, 10, 2) & 0x7ff, little(data, 10, 2) >> 11};
  if (depth != 8 || entry.exposure_us < 4046) return bad_exposure;  // this emulation knows gray layers alone
  if (entry.bit + depth > 24) return bad_bit;
  if (entry.image > 17 || little(data, 0, 2) >= 400) return bad_pattern;
  entries_[little(data, 0, 2)] = entry;
  table_is_current_ = false;
  return 0;
}

std::uint8_t DeviceModel::write_table(const Bytes& data) {
  if (runs_ || (mode() != 2 && mode() != 3)) return not_in_this_mode;
  if (data.size() != 6) return bad_parameter;
  const std::size_t count = little(data, 0, 2);
  if (count < 1 || count > 400) return bad_pattern_count;
  for (std::size_t i = 0; i < count; ++i) {
    if (!entries_.contains(i)) return bad_pattern;
  }
  registers_[0x1a31] = data;
  table_is_current_ = true;
  return 0;
}

std::uint8_t DeviceModel::start_or_stop(std::uint8_t action) {
  if (action > 2) return bad_parameter;
  if (action != 2) {
    stop_sequence(clock_.now());
    return 0;
  }
  if (mode() != 2 && mode() != 3) return not_in_this_mode;
  if (!table_is_current_) return bad_pattern;
  const std::size_t count = little(registers_[0x1a31], 0, 2);
  const std::size_t repeats = little(registers_[0x1a31], 2, 4);
  // The old firmware counts rounds of the table, the new one patterns.
  const std::size_t shown = kind_.firmware_major >= 6 ? repeats : repeats * count;
  std::uint64_t total_us = 0, round_us = 0;
  for (std::size_t i = 0; i < count; ++i) round_us += entries_[i].exposure_us + entries_[i].dark_us;
  for (std::size_t i = 0; i < shown; ++i) total_us += entries_[i % count].exposure_us + entries_[i % count].dark_us;
  if (mode() == 2 && round_us > 16667) {
    sequencer_abort_ = true;
    return 0;
  }
  runs_ = true;
  sequence_end_.reset();
  const auto now = clock_.now();
  if (repeats != 0 && !runs_on_) sequence_end_ = now + std::chrono::microseconds(total_us);
  update_light(now);
  return 0;
}

std::uint8_t DeviceModel::start_image(std::size_t controller, const Bytes& data) {
  if (mode() != 3 || runs_) return not_in_this_mode;
  if (data.size() != 6 || controller >= controllers() || little(data, 0, 2) > 17) return bad_parameter;
  loading_[controller] = {little(data, 0, 2), little(data, 2, 4), {}, true};
  memory_[controller].erase(loading_[controller].index);
  return 0;
}

std::uint8_t DeviceModel::load_image(std::size_t controller, const Bytes& data) {
  auto& loading = loading_[controller];
  if (mode() != 3 || runs_) return not_in_this_mode;
  if (!loading.active || data.size() < 2) return bad_parameter;
  const std::size_t count = little(data, 0, 2);
  if (count > 504 || count != data.size() - 2 || loading.bytes.size() + count > loading.total) return bad_parameter;
  loading.bytes.insert(loading.bytes.end(), data.begin() + 2, data.end());
  if (loading.bytes.size() < loading.total) return 0;
  loading.active = false;
  try {
    DecodedImage image = decode_image(loading.bytes);
    if (image.width != kind_.columns / controllers() || image.height != kind_.rows) return bad_parameter;
    memory_[controller][loading.index] = std::move(image);
  } catch (const BadImage&) {
    return bad_compression;
  }
  return 0;
}

std::uint8_t DeviceModel::hardware_byte() const {
  return static_cast<std::uint8_t>(1 | (controllers() == 2 && secondary_ ? 1 << 4 : 0) |
                                   (sequencer_abort_ ? 1 << 6 : 0) | (sequencer_error_ ? 1 << 7 : 0));
}

std::uint8_t DeviceModel::status_byte() const {
  return static_cast<std::uint8_t>((runs_ ? 1 << 1 : 0) | (locked_ ? 1 << 3 : 0));
}

bool DeviceModel::lit() const {
  const std::uint8_t enable = registers_.at(0x1a07)[0];
  if (registers_.at(0x0b01)[0] == 0) return false;
  if ((enable & 8) == 0) return (enable & 7) != 0;
  return runs_ && entries_.at(0).leds != 0;
}

Bytes DeviceModel::mirrors() const {
  Bytes picture(kind_.columns * kind_.rows, 0);
  if (mode() == 0 || (mode() == 2 && runs_)) return locked_ && video_.size() == picture.size() ? video_ : picture;
  if (mode() != 3 || !runs_) return picture;
  const std::size_t width = kind_.columns / controllers();
  const Entry& entry = entries_.at(0);
  for (std::size_t c = 0; c < controllers(); ++c) {
    const auto image = memory_[c].find(entry.image);
    const Bytes plane =
        image == memory_[c].end() ? Bytes(width * kind_.rows, default_image) : image->second.plane(entry.bit);
    for (std::size_t y = 0; y < kind_.rows; ++y) {
      std::copy_n(plane.begin() + static_cast<std::ptrdiff_t>(y * width), width,
                  picture.begin() + static_cast<std::ptrdiff_t>(y * kind_.columns + c * width));
    }
  }
  return picture;
}

/// What happened since the last call, at the moment at which it happened.
void DeviceModel::advance() {
  if (runs_ && sequence_end_ && clock_.now() >= *sequence_end_) stop_sequence(*sequence_end_);
}

void DeviceModel::stop_sequence(Clock::Duration at) {
  runs_ = runs_on_ = false;
  sequence_end_.reset();
  update_light(at);
}

void DeviceModel::update_light(Clock::Duration at) {
  if (lit() == light_is_on_) return;
  light_is_on_ = !light_is_on_;
  if (light_is_on_) {
    log_.push_back({at, {}, registers_[0x0b01][0], mirrors()});
  } else {
    log_.back().off = at;
  }
}

void DeviceModel::script(const ScriptedFault& fault) {
  const Lock lock(mutex_);
  faults_.push_back(fault);
}

std::size_t DeviceModel::faults_left() {
  const Lock lock(mutex_);
  return faults_.size();
}

void DeviceModel::power_cycle() {
  const Lock lock(mutex_);
  advance();
  defaults();
  update_light(clock_.now());
}

void DeviceModel::stand_by() {
  const Lock lock(mutex_);
  static_cast<void>(write(0x0200, {1}));
}

void DeviceModel::heal_sequencer() {
  const Lock lock(mutex_);
  sequencer_error_ = sequencer_abort_ = false;
  secondary_ = locked_ = true;
}

bool DeviceModel::plugged() {
  const Lock lock(mutex_);
  return plugged_;
}

void DeviceModel::plug(bool in) {
  const Lock lock(mutex_);
  plugged_ = in;
  message_.clear();
  outgoing_.clear();
  late_.reset();
}

void DeviceModel::show_video(const Bytes& picture) {
  const Lock lock(mutex_);
  video_ = picture;
}

void DeviceModel::lock_video(bool locked) {
  const Lock lock(mutex_);
  locked_ = locked;
}

std::vector<LightRecord> DeviceModel::light_log() {
  const Lock lock(mutex_);
  advance();
  return log_;
}

bool DeviceModel::light_is_on() {
  const Lock lock(mutex_);
  advance();
  return light_is_on_;
}

Bytes DeviceModel::register_value(std::uint16_t command) {
  const Lock lock(mutex_);
  return registers_.at(command);
}

std::vector<std::uint16_t> DeviceModel::commands_seen() {
  const Lock lock(mutex_);
  return seen_;
}

}  // namespace mezzotint::emulator
