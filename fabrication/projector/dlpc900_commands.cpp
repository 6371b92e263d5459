#include "fabrication/projector/dlpc900_commands.h"

#include <array>
#include <utility>

#include "forward/base/error.h"

namespace mezzotint::dlpc900 {
namespace {

bool bit(std::uint8_t byte, int index) { return (byte >> index & 1) != 0; }

}  // namespace

std::string_view command_name(Command command) {
  static constexpr std::pair<Command, std::string_view> names[] = {
      {Command::ErrorCode, "error code"},
      {Command::ErrorText, "error text"},
      {Command::PowerMode, "power mode"},
      {Command::FirmwareVersion, "firmware version"},
      {Command::HardwareAndTag, "hardware and tag"},
      {Command::LedCurrents, "LED currents"},
      {Command::FlipLongAxis, "flip of the long axis"},
      {Command::FlipShortAxis, "flip of the short axis"},
      {Command::InputSource, "input source"},
      {Command::VideoReceiver, "video receiver"},
      {Command::LedPolarity, "LED polarity"},
      {Command::LedEnable, "LED enable"},
      {Command::HardwareStatus, "hardware status"},
      {Command::MainStatus, "main status"},
      {Command::DisplayMode, "display mode"},
      {Command::Sequence, "start or stop"},
      {Command::PrimaryImageStart, "begin of the primary's image"},
      {Command::PrimaryImageData, "data of the primary's image"},
      {Command::SecondaryImageStart, "begin of the secondary's image"},
      {Command::SecondaryImageData, "data of the secondary's image"},
      {Command::PatternTable, "pattern table"},
      {Command::PatternEntry, "pattern entry"},
      {Command::Degamma, "degamma"}};
  for (const auto& [known, name] : names) {
    if (known == command) return name;
  }
  return "unknown command";
}

std::string_view error_code_text(int code) {
  constexpr std::array<std::string_view, 18> texts = {"no error",
                                                      "batch file checksum",
                                                      "device failure",
                                                      "bad command number",
                                                      "controller and micromirrors do not go together",
                                                      "not allowed in this mode",
                                                      "bad parameter",
                                                      "item is not there",
                                                      "out of memory",
                                                      "bad compression of the image",
                                                      "bit position out of range",
                                                      "image is not in flash memory",
                                                      "dark time out of range",
                                                      "signal delay out of range",
                                                      "exposure out of range",
                                                      "number of patterns out of range",
                                                      "bad pattern definition",
                                                      "image memory address out of range"};
  if (code >= 0 && static_cast<std::size_t>(code) < texts.size()) return texts[static_cast<std::size_t>(code)];
  return code == 255 ? "internal error" : "unknown error";
}

HardwareStatus hardware_status(std::uint8_t byte) {
  return {bit(byte, 0), bit(byte, 1), bit(byte, 4), bit(byte, 6), bit(byte, 7)};
}

MainStatus main_status(std::uint8_t byte) { return {bit(byte, 1), bit(byte, 3)}; }

FirmwareVersion firmware_version(std::uint32_t word) { return {word >> 24, word >> 16 & 0xff, word & 0xffff}; }

std::vector<std::uint8_t> encode_pattern_entry(const PatternEntry& entry) {
  std::vector<std::uint8_t> bytes;
  append_number(bytes, entry.index, 2);
  append_number(bytes, entry.exposure_us, 3);
  constexpr unsigned eight_bits = 7;
  bytes.push_back(static_cast<std::uint8_t>(eight_bits << 1 | entry.leds << 4));
  append_number(bytes, 0, 3);  // no dark time
  bytes.push_back(0);
  append_number(bytes, entry.image | entry.bit_position << 11, 2);
  return bytes;
}

std::vector<std::uint8_t> encode_pattern_table(unsigned entries, std::uint32_t rounds,
                                               const FirmwareVersion& firmware) {
  const bool counts_patterns = firmware.major >= 6;
  std::vector<std::uint8_t> bytes;
  append_number(bytes, entries, 2);
  append_number(bytes, counts_patterns ? rounds * entries : rounds, 4);
  return bytes;
}

ExposurePlan plan_exposure(std::uint64_t exposure_us) {
  require(exposure_us >= shortest_8bit_us, "an 8-bit layer is lit for at least " + std::to_string(shortest_8bit_us) +
                                               " us, not " + std::to_string(exposure_us));
  require(exposure_us <= 3600'000'000ULL, "a layer is lit for an hour at most");
  const std::uint64_t rounds = (exposure_us + longest_entry_us - 1) / longest_entry_us;
  return {static_cast<std::uint32_t>((exposure_us + rounds / 2) / rounds), static_cast<std::uint32_t>(rounds)};
}

}  // namespace mezzotint::dlpc900
