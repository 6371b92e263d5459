#include "fabrication/projector/dlpc900_settings.h"

#include <fmt/format.h>

namespace mezzotint::dlpc900 {
namespace {

constexpr std::size_t version_bytes = 16, hardware_bytes = 33;
constexpr auto wake_time = std::chrono::seconds(130);
constexpr auto wake_poll = std::chrono::seconds(1);
constexpr auto lock_time = std::chrono::seconds(5);
constexpr auto lock_poll = std::chrono::milliseconds(100);
constexpr auto mode_change_time = std::chrono::milliseconds(350);  // 300 in the guide; earlier answers are not true

constexpr std::uint8_t parallel_source_24_bit = 0 | 1 << 3;

DisplayMode mode_of(const Dlpc900Options& options) {
  if (options.way == Dlpc900Options::Way::Upload) return DisplayMode::PatternOnTheFly;
  return options.video_by_sequencer ? DisplayMode::VideoPattern : DisplayMode::Video;
}

std::vector<std::uint8_t> byte_of(DisplayMode mode) { return {static_cast<std::uint8_t>(mode)}; }

void wait_for_lock(Link& link, Clock& clock) {
  const auto deadline = clock.now() + lock_time;
  while (!read_main_status(link).source_is_locked) {
    if (clock.now() >= deadline) {
      throw LightEngineError(LightFault::LostSync,
                             "the projector finds no video signal; is its display on, at its own size?");
    }
    clock.sleep_for(lock_poll);
  }
}

// The whole frame for one plane: four times the shortest time, 16.18 ms of 16.67.
void play_video_plane(Link& link, const Dlpc900Options& options, const FirmwareVersion& firmware) {
  constexpr std::uint16_t entries = 4;
  for (std::uint16_t index = 0; index < entries; ++index) {
    link.order(Command::PatternEntry, encode_pattern_entry({index, shortest_8bit_us, options.leds, 0, 0}));
  }
  link.set(Command::PatternTable, encode_pattern_table(entries, 0, firmware));
}

}  // namespace

Hardware identify(Link& link) {
  Hardware hardware;
  hardware.firmware = firmware_version(number_at(link.read(Command::FirmwareVersion, version_bytes), 0, 4));
  const auto bytes = link.read(Command::HardwareAndTag, hardware_bytes);
  auto& identity = hardware.identity;
  identity.firmware =
      fmt::format("{}.{}.{}", hardware.firmware.major, hardware.firmware.minor, hardware.firmware.patch);
  for (std::size_t i = 1; i < bytes.size() && bytes[i] != 0; ++i) {
    identity.tag += bytes[i] >= 0x20 && bytes[i] < 0x7f ? static_cast<char>(bytes[i]) : '?';
  }
  switch (bytes[0]) {
    case 1:
      identity.model = "DLP6500 (DLPC900)", identity.columns = 1920, identity.rows = 1080;
      break;
    case 2:
      identity.model = "DLP9000 (DLPC900)", identity.columns = 2560, identity.rows = 1600;
      hardware.controllers = 2;
      break;
    default:
      throw LightEngineError(LightFault::Incompatible,
                             fmt::format("the projector has mirrors of kind {}; this driver knows 1 (DLP6500) and "
                                         "2 (DLP9000)",
                                         bytes[0]));
  }
  return hardware;
}

void wake(Link& link, Clock& clock) {
  constexpr std::uint8_t normal = 0;
  const auto deadline = clock.now() + wake_time;
  while (link.read(Command::PowerMode, 1)[0] != normal) {
    if (clock.now() >= deadline) throw LightEngineError(LightFault::Timeout, "the projector does not leave standby");
    try {
      link.order(Command::PowerMode, {normal});
    } catch (const LightEngineError& error) {
      if (error.fault() != LightFault::Refused) throw;
    }
    clock.sleep_for(wake_poll);
  }
}

std::vector<Setting> settings_that_read_back(const LightSettings& settings, const Dlpc900Options& options) {
  const auto current = static_cast<std::uint8_t>(settings.led_amplitude);
  const auto flag = [](bool value) { return std::vector<std::uint8_t>{static_cast<std::uint8_t>(value ? 1 : 0)}; };
  std::vector<Setting> list = {
      {Command::LedCurrents, {current, current, current}},
      {Command::LedPolarity, flag(options.led_polarity_inverted)},
      // Off, and by force: after a reset the sequencer has them, and a start would light them.
      {Command::LedEnable, {leds_off}},
      // Pictures are flipped before they are sent: a pair of controllers cannot flip the long axis.
      {Command::FlipLongAxis, flag(false)},
      {Command::FlipShortAxis, flag(false)}};
  if (options.way == Dlpc900Options::Way::Video) {
    list.push_back({Command::VideoReceiver, {static_cast<std::uint8_t>(options.video_receiver)}});
    list.push_back({Command::InputSource, {parallel_source_24_bit}});
  }
  list.push_back({Command::DisplayMode, byte_of(mode_of(options))});
  return list;
}

void require_unchanged(Link& link, const std::vector<Setting>& settings) {
  for (const auto& [command, data] : settings) {
    const auto back = link.read(command, data.size());
    if (back == data) continue;
    throw LightEngineError(
        LightFault::IgnoredSetting,
        fmt::format("the projector's {} read back {:02X} and were set to {:02X}: it may have reset itself",
                    command_name(command), fmt::join(back, " "), fmt::join(data, " ")));
  }
}

void require_healthy(const HardwareStatus& status, std::size_t controllers) {
  if (!status.initialised || status.incompatible) {
    throw LightEngineError(LightFault::Incompatible, "the projector's controller and mirrors did not initialise");
  }
  if (controllers > 1 && !status.has_secondary) {
    throw LightEngineError(LightFault::MissingSecondary,
                           "the projector's secondary controller, which drives the right half, does not answer");
  }
  if (status.sequence_aborted || status.sequence_failed) {
    throw LightEngineError(LightFault::Sequencer, status.sequence_aborted
                                                      ? "the projector's sequencer has aborted"
                                                      : "the projector's sequencer reports an error");
  }
}

HardwareStatus read_hardware_status(Link& link) { return hardware_status(link.read(Command::HardwareStatus, 1)[0]); }
MainStatus read_main_status(Link& link) { return main_status(link.read(Command::MainStatus, 1)[0]); }

void enter_display_mode(Link& link, Clock& clock, const Dlpc900Options& options, const FirmwareVersion& firmware) {
  if (options.way == Dlpc900Options::Way::Upload) {
    return link.set(Command::DisplayMode, byte_of(DisplayMode::PatternOnTheFly));
  }
  // The mode first: receiver and source can be chosen in video mode alone.
  link.set(Command::DisplayMode, byte_of(DisplayMode::Video));
  link.set(Command::VideoReceiver, {static_cast<std::uint8_t>(options.video_receiver)});
  link.set(Command::InputSource, {parallel_source_24_bit});
  wait_for_lock(link, clock);
  if (!options.video_by_sequencer) {
    // Since firmware 6 the curve of plain video can be chosen: a linear one.
    if (firmware.major >= 6) link.order(Command::Degamma, {1, 0});
    return;
  }
  link.order(Command::DisplayMode, byte_of(DisplayMode::VideoPattern));
  clock.sleep_for(mode_change_time);
  require_unchanged(link, {{Command::DisplayMode, byte_of(DisplayMode::VideoPattern)}});
  play_video_plane(link, options, firmware);
}

}  // namespace mezzotint::dlpc900
