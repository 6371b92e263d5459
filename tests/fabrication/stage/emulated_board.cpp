#include "tests/fabrication/stage/emulated_board.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

// libserialport asks every port for its modem lines, which a pseudo-terminal has none of. Here they are all low, as on
// a cable of three wires; every other request goes to the system.
extern "C" int ioctl(int file, unsigned long request, ...) __THROW {
  va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  using Ioctl = int (*)(int, unsigned long, ...);
  static const auto system_ioctl = reinterpret_cast<Ioctl>(::dlsym(RTLD_NEXT, "ioctl"));
  const int result = system_ioctl(file, request, argument);
  if (result == 0 || (errno != ENOTTY && errno != EINVAL)) return result;
  if (request == TIOCMGET) {
    *static_cast<int*>(argument) = 0;
    return 0;
  }
  return request == TIOCMSET || request == TIOCMBIS || request == TIOCMBIC ? 0 : result;
}

namespace mezzotint::test {

EmulatedBoard::EmulatedBoard(BoardFaults faults) : faults_(faults) {
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0) throw std::runtime_error("no pseudo-terminal");
  termios raw{};
  ::tcgetattr(master, &raw);
  ::cfmakeraw(&raw);
  ::tcsetattr(master, TCSANOW, &raw);
  std::filesystem::create_symlink(::ptsname(master), folder_ / "stage");
  master_ = master;
  thread_ = std::thread([this] { work(); });
}

EmulatedBoard::~EmulatedBoard() {
  ends_ = true;
  thread_.join();
  unplug();
}

std::string EmulatedBoard::port() const { return "/dev/../../.." + (folder_ / "stage").string(); }

void EmulatedBoard::set(const BoardFaults& faults) {
  const std::lock_guard lock(mutex_);
  faults_ = faults;
  halted_ = false;
}

std::vector<std::string> EmulatedBoard::commands() const {
  const std::lock_guard lock(mutex_);
  return commands_;
}

std::vector<EmulatedBoard::Move> EmulatedBoard::moves() const {
  const std::lock_guard lock(mutex_);
  return moves_;
}

void EmulatedBoard::unplug() {
  const int master = master_.exchange(-1);
  if (master >= 0) ::close(master);
}

void EmulatedBoard::reboot() {
  last_number_ = 0;
  halted_ = false;
  height_um_ = 0;  // it takes the place where it stands for zero
  if (faults_.mute_banner) return;
  say("start");
  say("echo:Marlin bugfix-2.1.x");
}

void EmulatedBoard::work() {
  std::string unread;
  bool boots = true;
  while (!ends_) {
    const int master = master_;
    if (master < 0) return;
    {
      const std::lock_guard lock(mutex_);
      boots = boots && faults_.boots_slowly;
    }
    pollfd ready{master, POLLIN, 0};
    if (::poll(&ready, 1, 5) <= 0 || (ready.revents & POLLIN) == 0) {
      if ((ready.revents & POLLHUP) != 0) ::usleep(1000);  // nobody has opened the port yet
      continue;
    }
    char bytes[256];
    const auto count = ::read(master, bytes, sizeof(bytes));
    if (count <= 0) continue;
    if (boots) {  // what comes while it boots is lost
      boots = false;
      ::usleep(150000);
      while (::poll(&ready, 1, 0) > 0 && ::read(master, bytes, sizeof(bytes)) > 0) {
      }
      const std::lock_guard lock(mutex_);
      reboot();
      continue;
    }
    unread.append(bytes, static_cast<std::size_t>(count));
    for (auto end = unread.find('\n'); end != std::string::npos; end = unread.find('\n')) {
      std::string line = unread.substr(0, end);
      unread.erase(0, end + 1);
      const std::lock_guard lock(mutex_);
      take(std::move(line));
    }
  }
}

void EmulatedBoard::say(const std::string& line) {
  if (faults_.silent || master_ < 0) return;
  if (line.starts_with("ok") && faults_.lost_answers > 0) {
    --faults_.lost_answers;
    return;
  }
  const std::string bytes = line + "\r\n";
  [[maybe_unused]] const auto count = ::write(master_, bytes.data(), bytes.size());
}

void EmulatedBoard::take(std::string line) {
  if (faults_.unplug_after >= 0 && faults_.unplug_after-- == 0) return unplug();
  if (faults_.reboot_after >= 0 && faults_.reboot_after-- == 0) return reboot();
  if (faults_.damaged_lines > 0 && line.size() > 4) {
    --faults_.damaged_lines;
    line[line.size() / 2] = static_cast<char>(line[line.size() / 2] ^ 0x15);
  }
  long number = -1;
  int read = 0;
  if (std::sscanf(line.c_str(), "N%ld %n", &number, &read) != 1) return say("Error:No Line Number with checksum");
  const auto star = line.rfind('*');
  unsigned sum = 0;
  for (std::size_t i = 0; i < star && i < line.size(); ++i) sum ^= static_cast<unsigned char>(line[i]);
  const std::string command = star == std::string::npos ? "" : line.substr(std::size_t(read), star - std::size_t(read));
  if (star == std::string::npos || std::strtoul(line.c_str() + star + 1, nullptr, 10) != sum) {
    say("Error:checksum mismatch, Last Line: " + std::to_string(last_number_));
  } else if (command.starts_with("M110")) {
    last_number_ = number;
    return say("ok");
  } else if (number != last_number_ + 1) {
    say("Error:Line Number is not Last Line Number+1, Last Line: " + std::to_string(last_number_));
  } else {
    last_number_ = number;
    commands_.push_back(command);
    return carry_out(command);
  }
  say("Resend: " + std::to_string(last_number_ + 1));
  say("ok");
}

void EmulatedBoard::carry_out(const std::string& command) {
  if (halted_) return;
  if (faults_.refuses) return say("Error:Printer halted. kill() called!");
  if (command.starts_with("G28") && faults_.no_endstop) {
    halted_ = true;
    say("Error:Homing Failed");
    return say("Error:Printer halted. kill() called!");
  }
  if (command.starts_with("G28")) height_um_ = 150000;
  if (command.starts_with("G1 Z"))
    height_um_ = std::lround(std::strtod(command.c_str() + 4, nullptr) * 1000.0) + faults_.drift_um;
  if (command.starts_with("G")) moves_.push_back({std::chrono::steady_clock::now(), height_um_});
  if (command == "M400") {
    for (int i = 0; i < faults_.busy; ++i) {
      say("echo:busy: processing");
      ::usleep(static_cast<useconds_t>(faults_.busy_ms) * 1000);
    }
  }
  if (command == "M114") {
    char text[128];
    std::snprintf(text, sizeof(text), "X:0.00 Y:0.00 Z:%.2f E:0.00 Count X:0 Y:0 Z:%ld", double(height_um_) * 1e-3,
                  long(height_um_) * 16 / 10);
    say(text);
  }
  say("ok");
}

}  // namespace mezzotint::test
