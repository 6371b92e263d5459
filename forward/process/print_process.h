#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "forward/process/printed_relief.h"

namespace mezzotint {

/// The slopes of a scalar J toward what a profile says.
struct ProfileSlopes {
  double alpha_um = 0.0;  ///< ∂J/∂α, a µm
  double beta_um = 0.0;   ///< ∂J/∂β, a µm
  double gamma = 0.0;     ///< ∂J/∂γ
  double width_um = 0.0;  ///< ∂J/∂(width of the blur), a µm
};

/// A relief's slopes, with the light that made it: all that the way back needs.
struct PrintedSlopes {
  GrayImage light;  ///< at the samples
  ReliefSlopes slopes;
};

/// The print of patches of one size: gray → light → cure height, with derivatives. What depends on the size and the
/// profile only is made once, so that a search prints as often as it wants. Safe to use from several threads.
///
/// Shape    images of columns × rows pixels; reliefs as `print_layer`.
/// Levels   gray values as they are: give `quantize`d ones for the printer's own levels. Through the rounding itself
///          there is no derivative; that of the rounded image toward its gray values is the one to go on with.
class PrintProcess {
public:
  /// @throws InvalidInput as `print_layer`.
  PrintProcess(std::size_t columns, std::size_t rows, const PrinterProfile& profile, const ProcessOptions& options);
  ~PrintProcess();
  PrintProcess(PrintProcess&&) noexcept;
  PrintProcess& operator=(PrintProcess&&) noexcept;

  /// @throws InvalidInput for an image that is invalid or of another size.
  [[nodiscard]] HeightField print(const GrayImage& image) const;

  /// By the adjoint: from ∂J/∂(height), one a sample of the relief, to ∂J/∂(gray value), one a pixel, at this image;
  /// for the cost of one or two prints, however many pixels there are.
  /// Where nothing cures, and where the layer's thickness cuts, heights do not move and the slope is 0.
  /// @throws InvalidInput for an image that is invalid or of another size, or another number of slopes.
  [[nodiscard]] std::vector<float> gray_slopes(const GrayImage& image, std::span<const float> height_slopes) const;

  /// The same toward the cure curve and the width of the blur; for calibration.
  [[nodiscard]] ProfileSlopes profile_slopes(const GrayImage& image, std::span<const float> height_slopes) const;

  /// The relief's own slopes at the samples, from the derivatives of the light: exact at the point, where differences
  /// of heights are means over a sub-pixel. 0 where nothing cures, and where the layer's thickness cuts.
  /// @throws InvalidInput for an image that is invalid or of another size.
  [[nodiscard]] ReliefSlopes slopes(const GrayImage& image) const;

  /// From ∂J/∂(slopes of the relief) to ∂J/∂(gray value): the adjoint of `slopes`.
  [[nodiscard]] std::vector<float> gray_slopes(const GrayImage& image, const ReliefSlopes& toward) const;

  /// Both for an image that goes there and back: the way back costs half as much.
  [[nodiscard]] PrintedSlopes printed_slopes(const GrayImage& image) const;
  [[nodiscard]] std::vector<float> gray_slopes(PrintedSlopes printed, ReliefSlopes toward) const;

private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

/// ∂J/∂(wanted height), one a pixel in 1/µm, from ∂J/∂(gray value): through `expose`. 0 where a pixel asks for nothing,
/// or for more than the printer reaches.
/// @param gray  what `expose` makes of the heights
/// @throws InvalidInput for heights, gray values and slopes of different numbers.
[[nodiscard]] std::vector<float> wanted_height_slopes(const HeightField& pixel_heights, const GrayImage& gray,
                                                      const PrinterProfile& profile,
                                                      std::span<const float> gray_slopes);

}  // namespace mezzotint
