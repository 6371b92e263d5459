#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "measurement/correction/gaussian_filter.h"
#include "measurement/texture/roughness.h"
#include "measurement/texture/spatial_parameters.h"
#include "measurement/texture/texture_notes.h"
#include "tests/measurement/relief.h"

namespace mezzotint::test {

/// A patch of Gaussian heights, samples 1 µm apart: white noise under a Gaussian filter of this cut-off, without rim
/// effects. Its autocorrelation is Gaussian, with Sal = 0.4755 cut-offs. The expected Sq is 1 µm.
inline HeightField texture(std::size_t side, double cutoff_um, std::uint64_t seed = 1) {
  const auto rim = static_cast<std::size_t>(std::ceil(1.2 * cutoff_um));
  const Grid grid = micrometre_grid(side + 2 * rim, side + 2 * rim);
  HeightField field = crop(s_filter(white_noise(grid, seed), Length::from_um(cutoff_um)), rim, rim, side, side);
  // The square sum of the weights exp(−π r²/(α λ)²)/(α λ)² is 1/(2 (α λ)²), α² = ln 2/π.
  const double scale = cutoff_um * std::sqrt(2.0 * 0.6931471805599453 / 3.141592653589793);
  for (float& z : field.heights_um()) z = static_cast<float>(double{z} * scale);
  return field;
}

/// Of the notes of `roughness`, the one with these words in it; empty where there is none.
inline std::string texture_note(const HeightField& field, const std::string& words) {
  const SpatialParameters spatial = spatial_parameters(field);
  std::vector<std::string> notes = texture_notes(field, area_roughness(field), &spatial);
  notes.push_back(spatial.note);
  for (const std::string& note : notes)
    if (note.find(words) != std::string::npos) return note;
  return "";
}

}  // namespace mezzotint::test
