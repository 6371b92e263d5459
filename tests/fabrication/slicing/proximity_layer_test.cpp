#include <cmath>

#include <gtest/gtest.h>

#include "fabrication/slicing/proximity_layer.h"
#include "fabrication/slicing/slice.h"
#include "forward/base/error.h"
#include "forward/process/printed_relief.h"

namespace mezzotint {
namespace {

PrinterProfile small_printer() {
  PrinterProfile printer;
  printer.pixels_x = 160;
  printer.pixels_y = 150;
  printer.layer = 12.0_um;  // light to spare: full gray would cure 17.8 µm
  return printer;
}

PartMesh turned_box(double size, double height) {
  PartMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices_mm.push_back({i & 1 ? size : 0.0, i & 2 ? size : 0.0, i & 4 ? height : 0.0});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

SlicedLayer one_layer(bool corrected) {
  SlicedLayer result;
  SliceOptions options{.proximity_correction = corrected};
  options.placement.rotation = 20.0_deg;
  (void)slice_part(turned_box(0.7, small_printer().layer.mm()), small_printer(), options, {},
                   [&](SlicedLayer&& sliced) { result = std::move(sliced); });
  return result;
}

GrayImage gray_of(const SlicedLayer& layer) {
  GrayImage image{layer.picture.columns, layer.picture.rows, {}};
  for (const std::uint8_t level : to_pixels(layer.picture)) image.values.push_back(static_cast<float>(level) / 255.0F);
  return image;
}

double printed_volume(const GrayImage& image) {
  const HeightField printed = print_layer(image, small_printer(), {.subsamples = 8, .surround = Surround::Dark});
  double sum = 0.0;
  for (const float height : printed.heights_um()) sum += double(height);
  return sum / 64.0;
}

// A box whose walls stand aslant to the pixels: the blur takes light from its edges and rounds its corners.
TEST(ProximityLayer, PrintsTheVolumeThatIsWanted) {
  const PrinterProfile printer = small_printer();
  const double wanted = 0.7 * 0.7 / std::pow(printer.pixel_pitch.mm(), 2.0) * printer.layer.um();
  const SlicedLayer plain = one_layer(false), corrected = one_layer(true);
  const double error = std::abs(printed_volume(gray_of(plain)) - wanted),
               left = std::abs(printed_volume(gray_of(corrected)) - wanted);
  EXPECT_LT(2.0 * left, error);
  const ProximityFigures& figures = corrected.figures.proximity;
  EXPECT_LT(6.0 * figures.squares_after, figures.squares_before);
  EXPECT_GT(figures.edge_pixels, 300U);
  EXPECT_EQ(plain.figures.coverage_pixels, corrected.figures.coverage_pixels);
  EXPECT_EQ(plain.figures.proximity.edge_pixels, 0U);
}

TEST(ProximityLayer, RefusesWhatMakesNoSense) {
  const std::vector<float> coverage(12, 0.5F);
  EXPECT_THROW((void)correct_layer(coverage, {0, 0, 5, 2}, small_printer(), 18.0_um), InvalidInput);
  EXPECT_THROW((void)slice_part(turned_box(0.5, 0.1), small_printer(), {.linear = true, .proximity_correction = true},
                                {}, [](SlicedLayer&&) {}),
               InvalidInput);
}

}  // namespace
}  // namespace mezzotint
