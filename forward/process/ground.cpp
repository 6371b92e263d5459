#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "forward/base/error.h"
#include "forward/base/random.h"
#include "forward/pattern/noise_scatter.h"
#include "forward/pattern/sparse_noise.h"
#include "forward/process/printed_relief.h"

namespace mezzotint {

namespace {

// The noise is rougher on the planes of its lattice (mean square 0.0226) and smoother between them (0.0215); a quarter
// of a cell away from a plane it has the mean that the closed forms promise.
constexpr double plane_of_mean_roughness = 0.25;

// An octave is named by its scale; a second one of the same scale gets another draw.
std::uint64_t octave_seed(std::uint64_t seed, const std::vector<GroundOctave>& octaves, std::size_t index) {
  const Length scale = octaves[index].scale;
  const auto earlier = std::count_if(octaves.begin(), octaves.begin() + static_cast<std::ptrdiff_t>(index),
                                     [scale](const GroundOctave& other) { return other.scale == scale; });
  const RandomStream stream(seed, RandomPurpose::GroundImpulse);
  const auto words = stream.bits4(std::bit_cast<std::uint64_t>(scale.um()), static_cast<std::uint32_t>(earlier));
  return (std::uint64_t{words[0]} << 32) | words[1];
}

// Missing samples are NaN and stay it.
void add_octave(HeightField& relief, const Position& first, double amplitude_um, Length scale, std::uint64_t seed) {
  const PatternMap map = in_units({.u0 = first.x.um(), .v0 = first.y.um()}, scale.um(), scale.um());
  add_sparse_noise(relief.heights_um(), relief.grid(), map, NoiseLattice(seed, CellHash::Integer),
                   plane_of_mean_roughness, amplitude_um);
}

}  // namespace

Length ground_rms_height(const PrinterProfile& profile, const GroundOctave& octave) {
  return profile.ground_amplitude * (std::abs(octave.weight) * std::sqrt(noise_variance));
}

GroundSplit split_ground(const PrinterProfile& profile, Length wavelength) {
  require(std::isfinite(wavelength.um()) && wavelength.um() > 0.0, "a wavelength must be positive");
  require_valid(profile);
  GroundSplit split;
  double square_phase = 0.0;
  for (const GroundOctave& octave : profile.ground) {
    const double phase = 4.0 * std::numbers::pi * (ground_rms_height(profile, octave) / wavelength);
    if (phase < 1.0) square_phase += phase * phase;
    (phase < 1.0 ? split.coherent : split.geometric).push_back(octave);
  }
  split.coherent_share = std::exp(-square_phase);
  return split;
}

namespace {

void add_ground_from(HeightField& relief, const Position& first, const PrinterProfile& profile,
                     const std::vector<GroundOctave>& octaves, std::uint64_t seed) {
  PrinterProfile checked = profile;
  checked.ground = octaves;
  require_valid(checked);
  for (std::size_t i = 0; i < octaves.size(); ++i) {
    const double amplitude_um = profile.ground_amplitude.um() * octaves[i].weight;
    if (amplitude_um != 0.0) add_octave(relief, first, amplitude_um, octaves[i].scale, octave_seed(seed, octaves, i));
  }
}

}  // namespace

void add_ground(HeightField& relief, const PrinterProfile& profile, const std::vector<GroundOctave>& octaves,
                std::uint64_t seed) {
  add_ground_from(relief, {}, profile, octaves, seed);
}

ReliefSlopes ground_slopes(const Grid& grid, const Position& first, const PrinterProfile& profile,
                           const std::vector<GroundOctave>& octaves, std::uint64_t seed) {
  constexpr double step_um = 0.1;
  const auto moved = [&](double x_um, double y_um) {
    HeightField ground(grid, Continuation::Mirrored);
    add_ground_from(ground, {first.x + Length::from_um(x_um), first.y + Length::from_um(y_um)}, profile, octaves, seed);
    return ground;
  };
  const auto slopes = [&](const HeightField& above, const HeightField& below) {
    std::vector<float> values(grid.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = (above.heights_um()[i] - below.heights_um()[i]) / static_cast<float>(2.0 * step_um);
    return values;
  };
  return {slopes(moved(step_um, 0.0), moved(-step_um, 0.0)), slopes(moved(0.0, step_um), moved(0.0, -step_um))};
}

double ground_rms_slope(const PrinterProfile& profile, const std::vector<GroundOctave>& octaves) {
  double sum = 0.0;
  for (const GroundOctave& octave : octaves) {
    const double ratio = octave.weight * (profile.ground_amplitude / octave.scale);
    sum += ratio * ratio;
  }
  return std::sqrt(sum * noise_plane_gradient_square / 2.0);
}

}  // namespace mezzotint
