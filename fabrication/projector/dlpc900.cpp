#include "fabrication/projector/dlpc900.h"

#include <fmt/format.h>

#include <algorithm>

#include "fabrication/projector/dlpc900_settings.h"
#include "fabrication/projector/dlpc900_upload.h"
#include "fabrication/projector/light_switch.h"

namespace mezzotint {
namespace dlpc900 {
namespace {

constexpr auto end_grace = std::chrono::milliseconds(100);        // for a sequence to end after its time
constexpr auto end_poll = std::chrono::milliseconds(2);           // near that end
constexpr auto quiet_before_end = std::chrono::milliseconds(60);  // no questions that could delay the order to end

std::vector<std::uint8_t> byte_of(SequenceAction action) { return {static_cast<std::uint8_t>(action)}; }

class Dlpc900 final : public LightEngine {
public:
  Dlpc900(std::unique_ptr<ReportTransport> transport, Clock& clock, const Dlpc900Options& options,
          std::unique_ptr<LayerWindow> window)
      : link_(std::move(transport), clock), clock_(clock), options_(options), window_(std::move(window)) {}

  ~Dlpc900() override {
    const bool dark = try_light_off();
    static_cast<void>(dark);  // nobody is left to be told; the session asks before it lets go
  }

  void connect();

  [[nodiscard]] const LightEngineIdentity& identity() const override { return hardware_.identity; }
  void prepare(const LightSettings& settings) override;
  [[nodiscard]] UploadEstimate estimate(const ShownPicture& picture) const override;
  void show(const ShownPicture& picture, Clock::Duration exposure) override;
  [[nodiscard]] ExposureReport expose(const std::function<bool()>& go_on) override;
  void light_off() override;
  [[nodiscard]] bool try_light_off() noexcept override;
  [[nodiscard]] LightStatus status() override;

private:
  [[nodiscard]] bool uploads() const { return options_.way == Dlpc900Options::Way::Upload; }
  [[nodiscard]] bool has_sequence() const { return uploads() || options_.video_by_sequencer; }
  void require_picture(const ShownPicture& picture) const;
  void load_by_upload(const ShownPicture& picture, Clock::Duration exposure);
  void load_by_video(const ShownPicture& picture);
  void stop_sequence() { link_.order(Command::Sequence, byte_of(SequenceAction::Stop)); }

  Moment start_light();
  void start_uploaded_sequence();
  ExposureReport light_by_host(const std::function<bool()>& go_on);
  ExposureReport light_by_device(const std::function<bool()>& go_on);
  [[nodiscard]] bool watch(Clock::Duration until, const std::function<bool()>& go_on);
  void check_lit(Clock::Duration deadline);
  Clock::Duration wait_for_sequence_end(Clock::Duration earliest_end);
  [[noreturn]] void fail_exposure(const LightEngineError& cause);

  Link link_;
  Clock& clock_;
  Dlpc900Options options_;
  std::unique_ptr<LayerWindow> window_;
  Hardware hardware_;
  std::vector<Setting> settings_;  ///< empty until prepared
  LightSettings orientation_;
  Clock::Duration exposure_{0};  ///< of the picture that is shown and not yet lit; 0: none

