#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "forward/process/depth_cure.h"
#include "forward/process/printed_relief.h"

namespace mezzotint {

/// A layer with its picture.
struct LitLayer {
  GrayImage image;
  StackLayer layer;
};

/// The print of stacks of one picture size: gray → light → dose in depth → solid thickness, with derivatives.
///
/// Shape    pictures of columns × rows pixels; thicknesses columns·subsamples × rows·subsamples samples.
/// Memory   `print` holds a few pictures whatever the number of layers; `gray_slopes` the dose of every layer.
class StackProcess {
public:
  /// @throws InvalidInput as `print_layer`.
  StackProcess(std::size_t columns, std::size_t rows, const PrinterProfile& profile, const ProcessOptions& options);
  ~StackProcess();
  StackProcess(StackProcess&&) noexcept;
  StackProcess& operator=(StackProcess&&) noexcept;

  [[nodiscard]] std::size_t samples() const;

  /// Gives layer i, 0 the lowest; asked from the last one down.
  using LayerSource = std::function<LitLayer(std::size_t index)>;
  /// Takes the solid thicknesses of layer i in µm, at its upper end.
  using LayerVisit = std::function<void(std::size_t index, std::span<const float> cured_um)>;
  /// @throws InvalidInput for a picture that is invalid or of another size.
  void print(std::size_t count, const LayerSource& source, const LayerVisit& visit) const;
  [[nodiscard]] std::vector<std::vector<float>> print(std::span<const LitLayer> layers) const;

  /// By the adjoint: from ∂J/∂(solid thickness), one list a layer and one value a sample, to ∂J/∂(gray value),
  /// one list a layer and one value a pixel. A layer that is solid throughout, or not at all, does not move.
  /// A face that looks down moves with the sum of thicknesses over the layers that its solid reaches through.
  /// @throws InvalidInput as `print`, or for another number of slopes.
  [[nodiscard]] std::vector<std::vector<float>> gray_slopes(std::span<const LitLayer> layers,
                                                            std::span<const std::vector<float>> cured_slopes) const;

private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace mezzotint
