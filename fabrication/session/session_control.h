#pragma once

#include <atomic>

namespace mezzotint {

/// How a user steers a print from outside. Every function may be called from a signal handler or another thread.
class SessionControl {
public:
  enum class Stop : int {
    No = 0,
    AfterLayer = 1,  ///< a running exposure is finished first
    Now = 2          ///< it is cut; the rest is exposed when the print goes on
  };

  /// Once: after the layer. Again: now.
  void ask_to_stop() noexcept {
    const int before = stop_.load();
    stop_.store(before == 0 ? 1 : 2);
  }
  [[nodiscard]] Stop stop() const noexcept { return static_cast<Stop>(stop_.load()); }

  /// Pauses before the next layer, in the dark, with the platform lifted.
  void ask_to_pause(bool paused = true) noexcept { paused_.store(paused); }
  [[nodiscard]] bool paused() const noexcept { return paused_.load(); }

private:
  static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);
  std::atomic<int> stop_{0};
  std::atomic<bool> paused_{false};
};

}  // namespace mezzotint
