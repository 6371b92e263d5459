#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/report/charts.h"
#include "experiments/report/components.h"
#include "experiments/report/report.h"
#include "forward/base/random.h"

// A report with every component, from invented but plausible data: what the page's tests draw.
namespace mezzotint::test {

inline const std::string hostile_text = "</script><b id=\"broken-out\">bold</b><!-- <script>";

/// A Gaussian lobe of slopes about the mirror direction; not the library's Beckmann lobe on purpose.
inline DirectionMap demo_lobe(const DirectionGrid& grid, double alpha_x, double alpha_y, double rotation_deg,
                              const DirectionAngles& light) {
  const double c = std::cos(rotation_deg * std::numbers::pi / 180), s = std::sin(rotation_deg * std::numbers::pi / 180);
  const double lx = std::sin(light.theta.radians()) * std::cos(light.phi.radians());
  const double ly = std::sin(light.theta.radians()) * std::sin(light.phi.radians());
  const double lz = std::cos(light.theta.radians());
  DirectionMap map(grid.size(), 0.0);
  for (std::size_t k = 0; k < map.size(); ++k) {
    const double x = (2.0 * static_cast<double>(k % grid.width) + 1.0) / static_cast<double>(grid.width) - 1.0;
    const double y = (2.0 * static_cast<double>(k / grid.width) + 1.0) / static_cast<double>(grid.height) - 1.0;
    const double z = std::sqrt(std::max(0.0, 1.0 - x * x - y * y));
    if (z <= 0.0) continue;
    const double p = -(x + lx) / (z + lz), q = -(y + ly) / (z + lz);
    const double u = (c * p + s * q) / alpha_x, v = (c * q - s * p) / alpha_y;
    map[k] = std::exp(-u * u - v * v) / (4.0 * std::numbers::pi * alpha_x * alpha_y * lz * (0.2 + 0.8 * z));
  }
  return map;
}

inline NamedMap demo_achieved(const NamedMap& target) {
  NamedMap map = target;
  map.name = "Achieved";
  map.target = false;
  map.note.clear();
  map.mean = demo_lobe(target.grid, 0.262, 0.108, 31.4, *target.incidence);
  const RandomStream random(7, RandomPurpose::Test);
  for (std::size_t k = 0; k < map.mean.size(); ++k) {
    map.standard_error.push_back(0.0004 + 0.03 * std::sqrt(map.mean[k]));
    map.mean[k] = std::max(0.0, map.mean[k] + map.standard_error[k] * random.normal4(k)[0]);
  }
  return map;
}

/// A few dozen plane waves, steeper along 30°.
inline HeightField demo_relief(std::size_t columns, std::size_t rows, double pitch_um, double gain, double noise_um,
                               bool gaps) {
  HeightField field({columns, rows, Length::from_um(pitch_um), Length::from_um(pitch_um)},
                    gaps ? Continuation::Mirrored : Continuation::Periodic);
  const RandomStream random(3, RandomPurpose::Test);
  std::vector<std::array<double, 3>> waves;
  for (std::uint64_t k = 0; k < 40; ++k) {
    const auto draw = random.normal4(k);
    const double u = draw[0] / 42.0, v = draw[1] / 105.0;  // wave vector along its own axes, in rad/µm
    waves.push_back({0.866 * u - 0.5 * v, 0.5 * u + 0.866 * v, 3.1 * draw[2]});
  }
  for (std::size_t k = 0; k < field.grid().size(); ++k) {
    const double x = pitch_um * static_cast<double>(k % columns), y = pitch_um * static_cast<double>(k / columns);
    double height_um = 0.0;
    for (const auto& [a, b, phase] : waves) height_um += std::cos(2.2 * (a * x + b * y) + phase);
    const double rough_um = noise_um * random.normal4(k, 1)[0];
    field.heights_um()[k] = static_cast<float>(gain * height_um + rough_um);
    const bool blind = std::hypot(x - 150.0, y - 420.0) < 38.0 || std::hypot(x - 610.0, y - 130.0) < 22.0;
    if (gaps && blind) field.heights_um()[k] = std::numeric_limits<float>::quiet_NaN();
  }
  return field;
}

inline Section demo_optics() {
  NamedMap target;
  target.name = "Target";
  target.grid = {64, 64};
  target.incidence = DirectionAngles{Angle::from_degrees(20.0), Angle::from_degrees(0.0)};
  target.mean = demo_lobe(target.grid, 0.25, 0.10, 30.0, *target.incidence);
  target.target = true;
  target.note = "closed form";
  const NamedMap achieved = demo_achieved(target);
  const NamedMap difference = difference_map("Achieved − target", achieved, target);

  Section section{"Appearance",
                  "The lobe of the **virtual print** against the target, for light at θ = 20°, φ = 0°. "
                  "Both were computed on the rung `paths`; each bin is averaged over *pixel ∩ disc*.\n\n"
                  "The residual is a rotation of 1.4° and a widening of 5 %, both within tolerance.",
                  {}};
  section.components.push_back(direction_maps(
      {"BRDF, light at 20°", "Orthographic projection: x to the right, y upward, the rim is the horizon."},
      {target, achieved, difference}, {.difference_label = "Achieved − target", .logarithmic = false}));
  section.components.push_back(lobe_viewer(
      {"The lobe in three dimensions", "Wires: target. Surface: achieved.", Span::Half}, {target, achieved}));
  Series wanted{"target", {}, {}, {}, true}, found{"achieved", {}, {}, {}, false};
  for (int k = -80; k <= 80; k += 2) {
    const double angle = k, value = 2.9 * std::exp(-std::pow((k + 20.0) / 21.0, 2));
    wanted.x.push_back(angle);
    wanted.y.push_back(value);
    found.x.push_back(angle);
    found.y.push_back(2.8 * std::exp(-std::pow((k + 20.0) / 22.0, 2)) + 0.02 + 0.015 * std::sin(k));
    found.standard_error.push_back(0.004 + 0.04 * value);
  }
  section.components.push_back(line_chart({"Plane of incidence", "", Span::Half},
                                          {"Viewing angle in the plane of incidence (°)", "BRDF (sr⁻¹)"},
                                          {wanted, found}));
  return section;
}

inline Section demo_relief_section() {
  const HeightField design = demo_relief(384, 320, 1.885, 0.62, 0.0, false);
  const HeightField printed = demo_relief(384, 320, 1.885, 0.57, 0.08, false);
  const HeightField measured = demo_relief(550, 460, 1.32, 0.58, 0.12, true);
  const std::vector<NamedRelief> reliefs = {{"Design", design}, {"Printed (virtual)", printed}, {"Measured", measured}};
  Section section{
      "Relief", "What was asked for, what the printer's process leaves of it, and what the instrument saw.", {}};
  section.components.push_back(relief_maps({"Heights", "One scale for all three; the mean plane is zero."}, reliefs));
  section.components.push_back(relief_viewer({"Relief in three dimensions", "", Span::TwoThirds}, reliefs));
  const auto axes = [](double major, double minor, double degrees) {
    return SlopeAxes{major, minor, Angle::from_degrees(degrees)};
  };
  section.components.push_back(
      slope_ellipses({"Slope covariance", "One-sigma ellipses and their long axes.", Span::Third},
                     {{"target", axes(0.177, 0.071, 30.0), true}, {"printed", axes(0.181, 0.074, 31.4), false}}));
  section.components.push_back(
      messages({{MessageLevel::Note, "The instrument could not see two spots; they enter no statistic."}}));
  return section;
}

inline Section demo_numbers() {
  const auto q = [](double value, const char* unit, double error) { return Quantity{value, unit, error}; };
  Section section{"Numbers", "Every value with its standard error; digits follow from it.", {}};
  section.components.push_back(table(
      {"Roughness side by side", "Parameters of ISO 25178-2, S-filter 2.5 µm.", Span::TwoThirds},
      {"Parameter", "Target", "Printed", "Measured", "Difference"},
      {{{"Sq", Quantity{2.71, "um", {}}, q(2.6932, "um", 0.0118), q(2.741, "um", 0.031), q(1.8, "%", 1.2)},
        Outcome::Met},
       {{"Sa", Quantity{2.16, "um", {}}, q(2.1489, "um", 0.0094), q(2.187, "um", 0.025), q(1.8, "%", 1.2)},
        Outcome::Met},
       {{"Sz", Quantity{17.8, "um", {}}, q(17.21, "um", 0.35), q(19.64, "um", 0.81), q(14.1, "%", 5.2)},
        Outcome::Missed},
       {{"Sdq", Quantity{0.1904, "1", {}}, q(0.19562, "1", 0.00084), q(0.2011, "1", 0.0023), q(2.8, "%", 1.2)},
        Outcome::Met},
       {{"Flux cut off", Quantity{0.0, "1", {}}, q(1.234e-5, "1", 1.2e-6), nullptr, nullptr}, Outcome::Information},
       {{hostile_text, 12, 1234567, 0.0003, "n/a"}, Outcome::Information}}));
  section.components.push_back(bar_chart({"Roughness", "", Span::Third}, "Value (µm)",
                                         {{"Sq", "printed", 2.6932, 0.0118},
                                          {"Sq", "measured", 2.741, 0.031},
                                          {"Sa", "printed", 2.1489, 0.0094},
                                          {"Sa", "measured", 2.187, 0.025}}));
  return section;
}

inline Section demo_search() {
  Section section{"Search", "`LN_BOBYQA` on the process model: 4 parameters, 120 evaluations.", {}};
  std::vector<double> objectives;
  const RandomStream random(11, RandomPurpose::Test);
  for (std::size_t k = 0; k < 120; ++k) {
    const double bottom = 0.031 + 1.1 * std::exp(-static_cast<double>(k) / 14.0);
    objectives.push_back(bottom * std::exp(0.5 * std::abs(random.normal4(k)[0])));
  }
  objectives[40] = std::numeric_limits<double>::quiet_NaN();
  section.components.push_back(
      search_history({"Course of the search", "", Span::Half}, objectives, 0.05, "Largest slope error"));
  Histogram histogram{"printed", {}, {}};
  Series target{"target", {}, {}, {}, true};
  for (int k = -30; k <= 30; ++k) {
    const double slope = 0.02 * k, next = slope + 0.02;
    histogram.edges.push_back(slope);
    if (k < 30)
      histogram.density.push_back(2.45 * std::exp(-std::pow((slope + next) / 2.0 / 0.23, 2)) +
                                  0.05 * std::cos(9.0 * k));
    if (k < 30 && histogram.density.back() < 0.0) histogram.density.back() = 0.0;
    target.x.push_back(slope);
    target.y.push_back(2.34 * std::exp(-std::pow(slope / 0.241, 2)));
  }
  section.components.push_back(slope_histogram({"Slopes along x", "", Span::Half}, histogram, {target}));
  return section;
}

inline Report demo_report() {
  Report report;
  report.title = "Anisotropic Beckmann lobe, 0.25 × 0.10 at 30°";
  report.subtitle =
      "Stretched sparse-convolution noise through the process model of `dlp9000`, virtual print, re-measured.";
  report.verdict = {Outcome::Met,
                    "Both slope axes are within 5 % of the target (largest error 4.8 % at α_y), and the lobe turns by "
                    "1.4° of the 3° allowed."};
  const auto figure = [&](const char* name, Quantity quantity, std::optional<double> at_most, Outcome outcome,
                          const char* note = "") {
    report.key_figures.push_back({name, std::move(quantity), at_most, outcome, note});
  };
  figure("Slope error, larger axis", {0.0476, "1", 0.0021}, 0.05, Outcome::Met);
  figure("Rotation of the lobe", {1.38, "deg", 0.22}, 3.0, Outcome::Met);
  figure("Relative L2 of the map", {0.0871, "1", 0.0034}, {}, Outcome::Information, "noise taken out");
  figure("Albedo", {0.99831, "1", 0.00042}, {}, Outcome::Information, "mirror material");
  figure("Highest gray", {1.019, "1", {}}, 1.0, Outcome::Missed, "saturates");
  report.messages = {
      {MessageLevel::Warning, "A full layer of 18 µm asks for a gray of 1.019: the top of the relief saturates."},
      {MessageLevel::Note, "The blur of the projector (σ = 0.5 pixel) is *assumed*, not calibrated."}};
  report.sections = {demo_optics(), demo_relief_section(), demo_numbers(), demo_search()};
  report.provenance = {{"program", "mezzotint 0.1.0"},
                       {"experiment", "beckmann-0.25-0.10.toml"},
                       {"seed", "1"},
                       {"hostile", hostile_text},
                       {"simd_target", "AVX2"},
                       {"relief_sha256", "6f1d4c0b7a6e2b1c9d8e7f60514233441526378495a6b7c8d9e0f1a2b3c4d5e6"}};
  return report;
}

}  // namespace mezzotint::test
