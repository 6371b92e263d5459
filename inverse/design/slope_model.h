#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "forward/pattern/pattern.h"
#include "forward/process/print_process.h"
#include "inverse/design/printed_texture.h"
#include "inverse/design/slope_moments.h"
#include "inverse/objective/smooth_lobe.h"
#include "inverse/search/minimize.h"
#include "inverse/target/lobe_target.h"

namespace mezzotint {

/// How a relief is met.
struct SlopeModelOptions {
  GrayLevels levels = GrayLevels::Continuous;
  bool drawn_ground = false;  ///< each draw on a ground of its own, as printed; else the mean over all grounds
  double place_x = 0.5, place_y = 0.5;  ///< of the samples in their sub-pixels
  /// The covariance that `shown` gives is brought to the mean over all draws, where the pattern is smooth: what the
  /// draws lack or have too much shows as well in their unprinted heights, whose expectation is known (a control
  /// variate). A search for slopes then sees far less of its draws. Maps are those of the draws.
  bool to_expectation = false;
};

/// What a printed pattern shows by its slopes alone: the model that a search asks at every step.
///
/// Method   pattern → gray → light → slopes of the cured relief at points → their covariance, and the light that they
///          reflect, in soft bins; the mean over some draws of the pattern, the same ones at every step (common random
///          numbers). The printer's ground comes in by its mean over all draws: its variance is added to the slopes',
///          and the lobes are scattered by it. A search would learn draws of it by heart; a verdict wants them.
/// Leaves out  shadows and further reflections; while it searches, the rounding to gray levels.
/// Threads  the same bits with any number of them.
class SlopeModel {
public:
  /// @param lobes  the light and the bins of the maps; nullopt: no maps are made
  /// @throws InvalidInput for a patch out of range, or no seed.
  SlopeModel(const PrinterProfile& printer, const PatchOptions& patch, std::vector<std::uint64_t> seeds,
             const std::optional<LobeTarget>& lobes, const SlopeModelOptions& options = {});

  struct Shown {
    SlopeCovariance covariance;      ///< of the slopes about each draw's mean, the ground's included
    std::vector<DirectionMap> maps;  ///< one a direction of the light
    /// The symmetric B that brings a covariance C of these draws to the mean over all of them, B·C·B; 1 where that is
    /// not known. `covariance` is there already.
    SlopeCovariance to_all_draws{1.0, 1.0, 0.0};
  };
  /// Mean over the draws.
  [[nodiscard]] Shown shown(const Pattern& pattern) const;
  /// Each draw by itself, in the order of the seeds.
  [[nodiscard]] std::vector<Shown> draws(const Pattern& pattern) const;

  /// A figure of what is shown, which also sets its slopes toward all of it (in the same order and shape).
  using Figure = std::function<double(const Shown& shown, Shown& slopes)>;
  /// The figure of the mean over the draws, and by the adjoint its slopes toward some of the pattern's numbers: through
  /// lobes, covariance, cure curve, light and pattern, for the cost of about two evaluations more, however many numbers
  /// there are (synthesize_with_derivatives says where patterns have edges).
  /// @param names   of the numbers, by their paths
  /// @param slopes  are set, one a name, in the unit that the name says
  /// @throws InvalidInput for a name that has no slope, rounded gray levels, or a drawn ground.
  [[nodiscard]] double figure_with_slopes(const Pattern& pattern, std::span<const std::string> names,
                                          const Figure& figure, std::vector<double>& slopes) const;

  [[nodiscard]] std::size_t draw_count() const { return seeds_.size(); }
  /// Light samples of one evaluation over all draws: what an evaluation costs, up to a factor.
  [[nodiscard]] double samples() const;

private:
  [[nodiscard]] ReliefSlopes printed_slopes(const HeightField& heights, std::uint64_t seed) const;
  [[nodiscard]] Shown expected(const Pattern& pattern, const SlopeCovariance& before_printing) const;
  [[nodiscard]] Shown shown_by(const ReliefSlopes& slopes, const SlopeMoments& moments) const;
  [[nodiscard]] ReliefSlopes slopes_toward(const ReliefSlopes& slopes, const SlopeMoments& moments, const Shown& toward,
                                           double share) const;

  PrinterProfile printer_;
  PatchOptions patch_;
  SlopeModelOptions options_;
  std::vector<std::uint64_t> seeds_;
  PrintProcess process_;
  std::vector<GroundOctave> ground_;  // that is geometry
  double mean_ground_ = 0.0;          // RMS slope of what comes in by its mean
  std::optional<SmoothGrid> grid_;
  std::vector<SmoothLobe> lobes_;  // one a direction of the light
  std::vector<double> variances_;  // of the ground's scatter, in squared bins, the same way
};

/// What minimize_with_slopes lowers: a figure of what a pattern shows, by the values of some of its numbers.
/// @param model  must live as long as what is returned
[[nodiscard]] SteepObjective steep_objective(const SlopeModel& model, Pattern pattern, std::vector<std::string> names,
                                             SlopeModel::Figure figure);

/// The mean of some draws, each counting alike.
[[nodiscard]] SlopeModel::Shown mean_of(const std::vector<SlopeModel::Shown>& draws);

}  // namespace mezzotint
