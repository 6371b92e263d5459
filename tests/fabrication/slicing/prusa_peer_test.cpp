#include <cmath>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "fabrication/job/job_file.h"
#include "fabrication/part/part_file.h"
#include "fabrication/slicing/slice.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

// The display of the archives' .ini: portrait, 1440 × 2560 pixels of 47.25 µm, layers of 0.1 mm.
PrinterProfile sl1_display() {
  PrinterProfile profile;
  profile.name = "SL1";
  profile.pixels_x = 1440;
  profile.pixels_y = 2560;
  profile.pixel_pitch = Length::from_um(47.25);
  profile.layer = Length::from_um(100.0);
  return profile;
}

std::vector<double> peer_sums(const std::string& archive) {
  std::ifstream file(test::external_data_folder() / "sla" / "reference_layers.csv");
  std::vector<double> sums;
  for (std::string line; std::getline(file, line);) {
    std::stringstream fields(line);
    std::vector<std::string> values;
    for (std::string value; std::getline(fields, value, ',');) values.push_back(value);
    if (values[0] == archive) sums.push_back(std::stod(values[4]));
  }
  return sums;
}

struct Difference {
  int largest = 0;
  std::size_t pixels = 0;      ///< that differ at all
  std::size_t not_at_rim = 0;  ///< that differ though we have them dark or full
};

Difference difference(const std::vector<std::uint8_t>& ours, const std::vector<std::uint8_t>& theirs) {
  Difference found;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const int by = std::abs(int{ours[i]} - int{theirs[i]});
    found.largest = std::max(found.largest, by);
    found.pixels += by > 0 ? 1 : 0;
    found.not_at_rim += by > 0 && (ours[i] == 0 || ours[i] == 255) ? 1 : 0;
  }
  return found;
}

void expect_as_prusa_slicer(const std::string& mesh, const std::string& archive) {
  const auto data = test::external_data_folder();
  MEZZOTINT_NEEDS_DATA(data / "sla" / archive);
  const std::vector<double> sums = peer_sums(archive);
  const JobReader peer(data / "sla" / archive);
  const PartFile part = read_part(data / "mesh" / mesh);
  SliceOptions options;
  options.coverage.mode = CoverageMode::Midplane;
  options.linear = true;
  std::size_t layers = 0;
  std::size_t compared = 0;
  (void)slice_part(part.mesh, sl1_display(), options, {}, [&](SlicedLayer&& layer) {
    ASSERT_LT(layer.index, sums.size());
    EXPECT_NEAR(static_cast<double>(layer.figures.gray_sum) / 255.0, sums[layer.index], 1e-4 * sums[layer.index]);
    if (layer.index % 60 == 7) {
      const Difference found = difference(to_pixels(layer.picture), peer.read_layer(layer.index));
      // AGG, which it draws by, scales a pixel's share by 256 and cuts at 255: up to one level more than rounding.
      EXPECT_LE(found.largest, 1);
      EXPECT_EQ(found.not_at_rim, 0U);
      compared += found.pixels;
    }
    ++layers;
  });
  EXPECT_EQ(layers, sums.size());
  EXPECT_GT(compared, 0U) << "its rounding shows nowhere: were these its pictures?";
}

TEST(PrusaPeer, SlicesACubeAlike) { expect_as_prusa_slicer("ps_20mm_cube.obj", "cube20_L0.1.sl1"); }
TEST(PrusaPeer, SlicesACubeWithAConcaveHoleAlike) {
  expect_as_prusa_slicer("ps_cube_with_concave_hole.obj", "cube_with_concave_hole_L0.1.sl1");
}

}  // namespace
}  // namespace mezzotint
