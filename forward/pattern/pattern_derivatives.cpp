#include "forward/pattern/pattern_derivatives.h"

#include "forward/base/error.h"
#include "forward/pattern/pattern_drawing.h"
#include "forward/pattern/pattern_parameters.h"
#include "forward/pattern/pattern_place.h"

namespace mezzotint {

namespace {

// From gray to µm: height·∂gray + ∂height·gray.
std::vector<float> height_slopes(const Drawing& drawing, std::size_t number, const SteepHeight& height) {
  std::vector<float> slopes = drawing.slopes[number];
  slopes.resize(drawing.gray.size(), 0.0F);
  const auto of_gray = static_cast<float>(height.um), of_height = static_cast<float>(height.slopes[number]);
  for (std::size_t i = 0; i < slopes.size(); ++i) slopes[i] = of_gray * slopes[i] + of_height * drawing.gray[i];
  return slopes;
}

}  // namespace

HeightDerivatives synthesize_with_derivatives(const Pattern& pattern, const Grid& grid, const Position& origin,
                                              std::span<const std::string> names) {
  require_valid(pattern);
  require_valid_grid(grid);
  for (const std::string& name : names) {
    require(!find_parameter(pattern, name).whole,
            "\"" + name + "\" is a whole number; heights have no slope toward it");
  }
  const Sheet sheet{grid, {.u0 = origin.x.um(), .v0 = origin.y.um()}, Continuation::Mirrored};
  const Drawing drawing = draw_pattern(with_independent_parts(pattern), sheet, names);
  const SteepHeight height = steep_height(pattern, "", names);
  HeightDerivatives result{heights_of(drawing.gray, pattern, grid, Continuation::Mirrored), {}, height.slopes};
  for (std::size_t k = 0; k < names.size(); ++k) result.toward.push_back(height_slopes(drawing, k, height));
  return result;
}

}  // namespace mezzotint
