#include "measurement/pattern_fit/pattern_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "forward/base/error.h"
#include "measurement/pattern_fit/line_fit.h"
#include "measurement/pattern_fit/noise_draws.h"
#include "measurement/pattern_fit/noise_report.h"

namespace mezzotint {

namespace {

constexpr double least_cells = 8.0;
constexpr double least_waves = 2.5;
constexpr double negligible_share = 1e-4;  // of the mean square, left over by lines: 1 % of the height's RMS
constexpr double least_gain_over_white = 10.0;
constexpr double probability_of_chance_stretch = 0.01;

bool is_wanted(const PatternFitOptions& options, std::string_view kind) {
  return options.kinds.empty() || std::ranges::find(options.kinds, kind) != options.kinds.end();
}

void check(const HeightField& scan, const PatternFitOptions& options) {
  require(scan.columns() >= 32 && scan.rows() >= 32,
          fmt::format("a texture fit needs 32 x 32 samples at least, not {} x {}", scan.columns(), scan.rows()));
  require(2 * scan.missing_count() <= scan.grid().size(),
          fmt::format("{} of {} samples are missing; a texture fit needs half of them", scan.missing_count(),
                      scan.grid().size()));
  const HeightRange range = height_range(scan);
  require(range.highest > range.lowest, "the relief is flat: there is no texture to fit");
  require(options.draws >= 24 && options.draws <= 1000, "a texture fit makes 24 to 1000 draws");
  require(options.false_alarm >= 1e-6 && options.false_alarm <= 0.5, "a rate of false alarms is in [1e-6, 0.5]");
  constexpr std::array<std::string_view, 4> known = {"noise", "fbm", "sinusoid", "ridges"};
  for (const std::string& kind : options.kinds) {
    require(std::ranges::find(known, kind) != known.end(),
            fmt::format("a texture fit knows no \"{}\"; it tries {}", kind, fmt::join(known, ", ")));
  }
}

double shorter_side_um(const Grid& grid) {
  return std::min(static_cast<double>(grid.columns) * grid.pitch_x.um(),
                  static_cast<double>(grid.rows) * grid.pitch_y.um());
}

// Only of what would be a fit is more asked for.
void require_enough(const PatternFit& fit, double least, const char* what, const Grid& grid) {
  if (!fit.fits || fit.cells >= least) return;
  throw InvalidInput(fmt::format(
      "the patch is too small: along its shorter side of {:.4g} um it holds {:.1f} {} of a {} that would fit; "
      "{} are needed: measure {:.4g} um or more",
      shorter_side_um(grid), fit.cells, what, kind_name(fit.pattern), least,
      shorter_side_um(grid) * least / fit.cells));
}

FittedParameter parameter(const char* name, const char* unit, double value, double error) {
  return {name, {value, unit, error}, value - 1.959964 * error, value + 1.959964 * error};
}

PatternFit report_lines(const LineFit& lines, const FitView& view, const PatternFitOptions& options) {
  const LineNumbers &n = lines.numbers, &e = lines.errors;
  PatternFit fit{.pattern = pattern_of(lines.kind, n)};
  const auto wavelength = [&fit](const char* name, double waves, double error) {
    fit.parameters.push_back(parameter(name, "µm", 1.0 / waves, error / (waves * waves)));
  };
  const bool sinusoid = lines.kind == LineKind::Sinusoid;
  wavelength(sinusoid ? "wavelength_u_um" : "wavelength_um", n.waves_u_per_um, e.waves_u_per_um);
  if (sinusoid) wavelength("wavelength_v_um", n.waves_v_per_um, e.waves_v_per_um);
  const double degrees = 180.0 / std::numbers::pi;
  fit.parameters.push_back(parameter("direction_deg", "deg", degrees * n.direction, degrees * e.direction));
  fit.parameters.push_back(parameter("height_um", "µm", n.height_um, e.height_um));
  if (!sinusoid) fit.parameters.push_back(parameter("skew", "1", n.skew, e.skew));
  fit.white_noise = {lines.residual_um, "µm", {}};
  fit.unexplained_share = lines.share_left;
  fit.cells = lines.waves;
  fit.tests = {{"remainder", lines.flatness}};
  fit.fits = lines.flatness >= options.false_alarm || lines.share_left <= negligible_share;
  const std::string left =
      fmt::format("{:.3g} um RMS ({:.2g} % of the heights' mean square)", lines.residual_um, 100.0 * lines.share_left);
  const std::string kind(kind_name(fit.pattern));
  if (lines.flatness >= options.false_alarm) {
    fit.verdict = fmt::format("{} fits; what it leaves over, {}, is like white noise", kind, left);
  } else if (fit.fits) {
    fit.verdict = fmt::format("{} fits but for {}", kind, left);
  } else {
    fit.verdict =
        fmt::format("no pattern fits: {} is the nearest, but leaves over {}, and that is no white noise", kind, left);
  }
  require_enough(fit, least_waves, "waves", view.grid());
  return fit;
}

// The better of the two, if it is one of lines at all, or if nothing else is asked for.
std::optional<LineFit> best_lines(const FitView& view, const HeightField& seen, const PatternFitOptions& options) {
  std::optional<LineFit> best;
  for (const LineKind kind : {LineKind::Sinusoid, LineKind::Ridges}) {
    if (!is_wanted(options, kind == LineKind::Sinusoid ? "sinusoid" : "ridges")) continue;
    const auto fit = fit_lines(kind, view, seen);
    if (fit && (!best || fit->share_left < best->share_left)) best = fit;
  }
  if (!best || (!is_wanted(options, "noise") && !is_wanted(options, "fbm"))) return best;
  const double measured = static_cast<double>(view.grid().size() - seen.missing_count());
  // A peak of white noise alone explains 2 ln(samples/2) of them, 30 at most.
  const bool all_but_noise = best->flatness >= options.false_alarm && (1.0 - best->share_left) * measured > 80.0;
  if (best->share_left < 0.5 || all_but_noise) return best;
  return {};
}

std::string in_words(const NoiseModel& model) {
  const std::string kind = model.octaves == 1 ? "noise" : fmt::format("fbm of {} octaves", model.octaves);
  return kind + (model.stretched ? ", stretched" : "") + (model.free_lacunarity ? ", lacunarity fitted" : "");
}

void report_alternatives(const NoiseSearch& search, PatternFit& fit) {
  const double best = penalised(search.fits.front(), search.seen);
  for (std::size_t i = 1; i < search.fits.size(); ++i)
    fit.alternatives.push_back({in_words(search.fits[i].model), best - penalised(search.fits[i], search.seen)});
}

// Whether a pattern is there at all: a constant density would do nearly as well.
bool is_white(const NoiseSearch& search) {
  double power = 0.0, count = 0.0;
  for (std::size_t i = 0; i < search.seen.blocks.size(); ++i) {
    power += search.seen.blocks[i].count * search.seen.density_um4[i];
    count += search.seen.blocks[i].count;
  }
  const std::vector<double> flat(search.seen.blocks.size(), power / count);
  return penalised(search.fits.front(), search.seen) - log_likelihood(search.seen, flat) < least_gain_over_white;
}

void judge(const TextureFigures& seen, const NoiseDraws& draws, PatternFit& fit) {
  for (const auto& [name, member] :
       {std::pair{"spectrum", &TextureFigures::spectrum}, std::pair{"directions", &TextureFigures::directions},
        std::pair{"shape", &TextureFigures::shape}, std::pair{"evenness", &TextureFigures::evenness}}) {
    std::vector<std::vector<double>> drawn;
    for (const TextureFigures& figures : draws.figures) drawn.push_back(figures.*member);
    fit.tests.push_back({name, probability_among(seen.*member, drawn)});
  }
}

// Of several tests each may raise its share of the false alarms.
void conclude(const NoiseSearch& search, const PatternFitOptions& options, const Grid& grid, PatternFit& fit) {
  const double least = options.false_alarm / static_cast<double>(fit.tests.size());
  std::vector<std::string> failed;
  for (const FitTest& test : fit.tests) {
    if (!(test.probability >= least))
      failed.push_back(fmt::format("{} (probability {:.1g})", test.name, test.probability));
  }
  const NoiseFit& best = search.fits.front();
  if (is_white(search)) failed.emplace_back("nothing but white noise is seen");
  if (std::exp(best.numbers.log_scale) < 1.01 * scale_bounds(grid).least_um)
    failed.emplace_back("its cells would be shorter than 2.5 samples");
  fit.fits = failed.empty();
  const std::string kind = in_words(best.model);
  fit.verdict = fit.fits ? fmt::format("{} fits: spectrum, directions, shape and evenness are those of its draws", kind)
                         : fmt::format("no pattern fits: {} is the nearest, but differs from its draws in: {}", kind,
                                       fmt::join(failed, "; "));
}

PatternFit fit_noise(FitView view, const HeightField& seen, const PatternFitOptions& options,
                     const Progress& progress) {
  view.listen_to(view.periodogram(seen));
  const std::vector<double> density = view.audible(seen);
  NoiseSearch search = search_noise(view, density, {is_wanted(options, "noise"), is_wanted(options, "fbm")}, progress);
  const auto redraw = [&] {
    const FigureTaker taker(view, search.fits.front(), density, search.used);
    return std::pair{taker.figures(seen, density, search.fits.front().numbers),
                     draw_noise(view, search.fits.front(), search, taker, options.draws, options.seed, progress)};
  };
  auto [figures, draws] = redraw();
  if (search.fits.front().model.stretched &&
      probability_of_stretch(search.fits.front(), draws) > probability_of_chance_stretch) {
    search.fits.front() = without_stretch(search.fits.front(), search.seen);
    std::tie(figures, draws) = redraw();
  }
  const NoiseFit& best = search.fits.front();
  PatternFit fit;
  report_parameters(best, draws, fit);
  report_alternatives(search, fit);
  judge(figures, draws, fit);
  conclude(search, options, view.grid(), fit);
  const double sample = view.grid().pitch_x.um() * view.grid().pitch_y.um();
  // An error of the square; where that is larger than the square itself, its root is what could have been missed.
  const double rms = std::sqrt(draws.white_um4 / sample), missed = std::sqrt(draws.white_error_um4 / sample);
  fit.white_noise = {rms, "µm", rms > missed ? 0.5 * missed * missed / rms : missed};
  fit.cells = shorter_side_um(view.grid()) / cell_size_um(best.numbers).across;
  if (!best.model.stretched) fit.notes.emplace_back("alike in all directions, as far as this patch can tell");
  if (best.model.octaves > 1 && !best.model.free_lacunarity)
    fit.notes.emplace_back("a lacunarity of 2 is taken for granted");
  require_enough(fit, least_cells, "cells", view.grid());
  return fit;
}

}  // namespace

PatternFit fit_pattern(const HeightField& scan, const PatternFitOptions& options, const Progress& progress) {
  check(scan, options);
  const FitView view(scan);
  const HeightField seen = view.seen(scan);
  report(progress, "fit", 0.0, "lines");
  const auto lines = best_lines(view, seen, options);
  const bool noise = is_wanted(options, "noise") || is_wanted(options, "fbm");
  if (!lines && !noise) throw InvalidInput("the spectrum has no lines that a sinusoid or ridges could be");
  PatternFit fit = lines ? report_lines(*lines, view, options) : fit_noise(view, seen, options, progress);
  fit.missing_share = static_cast<double>(seen.missing_count()) / static_cast<double>(scan.grid().size());
  report(progress, "fit", 1.0);
  return fit;
}

}  // namespace mezzotint
