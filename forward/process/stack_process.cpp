#include "forward/process/stack_process.h"

#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "forward/base/error.h"
#include "forward/process/light_spread.h"

namespace mezzotint {

struct StackProcess::Parts {
  std::size_t columns, rows;
  CureCurve cure;
  ProcessOptions options;
  LightSpread spread;

  [[nodiscard]] std::size_t samples() const { return columns * rows * options.subsamples * options.subsamples; }
  [[nodiscard]] GrayImage light(const LitLayer& layer) const {
    const GrayImage& image = layer.image;
    require(image.columns == columns && image.rows == rows,
            "the process was made for pictures of " + std::to_string(columns) + " × " + std::to_string(rows) +
                " pixels; this one has " + std::to_string(image.columns) + " × " + std::to_string(image.rows));
    require_valid(image);
    return std::visit([&](const auto& kernel) { return kernel.apply(image, LightPart::Value, {}); }, spread);
  }
  [[nodiscard]] std::vector<float> back(const GrayImage& samples_slopes) const {
    return std::visit([&](const auto& kernel) { return kernel.transposed(samples_slopes, LightPart::Value).values; },
                      spread);
  }
};

StackProcess::StackProcess(std::size_t columns, std::size_t rows, const PrinterProfile& profile,
                           const ProcessOptions& options)
    : parts_(new Parts{columns, rows, profile.cure, options, light_spread(columns, rows, profile, options)}) {}
StackProcess::~StackProcess() = default;
StackProcess::StackProcess(StackProcess&&) noexcept = default;
StackProcess& StackProcess::operator=(StackProcess&&) noexcept = default;

std::size_t StackProcess::samples() const { return parts_->samples(); }

void StackProcess::print(std::size_t count, const LayerSource& source, const LayerVisit& visit) const {
  DepthDose dose(parts_->cure, samples());
  std::vector<float> cured_um(samples());
  for (std::size_t i = count; i-- > 0;) {
    const LitLayer lit = source(i);
    dose.descend(lit.layer, parts_->light(lit).values);
    dose.cured_um(cured_um);
    visit(i, cured_um);
  }
}

std::vector<std::vector<float>> StackProcess::print(std::span<const LitLayer> layers) const {
  std::vector<std::vector<float>> cured_um(layers.size());
  print(
      layers.size(), [&](std::size_t i) { return layers[i]; },
      [&](std::size_t i, std::span<const float> values) { cured_um[i].assign(values.begin(), values.end()); });
  return cured_um;
}

namespace {

// A_j is a sum over the layers from j up, so its slopes run the other way: toward A_j they are
// B_j = s_j β/A_j + e^(−τ_j/β) B_(j−1), from the platform up.
void carry_up(const StackLayer& layer, const CureCurve& cure, std::span<const float> dose,
              std::span<const float> cured_slopes, std::span<float> carried) {
  const float kept = passing_share(layer.thickness, cure), beta_um = static_cast<float>(cure.beta.um());
  const auto least = static_cast<float>(std::exp(-(cure.alpha / cure.beta)));
  const auto fills = static_cast<float>(std::exp((layer.thickness - cure.alpha) / cure.beta));
  for (std::size_t k = 0; k < dose.size(); ++k) {
    const bool moves = dose[k] > least && dose[k] < fills;
    carried[k] = kept * carried[k] + (moves ? cured_slopes[k] * beta_um / dose[k] : 0.0F);
  }
}

}  // namespace

std::vector<std::vector<float>> StackProcess::gray_slopes(std::span<const LitLayer> layers,
                                                          std::span<const std::vector<float>> cured_slopes) const {
  require(cured_slopes.size() == layers.size(), "one list of slopes a layer is needed");
  for (const auto& slopes : cured_slopes) require(slopes.size() == samples(), "one slope a sample is needed");
  DepthDose dose(parts_->cure, samples());
  std::vector<std::vector<float>> doses(layers.size()), slopes(layers.size());
  for (std::size_t i = layers.size(); i-- > 0;) {
    dose.descend(layers[i].layer, parts_->light(layers[i]).values);
    doses[i].assign(dose.dose().begin(), dose.dose().end());
  }
  const std::size_t columns = parts_->columns * parts_->options.subsamples;
  GrayImage toward_light{columns, samples() / columns, std::vector<float>(samples())};
  std::vector<float> carried(samples(), 0.0F);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    carry_up(layers[i].layer, parts_->cure, doses[i], cured_slopes[i], carried);
    const auto exposure = static_cast<float>(layers[i].layer.exposure);
    for (std::size_t k = 0; k < carried.size(); ++k) toward_light.values[k] = exposure * carried[k];
    slopes[i] = parts_->back(toward_light);
  }
  return slopes;
}

}  // namespace mezzotint
