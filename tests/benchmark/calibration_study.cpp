// How often intervals of a calibration hold the truth: over drawn tables of steps, and over whole wedges that were
// printed and scanned virtually. Usage: calibration_study [tables] [prints]

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "fabrication/calibration/cure_fit.h"
#include "fabrication/calibration/wedge_layout.h"
#include "fabrication/calibration/wedge_scan.h"
#include "fabrication/device/virtual_printer.h"
#include "measurement/instrument/virtual_profilometer.h"
#include "tests/fabrication/calibration/cure_samples.h"

namespace {

using namespace mezzotint;

const CureCurve slides;

struct Tally {
  std::array<int, 3> held{};
  std::array<double, 3> said{}, square{}, sum{};
  int fits = 0, undetermined = 0;

  void add(const CureFit& fit) {
    ++fits;
    undetermined += fit.gamma_is_determined ? 0 : 1;
    const std::array<double, 3> truth{slides.alpha.um(), slides.beta.um(), slides.gamma};
    const std::array<const FittedNumber*, 3> numbers{&fit.alpha_um, &fit.beta_um, &fit.gamma};
    for (std::size_t k = 0; k < 3; ++k) {
      const FittedNumber& number = *numbers[k];
      held[k] += number.low_95 <= truth[k] && truth[k] <= number.high_95 ? 1 : 0;
      said[k] += number.standard_error;
      sum[k] += number.value - truth[k];
      square[k] += (number.value - truth[k]) * (number.value - truth[k]);
    }
  }
  void print(const char* name) const {
    std::printf("%-44s %5d", name, fits);
    for (std::size_t k = 0; k < 3; ++k) {
      const double mean = sum[k] / fits, deviation = std::sqrt(square[k] / fits - mean * mean);
      std::printf("  %5.1f %% (%.2g, said %.2g)", 100.0 * held[k] / fits, deviation, said[k] / fits);
    }
    std::printf("  undetermined %d\n", undetermined);
  }
};

void study_tables(const char* name, const test::WedgeSample& sample, int tables,
                  const std::function<void(std::vector<CurePoint>&, std::uint64_t)>& spoil = {}) {
  Tally tally;
  CureFitOptions options;
  options.layer = Length::from_um(sample.layer_um);
  for (int i = 0; i < tables; ++i) {
    std::vector<CurePoint> points = test::draw(sample, 10000 + static_cast<std::uint64_t>(i));
    if (spoil) spoil(points, static_cast<std::uint64_t>(i));
    tally.add(fit_cure(points, options));
  }
  tally.print(name);
}

void study_prints(const char* name, std::size_t step_pixels, int prints) {
  const PrinterProfile profile;
  const WedgeLayout layout{parse_levels(default_wedge_levels), step_pixels, 40, 30};
  const Job job = make_patch_job("wedge", wedge_image(layout), profile, {2, 4});
  WedgeScanOptions wedge_options;
  for (const int level : layout.levels) wedge_options.grays.push_back(level / 255.0);
  Tally tally;
  for (int i = 0; i < prints; ++i) {
    VirtualPrinterOptions printer;
    printer.subsamples = 2;
    printer.seed = 100 + static_cast<std::uint64_t>(i);
    VirtualProfilometer instrument;
    instrument.pitch = Length::from_um(4.0);
    instrument.tilt_x = 3e-3;
    instrument.tilt_y = -2e-3;
    instrument.bandwidth = Length::from_um(10.0);
    instrument.noise = Length::from_nm(60.0);
    instrument.missing_share = 0.01;
    instrument.seed = printer.seed;
    const WedgeScan wedge =
        measure_wedge(measure_virtually(print_virtually(job, profile, printer), instrument), wedge_options);
    CureFitOptions options;
    options.common_error_um = wedge.base_error_um;
    tally.add(fit_cure(cure_points(wedge), options));
  }
  tally.print(name);
}

}  // namespace

int main(int argc, char** argv) {
  const int tables = argc > 1 ? std::atoi(argv[1]) : 2000, prints = argc > 2 ? std::atoi(argv[2]) : 200;
  std::printf("%-44s %5s  alpha, beta, gamma: held by 95 %% intervals (scatter, mean standard error)\n", "", "fits");
  const auto levels = test::every_level(0, 255, 15);
  study_tables("18 levels, errors of 0.05 um told", {.grays = levels, .error_um = 0.05}, tables);
  study_tables("18 levels, errors of 0.2 um told", {.grays = levels, .error_um = 0.2}, tables);
  study_tables("18 levels, errors of 0.2 um not told", {.grays = levels, .error_um = 0.2, .say_error = false}, tables);
  study_tables("9 levels, errors of 0.1 um told", {.grays = test::every_level(15, 255, 30), .error_um = 0.1}, tables);
  study_tables("saturated at 14 um, errors of 0.1 um told", {.grays = levels, .layer_um = 14.0, .error_um = 0.1},
               tables);
  study_tables("one step of 18 off by 3 um, 0.1 um told", {.grays = levels, .error_um = 0.1}, tables,
               [](std::vector<CurePoint>& points, std::uint64_t i) { points[i % points.size()].height_um += 3.0; });
  study_prints("printed and scanned, steps of 181 um", 24, prints);
  study_prints("printed and scanned, steps of 302 um", 40, prints);
  return 0;
}
