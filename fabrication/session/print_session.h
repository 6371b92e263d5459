#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fabrication/device/clock.h"
#include "fabrication/device/light_engine.h"
#include "fabrication/session/journal.h"
#include "fabrication/session/layer_source.h"
#include "fabrication/session/machine_profile.h"
#include "fabrication/session/print_plan.h"
#include "fabrication/session/session_control.h"
#include "fabrication/stage/stage.h"

namespace mezzotint {

enum class SessionState { Preparing, Homing, Moving, Waiting, Showing, Exposing, Separating, Paused, Cooling, Ended };
[[nodiscard]] std::string_view state_name(SessionState state);

struct SessionEvent {
  SessionState state = SessionState::Preparing;
  std::size_t layer = 0;  ///< from 0
  std::size_t layers = 0;
  double left_s = 0.0;  ///< expected until the end
  std::string note;     ///< what a user must know; mostly empty
};

/// What happens to a layer of which nobody knows how much light it got.
enum class UncertainPolicy {
  Stop,     ///< nothing, until the user says which of the others
  Repeat,   ///< it is exposed as if it had got none
  Skip,     ///< it counts as done
  Complete  ///< it gets what is missing to its exposure, by the light that it surely got
};

/// Someone who sees to it that the light goes off when this process cannot any more (`Guardian`).
class LightWatch {
public:
  virtual ~LightWatch() = default;
  /// The light goes on; it will be off again within that time.
  virtual void expect_light(Clock::Duration longest) noexcept = 0;
  /// The device confirmed that it is off.
  virtual void expect_dark() noexcept = 0;
};

struct SessionOptions {
  std::filesystem::path journal;
  bool resume = false;
  UncertainPolicy uncertain = UncertainPolicy::Stop;
  /// Called at each change of state, and a few times a second while the light is on. What it throws stops the print.
  std::function<void(const SessionEvent&)> event;
  /// Called when a pause has begun; the print goes on when it returns. Without it a pause ends by the control alone.
  std::function<void()> when_paused;
  LightWatch* watch = nullptr;
};

enum class SessionEnd {
  Finished,  ///< all layers
  Stopped    ///< as the control asked; goes on with `resume`
};

/// A print stopped by a fault. The message says what happened, where light and platform are, and what to do.
class PrintError : public Error {
public:
  PrintError(const std::string& message, ExitStatus status, bool light_is_off, bool platform_is_away)
      : Error(message, status), light_is_off_(light_is_off), platform_is_away_(platform_is_away) {}
  [[nodiscard]] bool light_is_off() const { return light_is_off_; }
  [[nodiscard]] bool platform_is_away() const { return platform_is_away_; }

private:
  bool light_is_off_, platform_is_away_;
};

/// One print on one machine: home; per layer move, settle, show, light on, expose, light off, separate.
///
/// Light    It is on inside of one function alone, `LightEngine::expose`, with the platform at rest at the layer's
///          height and the exposure in the journal. Every way out of `run` and the destructor put it off and make sure;
///          where it stays on (the cable is gone), the platform moves away, and the error says so.
/// Journal  Written before an exposure and after it. A print that ended in between leaves an uncertain layer, which is
///          never exposed again without the user's word (`UncertainPolicy`). An exposure that was cut at a known time
///          is completed by what is missing.
/// Threads  `run` in one thread; `SessionControl` from anywhere.
/// Errors   InvalidInput before anything moves: a job that does not fit, a journal of another job, an uncertain layer
///          without a word on it. PrintError for all that happens later.
class PrintSession {
public:
  PrintSession(const LayerSource& source, const MachineProfile& profile, LightEngine& engine, Stage& stage,
               Clock& clock, SessionControl& control, SessionOptions options);
  ~PrintSession();
  PrintSession(const PrintSession&) = delete;
  PrintSession& operator=(const PrintSession&) = delete;

  /// Once.
  [[nodiscard]] SessionEnd run();

  /// What the journal has, during and after `run`.
  [[nodiscard]] const JournalState& journal() const { return journal_->state(); }

private:
  void open_journal();
  void settle_uncertain_layer();
  void prepare();
  SessionEnd print_layers();
  bool print_layer(std::size_t layer);
  void approach(std::size_t layer);
  bool expose(std::size_t layer);
  void show(std::size_t layer, double exposure_s);
  bool light(std::size_t layer, double exposure_s);
  bool record(std::size_t layer, const ExposureReport& report);
  void confirm_dark();
  void record_fault(std::size_t layer, double least_s, double most_s, bool known);
  void cool_down(std::size_t layer, const LightEngineError& cause);
  void separate(std::size_t layer);
  void pause_here(std::size_t layer);
  void wait(double duration_s, SessionState state, std::size_t layer);
  void move(std::int64_t height_um, double speed_um_per_s);
  void lift_from(std::int64_t height_um);
  void tell(SessionState state, std::size_t layer, const std::string& note = {});
  ExposureReport watched_exposure(std::size_t layer, double exposure_s, const std::function<bool()>& go_on);
  [[nodiscard]] double missing_s(std::size_t layer) const;
  [[nodiscard]] bool stop_asked() const { return control_.stop() != SessionControl::Stop::No; }
  [[noreturn]] void fail(const std::string& message, ExitStatus status);
  [[nodiscard]] bool move_away() noexcept;

  const LayerSource& source_;
  MachineProfile profile_;
  PrintPlan plan_;
  LightEngine& engine_;
  Stage& stage_;
  Clock& clock_;
  SessionControl& control_;
  SessionOptions options_;
  std::optional<Journal> journal_;
  std::vector<double> left_s_;  ///< expected from a layer on
  double showing_s_ = 0.0;      ///< of the last picture
  bool is_lifted_ = false;
  std::optional<std::int64_t> at_um_;  ///< the highest place where the platform may be; nothing before the first move
};

}  // namespace mezzotint
