#include "fabrication/session/guardian.h"

#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>

namespace mezzotint {

namespace {

// Messages are the monotonic time, in ns, by which the light will be off; or one of these.
constexpr std::int64_t dark = 0;
constexpr std::int64_t quit = -1;

std::int64_t now_ns() { return SteadyClock().now().count(); }

void put_off(const std::function<bool()>& put_light_off, const char* why) {
  std::fprintf(stderr, "mezzotint: %s with the light on; switching it off\n", why);
  bool off = false;
  try {
    off = put_light_off();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mezzotint: %s\n", error.what());
  }
  std::fputs(off ? "mezzotint: the light is off. The layer that was exposed is uncertain; go on with --resume\n"
                 : "mezzotint: THE LIGHT COULD NOT BE SWITCHED OFF: cut the light engine's power now\n",
             stderr);
}

int wait_ms(std::int64_t until) {
  if (until == dark) return -1;
  const std::int64_t left = (until - now_ns()) / 1'000'000 + 1;
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 1'000'000'000));
}

void guard(int line, pid_t guarded, const std::function<bool()>& put_light_off) {
  std::int64_t until = dark;
  for (;;) {
    pollfd ready{line, POLLIN, 0};
    const int count = ::poll(&ready, 1, wait_ms(until));
    if (count < 0 && errno == EINTR) continue;
    if (count == 0 && now_ns() >= until) {
      ::kill(guarded, SIGKILL);
      // Its files must be closed before the device can be opened: the line breaks then.
      std::int64_t rest = 0;
      while (::read(line, &rest, sizeof(rest)) > 0) {
      }
      return put_off(put_light_off, "the printing process hung");
    }
    if (count <= 0) continue;
    std::int64_t message = 0;
    const auto size = ::read(line, &message, sizeof(message));
    if (size < 0 && errno == EINTR) continue;
    if (size != sizeof(message)) {
      if (until != dark) put_off(put_light_off, "the printing process ended");
      return;
    }
    if (message == quit) return;
    until = message;
  }
}

}  // namespace

Guardian::Guardian(const std::function<bool()>& put_light_off) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw DeviceError(std::string("cannot make a line for the light's guardian: ") + std::strerror(errno));
  }
  Descriptor reading(ends[0]);
  line_ = Descriptor(ends[1]);
  const pid_t guarded = ::getpid();
  process_ = ::fork();
  if (process_ < 0) {
    throw DeviceError(std::string("cannot start the light's guardian: ") + std::strerror(errno));
  }
  if (process_ == 0) {
    ::close(line_.number());
    ::setsid();
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGTSTP, SIGPIPE}) ::signal(number, SIG_IGN);
    guard(reading.number(), guarded, put_light_off);
    ::_exit(0);
  }
}

Guardian::~Guardian() {
  if (!light_) say(Clock::Duration(quit));
  { const Descriptor closed = std::move(line_); }
  while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void Guardian::say(Clock::Duration until) noexcept {
  const std::int64_t message = until.count();
  while (::send(line_.number(), &message, sizeof(message), MSG_NOSIGNAL) < 0 && errno == EINTR) {
  }
}

void Guardian::expect_light(Clock::Duration longest) noexcept {
  light_ = true;
  say(SteadyClock().now() + longest);
}

void Guardian::expect_dark() noexcept {
  light_ = false;
  say(Clock::Duration(dark));
}

}  // namespace mezzotint
