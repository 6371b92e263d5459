#include "fabrication/session/print_session.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include <fmt/format.h>

namespace mezzotint {

namespace {

// Less is below what a light engine can time, and below any effect on the cure.
constexpr double negligible_share = 1e-3;
constexpr double wait_slice_s = 0.2;
constexpr double watch_margin_s = 5.0;

}  // namespace

std::string_view state_name(SessionState state) {
  switch (state) {
    case SessionState::Preparing:
      return "preparing";
    case SessionState::Homing:
      return "homing";
    case SessionState::Moving:
      return "moving";
    case SessionState::Waiting:
      return "waiting";
    case SessionState::Showing:
      return "showing";
    case SessionState::Exposing:
      return "exposing";
    case SessionState::Separating:
      return "separating";
    case SessionState::Paused:
      return "paused";
    case SessionState::Cooling:
      return "cooling";
    case SessionState::Ended:
      return "ended";
  }
  return "unknown";
}

PrintSession::PrintSession(const LayerSource& source, const MachineProfile& profile, LightEngine& engine, Stage& stage,
                           Clock& clock, SessionControl& control, SessionOptions options)
    : source_(source),
      profile_(profile),
      plan_(plan_print(source.frame, profile)),
      engine_(engine),
      stage_(stage),
      clock_(clock),
      control_(control),
      options_(std::move(options)) {
  const auto& identity = engine.identity();
  require(source.frame.columns == identity.columns && source.frame.rows == identity.rows,
          fmt::format("the job's pictures have {} × {} pixels, but {} shows {} × {}", source.frame.columns,
                      source.frame.rows, identity.model, identity.columns, identity.rows));
  left_s_.assign(plan_.layers.size() + 1, 0.0);
  for (std::size_t i = plan_.layers.size(); i-- > 0;) {
    left_s_[i] = left_s_[i + 1] + layer_times(plan_.layers[i], profile_).total_s();
  }
}

PrintSession::~PrintSession() {
  if (!engine_.try_light_off()) [[maybe_unused]]
    const bool away = move_away();
}

SessionEnd PrintSession::run() {
  open_journal();
  settle_uncertain_layer();
  try {
    return print_layers();
  } catch (const Error& error) {
    fail(error.what(), error.status());
  } catch (const std::exception& error) {
    fail(error.what(), ExitStatus::Failed);
  } catch (...) {
    fail("stopped by an unknown exception", ExitStatus::Failed);
  }
}

void PrintSession::open_journal() {
  journal_ = options_.resume ? Journal::resume(options_.journal, source_.identity, identity(plan_))
                             : Journal::begin(options_.journal, source_.identity, identity(plan_), plan_.layers.size());
  const JournalState& state = journal_->state();
  require(
      profile_.home_at == HomeAt::Top || (state.done == 0 && !state.open),
      "this stage homes at the vat, which would press the begun part into it; a print with layers cannot go on there");
}

void PrintSession::settle_uncertain_layer() {
  const auto open = journal_->state().open;
  if (!open || open->certain) return;
  const double wanted_s = plan_.layers[open->index].exposure_s;
  const std::string what = fmt::format(
      "layer {} was being exposed when the print ended: it got between {:.3g} and {:.3g} s "
      "of light, of {:.3g} s",
      open->index + 1, open->least_s, open->most_s, wanted_s);
  require(options_.uncertain != UncertainPolicy::Stop,
          what +
              "; look at the part, then say --uncertain repeat (expose it anew), skip (take it as done) or complete "
              "(add what is missing to the least)");
  const char* word = options_.uncertain == UncertainPolicy::Repeat ? "repeat"
                     : options_.uncertain == UncertainPolicy::Skip ? "skip"
                                                                   : "complete";
  tell(SessionState::Preparing, open->index, what + "; as asked: " + word);
  journal_->decide(open->index, word);
}

SessionEnd PrintSession::print_layers() {
  tell(SessionState::Preparing, journal_->state().done);
  prepare();
  tell(SessionState::Homing, journal_->state().done);
  stage_.home();
  while (journal_->state().done < plan_.layers.size()) {
    const std::size_t layer = journal_->state().done;
    pause_here(layer);
    if (stop_asked() || !print_layer(layer)) {
      confirm_dark();
      tell(SessionState::Ended, journal_->state().done, "stopped as asked; go on with --resume");
      return SessionEnd::Stopped;
    }
  }
  confirm_dark();
  journal_->finished();
  tell(SessionState::Ended, plan_.layers.size());
  return SessionEnd::Finished;
}

// False where the user stopped it; the platform is lifted then too.
bool PrintSession::print_layer(std::size_t layer) {
  approach(layer);
  wait(profile_.before_exposure_s, SessionState::Waiting, layer);
  const bool whole = !stop_asked() && expose(layer);
  if (whole) wait(profile_.after_exposure_s, SessionState::Waiting, layer);
  separate(layer);
  if (whole) wait(profile_.after_lift_s, SessionState::Waiting, layer);
  return whole;
}

void PrintSession::approach(std::size_t layer) {
  tell(SessionState::Moving, layer);
  const std::int64_t height = plan_.layers[layer].height_um;
  move(height + profile_.slow_lift_um, profile_.fast_lift_um_per_s);
  move(height, profile_.slow_lift_um_per_s);
}

void PrintSession::separate(std::size_t layer) {
  tell(SessionState::Separating, layer);
  lift_from(plan_.layers[layer].height_um);
}

void PrintSession::lift_from(std::int64_t height_um) {
  move(height_um + profile_.slow_lift_um, profile_.slow_lift_um_per_s);
  move(height_um + profile_.slow_lift_um + profile_.fast_lift_um, profile_.fast_lift_um_per_s);
  is_lifted_ = true;
}

void PrintSession::move(std::int64_t height_um, double speed_um_per_s) {
  // A move that fails may have ended anywhere between.
  at_um_ = std::max(at_um_.value_or(height_um), height_um);
  is_lifted_ = false;
  stage_.move_to(height_um, speed_um_per_s);
  at_um_ = height_um;
}

double PrintSession::missing_s(std::size_t layer) const {
  const auto& open = journal_->state().open;
  return plan_.layers[layer].exposure_s - (open ? open->taken_s : 0.0);
}

bool PrintSession::expose(std::size_t layer) {
  for (;;) {
    const double missing = missing_s(layer);
    if (missing <= negligible_share * plan_.layers[layer].exposure_s) {
      journal_->done(layer, plan_.layers[layer].exposure_s - missing);
      return true;
    }
    try {
      show(layer, missing);
      if (stop_asked()) return false;
      return light(layer, missing);
    } catch (const LightEngineError& error) {
      const auto& open = journal_->state().open;
      if (error.fault() != LightFault::OverTemperature || (open && !open->certain)) throw;
      cool_down(layer, error);
      if (stop_asked()) return false;
    }
  }
}

void PrintSession::show(std::size_t layer, double exposure_s) {
  tell(SessionState::Showing, layer);
  const auto begin = clock_.now();
  const std::vector<std::uint8_t> pixels = source_.read(layer);
  const std::size_t columns = source_.frame.columns, rows = source_.frame.rows;
  std::vector<std::uint8_t> turned(pixels.size());
  for (std::size_t row = 0; row < rows; ++row) {
    std::copy_n(pixels.begin() + std::ptrdiff_t(row * columns), columns,
                turned.begin() + std::ptrdiff_t((rows - 1 - row) * columns));
  }
  engine_.show({columns, rows, turned}, seconds(exposure_s));
  showing_s_ = in_seconds(clock_.now() - begin);
  // A board that restarted while the platform waited says so when it is asked.
  const std::int64_t wanted = plan_.layers[layer].height_um;
  const std::int64_t height = stage_.height_um();
  if (!stage_.is_homed() || std::abs(height - wanted) > profile_.tolerance_um) {
    throw StageError(StageFault::WrongPosition,
                     fmt::format("before the exposure of layer {} the platform was at {} µm, not at {} µm", layer + 1,
                                 height, wanted));
  }
}

// Whatever comes out of the light engine, the journal has it before anything else happens.
ExposureReport PrintSession::watched_exposure(std::size_t layer, double exposure_s,
                                              const std::function<bool()>& go_on) {
  const auto begin = clock_.now();
  std::optional<Clock::Duration> first_lit;  // as the light engine asks whether to go on, the light is on
  Clock::Duration last_lit{0};
  const auto noted = [&] {
    last_lit = clock_.now();
    if (!first_lit) first_lit = last_lit;
    return go_on();
  };
  if (options_.watch != nullptr) options_.watch->expect_light(seconds(exposure_s * 1.1 + watch_margin_s));
  try {
    const ExposureReport report = engine_.expose(noted);
    if (options_.watch != nullptr) options_.watch->expect_dark();
    return report;
  } catch (const ExposureError& error) {
    const bool is_off = error.light_is_off();
    const double most = is_off ? in_seconds(error.most_lit()) : std::max(exposure_s, in_seconds(error.most_lit()));
    record_fault(layer, in_seconds(error.least_lit()), most, is_off);
    throw;
  } catch (...) {
    const bool is_off = engine_.try_light_off();
    const double least = first_lit ? in_seconds(last_lit - *first_lit) : 0.0;
    record_fault(layer, least, in_seconds(clock_.now() - begin), is_off);
    throw;
  }
}

// False where the exposure was cut.
bool PrintSession::light(std::size_t layer, double exposure_s) {
  std::exception_ptr problem;
  tell(SessionState::Exposing, layer);
  journal_->exposing(layer, exposure_s);
  const auto latest = clock_.now() + seconds(exposure_s * (1.0 + profile_.exposure_tolerance) + 1.0);
  const ExposureReport report = watched_exposure(layer, exposure_s, [&] {
    try {
      tell(SessionState::Exposing, layer);
    } catch (...) {
      problem = std::current_exception();
    }
    return !problem && control_.stop() != SessionControl::Stop::Now && clock_.now() <= latest;
  });
  const bool whole = record(layer, report);
  if (problem) std::rethrow_exception(problem);
  if (!whole && control_.stop() != SessionControl::Stop::Now) {
    throw LightEngineError(LightFault::Sequencer, fmt::format("the exposure of layer {} ended after {:.3f} of {:.3f} s",
                                                              layer + 1, in_seconds(report.lit), exposure_s));
  }
  return whole;
}

void PrintSession::confirm_dark() {
  engine_.light_off();
  if (options_.watch != nullptr) options_.watch->expect_dark();
}

bool PrintSession::record(std::size_t layer, const ExposureReport& report) {
  const double lit = in_seconds(report.lit), uncertainty = in_seconds(report.uncertainty);
  const double tolerance = profile_.exposure_tolerance * plan_.layers[layer].exposure_s;
  if (!report.complete) {
    journal_->cut(layer, std::max(0.0, lit - uncertainty), lit + uncertainty, 2.0 * uncertainty <= tolerance);
    return false;
  }
  const auto& open = journal_->state().open;
  journal_->done(layer, (open ? open->taken_s : 0.0) + lit);
  if (std::abs(lit - in_seconds(report.requested)) > tolerance) {
    tell(SessionState::Exposing, layer,
         fmt::format("layer {} got {:.3f} s of light, not {:.3f} s", layer + 1, lit, in_seconds(report.requested)));
  }
  return true;
}

void PrintSession::record_fault(std::size_t layer, double least_s, double most_s, bool known) {
  const double tolerance = profile_.exposure_tolerance * plan_.layers[layer].exposure_s;
  try {
    journal_->cut(layer, least_s, most_s, known && most_s - least_s <= tolerance);
  } catch (const Error&) {
    // The journal has the exposure's begin: without its end the layer is uncertain, which is true. The fault itself
    // is what the user must hear of.
  }
}

void PrintSession::cool_down(std::size_t layer, const LightEngineError& cause) {
  confirm_dark();
  tell(SessionState::Cooling, layer, cause.what());
  const auto limit = clock_.now() + seconds(profile_.cool_down_limit_s);
  do {
    if (clock_.now() >= limit) throw cause;
    wait(profile_.cool_down_s, SessionState::Cooling, layer);
    if (stop_asked()) return;
  } while (!engine_.status().ready);
  prepare();
}

void PrintSession::prepare() { engine_.prepare({plan_.led_amplitude, plan_.flip_columns, plan_.flip_rows}); }

void PrintSession::pause_here(std::size_t layer) {
  if (!control_.paused()) return;
  confirm_dark();
  tell(SessionState::Paused, layer);
  if (options_.when_paused) {
    options_.when_paused();
    control_.ask_to_pause(false);
  }
  while (control_.paused() && !stop_asked()) clock_.sleep_for(seconds(wait_slice_s));
}

void PrintSession::wait(double duration_s, SessionState state, std::size_t layer) {
  if (duration_s <= 0.0) return;
  const auto end = clock_.now() + seconds(duration_s);
  while (clock_.now() < end && !stop_asked()) {
    tell(state, layer);
    clock_.sleep_until(std::min(end, clock_.now() + seconds(wait_slice_s)));
  }
}

void PrintSession::tell(SessionState state, std::size_t layer, const std::string& note) {
  if (!options_.event) return;
  const std::size_t layers = plan_.layers.size();
  const double showing = showing_s_ * double(layers - std::min(layer, layers));
  options_.event({state, layer, layers, left_s_[std::min(layer, layers)] + showing, note});
}

bool PrintSession::move_away() noexcept {
  try {
    if (!stage_.is_homed()) return false;
    // At its home the platform is away already.
    if (at_um_ && !is_lifted_)
      lift_from(std::min(*at_um_, profile_.highest_um - profile_.slow_lift_um - profile_.fast_lift_um));
    return true;
  } catch (...) {
    return false;
  }
}

void PrintSession::fail(const std::string& message, ExitStatus status) {
  const bool dark = engine_.try_light_off();
  if (dark && options_.watch != nullptr) options_.watch->expect_dark();
  const bool away = move_away();
  std::string text = message;
  if (!dark) {
    text += "\nTHE LIGHT COULD NOT BE SWITCHED OFF and may still be on: cut the light engine's power now.";
  } else {
    text += "\nThe light is off.";
  }
  text += away     ? " The platform is lifted."
          : at_um_ ? " The platform could not be moved: it may rest on the vat's floor."
                   : " The platform was not moved yet.";
  const auto& open = journal_->state().open;
  if (open && !open->certain) {
    text += fmt::format(" It is uncertain how much light layer {} got: between {:.3g} and {:.3g} s of {:.3g} s{}.",
                        open->index + 1, open->least_s, open->most_s, plan_.layers[open->index].exposure_s,
                        dark ? "" : " or more");
  }
  text += fmt::format(" {} of {} layers are done; mend the cause, then go on with --resume.", journal_->state().done,
                      plan_.layers.size());
  throw PrintError(text, status, dark, away);
}

}  // namespace mezzotint
