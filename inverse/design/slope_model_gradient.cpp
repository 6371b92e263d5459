#include <optional>

#include <tbb/parallel_for.h>
#include <Eigen/Core>

#include "forward/base/error.h"
#include "forward/pattern/pattern_parameters.h"
#include "inverse/design/slope_model.h"

namespace mezzotint {

namespace {

// One draw on its way forth, with what is needed on the way back.
struct Printed {
  HeightDerivatives heights;
  GrayImage gray = {};
  PrintedSlopes relief = {};
  SlopeMoments moments = {};
};

// ∂J/∂slope of what the covariance of a draw's slopes about their mean adds.
ReliefSlopes covariance_slopes(const ReliefSlopes& slopes, const SlopeMoments& moments, const SlopeCovariance& toward,
                               double share) {
  const auto n = static_cast<double>(slopes.x.size());
  const auto xx = static_cast<float>(2.0 * share * toward.xx / n), yy = static_cast<float>(2.0 * share * toward.yy / n),
             xy = static_cast<float>(share * toward.xy / n);
  const auto mean_x = static_cast<float>(moments.mean_x), mean_y = static_cast<float>(moments.mean_y);
  ReliefSlopes result{std::vector<float>(slopes.x.size()), std::vector<float>(slopes.y.size())};
  for (std::size_t i = 0; i < slopes.x.size(); ++i) {
    const float x = slopes.x[i] - mean_x, y = slopes.y[i] - mean_y;
    result.x[i] = xx * x + xy * y;
    result.y[i] = yy * y + xy * x;
  }
  return result;
}

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  const auto map = [](const std::vector<float>& v) {
    return Eigen::Map<const Eigen::VectorXf>(v.data(), static_cast<Eigen::Index>(v.size())).cast<double>();
  };
  return map(a).dot(map(b));
}

}  // namespace

ReliefSlopes SlopeModel::slopes_toward(const ReliefSlopes& slopes, const SlopeMoments& moments, const Shown& toward,
                                       double share) const {
  ReliefSlopes result = covariance_slopes(slopes, moments, toward.covariance, share);
  for (std::size_t light = 0; light < lobes_.size(); ++light) {
    lobes_[light].add_slope_derivatives(
        slopes.x, slopes.y, grid_->scattered_back(toward.maps[light], variances_[light]), share, result.x, result.y);
  }
  return result;
}

double SlopeModel::figure_with_slopes(const Pattern& pattern, std::span<const std::string> names, const Figure& figure,
                                      std::vector<double>& slopes) const {
  require(options_.levels == GrayLevels::Continuous && !options_.drawn_ground,
          "slopes go through continuous gray levels and the mean ground, as a search sees them");
  std::vector<std::optional<Printed>> printed(seeds_.size());
  std::vector<Shown> draws(seeds_.size());
  tbb::parallel_for(std::size_t{0}, seeds_.size(), [&](std::size_t i) {
    Printed draw{pixel_heights_with_derivatives(draw_instance(pattern, seeds_[i]), printer_, patch_.pixels, names)};
    draw.gray = expose(draw.heights.heights, printer_).image;
    draw.relief = process_.printed_slopes(draw.gray);
    draw.moments = slope_moments(draw.relief.slopes);
    draws[i] = shown_by(draw.relief.slopes, draw.moments);
    printed[i] = std::move(draw);
  });
  const Shown shown = mean_of(draws);
  Shown toward{{}, std::vector<DirectionMap>(shown.maps.size())};
  for (std::size_t light = 0; light < shown.maps.size(); ++light)
    toward.maps[light].resize(shown.maps[light].size(), 0.0);
  const double value = figure(shown, toward);
  require(toward.maps.size() == shown.maps.size(), "a figure of what is shown has slopes toward every map");

  std::vector<std::vector<double>> of_draws(seeds_.size(), std::vector<double>(names.size()));
  const double share = 1.0 / static_cast<double>(seeds_.size());
  tbb::parallel_for(std::size_t{0}, seeds_.size(), [&](std::size_t i) {
    Printed draw = std::move(*printed[i]);
    ReliefSlopes toward_slopes = slopes_toward(draw.relief.slopes, draw.moments, toward, share);
    const std::vector<float> toward_gray = process_.gray_slopes(std::move(draw.relief), std::move(toward_slopes));
    const std::vector<float> toward_heights =
        wanted_height_slopes(draw.heights.heights, draw.gray, printer_, toward_gray);
    for (std::size_t k = 0; k < names.size(); ++k) of_draws[i][k] = dot(toward_heights, draw.heights.toward[k]);
  });
  slopes.assign(names.size(), 0.0);
  for (const std::vector<double>& draw : of_draws) {
    for (std::size_t k = 0; k < names.size(); ++k) slopes[k] += draw[k];
  }
  return value;
}

SteepObjective steep_objective(const SlopeModel& model, Pattern pattern, std::vector<std::string> names,
                               SlopeModel::Figure figure) {
  return [&model, pattern = std::move(pattern), names = std::move(names), figure = std::move(figure)](
             const std::vector<double>& values, std::vector<double>& slopes) {
    require(values.size() == names.size(), "one value a name is needed");
    Pattern changed = pattern;
    for (std::size_t k = 0; k < names.size(); ++k) set_parameter(changed, names[k], values[k]);
    return model.figure_with_slopes(changed, names, figure, slopes);
  };
}

}  // namespace mezzotint
