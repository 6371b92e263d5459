// How much of a wanted relief proximity correction brings back, and what it costs. Not a test.
//
// Errors are RMS of printed − wanted heights, the printer's levels and blur included, without ground noise: at fresh
// sub-pixel positions (5 × 5 a pixel, moved, none of them optimised), and of pixels' means. "before" exposes each
// pixel for the height at its centre.

#include <chrono>
#include <cmath>
#include <ctime>

#include <fmt/format.h>

#include "forward/pattern/pattern.h"
#include "forward/process/printed_relief.h"
#include "forward/process/proximity_correction.h"

namespace {

using namespace mezzotint;

constexpr std::size_t pixels = 256;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

HeightField sampled(const Pattern& pattern, const PrinterProfile& printer, std::size_t columns, std::size_t rows,
                    std::size_t samples, double place_x = 0.5, double place_y = 0.5) {
  const Length pitch = printer.pixel_pitch / static_cast<double>(samples);
  return synthesize(pattern, {columns * samples, rows * samples, pitch, pitch}, {pitch * place_x, pitch * place_y});
}

// Without the outermost pixels, beyond which the pattern goes on and the mirror does not.
double rms_difference(const HeightField& a, const HeightField& b, std::size_t border) {
  double squares = 0.0, count = 0.0;
  for (std::size_t r = border; r < a.rows() - border; ++r) {
    for (std::size_t c = border; c < a.columns() - border; ++c, ++count)
      squares += std::pow(double(a.at(c, r)) - double(b.at(c, r)), 2.0);
  }
  return std::sqrt(squares / count);
}

HeightField means(const HeightField& field, std::size_t n) {
  const Length pitch = field.grid().pitch_x * static_cast<double>(n);
  HeightField mean({field.columns() / n, field.rows() / n, pitch, pitch}, Continuation::Mirrored);
  for (std::size_t r = 0; r < field.rows(); ++r)
    for (std::size_t c = 0; c < field.columns(); ++c)
      mean.at(c / n, r / n) += field.at(c, r) / static_cast<float>(n * n);
  return mean;
}

struct Errors {
  double samples, means;
};
Errors errors_of(const GrayImage& image, const Pattern& pattern, const PrinterProfile& printer) {
  const ProcessOptions fresh{.subsamples = 5, .surround = Surround::Mirror, .place_x = 0.21, .place_y = 0.83};
  const HeightField printed = print_layer(image, printer, fresh);
  const HeightField wanted = sampled(pattern, printer, pixels, pixels, 5, fresh.place_x, fresh.place_y);
  return {rms_difference(printed, wanted, 20), rms_difference(means(printed, 5), means(wanted, 5), 4)};
}

void study(const char* name, const Pattern& pattern, const PrinterProfile& printer) {
  const ProcessOptions process{.subsamples = 4, .surround = Surround::Mirror};
  const GrayImage plain = quantize(expose(sampled(pattern, printer, pixels, pixels, 1), printer).image, printer);
  const Errors before = errors_of(plain, pattern, printer);
  fmt::print("{:24} before {:.3f} µm (means {:.3f})\n", name, before.samples, before.means);
  for (const std::size_t steps : {3U, 10U, 20U, 40U, 100U}) {
    const double start = cpu_seconds();
    const auto corrected =
        correct_proximity(sampled(pattern, printer, pixels, pixels, 4), printer, process, {.steps = steps});
    const double seconds = cpu_seconds() - start;
    const Errors after = errors_of(corrected.image, pattern, printer);
    const auto counts = corrected.counts();
    fmt::print(
        "  {:3} steps: {:.3f} µm, {:4.1f} times less (means {:.3f}, {:4.1f}); at its own samples {:.3f}; {:.2f} s "
        "CPU; unreached: more light {}, too much {}, finer {}\n",
        steps, after.samples, before.samples / after.samples, after.means, before.means / after.means,
        corrected.error_after.um(), seconds, counts[1], counts[2], counts[3]);
  }
}

void study_speed(std::size_t samples, std::size_t per_pixel) {
  const PrinterProfile printer;
  const HeightField wanted = sampled(Noise{.scale = 60.0_um, .stretch = 2.5}, printer, 2560, 1600, per_pixel);
  const double start = cpu_seconds();
  const auto wall = std::chrono::steady_clock::now();
  const auto corrected =
      correct_proximity(wanted, printer, {.subsamples = samples, .surround = Surround::Dark}, {.steps = 20});
  fmt::print(
      "2560 × 1600, {}² samples a pixel, {}² wanted heights, 20 steps: {:.1f} s CPU, {:.1f} s; error {:.3f} → "
      "{:.3f} µm\n",
      samples, per_pixel, cpu_seconds() - start,
      std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count(), corrected.error_before.um(),
      corrected.error_after.um());
}

}  // namespace

int main() {
  const Angle steep = 30.0_deg;
  PrinterProfile printer;
  for (const double sigma : {0.3, 0.5, 1.0}) {
    printer.spread.width = printer.pixel_pitch * sigma;
    fmt::print("blur of {} pixels\n", sigma);
    study("noise.toml", Noise{60.0_um, 2.5, steep, 16.0_um}, printer);
    study("ridges.toml", Ridges{120.0_um, steep, 16.0_um}, printer);
    study("brushed.toml", LineIntegralConvolution{30.0_um, 300.0_um, steep, 16.0_um}, printer);
    study("noise of 4 pixels", Noise{60.0_um, 1.0, steep, 16.0_um}, printer);
  }
  study_speed(2, 2);
  study_speed(2, 1);
}