  /// What is known of the light of the exposure under way.
  struct Lit {
    std::optional<Clock::Duration> ordered;  ///< the first order that may have put it on
    std::optional<Moment> on;                ///< confirmed
    Clock::Duration seen_lit{0};             ///< last moment at which the device answered and all was well
  } lit_;
};

void Dlpc900::connect() {
  link_.drain();
  wake(link_, clock_);
  link_.set(Command::LedEnable, {leds_off});
  hardware_ = identify(link_);
  require_healthy(read_hardware_status(link_), hardware_.controllers);
  const auto& identity = hardware_.identity;
  if (uploads()) return;
  require(window_ != nullptr, "the way by video needs a window on the projector's display");
  if (window_->columns() != identity.columns || window_->rows() != identity.rows) {
    throw LightEngineError(LightFault::Incompatible,
                           fmt::format("the window has {} x {} pixels and the projector {} x {}", window_->columns(),
                                       window_->rows(), identity.columns, identity.rows));
  }
  window_->blank();
}

void Dlpc900::prepare(const LightSettings& settings) {
  require(settings.led_amplitude >= 0 && settings.led_amplitude <= 255, "the LED amplitude is 0 to 255");
  settings_.clear();
  exposure_ = {};
  light_off();
  const auto wanted = settings_that_read_back(settings, options_);
  for (const auto& [command, data] : wanted) {
    // The display mode has an order and waits of its own.
    const bool by_mode =
        command == Command::DisplayMode || command == Command::VideoReceiver || command == Command::InputSource;
    if (!by_mode) link_.set(command, data);
  }
  enter_display_mode(link_, clock_, options_, hardware_.firmware);
  require_unchanged(link_, wanted);
  settings_ = wanted;
  orientation_ = settings;
}

void Dlpc900::require_picture(const ShownPicture& picture) const {
  const auto& identity = hardware_.identity;
  require(picture.columns == identity.columns && picture.rows == identity.rows &&
              picture.gray.size() == picture.columns * picture.rows,
          fmt::format("a layer has {} x {} pixels and the projector {} x {}", picture.columns, picture.rows,
                      identity.columns, identity.rows));
}

UploadEstimate Dlpc900::estimate(const ShownPicture& picture) const {
  require_picture(picture);
  return uploads() ? estimate_upload(encode_halves(picture, hardware_.controllers)) : UploadEstimate{};
}

void Dlpc900::show(const ShownPicture& picture, Clock::Duration exposure) {
  require(!settings_.empty(), "prepare the projector before it shows a layer");
  require_picture(picture);
  require(exposure.count() > 0, "an exposure is longer than 0");
  exposure_ = {};
  const auto gray = flipped(picture, orientation_);
  const ShownPicture turned{picture.columns, picture.rows, gray};
  try {
    require_unchanged(link_, settings_);
    require_healthy(read_hardware_status(link_), hardware_.controllers);
    if (uploads()) {
      load_by_upload(turned, exposure);
    } else {
      load_by_video(turned);
    }
  } catch (const LightEngineError&) {
    if (!try_light_off()) throw;  // what went wrong first is what is told
    throw;
  }
  exposure_ = exposure;
}

void Dlpc900::load_by_upload(const ShownPicture& picture, Clock::Duration exposure) {
  const auto images = encode_halves(picture, hardware_.controllers);
  const auto cost = estimate_upload(images);
  require(options_.force_upload || cost.duration <= options_.longest_upload,
          fmt::format("the layer takes {:.0f} s to upload ({} bytes over USB 1.1), longer than the {:.0f} s that are "
                      "allowed: show it by video, or force it",
                      in_seconds(cost.duration), cost.bytes, in_seconds(options_.longest_upload)));
  const auto plan =
      plan_exposure(static_cast<std::uint64_t>(std::chrono::round<std::chrono::microseconds>(exposure).count()));
  stop_sequence();
  link_.order(Command::PatternEntry, encode_pattern_entry({0, plan.entry_us, options_.leds, 0, 0}));
  const auto table = encode_pattern_table(1, plan.rounds, hardware_.firmware);
  link_.set(Command::PatternTable, table);
  upload(link_, images);
  link_.set(Command::PatternTable, table);  // revision F of the guide has it here, revision J before the images
}

void Dlpc900::load_by_video(const ShownPicture& picture) {
  const auto status = read_main_status(link_);
  if (!status.source_is_locked) {
    throw LightEngineError(LightFault::LostSync, "the projector has lost its video signal");
  }
  window_->show(picture);
  if (options_.video_by_sequencer && !status.sequence_runs) {
    link_.order(Command::Sequence, byte_of(SequenceAction::Start));
  }
  clock_.sleep_for(options_.video_delay);
}

ExposureReport Dlpc900::expose(const std::function<bool()>& go_on) {
  require(exposure_.count() > 0, "show a layer before it is lit; it is lit once");
  lit_ = {};
  try {
    ExposureReport report = uploads() ? light_by_device(go_on) : light_by_host(go_on);
    report.requested = exposure_;
    exposure_ = {};
    if (window_) window_->blank();
    return report;
  } catch (const LightEngineError& error) {
    fail_exposure(error);
  } catch (...) {
    exposure_ = {};
    if (!try_light_off()) throw;  // what went wrong first is what is told
    throw;
  }
}

void Dlpc900::fail_exposure(const LightEngineError& cause) {
  const auto failed_at = clock_.now();
  const bool dark = try_light_off();
  const auto now = clock_.now();
  const auto none = Clock::Duration(0);
  const auto exposure = exposure_;
  exposure_ = {};
  Clock::Duration most = lit_.ordered ? now - *lit_.ordered : none;
  // The device ends an uploaded layer by itself, also where it cannot be reached; unless it was seen not to.
  if (uploads() && !dark && lit_.ordered) most = std::min(most, std::max(exposure, lit_.seen_lit - *lit_.ordered));
  Clock::Duration least = lit_.on ? std::max(lit_.seen_lit, lit_.on->latest) - lit_.on->latest : none;
  least = std::min({least, most, failed_at - (lit_.on ? lit_.on->latest : failed_at)});
  throw ExposureError(cause, least, most, dark);
}

/// Asks and looks until a moment; false where `go_on` says so.
bool Dlpc900::watch(Clock::Duration until, const std::function<bool()>& go_on) {
  while (clock_.now() < until) {
    if (!go_on()) return false;
    const auto deadline = until - quiet_before_end;
    if (clock_.now() + quiet_before_end < deadline) check_lit(std::min(deadline, clock_.now() + options_.poll));
    clock_.sleep_until(std::min(until, clock_.now() + options_.poll));
  }
  return true;
}

void Dlpc900::check_lit(Clock::Duration deadline) {
  try {
    require_healthy(hardware_status(link_.read_before(Command::HardwareStatus, 1, deadline)[0]), hardware_.controllers);
    const auto status = main_status(link_.read_before(Command::MainStatus, 1, deadline)[0]);
    if (!uploads() && !status.source_is_locked) {
      throw LightEngineError(LightFault::LostSync, "the projector lost its video signal while the light was on");
    }
    if (has_sequence() && !status.sequence_runs) {
      throw LightEngineError(LightFault::Sequencer, "the projector's sequence ended while the light was on");
    }
    lit_.seen_lit = clock_.now();
  } catch (const LightEngineError& error) {
    // One lost answer is asked for again at the next look; the end of the exposure is not put off for it.
    if (error.fault() != LightFault::Timeout) throw;
  }
}

Moment Dlpc900::start_light() {
  lit_.ordered = clock_.now();
  const Moment on = switch_leds(link_, clock_, static_cast<std::uint8_t>(options_.leds));
  lit_.on = on;
  lit_.seen_lit = on.latest;
  return on;
}

ExposureReport Dlpc900::light_by_host(const std::function<bool()>& go_on) {
  const Moment on = start_light();
  const bool complete = watch(on.earliest + exposure_, go_on);
  const Moment off = switch_leds(link_, clock_, leds_off);
  return {.lit = between(on, off), .uncertainty = uncertainty_between(on, off), .complete = complete};
}

void Dlpc900::start_uploaded_sequence() {
  switch_leds(link_, clock_, leds_by_sequencer);  // dark until the sequence starts
  lit_.ordered = clock_.now();
  Moment on{clock_.now(), {}};
  try {
    link_.order(Command::Sequence, byte_of(SequenceAction::Start));
    on.latest = clock_.now();
  } catch (const LightEngineError& error) {
    // A start is never given twice: the layer would be lit twice.
    if (error.fault() != LightFault::Timeout || !read_main_status(link_).sequence_runs) throw;
    on.latest = clock_.now();
  }
  lit_.on = on;
  lit_.seen_lit = on.latest;
}

/// When the sequence was first seen at rest.
Clock::Duration Dlpc900::wait_for_sequence_end(Clock::Duration earliest_end) {
  const auto deadline = lit_.on->latest + exposure_ + end_grace;
  for (;;) {
    const auto asked = clock_.now();
    const bool runs = read_main_status(link_).sequence_runs;
    if (!runs && clock_.now() < earliest_end) {
      throw LightEngineError(LightFault::Sequencer, "the projector's sequence ended before its time");
    }
    if (!runs) return clock_.now();
    if (asked > deadline) {
      throw LightEngineError(LightFault::Sequencer, "the projector's sequence did not end in its time");
    }
    lit_.seen_lit = clock_.now();
    clock_.sleep_for(end_poll);
  }
}

ExposureReport Dlpc900::light_by_device(const std::function<bool()>& go_on) {
  start_uploaded_sequence();
  const Moment on = *lit_.on;
  ExposureReport report;
  if (watch(on.earliest + exposure_, go_on)) {
    const auto ended = wait_for_sequence_end(on.earliest + exposure_);
    report.lit = exposure_;
    report.uncertainty = ended - (on.earliest + exposure_);
    stop_sequence();
    switch_leds(link_, clock_, leds_off);
  } else {
    const Moment off = switch_leds(link_, clock_, leds_off);
    stop_sequence();
    report.complete = false;
    report.lit = std::min(between(on, off), exposure_);
    report.uncertainty = uncertainty_between(on, off);
  }
  // An end that came late is seen here too: no error may have been raised on the way.
  require_healthy(read_hardware_status(link_), hardware_.controllers);
  return report;
}

void Dlpc900::light_off() {
  switch_leds(link_, clock_, leds_off);
  if (has_sequence() && read_main_status(link_).sequence_runs) stop_sequence();
}

bool Dlpc900::try_light_off() noexcept {
  settings_.clear();  // the LED current is 0 afterwards
  return force_dark(link_);
}

LightStatus Dlpc900::status() {
  LightStatus status;
  const auto leds = link_.read(Command::LedEnable, 1)[0];
  const auto hardware = read_hardware_status(link_);
  const auto main = read_main_status(link_);
  status.light_on = (leds & leds_by_sequencer) != 0 ? main.sequence_runs : leds != leds_off;
  if (!hardware.initialised || hardware.incompatible) status.faults.push_back(LightFault::Incompatible);
  if (hardware_.controllers > 1 && !hardware.has_secondary) status.faults.push_back(LightFault::MissingSecondary);
  if (hardware.sequence_aborted || hardware.sequence_failed) status.faults.push_back(LightFault::Sequencer);
  if (!uploads() && !settings_.empty() && !main.source_is_locked) status.faults.push_back(LightFault::LostSync);
  status.ready = status.faults.empty();
  return status;
}

}  // namespace
}  // namespace dlpc900

std::unique_ptr<LightEngine> make_dlpc900(std::unique_ptr<dlpc900::ReportTransport> transport, Clock& clock,
                                          const Dlpc900Options& options, std::unique_ptr<LayerWindow> window) {
  require(options.leds >= 1 && options.leds <= 7, "the UV LED is on output 1 (red), 2 (green), 4 (blue), or sums");
  auto engine = std::make_unique<dlpc900::Dlpc900>(std::move(transport), clock, options, std::move(window));
  engine->connect();
  return engine;
}

}  // namespace mezzotint
