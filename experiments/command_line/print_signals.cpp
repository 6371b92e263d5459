#include "experiments/command_line/print_signals.h"

#include <signal.h>

#include <array>
#include <atomic>

namespace mezzotint {

namespace {

constexpr std::array stopping = {SIGINT, SIGTERM, SIGHUP};
std::atomic<SessionControl*> steered{nullptr};
static_assert(std::atomic<SessionControl*>::is_always_lock_free);

extern "C" void steer_print(int number) {
  SessionControl* control = steered.load();
  if (control == nullptr) return;
  if (number == SIGTSTP) {
    control->ask_to_pause();
  } else {
    control->ask_to_stop();
  }
}

}  // namespace

struct PrintSignals::Kept {
  std::array<struct sigaction, stopping.size() + 2> before{};
};

PrintSignals::PrintSignals(SessionControl& control) : kept_(new Kept) {
  steered = &control;
  struct sigaction action {};
  action.sa_handler = steer_print;
  action.sa_flags = SA_RESTART;
  ::sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < stopping.size(); ++i) ::sigaction(stopping[i], &action, &kept_->before[i]);
  ::sigaction(SIGTSTP, &action, &kept_->before[stopping.size()]);
  action.sa_handler = SIG_IGN;
  ::sigaction(SIGPIPE, &action, &kept_->before[stopping.size() + 1]);
}

PrintSignals::~PrintSignals() {
  for (std::size_t i = 0; i < stopping.size(); ++i) ::sigaction(stopping[i], &kept_->before[i], nullptr);
  ::sigaction(SIGTSTP, &kept_->before[stopping.size()], nullptr);
  ::sigaction(SIGPIPE, &kept_->before[stopping.size() + 1], nullptr);
  steered = nullptr;
  delete kept_;
}

void PrintSignals::stop_process() { ::raise(SIGSTOP); }

}  // namespace mezzotint
