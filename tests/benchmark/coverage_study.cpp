// Error against time of a layer's coverage: exact, and by N × N samples. A gear of 10.4 mm in one layer of 2560 × 1600
// pixels, at 16 places of the pixel grid; errors are the root mean square over the pixels that its outline crosses,
// against the outline cut to each pixel, in gray levels of 255.
//
//   coverage_study [FIGURE.svg]

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "fabrication/slicing/slab_raster.h"
#include "forward/base/file_output.h"
#include "measure.h"
#include "tests/fabrication/slicing/shapes.h"

namespace mezzotint::benchmark {
namespace {

constexpr std::size_t columns = 1500, rows = 1500;

using Row = std::vector<float>;
using Image = std::vector<Row>;

Image layer_image(const std::vector<RasterTriangle>& triangles, SlabRaster& raster) {
  Image image(rows, Row(columns, 0.0F));
  raster.begin(1);
  raster.add(triangles);
  (void)raster.finish([&](std::size_t row, std::span<const CoverageRun> runs) {
    for (const CoverageRun& run : runs)
      std::fill(image[row].begin() + run.begin, image[row].begin() + run.end, run.coverage);
  });
  return image;
}

double seconds_a_layer(const std::vector<RasterTriangle>& triangles, SlabRaster& raster) {
  std::vector<double> times;
  for (int i = 0; i < 7; ++i) {
    const double begin = thread_seconds();
    for (int k = 0; k < 10; ++k) {
      raster.begin(1);
      raster.add(triangles);
      (void)raster.finish([](std::size_t, std::span<const CoverageRun>) {});
    }
    times.push_back((thread_seconds() - begin) / 10.0);
  }
  return median(times);
}

// Exact by other means: row by row, then pixel by pixel. Only pixels that are partly covered are kept.
std::map<std::pair<std::size_t, std::size_t>, double> partly_covered(const test::Outline& outline, const Image& hint) {
  std::map<std::pair<std::size_t, std::size_t>, double> areas;
  for (std::size_t r = 0; r < rows; ++r) {
    const double y = static_cast<double>(r);
    const test::Outline strip = test::cut_by(test::cut_by(outline, 1, y, 1.0), 1, y + 1.0, -1.0);
    for (std::size_t c = 0; c < columns; ++c) {
      if (hint[r][c] <= 0.0F || hint[r][c] >= 1.0F) continue;
      const double x = static_cast<double>(c);
      areas[{r, c}] = test::area(test::cut_by(test::cut_by(strip, 0, x, 1.0), 0, x + 1.0, -1.0));
    }
  }
  return areas;
}

struct Point {
  std::string name;
  double seconds, error, largest;
};

// Both axes logarithmic: 0.1 to 10 ms, 1e-6 to 100 gray levels.
std::string figure(const std::vector<Point>& points) {
  constexpr double left = 70.0, top = 40.0, width = 420.0, height = 300.0;
  const auto x = [&](double ms) { return left + width * (std::log10(ms) + 1.0) / 2.0; };
  const auto y = [&](double levels) { return top + height * (2.0 - std::log10(levels)) / 8.0; };
  std::string svg =
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 560 400' font-family='sans-serif' font-size='12'>\n"
      "<rect width='560' height='400' fill='white'/>\n"
      "<text x='70' y='22' font-size='14'>Coverage of a layer: error against time</text>\n";
  for (const double ms : {0.1, 1.0, 10.0}) {
    svg +=
        fmt::format("<path d='M{0} {1}V{2}' stroke='#ddd'/><text x='{0}' y='{3}' text-anchor='middle'>{4:g}</text>\n",
                    x(ms), top, top + height, top + height + 18.0, ms);
  }
  for (int decade = -6; decade <= 2; decade += 2) {
    const double at = y(std::pow(10.0, decade));
    svg += fmt::format("<path d='M{0} {1}H{2}' stroke='#ddd'/><text x='{3}' y='{4}' text-anchor='end'>1e{5}</text>\n",
                       left, at, left + width, left - 6.0, at + 4.0, decade);
  }
  svg += fmt::format(
      "<path d='M{0} {1}H{2}' stroke='#999' stroke-dasharray='4 3'/><text x='{3}' y='{4}' fill='#666'>half a level of "
      "8 "
      "bits</text>\n",
      left, y(0.5), left + width, left + 6.0, y(0.5) - 5.0);
  for (const Point& point : points) {
    const bool exact = point.name == "exact";
    svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='4.5' fill='{}'/><text x='{:.1f}' y='{:.1f}'>{}</text>\n",
                       x(1e3 * point.seconds), y(point.error), exact ? "#d55e00" : "#0072b2",
                       x(1e3 * point.seconds) + 8.0, y(point.error) + 4.0, point.name);
  }
  svg += fmt::format("<text x='{}' y='{}' text-anchor='middle'>CPU time of a layer, ms</text>\n", left + width / 2.0,
                     top + height + 40.0);
  svg += fmt::format(
      "<text transform='translate(20 {}) rotate(-90)' text-anchor='middle'>RMS error of rim pixels, gray "
      "levels</text>\n"
      "</svg>\n",
      top + height / 2.0);
  return svg;
}

std::vector<Point> study() {
  fmt::print("{:>10} {:>12} {:>14} {:>14}\n", "samples", "ms a layer", "RMS, levels", "largest, levels");
  std::map<int, std::vector<double>> squares, largest;
  std::map<int, double> seconds;
  for (int place = 0; place < 16; ++place) {
    const double x = 750.0 + 0.137 * place, y = 750.0 + 0.291 * place;
    const test::Outline outline = test::gear(x, y, 557.0, 690.0, 40, 0.01 * place);
    const auto triangles = test::as_triangles(test::prism(outline, 0.0, 3.0));
    SlabRaster exact(columns, rows, {CoverageMode::Midplane, 0});
    const auto areas = partly_covered(outline, layer_image(triangles, exact));
    for (const int n : {0, 1, 2, 4, 8, 16, 32}) {
      SlabRaster raster(columns, rows, {CoverageMode::Midplane, n});
      const Image image = layer_image(triangles, raster);
      double sum = 0.0, worst = 0.0;
      for (const auto& [pixel, area] : areas) {
        const double error = 255.0 * std::abs(double{image[pixel.first][pixel.second]} - area);
        sum += error * error;
        worst = std::max(worst, error);
      }
      squares[n].push_back(sum / static_cast<double>(areas.size()));
      largest[n].push_back(worst);
      if (place == 0) seconds[n] = seconds_a_layer(triangles, raster);
    }
  }
  std::vector<Point> points;
  for (const auto& [n, all] : squares) {
    double mean = 0.0;
    for (const double square : all) mean += square / static_cast<double>(all.size());
    points.push_back({n == 0 ? "exact" : fmt::format("{0} x {0}", n), seconds[n], std::sqrt(mean),
                      *std::max_element(largest[n].begin(), largest[n].end())});
    fmt::print("{:>10} {:12.3f} {:14.5f} {:14.5f}\n", points.back().name, 1e3 * points.back().seconds,
               points.back().error, points.back().largest);
  }
  return points;
}

}  // namespace
}  // namespace mezzotint::benchmark

int main(int count, char** arguments) {
  const auto points = mezzotint::benchmark::study();
  if (count > 1) mezzotint::write_file(arguments[1], mezzotint::benchmark::figure(points));
}
