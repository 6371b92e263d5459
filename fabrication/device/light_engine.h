#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fabrication/device/clock.h"
#include "forward/base/error.h"

namespace mezzotint {

/// What can be wrong with a light engine, whatever its make.
enum class LightFault {
  Refused,           ///< the device answered that it will not; `device_code` and its text say why
  Timeout,           ///< no answer before the deadline
  Protocol,          ///< an answer that cannot be: short, over-long, of another command
  Disconnected,      ///< the cable or the power is gone
  Sequencer,         ///< the device's own timing stopped or failed
  MissingSecondary,  ///< the second controller, which drives the right half, does not answer
  LostSync,          ///< the display's signal is gone
  IgnoredSetting,    ///< accepted, yet reads back as something else; a device that reset itself looks like this
  Incompatible,      ///< not the device, firmware or display size that the driver is for
  OverTemperature    ///< the LED or its driver says that it is too hot
};

/// "refused", "timeout", …: for journals and messages.
[[nodiscard]] std::string_view fault_name(LightFault fault);

/// A light engine failed. The message says what was asked and what came back.
class LightEngineError : public DeviceError {
public:
  LightEngineError(LightFault fault, const std::string& message, std::optional<int> device_code = {})
      : DeviceError(message), fault_(fault), device_code_(device_code) {}

  [[nodiscard]] LightFault fault() const { return fault_; }
  /// The device's own code where it sent one.
  [[nodiscard]] std::optional<int> device_code() const { return device_code_; }

private:
  LightFault fault_;
  std::optional<int> device_code_;
};

/// An exposure ended early by a fault.
///
/// The layer got between `least_lit` and `most_lit` of light: a resumed print says so and does not guess.
class ExposureError : public LightEngineError {
public:
  ExposureError(const LightEngineError& cause, Clock::Duration least_lit, Clock::Duration most_lit, bool light_is_off)
      : LightEngineError(cause), least_lit_(least_lit), most_lit_(most_lit), light_is_off_(light_is_off) {}

  [[nodiscard]] Clock::Duration least_lit() const { return least_lit_; }
  /// Counts on the light's own end where the device times it; else meaningful only if `light_is_off()`.
  [[nodiscard]] Clock::Duration most_lit() const { return most_lit_; }
  /// Whether the device confirmed, after the fault, that the light is off. Where not, move the platform away.
  [[nodiscard]] bool light_is_off() const { return light_is_off_; }

private:
  Clock::Duration least_lit_;
  Clock::Duration most_lit_;
  bool light_is_off_;
};

struct LightEngineIdentity {
  std::string model;     ///< "DLP9000 (DLPC900)"
  std::string tag;       ///< the device's own name for itself, empty where it has none
  std::string firmware;  ///< "5.0.0"
  std::size_t columns = 0;
  std::size_t rows = 0;
};

/// What stays the same from layer to layer.
struct LightSettings {
  int led_amplitude = 230;    ///< 0…255, the printer profile's
  bool flip_columns = false;  ///< mirrored left to right: a projector that looks up from below needs one flip
  bool flip_rows = false;
};

/// A picture to be shown; borrowed, not copied.
///
/// Shape    rows × columns of the light engine, 8 bits a pixel, row after row; row 0 is the projector's first
///          row, that is the *top* of the archive's PNG (`JobLayer::gray` has row 0 at y = 0: turn it).
struct ShownPicture {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::span<const std::uint8_t> gray;
};

/// The same picture mirrored left to right, top to bottom, or both.
[[nodiscard]] std::vector<std::uint8_t> flipped(const ShownPicture& picture, const LightSettings& settings);

/// What `show` will cost.
struct UploadEstimate {
  std::size_t bytes = 0;  ///< over the control link; 0 where the picture goes by a video cable
  Clock::Duration duration{0};
};

struct ExposureReport {
  Clock::Duration requested{0};
  Clock::Duration lit{0};          ///< as the host measured it, or as the device timed it
  Clock::Duration uncertainty{0};  ///< the light was on for `lit`, give or take this at most
  bool complete = true;            ///< false where `go_on` ended it
};

struct LightStatus {
  bool light_on = false;  ///< what the device says, not what the host believes
  bool ready = true;      ///< initialised, nothing in `faults`
  std::vector<LightFault> faults;
};

/// A projector as a print session sees it: it shows a picture in the dark, and lights it for a stated time.
///
/// Light    is on inside of `expose` alone. It is off after construction and after every function that returns or
///          throws, as far as the device can still be reached; the destructor sees to it too.
/// Life     Made connected and identified (see `LightEngineFactory`). After a LightEngineError `prepare` it again, as
///          it was put into its dark state; after `Disconnected` throw it away and make another.
/// Threads  One thread at a time.
/// Errors   LightEngineError (ExposureError out of `expose`); InvalidInput for a picture of another size,
///          an amplitude outside of 0…255, an exposure that is not positive, a picture whose upload is absurd.
class LightEngine {
public:
  virtual ~LightEngine() = default;

  [[nodiscard]] virtual const LightEngineIdentity& identity() const = 0;

  /// Sets everything and reads it back. Light stays off.
  virtual void prepare(const LightSettings& settings) = 0;

  /// Talks to no device.
  [[nodiscard]] virtual UploadEstimate estimate(const ShownPicture& picture) const = 0;

  /// Loads a picture and how long it will be lit; returns when `expose` may follow. Light stays off.
  /// Reads the settings back first: a device that reset itself since is found out here.
  virtual void show(const ShownPicture& picture, Clock::Duration exposure) = 0;

  /// Lights the shown picture for its exposure, once: a second call needs another `show`.
  /// @param go_on  asked a few times a second while the light is on; false puts it off and returns
  ///               `complete = false`. What it throws passes through, with the light off.
  [[nodiscard]] virtual ExposureReport expose(const std::function<bool()>& go_on) = 0;

  /// Puts the light off and stops the device's sequencer, and makes sure. Any number of times.
  virtual void light_off() = 0;
  /// The same for destructors and signal paths: never throws; true where the device confirmed it.
  [[nodiscard]] virtual bool try_light_off() noexcept = 0;

  [[nodiscard]] virtual LightStatus status() = 0;
};

/// Connects, identifies, puts the light off.
using LightEngineFactory = std::function<std::unique_ptr<LightEngine>()>;

}  // namespace mezzotint
