#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sp_port;

namespace mezzotint {

/// A serial line as lines of text: 8 bits, no parity, one stop bit, no flow control.
///
/// Errors   StageError(Disconnected) where the line cannot be opened or is gone, StageError(Garbled) for a line without
///          an end.
class SerialLine {
public:
  using Time = std::chrono::steady_clock::time_point;

  /// @param port  "/dev/ttyUSB0", or a link to it
  SerialLine(const std::string& port, int baud);
  ~SerialLine();
  SerialLine(const SerialLine&) = delete;
  SerialLine& operator=(const SerialLine&) = delete;

  /// @throws also StageError(Silent) where the bytes cannot be sent within a second
  void write(std::string_view bytes);
  /// The next line without its end; nothing where none came before the deadline.
  [[nodiscard]] std::optional<std::string> read_line(Time deadline);

private:
  struct Close {
    void operator()(sp_port* port) const;
  };
  [[noreturn]] void gone(const char* doing) const;

  std::string name_;
  std::unique_ptr<sp_port, Close> port_;
  std::string unread_;
};

}  // namespace mezzotint
