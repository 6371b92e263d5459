#include "experiments/command_line/machine_print.h"

#include <chrono>
#include <cmath>
#include <thread>

#include <fmt/format.h>

#include "experiments/command_line/print_devices.h"
#include "experiments/command_line/print_signals.h"
#include "experiments/configuration/machine_file.h"
#include "fabrication/device/paced_clock.h"
#include "fabrication/session/guardian.h"
#include "fabrication/session/print_session.h"

namespace mezzotint {

namespace {

std::string hours(double duration_s) {
  const auto whole = static_cast<long>(std::llround(duration_s));
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::filesystem::path journal_of(const MachinePrint& print) {
  if (!print.journal.empty()) return print.journal;
  std::string name = print.job.string();
  while (name.size() > 1 && name.back() == '/') name.pop_back();
  return name + ".journal";
}

UncertainPolicy policy_of(const std::string& word) {
  if (word == "repeat") return UncertainPolicy::Repeat;
  if (word == "skip") return UncertainPolicy::Skip;
  return word == "complete" ? UncertainPolicy::Complete : UncertainPolicy::Stop;
}

std::unique_ptr<Clock> clock_of(const MachinePrint& print) {
  if (print.device != "virtual") return std::make_unique<SteadyClock>();
  if (print.pace > 0.0) return std::make_unique<PacedClock>(print.pace);
  return std::make_unique<VirtualClock>();
}

nlohmann::ordered_json times_json(const PrintTimes& times) {
  return {{"light_s", times.light_s},
          {"moving_s", times.moving_s},
          {"waiting_s", times.waiting_s},
          {"total_s", times.total_s()}};
}

MachinePrintEnd rehearse(const LayerSource& source, const PrintPlan& plan, const Machine& machine) {
  const PrintTimes times = expected_times(plan, machine.profile);
  MachinePrintEnd end;
  end.json = {{"machine", machine.profile.name},
              {"layers", plan.layers.size()},
              {"led_amplitude", plan.led_amplitude},
              {"height_um", plan.layers.back().height_um - machine.profile.zero_um},
              {"largest_rounding_um", plan.largest_rounding_um},
              {"times", times_json(times)}};
  end.text = fmt::format(
      "{}: {} layers of {} × {} pixels up to {:.3f} mm on {}, LED amplitude {}\n"
      "about {}: light {}, moves {}, waits {}; homing and the loading of pictures come on top",
      source.frame.name, plan.layers.size(), source.frame.columns, source.frame.rows,
      1e-3 * double(plan.layers.back().height_um - machine.profile.zero_um), machine.profile.name, plan.led_amplitude,
      hours(times.total_s()), hours(times.light_s), hours(times.moving_s), hours(times.waiting_s));
  if (plan.largest_rounding_um > 1e-6) {
    end.text += fmt::format("\nheights are rounded to whole micrometres, each by itself, by up to {:.2f} µm",
                            plan.largest_rounding_um);
  }
  end.finished = true;
  return end;
}

/// Shows a session's events, and says once what a first Ctrl-C does.
class Announcer {
public:
  Announcer(const CommandContext& context, const SessionControl& control) : context_(context), control_(control) {}

  void operator()(const SessionEvent& event) {
    if (!event.note.empty()) context_.warn({event.note});
    if (control_.stop() == SessionControl::Stop::AfterLayer && !said_stop_) {
      said_stop_ = true;
      context_.warn({"stopping after this layer; again to cut the exposure, the rest of which is kept for --resume"});
    }
    report(context_.progress, "print", double(event.layer) / double(event.layers),
           fmt::format("layer {}/{} {}, {} left", std::min(event.layer + 1, event.layers), event.layers,
                       state_name(event.state), hours(event.left_s)));
  }

private:
  const CommandContext& context_;
  const SessionControl& control_;
  bool said_stop_ = false;
};

MachinePrintEnd ended(const MachinePrint& print, const JournalState& journal, bool finished) {
  MachinePrintEnd end;
  end.finished = finished;
  end.lit_s = journal.lit_s;
  end.json = {{"device", print.device},
              {"finished", finished},
              {"layers", journal.layers},
              {"done", journal.done},
              {"journal", journal_of(print).string()},
              {"uncertain_layers", journal.decided}};
  end.text = finished ? fmt::format("printed {} layers", journal.layers)
                      : fmt::format(
                            "stopped before layer {} of {}; the light is off, the platform lifted. Go on with "
                            "--resume",
                            journal.done + 1, journal.layers);
  return end;
}

}  // namespace

MachinePrintEnd print_on_machine(const MachinePrint& print, const CommandContext& context) {
  Machine machine = read_machine(print.machine);
  machine.projector.force_upload = print.force_upload;
  const LayerSource source = open_layers(print.job);
  const PrintPlan plan = plan_print(source.frame, machine.profile);
  if (print.dry_run) return rehearse(source, plan, machine);

  SessionControl control;
  const PrintSignals signals(control);
  std::unique_ptr<Guardian> guardian;  // before the device is opened, after which it could not be opened again
  if (print.device == "dlpc900") guardian = std::make_unique<Guardian>([&] { return put_light_off(machine); });
  const auto clock = clock_of(print);
  const auto stage = make_stage(print.device, machine, *clock);
  const auto light = make_light(print.device, machine, source.frame, *clock);

  Announcer announce(context, control);
  SessionOptions options{journal_of(print), print.resume, policy_of(print.uncertain)};
  options.event = [&](const SessionEvent& event) { announce(event); };
  options.when_paused = [&] {
    context.warn({"paused with the light off and the platform lifted; go on with fg"});
    PrintSignals::stop_process();
  };
  options.watch = guardian.get();
  PrintSession session(source, machine.profile, *light, *stage, *clock, control, options);
  const SessionEnd end = session.run();
  return ended(print, session.journal(), end == SessionEnd::Finished);
}

}  // namespace mezzotint
