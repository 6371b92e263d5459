#pragma once

#include <nlohmann/json.hpp>

#include "tests/benchmark/tracer_race.h"

namespace mezzotint::benchmark {

/// How much of the time of a run is spent in the tracer: PathTracer::trace (a beam, no control variate, one thread)
/// against the tracer's calls alone on the same rays; and the same for the walk without its set-up and its summary.
nlohmann::json end_to_end(const RaceOptions& options);

}  // namespace mezzotint::benchmark
