#include "experiments/study/scene.h"

#include <cmath>

#include "forward/base/error.h"
#include "forward/surface/slope_covariance.h"
#include "measurement/correction/fill.h"
#include "measurement/correction/plane.h"
#include "measurement/instrument/virtual_profilometer.h"

namespace mezzotint {

namespace {

double rms_gradient(const HeightField& field) {
  const SlopeCovariance slopes = slope_covariance(field);
  return std::sqrt(slopes.xx + slopes.yy);
}

}  // namespace

const std::vector<std::string>& study_families() {
  static const std::vector<std::string> names = {"gaussian", "noise", "sinusoid", "ridges"};
  return names;
}

StudyRelief make_study_relief(const std::string& family, double gradient, const ReliefDraw& draw) {
  require(gradient > 0.0 && gradient <= 4.0, "a study needs an RMS gradient in (0, 4]");
  HeightField field = draw_relief(family, draw);
  const auto scale = static_cast<float>(gradient / rms_gradient(field));
  for (float& z : field.heights_um()) z *= scale;
  return {family, gradient, std::move(field)};
}

StudyRelief scan_relief(const HeightField& measured) {
  const HeightField whole = level(fill_missing(measured));
  const std::span<const float> heights = whole.heights_um();
  HeightField field(whole.grid(), Continuation::Mirrored, {heights.begin(), heights.end()}, whole.datum());
  const double gradient = rms_gradient(field);
  require(gradient > 0.0, "a scan without any relief has no error to chart");
  return {"scan", gradient, std::move(field)};
}

HeightField virtual_scan(std::size_t cells) {
  const StudyRelief relief = make_study_relief("patch", 0.3, {.cells = cells});
  const VirtualProfilometer instrument{.pitch = Length::from_um(1.0),
                                       .tilt_x = 0.02,
                                       .tilt_y = -0.01,
                                       .noise = Length::from_nm(10.0),
                                       .missing_share = 0.01};
  return measure_virtually(relief.field, instrument);
}

HeightField coarser(const HeightField& field, std::size_t step) {
  const Grid& grid = field.grid();
  const auto longer = static_cast<double>(step);
  HeightField coarse({grid.columns / step, grid.rows / step, grid.pitch_x * longer, grid.pitch_y * longer},
                     field.continuation());
  for (std::size_t row = 0; row < coarse.rows(); ++row)
    for (std::size_t column = 0; column < coarse.columns(); ++column)
      coarse.at(column, row) = field.at(step * column, step * row);
  return coarse;
}

}  // namespace mezzotint
