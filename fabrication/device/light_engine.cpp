#include "fabrication/device/light_engine.h"

#include <algorithm>

namespace mezzotint {

std::string_view fault_name(LightFault fault) {
  switch (fault) {
    case LightFault::Refused:
      return "refused";
    case LightFault::Timeout:
      return "timeout";
    case LightFault::Protocol:
      return "protocol";
    case LightFault::Disconnected:
      return "disconnected";
    case LightFault::Sequencer:
      return "sequencer";
    case LightFault::MissingSecondary:
      return "missing secondary controller";
    case LightFault::LostSync:
      return "lost sync";
    case LightFault::IgnoredSetting:
      return "ignored setting";
    case LightFault::Incompatible:
      return "incompatible";
    case LightFault::OverTemperature:
      return "over-temperature";
  }
  return "unknown";
}

std::vector<std::uint8_t> flipped(const ShownPicture& picture, const LightSettings& settings) {
  std::vector<std::uint8_t> gray(picture.gray.begin(), picture.gray.end());
  const auto columns = static_cast<std::ptrdiff_t>(picture.columns);
  const auto row = [&](std::size_t index) { return gray.begin() + static_cast<std::ptrdiff_t>(index) * columns; };
  for (std::size_t y = 0; settings.flip_columns && y < picture.rows; ++y) std::reverse(row(y), row(y + 1));
  for (std::size_t y = 0; settings.flip_rows && y < picture.rows / 2; ++y) {
    std::swap_ranges(row(y), row(y + 1), row(picture.rows - 1 - y));
  }
  return gray;
}

}  // namespace mezzotint
