#pragma once

#include <cstddef>
#include <cstdint>

#include <nlohmann/json.hpp>

namespace mezzotint::benchmark {

struct RaceOptions {
  std::size_t size = 1024;  ///< cells along either side
  double gradient = 0.3;
  std::uint32_t bits = 20;  ///< 2^bits rays a set
  int repetitions = 5;
  bool embree = true;
};

/// Our tracer against Embree on the same rays, one thread, turn by turn: prints a table and returns it.
nlohmann::json race(const RaceOptions& options);

/// What two threads are worth: time of one ÷ time of the slower of two.
nlohmann::json race_two_threads(const RaceOptions& options);

}  // namespace mezzotint::benchmark
