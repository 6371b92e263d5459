#pragma once

#include <memory>
#include <string>

#include "experiments/configuration/machine_file.h"
#include "fabrication/device/light_engine.h"
#include "fabrication/job/job.h"
#include "fabrication/stage/stage.h"

namespace mezzotint {

/// The devices of a machine by the name that `print --device` has for them.
///
/// @param clock  outlives them
/// @throws LightEngineError, StageError where they cannot be reached
[[nodiscard]] std::unique_ptr<Stage> make_stage(const std::string& device, const Machine& machine, Clock& clock);
[[nodiscard]] std::unique_ptr<LightEngine> make_light(const std::string& device, const Machine& machine,
                                                      const Job& frame, Clock& clock);

/// Connects to the projector anew and puts its light off: what a guardian does. True where it is surely off.
[[nodiscard]] bool put_light_off(const Machine& machine);

}  // namespace mezzotint
