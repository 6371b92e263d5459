#include <cstring>
#include <functional>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "measurement/correction/fill.h"
#include "measurement/correction/flatten_base.h"
#include "measurement/correction/gaussian_filter.h"
#include "measurement/correction/outliers.h"
#include "measurement/correction/plane.h"
#include "measurement/correction/polynomial.h"
#include "tests/measurement/relief.h"

// A result has the same bits with any number of threads.

namespace mezzotint {
namespace {

HeightField with_threads(std::size_t threads, const std::function<HeightField()>& work) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  return work();
}

bool same_bits(const HeightField& a, const HeightField& b) {
  return a.datum().um() == b.datum().um() &&
         std::memcmp(a.heights_um().data(), b.heights_um().data(), a.heights_um().size_bytes()) == 0;
}

TEST(Corrections, HaveTheSameBitsWithAnyNumberOfThreads) {
  HeightField field = test::white_noise(test::micrometre_grid(301, 517), 6);
  for (std::size_t i = 0; i < field.grid().size(); i += 7) field.heights_um()[i] = test::missing;
  for (std::size_t row = 100; row < 130; ++row)
    for (std::size_t column = 50; column < 80; ++column) field.at(column, row) = test::missing;
  const std::pair<const char*, std::function<HeightField()>> steps[] = {
      {"level", [&] { return level(field); }},
      {"polynomial", [&] { return subtract_polynomial(field, fit_polynomial(field, 4)); }},
      {"flatten base", [&] { return flatten_base(field, 3).field; }},
      {"outliers", [&] { return mask_outliers(field, 2.0).field; }},
      {"fill", [&] { return fill_missing(field); }},
      {"filter, direct", [&] { return s_filter(field, Length::from_um(5.0)); }},
      {"filter, by FFT", [&] { return s_filter(field, Length::from_um(120.0)); }}};
  for (const auto& [name, step] : steps) EXPECT_TRUE(same_bits(with_threads(1, step), with_threads(4, step))) << name;
}

}  // namespace
}  // namespace mezzotint
