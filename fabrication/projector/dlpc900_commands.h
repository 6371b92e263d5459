#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "fabrication/projector/dlpc900_frame.h"

namespace mezzotint::dlpc900 {

/// The commands that the driver uses. Source: TI DLPU018F/J, chapter 2.
enum class Command : std::uint16_t {
  ErrorCode = 0x0100,
  ErrorText = 0x0101,
  PowerMode = 0x0200,
  FirmwareVersion = 0x0205,
  HardwareAndTag = 0x0206,
  LedCurrents = 0x0b01,
  FlipLongAxis = 0x1008,
  FlipShortAxis = 0x1009,
  InputSource = 0x1a00,
  VideoReceiver = 0x1a01,
  LedPolarity = 0x1a05,
  LedEnable = 0x1a07,
  HardwareStatus = 0x1a0a,
  MainStatus = 0x1a0c,
  DisplayMode = 0x1a1b,
  Sequence = 0x1a24,
  PrimaryImageStart = 0x1a2a,
  PrimaryImageData = 0x1a2b,
  SecondaryImageStart = 0x1a2c,
  SecondaryImageData = 0x1a2d,
  PatternTable = 0x1a31,
  PatternEntry = 0x1a34,
  Degamma = 0x1a3b
};

/// What a command is called in messages.
[[nodiscard]] std::string_view command_name(Command command);

/// What an error code of 0x0100 means.
[[nodiscard]] std::string_view error_code_text(int code);

enum class DisplayMode : std::uint8_t { Video = 0, VideoPattern = 2, PatternOnTheFly = 3 };
enum class SequenceAction : std::uint8_t { Stop = 0, Start = 2 };

inline constexpr std::uint8_t leds_off = 0x00;           ///< forced, none
inline constexpr std::uint8_t leds_by_sequencer = 0x08;  ///< as the pattern's entry says

struct HardwareStatus {
  bool initialised = false;
  bool incompatible = false;
  bool has_secondary = false;
  bool sequence_aborted = false;
  bool sequence_failed = false;
};
[[nodiscard]] HardwareStatus hardware_status(std::uint8_t byte);

struct MainStatus {
  bool sequence_runs = false;
  bool source_is_locked = false;
};
[[nodiscard]] MainStatus main_status(std::uint8_t byte);

struct FirmwareVersion {
  unsigned major = 0, minor = 0, patch = 0;
};
[[nodiscard]] FirmwareVersion firmware_version(std::uint32_t word);

/// One entry of the pattern table: an 8-bit plane for a time. 12 bytes.
struct PatternEntry {
  std::uint16_t index = 0;
  std::uint32_t exposure_us = 0;
  unsigned leds = 7;  ///< 1 red, 2 green, 4 blue
  unsigned image = 0;
  unsigned bit_position = 0;
};
inline constexpr std::uint32_t shortest_8bit_us = 4046;  ///< DLP9000, LED not modulated
inline constexpr std::uint32_t longest_entry_us = 0xffffff;
[[nodiscard]] std::vector<std::uint8_t> encode_pattern_entry(const PatternEntry& entry);

/// Payload of 0x1A31: the table shown `rounds` times (0: for ever).
/// Revision F of the guide counts rounds there, revision J patterns. Which firmware changed is not written down;
/// taken to be 6.0, where other fields of the table changed too. A table of one entry is the same under both.
[[nodiscard]] std::vector<std::uint8_t> encode_pattern_table(unsigned entries, std::uint32_t rounds,
                                                             const FirmwareVersion& firmware);

/// A time as equal entries shown one after another, each within the table's field and the plane's shortest time.
/// @throws InvalidInput below `shortest_8bit_us`.
struct ExposurePlan {
  std::uint32_t entry_us = 0;
  std::uint32_t rounds = 1;
};
[[nodiscard]] ExposurePlan plan_exposure(std::uint64_t exposure_us);

}  // namespace mezzotint::dlpc900
