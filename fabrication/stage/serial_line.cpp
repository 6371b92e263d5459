#include "fabrication/stage/serial_line.h"

#include <libserialport.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "fabrication/stage/stage.h"

namespace mezzotint {

namespace {

constexpr std::size_t longest_line = 4096;
constexpr unsigned write_limit_ms = 1000;

// libserialport finds a port by its own name only, udev's links need to be followed.
sp_port* find_port(const std::string& name) {
  sp_port* port = nullptr;
  if (sp_get_port_by_name(name.c_str(), &port) == SP_OK) return port;
  std::error_code problem;
  const auto followed = std::filesystem::canonical(name, problem);
  if (!problem && sp_get_port_by_name(followed.c_str(), &port) == SP_OK) return port;
  return nullptr;
}

std::string last_problem() {
  char* text = sp_last_error_message();
  const std::string copy = text == nullptr ? "" : text;
  sp_free_error_message(text);
  return copy;
}

}  // namespace

void SerialLine::Close::operator()(sp_port* port) const {
  sp_close(port);
  sp_free_port(port);
}

SerialLine::SerialLine(const std::string& port, int baud) : name_(port), port_(find_port(port)) {
  if (port_ == nullptr) {
    throw StageError(StageFault::Disconnected,
                     port + ": there is no such serial port; is the stage's cable plugged in?");
  }
  if (sp_open(port_.get(), SP_MODE_READ_WRITE) != SP_OK) {
    throw StageError(StageFault::Disconnected,
                     port + ": cannot be opened: " + last_problem() +
                         " (on Debian the user belongs into the group dialout, and no other program may hold it)");
  }
  const bool set = sp_set_baudrate(port_.get(), baud) == SP_OK && sp_set_bits(port_.get(), 8) == SP_OK &&
                   sp_set_parity(port_.get(), SP_PARITY_NONE) == SP_OK && sp_set_stopbits(port_.get(), 1) == SP_OK &&
                   sp_set_flowcontrol(port_.get(), SP_FLOWCONTROL_NONE) == SP_OK;
  if (!set) {
    throw StageError(StageFault::Refused,
                     port + ": cannot be set to " + std::to_string(baud) + " baud: " + last_problem());
  }
  sp_flush(port_.get(), SP_BUF_BOTH);
}

SerialLine::~SerialLine() = default;

void SerialLine::gone(const char* doing) const {
  throw StageError(StageFault::Disconnected, name_ + ": the stage's serial line is gone while " + doing + " (" +
                                                 last_problem() + "); check its cable and power");
}

void SerialLine::write(std::string_view bytes) {
  const auto written = sp_blocking_write(port_.get(), bytes.data(), bytes.size(), write_limit_ms);
  if (written < 0) gone("writing");
  if (static_cast<std::size_t>(written) != bytes.size()) {
    throw StageError(StageFault::Silent, name_ + ": the stage takes no bytes; is it powered?");
  }
}

std::optional<std::string> SerialLine::read_line(Time deadline) {
  for (;;) {
    const auto end = unread_.find('\n');
    if (end != std::string::npos) {
      std::string line = unread_.substr(0, end);
      unread_.erase(0, end + 1);
      if (!line.empty() && line.back() == '\r') line.pop_back();
      return line;
    }
    if (unread_.size() > longest_line) {
      throw StageError(StageFault::Garbled, name_ + ": the stage sends no line ends; is the baud rate right?");
    }
    using namespace std::chrono;
    const auto left = ceil<milliseconds>(deadline - steady_clock::now()).count();
    if (left <= 0) return {};
    std::array<char, 256> bytes;
    const auto count = sp_blocking_read_next(port_.get(), bytes.data(), bytes.size(),
                                             static_cast<unsigned>(std::min<std::int64_t>(left, 1000)));
    // An unplugged line reads as nothing without an end; asked for its bytes it fails.
    if (count < 0 || (count == 0 && sp_input_waiting(port_.get()) < 0)) gone("reading");
    unread_.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace mezzotint
