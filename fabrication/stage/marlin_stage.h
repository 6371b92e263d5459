#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "fabrication/stage/serial_line.h"
#include "fabrication/stage/stage.h"

namespace mezzotint {

struct MarlinSettings {
  std::string port;
  int baud = 115200;
  std::chrono::milliseconds boot{5000};      ///< many boards restart when the port is opened
  std::chrono::milliseconds answer{3000};    ///< silence of that length is a fault; "busy" counts as an answer
  std::chrono::milliseconds homing{120000};  ///< homing takes at most that long
  std::int64_t tolerance_um = 6;             ///< M114 has two decimals: it says 12.02 at 12.018
  std::int64_t lowest_um = 0;
  std::int64_t highest_um = 200000;
};

/// A build platform on a board that speaks Marlin's dialect, as axis Z.
///
/// Every line is numbered, has a checksum, and is acknowledged before the next one. A move is G1 to an absolute height,
/// M400 until it is done, M114 to read back. A board that restarts says "start": its position is lost then. A line that
/// is met with silence is sent once more, which is harmless since all heights are absolute.
/// Missing  M114 gives the height that the board counted its steps to: steps that the motor lost are not seen.
class MarlinStage final : public Stage {
public:
  /// Opens the port, waits for the board and sets absolute millimetres. Nothing moves.
  explicit MarlinStage(MarlinSettings settings);

  void home() override;
  [[nodiscard]] bool is_homed() const override { return homed_; }
  void move_to(std::int64_t height_um, double speed_um_per_s) override;
  [[nodiscard]] std::int64_t height_um() override;

private:
  using Time = SerialLine::Time;
  void greet();
  void command(std::string_view text, std::chrono::milliseconds limit);
  enum class Answer { Taken, Again, Silence };
  Answer await(std::string_view text, std::int64_t number, Time deadline);
  [[noreturn]] void fail(StageFault fault, std::string_view text, const std::string& problem);

  MarlinSettings settings_;
  SerialLine line_;
  std::int64_t number_ = 0;
  std::int64_t reported_um_ = 0;
  bool reported_ = false;
  bool homed_ = false;
  bool greeted_ = false;
};

}  // namespace mezzotint
