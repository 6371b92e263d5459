#include "measurement/comparison/registration.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "forward/base/error.h"
#include "measurement/comparison/coarse_search.h"
#include "measurement/comparison/parameter_errors.h"
#include "measurement/comparison/refinement.h"
#include "measurement/correction/plane.h"

namespace mezzotint {

namespace {

constexpr std::size_t least_side = 16;
constexpr double samples_at_first = 4e3;
constexpr double samples_for_choice = 2e4;
constexpr double samples_for_answer = 3e5;

void require_valid(const HeightField& design, const HeightField& measured, const RegistrationOptions& options) {
  for (const HeightField* field : {&design, &measured}) {
    require(field->columns() >= least_side && field->rows() >= least_side,
            "a registration needs surfaces of at least 16 × 16 samples");
  }
  const double largest = options.largest_rotation.degrees();
  require(largest >= 0.0 && largest <= 180.0, "the largest rotation of a registration must lie in [0°, 180°]");
  require(options.least_correlation >= -1.0 && options.least_correlation <= 1.0,
          "the least correlation of a registration must lie in [−1, 1]");
}

/// A levelled patch: what lies beyond its ends is not known, even of a periodic relief.
HeightField levelled_patch(const HeightField& field) {
  if (static_cast<double>(field.missing_count()) > static_cast<double>(field.grid().size()) - 16.0) {
    throw MethodError("a surface of which nothing was measured cannot be registered");
  }
  const HeightField levelled = level(field);
  return {levelled.grid(), Continuation::Mirrored, {levelled.heights_um().begin(), levelled.heights_um().end()}};
}

/// The design as pixels of this size see it; only whole pixels count.
HeightField seen_by(const HeightField& design, const Grid& instrument) {
  return area_average(design, instrument.pitch_x, instrument.pitch_y, 1.0);
}

Matching matching_of(const HeightField& design, const HeightField& measured, double most_samples) {
  const double arm_um = std::min(half_diagonal_um(design.grid()), half_diagonal_um(measured.grid()));
  return {design, measured, steps_for(measured.grid(), most_samples), arm_um};
}

/// Far below any standard error that 300,000 samples could reach.
double closely_um(const Grid& grid) { return 1e-5 * std::min(grid.pitch_x.um(), grid.pitch_y.um()); }

/// Candidates brought to the top of their hill, first at the resolution at which they were found.
std::vector<Fit> refined(const CoarseSearch& search, const HeightField& design, const HeightField& measured) {
  const auto smooth = [&](const HeightField& field) { return area_average(field, search.pitch, search.pitch, 0.5); };
  const HeightField smooth_design = smooth(design);
  const HeightField smooth_measured = smooth(measured);
  std::vector<Fit> fits;
  // A hundredth of a coarse sample lies well within the hill of the full resolution.
  const double roughly_um = 0.01 * search.pitch.um();
  for (const Candidate& candidate : search.candidates) {
    const Fit rough =
        refine(matching_of(smooth_design, smooth_measured, samples_at_first), candidate.placement, roughly_um);
    fits.push_back(refine(matching_of(design, measured, samples_for_choice), rough.placement, roughly_um));
  }
  return fits;
}

double evidence_of(const Fit& fit) { return evidence(fit.correlation, fit.samples); }

/// The best correlation of the fits that are not the best one's neighbours.
double runner_up_of(const std::vector<Fit>& fits, const Fit& best, const MainLobe& lobe) {
  double runner_up = 0.0;
  for (const Fit& fit : fits) {
    const bool same = lobe.holds(fit.placement.shift().x_um - best.placement.shift().x_um,
                                 fit.placement.shift().y_um - best.placement.shift().y_um);
    if (!same) runner_up = std::max(runner_up, fit.correlation);
  }
  return runner_up;
}

double used_area_um2(const Fit& fit, const Matching& matching) {
  const Grid& grid = matching.measured.grid();
  return fit.samples * static_cast<double>(matching.steps.x * matching.steps.y) * grid.pitch_x.um() * grid.pitch_y.um();
}

/// Could unrelated surfaces fit that well somewhere? Twice the gain in log-likelihood over n independent features is
/// χ² with one degree of freedom, whose tail beyond t is below exp(−t/2); one false answer in 1000 is let pass.
bool tells_from_chance(const Fit& fit, double area_um2, const CoarseSearch& search) {
  const double features = area_um2 / search.lobe.area_um2();
  return evidence(fit.correlation, features) > 2.0 * std::log(search.independent_trials / 1e-3);
}

std::string in_words(const Fit& fit) {
  std::ostringstream text;
  text.precision(3);
  text << "the best placement, shifted by (" << fit.placement.shift().x_um << ", " << fit.placement.shift().y_um
       << ") µm and turned by " << Angle::from_radians(fit.placement.rotation()).degrees()
       << "°, has a correlation of heights of " << fit.correlation;
  return text.str();
}

void require_match(const Fit& fit, double area_um2, const CoarseSearch& search, const RegistrationOptions& options) {
  if (fit.correlation < options.least_correlation) {
    std::ostringstream text;
    text << "the measured surface was not found on the design: " << in_words(fit) << ", below "
         << options.least_correlation << "; is it the right sample, its orientation within "
         << options.largest_rotation.degrees() << "°, and the sign of its heights right?";
    throw MethodError(text.str());
  }
  if (!tells_from_chance(fit, area_um2, search)) {
    throw MethodError("the surfaces have too few features in common to tell a match from chance: " + in_words(fit) +
                      "; a larger measurement would help");
  }
}

Registration answer(const Fit& fit, const Matching& matching, double area_um2, const HeightField& design) {
  const FitVector errors = standard_errors(matching, fit);
  Registration result;
  result.shift_x = {Length::from_um(fit.placement.shift().x_um), Length::from_um(errors[ShiftX])};
  result.shift_y = {Length::from_um(fit.placement.shift().y_um), Length::from_um(errors[ShiftY])};
  result.rotation = {Angle::from_radians(fit.placement.rotation()),
                     Angle::from_radians(errors[Rotation] / matching.arm_um)};
  result.correlation = fit.correlation;
  const Grid& grid = design.grid();
  const double design_um2 = static_cast<double>(grid.size()) * grid.pitch_x.um() * grid.pitch_y.um();
  result.overlap = std::min(1.0, area_um2 / design_um2);
  result.residual_rms = Length::from_um(std::sqrt(fit.mean_square));
  return result;
}

}  // namespace

Registration register_surfaces(const HeightField& design, const HeightField& measured,
                               const RegistrationOptions& options, const Progress& progress) {
  require_valid(design, measured, options);
  const HeightField patch = levelled_patch(design);
  const HeightField levelled = levelled_patch(measured);
  const CoarseSearch search = search_coarsely(patch, levelled, options.largest_rotation, progress);
  if (search.candidates.empty()) {
    throw MethodError("the measured surface was not found on the design: no placement has a positive correlation");
  }
  report(progress, "register", 0.8, "refining");
  const HeightField seen = seen_by(patch, levelled.grid());
  const std::vector<Fit> fits = refined(search, seen, levelled);
  const Fit& best = *std::max_element(fits.begin(), fits.end(),
                                      [](const Fit& a, const Fit& b) { return evidence_of(a) < evidence_of(b); });
  const Matching matching = matching_of(seen, levelled, samples_for_answer);
  const Fit fit = refine(matching, best.placement, closely_um(levelled.grid()));
  const double area_um2 = used_area_um2(fit, matching);
  require_match(fit, area_um2, search, options);
  Registration result = answer(fit, matching, area_um2, design);
  result.runner_up = runner_up_of(fits, best, search.lobe);
  report(progress, "register", 1.0);
  return result;
}

}  // namespace mezzotint
