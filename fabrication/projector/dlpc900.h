#pragma once

#include <memory>

#include "fabrication/device/layer_window.h"
#include "fabrication/device/light_engine.h"
#include "fabrication/projector/report_transport.h"

namespace mezzotint {

/// How a machine's DLPC900 is wired and used.
struct Dlpc900Options {
  enum class Way {
    Video,  ///< the picture goes by the video cable, the light is gated over USB: the way for gray layers
    Upload  ///< "pattern on the fly": the picture goes over USB, the device times the light; for simple layers
  };
  Way way = Way::Video;
  /// Video: show the 8-bit plane by the pattern sequencer, linear and for 97 % of a 60 Hz frame. Plain video splits
  /// the frame into slots for red, green and blue, and may have a curve of its own.
  bool video_by_sequencer = true;
  int video_receiver = 2;                                       ///< 1 HDMI, 2 DisplayPort
  Clock::Duration video_delay{std::chrono::milliseconds(100)};  ///< from the window to the mirrors (assumed)
  unsigned leds = 7;                   ///< which outputs drive the UV LED: 1 red, 2 green, 4 blue, and their sums
  bool led_polarity_inverted = false;  ///< of the driver board
  Clock::Duration longest_upload{std::chrono::seconds(30)};  ///< a longer one is refused …
  bool force_upload = false;                                 ///< … unless this is set
  Clock::Duration poll{std::chrono::milliseconds(200)};      ///< while the light is on
};

/// A projector with TI's DLPC900 controllers: DLP9000 (two of them, 2560 × 1600) or DLP6500 (one, 1920 × 1080).
///
/// Exposure   Video: the host switches the LEDs; `uncertainty` is what the longer of the two orders took. Upload: the
///            device times it; `uncertainty` is how closely the host saw it end.
/// Faults     LightEngine's. A setting that does not read back stops the print: a device that reset itself has a
///            lower LED current than it was given. What has no read form (pattern entries, image data) is trusted
///            once acknowledged; a wrong time of the pattern entry is noticed by when the sequence ends.
/// @param clock   outlives the engine.
/// @param window  for `Way::Video`; of the projector's size.
/// @throws LightEngineError as `open_usb` does; Incompatible for other mirrors or a window of another size;
///         MissingSecondary.
[[nodiscard]] std::unique_ptr<LightEngine> make_dlpc900(std::unique_ptr<dlpc900::ReportTransport> transport,
                                                        Clock& clock, const Dlpc900Options& options,
                                                        std::unique_ptr<LayerWindow> window = nullptr);

}  // namespace mezzotint
