#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "fabrication/device/light_engine.h"
#include "fabrication/session/layer_source.h"
#include "fabrication/session/machine_profile.h"
#include "fabrication/session/print_plan.h"
#include "fabrication/stage/stage.h"

namespace mezzotint::test {

inline constexpr std::size_t most_layers = 32;

/// What the resin saw: light by layer and picture. Plain numbers, so that it may lie in memory shared with a child.
struct Vat {
  /// Seconds of light that picture p got at the height of layer h; pictures are told by their first pixel.
  std::array<std::array<double, most_layers>, most_layers> lit_s{};
  double elsewhere_s = 0.0;  ///< light at any other height, or while the platform moved
};

enum class Fault {
  None,
  // The light engine, at the n-th thing that is asked of any device.
  LightRefused,
  LightTimeout,
  LightGone,
  LightSequencer,
  LightLostSync,
  LightReset,
  LightTooHot,
  LightSloppyDriver,
  LightStopsEarly,
  // The stage.
  StageSilentBefore,
  StageSilentAfter,
  StageRefused,
  StageRestarted,
  StageWrong,
  StageGone,
  // The user, and our own process.
  UserStops,
  UserStopsNow,
  EventThrows,
  ClockJumps
};
inline constexpr int fault_kinds = 20;

/// A printer of numbers: the light, the platform, the resin and time, and a fault at a chosen moment.
struct World {
  VirtualClock clock;
  Vat own_vat;
  Vat* vat = &own_vat;
  std::function<void()> each_moment;  ///< called at every step of anything
  std::vector<std::string> violations;

  // Light.
  bool light = false, light_reachable = true, stage_reachable = true;
  Clock::Duration light_since{0};
  int picture = -1;
  // Platform.
  bool homed = false, moving = false;
  std::int64_t height_um = 0;
  // Faults: kind by moment.
  std::map<int, Fault> faults;
  int moment = 0;
  bool hot = false;

  std::int64_t layer_um = 18;

  /// Counts a moment, and says which fault is due; one that does not fit the device waits for the next moment.
  Fault next(std::initializer_list<Fault> fitting) {
    if (each_moment) each_moment();
    ++moment;
    const auto due = faults.begin();
    if (due == faults.end() || due->first > moment) return Fault::None;
    if (std::find(fitting.begin(), fitting.end(), due->second) == fitting.end()) return Fault::None;
    const Fault fault = due->second;
    faults.erase(due);
    return fault;
  }

  void settle_light() {
    if (!light) return;
    const double lit = in_seconds(clock.now() - light_since);
    light_since = clock.now();
    const std::int64_t layer = height_um / layer_um - 1;
    const bool there = !moving && height_um % layer_um == 0 && layer >= 0 && layer < std::int64_t(most_layers);
    if (there && picture >= 0) {
      vat->lit_s[std::size_t(layer)][std::size_t(picture)] += lit;
    } else {
      vat->elsewhere_s += lit;
    }
  }
  void put_light(bool on) {
    settle_light();
    if (on && (moving || !homed)) violations.push_back("light on without the platform at rest");
    light = on;
    light_since = clock.now();
  }
};

/// A light engine without a device: it lights in steps of 20 ms, and fails as it is told.
class FakeLight final : public LightEngine {
public:
  FakeLight(World& world, std::size_t columns, std::size_t rows) : world_(world) {
    identity_.model = "fake";
    identity_.columns = columns;
    identity_.rows = rows;
    if (!try_light_off()) throw gone();
  }
  ~FakeLight() override { [[maybe_unused]] const bool off = try_light_off(); }

  const LightEngineIdentity& identity() const override { return identity_; }
  void prepare(const LightSettings& settings) override {
    disturb();
    settings_ = settings;
    prepared_ = true;
  }
  UploadEstimate estimate(const ShownPicture&) const override { return {}; }

