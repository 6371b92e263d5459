#pragma once

#include <cstdint>

#include "fabrication/job/job.h"
#include "forward/base/progress.h"
#include "forward/process/printed_relief.h"

namespace mezzotint {

struct VirtualPrinterOptions {
  std::size_t subsamples = 4;                 ///< samples a pixel and axis of the printed relief
  Length wavelength = Length::from_um(0.55);  ///< decides which octaves of the ground are geometry
  std::uint64_t seed = 1;                     ///< the printer's own draw: ground noise and stage error
  Length stage_error = Length::from_um(0.3);  ///< standard deviation of a platform step (assumed)
};

/// Prints a job on a simulated printer: every layer through the process model, on top of what is there.
///
/// Frame    z = 0 at the lower face of the last layer, which is the relief's: the top of what was fully cured
///          under it. `datum` is the height of that face over the platform. x, y from the picture's corner:
///          sample (0, 0) lies half a sub-pixel inside of it.
/// Shape    columns·subsamples × rows·subsamples of the job's picture, dark margin included; not periodic. Where
///          nothing cured the platform is seen.
/// Model    Each layer's light is blurred, dark around the picture, and goes on into the layers below it, where
///          doses add up (DepthDose): a terrace under dark layers grows by their stray light, and resin below an
///          overhang cures downward. z = lower face of the topmost layer that cures in a column + its cured height, up
///          to the gap that the platform left (the job's step plus its error). A layer under others that cures 0.9 of
///          its gap or more counts as filled (17.83 of 18 µm at the slides' full gray under dark layers). A layer's
///          exposure counts against the profile's: k times as long moves α by β ln k.
/// Overhang what cures above a void must fill its own layer and hold on to a neighbour; from above its top is seen.
///          What it cures below itself is in StackProcess, not in this height field.
/// Errors   MethodError where the top is no height field over the part: see `require_height_field` (each pixel is
///          taken at its own gray there, so that the blurred rim is none); InvalidInput where the job does not fit the
///          profile (pixel pitch, picture size, LED amplitude).
[[nodiscard]] HeightField print_virtually(const Job& job, const PrinterProfile& profile,
                                          const VirtualPrinterOptions& options, const Progress& progress = {});

}  // namespace mezzotint
