#include "fabrication/calibration/wedge_layout.h"

#include <charconv>
#include <cstdlib>

#include <fmt/format.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::size_t largest_wedge = 1000;

int number_of(std::string_view text, std::string_view whole) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  require(
      error == std::errc() && end == text.data() + text.size(),
      fmt::format("levels are numbers and FROM:TO:STEP between commas, such as 255,0:255:15; \"{}\" is not", whole));
  return value;
}

void add_levels(std::string_view part, std::string_view whole, std::vector<int>& levels) {
  const std::size_t first = part.find(':');
  if (first == std::string_view::npos) {
    levels.push_back(number_of(part, whole));
    return;
  }
  const std::size_t second = part.find(':', first + 1);
  const int from = number_of(part.substr(0, first), whole);
  const bool has_step = second != std::string_view::npos;
  const int to = number_of(part.substr(first + 1, has_step ? second - first - 1 : std::string_view::npos), whole);
  const int step = has_step ? std::abs(number_of(part.substr(second + 1), whole)) : 1;
  require(step > 0, "the step of a range of levels must not be 0");
  const int direction = to >= from ? step : -step;
  for (int level = from; direction > 0 ? level <= to : level >= to; level += direction) {
    require(levels.size() < largest_wedge, "a wedge has at most 1000 steps");
    levels.push_back(level);
  }
}

}  // namespace

std::vector<int> parse_levels(std::string_view text) {
  std::vector<int> levels;
  std::string_view rest = text;
  while (true) {
    const std::size_t comma = rest.find(',');
    add_levels(rest.substr(0, comma), text, levels);
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  require(levels.size() >= 2 && levels.size() <= largest_wedge, "a wedge has 2 to 1000 steps");
  for (const int level : levels) require(level >= 0 && level <= 255, "levels lie between 0 and 255");
  return levels;
}

GrayImage wedge_image(const WedgeLayout& layout) {
  require(!layout.levels.empty() && layout.step_pixels > 0 && layout.rows > 0, "a wedge needs steps, each with pixels");
  const std::size_t frame = layout.frame_pixels;
  GrayImage image{layout.levels.size() * layout.step_pixels + 2 * frame, layout.rows + 2 * frame, {}};
  image.values.assign(image.columns * image.rows, 0.0F);
  for (std::size_t row = frame; row < frame + layout.rows; ++row) {
    for (std::size_t x = 0; x < layout.levels.size() * layout.step_pixels; ++x)
      image.values[row * image.columns + frame + x] = static_cast<float>(layout.levels[x / layout.step_pixels] / 255.0);
  }
  return image;
}

}  // namespace mezzotint