  void show(const ShownPicture& picture, Clock::Duration exposure) override {
    world_.clock.sleep_for(seconds(0.05));
    disturb();
    if (!prepared_) throw LightEngineError(LightFault::IgnoredSetting, "not prepared");
    world_.picture = picture.gray[picture.gray.size() - picture.columns];  // row 0 of the job is the last one here
    exposure_ = exposure;
    shown_ = true;
  }

  ExposureReport expose(const std::function<bool()>& go_on) override {
    if (!shown_) throw LightEngineError(LightFault::Refused, "nothing is shown");
    shown_ = false;
    disturb();
    const auto begin = world_.clock.now();
    world_.put_light(true);
    const auto end = begin + exposure_;
    ExposureReport report{exposure_, exposure_, Clock::Duration{0}, true};
    while (world_.clock.now() < end) {
      world_.clock.sleep_until(std::min(end, world_.clock.now() + seconds(0.02)));
      world_.settle_light();
      trouble(begin);
      bool on = false;
      try {
        on = go_on();
      } catch (...) {
        light_off();
        throw;
      }
      if (!on && world_.clock.now() < end) {
        report.complete = false;
        break;
      }
    }
    report.lit = world_.clock.now() - begin;
    light_off();
    return report;
  }

  void light_off() override {
    if (!try_light_off()) throw gone();
  }
  bool try_light_off() noexcept override {
    if (!world_.light_reachable) return false;
    world_.put_light(false);
    return true;
  }
  LightStatus status() override {
    if (!world_.light_reachable) throw gone();
    world_.hot = false;  // it cools within one pause
    return {world_.light, true, {}};
  }

private:
  static LightEngineError gone() { return {LightFault::Disconnected, "the light engine is gone"}; }

  // Faults in the dark.
  void disturb() {
    if (!world_.light_reachable) throw gone();
    const Fault fault = world_.next({Fault::LightRefused, Fault::LightTimeout, Fault::LightGone, Fault::LightReset,
                                     Fault::LightLostSync, Fault::LightTooHot, Fault::ClockJumps});
    switch (fault) {
      case Fault::LightRefused:
        throw LightEngineError(LightFault::Refused, "refused", 6);
      case Fault::LightTimeout:
        throw LightEngineError(LightFault::Timeout, "no answer");
      case Fault::LightLostSync:
        throw LightEngineError(LightFault::LostSync, "no sync");
      case Fault::LightReset:
        prepared_ = false;
        throw LightEngineError(LightFault::IgnoredSetting, "reset");
      case Fault::LightTooHot:
        prepared_ = false;
        throw LightEngineError(LightFault::OverTemperature, "too hot");
      case Fault::LightGone:
        world_.light_reachable = false;
        throw gone();
      case Fault::ClockJumps:
        world_.clock.sleep_for(seconds(7.0));
        break;
      default:
        break;
    }
  }

  // Faults with the light on. The device's own end of light lies anywhere in the last step.
  void trouble(Clock::Duration begin) {
    const Fault fault = world_.next({Fault::LightRefused, Fault::LightTimeout, Fault::LightGone, Fault::LightSequencer,
                                     Fault::LightLostSync, Fault::LightReset, Fault::LightTooHot,
                                     Fault::LightSloppyDriver, Fault::LightStopsEarly});
    if (fault == Fault::None) return;
    const auto most = world_.clock.now() - begin;
    const auto least = most - std::min(most, fault == Fault::LightSequencer ? seconds(1.0) : seconds(0.02));
    prepared_ = false;
    if (fault == Fault::LightGone) {
      world_.light_reachable = false;
      throw ExposureError(gone(), least, most, false);
    }
    if (fault == Fault::LightSloppyDriver) throw std::runtime_error("a driver that leaves the light on");
    light_off();
    const LightFault kind = fault == Fault::LightRefused    ? LightFault::Refused
                            : fault == Fault::LightTimeout  ? LightFault::Timeout
                            : fault == Fault::LightReset    ? LightFault::IgnoredSetting
                            : fault == Fault::LightLostSync ? LightFault::LostSync
                            : fault == Fault::LightTooHot   ? LightFault::OverTemperature
                                                            : LightFault::Sequencer;
    throw ExposureError(LightEngineError(kind, "in an exposure"), least, most, true);
  }

