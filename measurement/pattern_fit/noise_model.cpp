#include "measurement/pattern_fit/noise_model.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <tbb/parallel_for.h>

#include "forward/pattern/noise_spectrum.h"
#include "forward/pattern/sparse_noise.h"

namespace mezzotint {

namespace {

using Member = double NoiseNumbers::*;

std::vector<Member> free_members(const NoiseModel& model) {
  std::vector<Member> members = {&NoiseNumbers::floor, &NoiseNumbers::log_height, &NoiseNumbers::log_scale};
  if (model.stretched) members.insert(members.end(), {&NoiseNumbers::stretch_cos, &NoiseNumbers::stretch_sin});
  if (model.octaves > 1) members.push_back(&NoiseNumbers::hurst);
  if (model.octaves > 1 && model.free_lacunarity) members.push_back(&NoiseNumbers::log_lacunarity);
  return members;
}

double log_stretch(const NoiseNumbers& numbers) { return std::hypot(numbers.stretch_cos, numbers.stretch_sin); }

double direction_radians(const NoiseNumbers& numbers) {
  return 0.5 * std::atan2(numbers.stretch_sin, numbers.stretch_cos);
}

// One octave of the model, as the samples see it.
struct SeenOctave {
  double ux, uy, vx, vy;  // frequency to cycles a cell
  double power;           // of the density in cycles a cell
  int aliases;            // how many multiples of the sampling frequency fold back; −1: all, so that it is white
};

// A cell of eight samples has 1e-7 of its power beyond them; one of a sample or two can hardly be told from white
// noise.
int aliases(double samples_a_cell) {
  if (samples_a_cell > 8.0) return 0;
  if (samples_a_cell > 2.5) return 1;
  return samples_a_cell > 1.5 ? 2 : -1;
}

std::vector<SeenOctave> seen_octaves(const NoiseModel& model, const NoiseNumbers& numbers, const Grid& grid) {
  const CellSize cell = cell_size_um(numbers);
  const double c = std::cos(direction_radians(numbers)), s = std::sin(direction_radians(numbers));
  const double pitch = std::max(grid.pitch_x.um(), grid.pitch_y.um());
  double squares = 0.0;
  for (int i = 0; i < model.octaves; ++i) squares += std::exp(-2.0 * numbers.hurst * numbers.log_lacunarity * i);
  std::vector<SeenOctave> octaves;
  for (int i = 0; i < model.octaves; ++i) {
    const double shrunk = std::exp(-numbers.log_lacunarity * i);
    const double u = cell.along * shrunk, v = cell.across * shrunk;
    const double share =
        std::exp(2.0 * numbers.log_height - 2.0 * numbers.hurst * numbers.log_lacunarity * i) / squares;
    octaves.push_back({u * c, u * s, -v * s, v * c, share * u * v, aliases(u / pitch)});
  }
  return octaves;
}

double density(const SeenOctave& octave, double x, double y, const Grid& grid) {
  const double u = octave.ux * x + octave.uy * y, v = octave.vx * x + octave.vy * y;
  if (octave.aliases == 0) return noise_spectral_density(u, v);
  double sum = 0.0;
  for (int i = -octave.aliases; i <= octave.aliases; ++i)
    for (int j = -octave.aliases; j <= octave.aliases; ++j) {
      const double a = i / grid.pitch_x.um(), b = j / grid.pitch_y.um();
      sum += noise_spectral_density(u + octave.ux * a + octave.uy * b, v + octave.vx * a + octave.vy * b);
    }
  return sum;
}

}  // namespace

std::size_t NoiseModel::size() const { return free_members(*this).size(); }

std::vector<double> free_numbers(const NoiseModel& model, const NoiseNumbers& numbers) {
  std::vector<double> values;
  for (const Member member : free_members(model)) values.push_back(numbers.*member);
  return values;
}

NoiseNumbers with_free_numbers(const NoiseModel& model, NoiseNumbers numbers, const std::vector<double>& values) {
  const std::vector<Member> members = free_members(model);
  for (std::size_t i = 0; i < members.size(); ++i) numbers.*members[i] = values.at(i);
  return numbers;
}

CellSize cell_size_um(const NoiseNumbers& numbers) {
  const double half = 0.5 * log_stretch(numbers);
  return {std::exp(numbers.log_scale - half), std::exp(numbers.log_scale + half)};
}

CellFrequency in_cells(const NoiseNumbers& numbers, const FrequencyBlock& block) {
  const CellSize cell = cell_size_um(numbers);
  const double c = std::cos(direction_radians(numbers)), s = std::sin(direction_radians(numbers));
  return {cell.along * (c * block.x_per_um + s * block.y_per_um),
          cell.across * (c * block.y_per_um - s * block.x_per_um)};
}

Pattern pattern_of(const NoiseModel& model, const NoiseNumbers& numbers) {
  const Length scale = Length::from_um(cell_size_um(numbers).along),
               height = Length::from_um(std::exp(numbers.log_height));
  const double stretch = std::exp(log_stretch(numbers));
  const Angle direction = Angle::from_radians(direction_radians(numbers));
  if (model.octaves == 1) return Noise{scale, stretch, direction, height};
  return FractionalBrownianMotion{
      scale, stretch, direction, height, numbers.hurst, std::exp(numbers.log_lacunarity), model.octaves};
}

std::vector<double> expected_density(const NoiseModel& model, const NoiseNumbers& numbers,
                                     const std::vector<FrequencyBlock>& blocks, const Grid& grid) {
  const std::vector<SeenOctave> octaves = seen_octaves(model, numbers, grid);
  const double sample = grid.pitch_x.um() * grid.pitch_y.um();
  std::vector<double> expected(blocks.size(), numbers.floor);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
    for (const SeenOctave& octave : octaves) {
      if (octave.aliases < 0) {
        // All of its variance, spread over the frequencies that the samples hold.
        const double cell = std::abs(octave.ux * octave.vy - octave.uy * octave.vx);
        expected[i] += octave.power / cell * noise_variance_at_z0 * sample;
      } else {
        expected[i] += octave.power * density(octave, blocks[i].x_per_um, blocks[i].y_per_um, grid);
      }
    }
  });
  return expected;
}

}  // namespace mezzotint
