#include <gtest/gtest.h>

#include "measurement/texture/autocorrelation.h"
#include "measurement/texture/functional_parameters.h"
#include "measurement/texture/power_spectrum.h"
#include "measurement/texture/roughness.h"
#include "tests/counted_memory.h"
#include "tests/measurement/relief.h"

// 10^8 samples have their parameters within 4 GB: what counts is bytes a sample, measured on a smaller field. The field
// itself, which takes 4, does not count here.

namespace mezzotint {
namespace {

template <class Work>
double bytes_a_sample(const HeightField& field, const Work& work) {
  return static_cast<double>(test::peak_bytes([&] { work(field); })) / static_cast<double>(field.grid().size());
}

TEST(MemoryOfParameters, IsInProportionToTheSamplesAndSmall) {
  HeightField field = test::white_noise(test::micrometre_grid(1500, 1400), 3);
  // A spectrum of the rows, half as wide again for the padding, 12 bytes; the map itself, 8.
  EXPECT_LT(bytes_a_sample(field, [](const HeightField& f) { (void)autocorrelation(f); }), 20.5);
  // 8 and 8.
  EXPECT_LT(bytes_a_sample(field, [](const HeightField& f) { (void)power_spectrum(f); }), 16.5);
  // Sums of bands, and two rows for each thread.
  EXPECT_LT(bytes_a_sample(field, [](const HeightField& f) { (void)area_roughness(f); }), 1.0);
  // Counts of 16 blocks, 4 MB whatever the size; curves of 65536 places, 1.3 MB at a time.
  EXPECT_LT(bytes_a_sample(field, [](const HeightField& f) { (void)functional_parameters(f); }) * 2.1e6, 10e6);
  field.at(700, 700) = test::missing;
  EXPECT_LT(bytes_a_sample(field, [](const HeightField& f) { (void)autocorrelation(f); }), 20.5);
}

}  // namespace
}  // namespace mezzotint