  World& world_;
  LightEngineIdentity identity_;
  LightSettings settings_;
  Clock::Duration exposure_{0};
  bool prepared_ = false, shown_ = false;
};

/// A platform without a board.
class FakeStage final : public Stage {
public:
  explicit FakeStage(World& world) : world_(world) { world_.homed = false; }

  void home() override {
    disturb("home");
    travel(100000, 10000.0);
    world_.homed = true;
  }
  bool is_homed() const override { return world_.homed; }
  void move_to(std::int64_t height_um, double speed_um_per_s) override {
    if (!world_.homed) throw StageError(StageFault::PositionLost, "not homed");
    disturb("move");
    travel(height_um, speed_um_per_s);
    if (world_.next({Fault::StageSilentAfter}) != Fault::None) throw StageError(StageFault::Silent, "silent after");
  }
  std::int64_t height_um() override {
    disturb("ask");
    return world_.height_um;
  }

private:
  void travel(std::int64_t height_um, double speed) {
    if (world_.light && world_.light_reachable) world_.violations.push_back("moved in the light");
    world_.settle_light();
    world_.moving = true;
    world_.clock.sleep_for(seconds(std::abs(double(height_um - world_.height_um)) / speed));
    world_.settle_light();
    world_.height_um = height_um;
    world_.moving = false;
  }

  void disturb(const char* doing) {
    if (!world_.stage_reachable) throw StageError(StageFault::Disconnected, "the stage is gone");
    const Fault fault = world_.next(
        {Fault::StageSilentBefore, Fault::StageRefused, Fault::StageRestarted, Fault::StageWrong, Fault::StageGone});
    switch (fault) {
      case Fault::StageSilentBefore:
        throw StageError(StageFault::Silent, std::string("silent: ") + doing);
      case Fault::StageRefused:
        throw StageError(StageFault::Refused, std::string("refused: ") + doing);
      case Fault::StageRestarted:
        world_.homed = false;
        throw StageError(StageFault::PositionLost, "restarted");
      case Fault::StageWrong:
        world_.homed = false;
        world_.height_um += 7;
        throw StageError(StageFault::WrongPosition, "elsewhere");
      case Fault::StageGone:
        world_.stage_reachable = false;
        world_.homed = false;
        throw StageError(StageFault::Disconnected, "the stage is gone");
      default:
        break;
    }
  }

  World& world_;
};

/// A job of `layers` pictures of 2 × 2 pixels: the first pixel tells the layer.
inline LayerSource small_job(std::size_t layers) {
  LayerSource source;
  source.identity = "small-" + std::to_string(layers);
  source.frame.columns = source.frame.rows = 2;
  for (std::size_t i = 0; i < layers; ++i) {
    source.frame.layers.push_back({{}, 1.0 + 0.25 * double(i % 3), Length::from_um(18.0 * double(i + 1))});
  }
  source.read = [](std::size_t index) {
    return std::vector<std::uint8_t>{static_cast<std::uint8_t>(index), 255, 7, 0};
  };
  return source;
}

inline MachineProfile small_machine() {
  MachineProfile profile;
  profile.bottom_layers = 2;
  profile.bottom_exposure_s = 4.0;
  profile.transition_layers = 2;
  return profile;
}

/// What an undisturbed print puts into the vat.
inline Vat expected_vat(const PrintPlan& plan) {
  Vat vat;
  for (std::size_t i = 0; i < plan.layers.size(); ++i) vat.lit_s[i][i] = plan.layers[i].exposure_s;
  return vat;
}

}  // namespace mezzotint::test
