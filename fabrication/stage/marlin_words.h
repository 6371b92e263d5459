#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mezzotint {

/// The words of Marlin's serial dialect, as pure functions.
///
/// Source   marlinfw.org (G-code index; M110, M114, M400, G28) and its host protocol: "N<line> <command>*<checksum>",
///          answered by "ok", or "Error:…" and "Resend: <line>" and "ok".

/// "N12 G1 Z0.018 F600*97\n"; the checksum is the exclusive or of all bytes before the star.
[[nodiscard]] std::string numbered_line(std::int64_t number, std::string_view command);

/// "12.018" for 12018 µm; exact, with no floating point in between.
[[nodiscard]] std::string millimetres(std::int64_t height_um);

/// What a line of the board means to the host.
struct MarlinReply {
  enum class Kind {
    Acknowledged,  ///< "ok"
    Resend,        ///< `number` is wanted again
    Busy,          ///< still at work; patience
    LineDamaged,   ///< an error that a Resend follows
    HomingFailed,  ///< the end switch was not hit
    Refused,       ///< any other error, an unknown command
    Restarted,     ///< the banner after power-on or reset
    Position,      ///< `height_um`
    Remark         ///< everything else
  };
  Kind kind = Kind::Remark;
  std::int64_t number = 0;
  std::int64_t height_um = 0;
};
[[nodiscard]] MarlinReply parse_marlin_reply(std::string_view line);

/// "12.02" → 12020: what stands at the beginning of `text`; nothing where it is no decimal number.
[[nodiscard]] std::optional<std::int64_t> parse_micrometres(std::string_view text);

}  // namespace mezzotint
