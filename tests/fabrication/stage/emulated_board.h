#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/test_data.h"

namespace mezzotint::test {

/// What goes wrong on the board.
struct BoardFaults {
  int damaged_lines = 0;      ///< that many of the next lines arrive damaged
  int lost_answers = 0;       ///< that many of the next acknowledgements get lost
  bool silent = false;        ///< takes lines and says nothing
  bool refuses = false;       ///< "Error:Printer halted. kill() called!"
  bool no_endstop = false;    ///< homing fails
  std::int64_t drift_um = 0;  ///< each move ends that much too high
  int busy = 0;               ///< "echo:busy: processing" that often before M400 is done
  int busy_ms = 20;           ///< between them
  int reboot_after = -1;      ///< after that many more lines: a power dip, then the banner
  bool mute_banner = false;   ///< the restart says nothing
  int unplug_after = -1;      ///< after that many more lines the cable is pulled
  bool boots_slowly = false;  ///< deaf for 150 ms, then "start"
};

/// A board that speaks Marlin's dialect at the other end of a pseudo-terminal, in a thread. It shares no code with the
/// stage: its line parser and checksum are its own.
class EmulatedBoard {
public:
  explicit EmulatedBoard(BoardFaults faults = {});
  ~EmulatedBoard();
  EmulatedBoard(const EmulatedBoard&) = delete;
  EmulatedBoard& operator=(const EmulatedBoard&) = delete;

  /// A name that libserialport takes for a port: it looks for a symbolic link in /sys/class/tty, beside /dev.
  [[nodiscard]] std::string port() const;
  void set(const BoardFaults& faults);
  [[nodiscard]] std::int64_t height_um() const { return height_um_; }
  /// Every move's end: when, and where.
  struct Move {
    std::chrono::steady_clock::time_point at;
    std::int64_t height_um;
  };
  [[nodiscard]] std::vector<Move> moves() const;
  /// The commands that were carried out, in their order.
  [[nodiscard]] std::vector<std::string> commands() const;

private:
  void work();
  void take(std::string line);
  void carry_out(const std::string& command);
  void say(const std::string& line);
  void reboot();
  void unplug();

  TemporaryFolder folder_;
  std::atomic<int> master_{-1};
  mutable std::mutex mutex_;
  BoardFaults faults_;
  std::vector<std::string> commands_;
  std::vector<Move> moves_;
  long last_number_ = 0;
  bool halted_ = false;
  std::atomic<std::int64_t> height_um_{43210};
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace mezzotint::test
