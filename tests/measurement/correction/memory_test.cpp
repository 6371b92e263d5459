#include <utility>

#include <gtest/gtest.h>

#include "measurement/correction/fill.h"
#include "measurement/correction/flatten_base.h"
#include "measurement/correction/gaussian_filter.h"
#include "measurement/correction/outliers.h"
#include "measurement/correction/plane.h"
#include "tests/counted_memory.h"
#include "tests/measurement/relief.h"

// 10^8 samples are corrected within 4 GB: what counts is bytes a sample, measured on a smaller field. The field itself
// takes 4; a step that copies it once takes 4 more.

namespace mezzotint {
namespace {

// A hundredth is missing.
const HeightField& scan() {
  static const HeightField once = [] {
    HeightField field = test::white_noise(test::micrometre_grid(1500, 1400), 3);
    for (std::size_t i = 0; i < field.grid().size(); i += 101) field.heights_um()[i] = test::missing;
    return field;
  }();
  return once;
}

template <class Work>
double bytes_a_sample(const Work& work) {
  HeightField field = scan();
  const auto samples = static_cast<double>(field.grid().size());
  return static_cast<double>(test::peak_bytes([&] { work(std::move(field)); })) / samples;
}

// Sums of bands, columns that were taken out, a bit a sample for the holes and 8 bytes for each sample in one.
constexpr double in_place = 1.0;

TEST(MemoryOfCorrections, OfAFieldThatIsMovedInIsNoCopy) {
  EXPECT_LT(bytes_a_sample([](HeightField f) { (void)level(std::move(f)); }), in_place);
  EXPECT_LT(bytes_a_sample([](HeightField f) { (void)mask_outliers(std::move(f), 3.0); }), in_place);
  EXPECT_LT(bytes_a_sample([](HeightField f) { (void)fill_missing(std::move(f)); }), in_place);
  EXPECT_LT(bytes_a_sample([](HeightField f) { (void)flatten_base(std::move(f)); }), in_place);
}

TEST(MemoryOfCorrections, OfAFieldThatIsKeptIsOneCopy) {
  const HeightField& field = scan();
  const auto samples = static_cast<double>(field.grid().size());
  EXPECT_GT(static_cast<double>(test::peak_bytes([&] { (void)level(field); })) / samples, 3.9);  // the count counts
  // And some tiles of 256² with their 14 sums, for each thread: up to 20 MB, on 16 of them 150 bytes a sample of this
  // small field, so that the filter is judged by its copy alone.
  EXPECT_GT(static_cast<double>(test::peak_bytes([&] { (void)s_filter(field, Length::from_um(4.0)); })) / samples, 3.9);
}

}  // namespace
}  // namespace mezzotint
