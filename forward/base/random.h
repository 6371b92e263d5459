#pragma once

#include <array>
#include <cstdint>

namespace mezzotint {

/// What a random number is for. Streams of different purposes never overlap, so that adding a draw
/// in one place changes nothing anywhere else. Append only: the values are part of every result.
enum class RandomPurpose : std::uint32_t {
  RayPosition = 1,
  RayChoice = 2,
  PatternImpulse = 3,
  GroundImpulse = 4,
  IncidentDirection = 5,
  SearchStart = 6,
  StageError = 7,
  InstrumentNoise = 8,
  Test = 9,
  PatternPart = 10,
  Pilot = 11,
  InstrumentOutlier = 12,
  InstrumentHole = 13,
  StudySample = 14,
  StudyTexture = 15,
  SamplePlace = 16,
  TextureDraw = 17,
  GamutTarget = 18
};

/// Random numbers by counter: a pure function of (seed, purpose, index, draw). No state is shared,
/// so the same indices give the same numbers with any number of threads and in any order.
///
/// Source   Philox4x32-10 of Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011,
///          in D. E. Shaw Research's Random123.
class RandomStream {
public:
  RandomStream(std::uint64_t seed, RandomPurpose purpose) : seed_(seed), purpose_(purpose) {}

  /// Four numbers, uniform in [0, 1) with 32 bits each.
  [[nodiscard]] std::array<double, 4> uniform4(std::uint64_t index, std::uint32_t draw = 0) const;

  /// Four independent standard normal numbers (Box–Muller).
  [[nodiscard]] std::array<double, 4> normal4(std::uint64_t index, std::uint32_t draw = 0) const;

  /// Four raw 32-bit words.
  [[nodiscard]] std::array<std::uint32_t, 4> bits4(std::uint64_t index, std::uint32_t draw = 0) const;

private:
  std::uint64_t seed_;
  RandomPurpose purpose_;
};

}  // namespace mezzotint
