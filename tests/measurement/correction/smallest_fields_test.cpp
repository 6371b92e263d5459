#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "measurement/correction/fill.h"
#include "measurement/correction/flatten_base.h"
#include "measurement/correction/gaussian_filter.h"
#include "measurement/correction/orientation.h"
#include "measurement/correction/outliers.h"
#include "measurement/correction/plane.h"
#include "measurement/correction/polynomial.h"
#include "measurement/correction/step_lines.h"
#include "tests/measurement/relief.h"

// Fields of one to three samples a side, where Gwyddion 2.62 hangs: every correction gives a field of the same samples,
// or says that it cannot. A hang is stopped by the time limit of the test.

namespace mezzotint {
namespace {

struct Correction {
  const char* name;
  std::function<HeightField(const HeightField&)> apply;
};

std::vector<Correction> corrections() {
  const Length um = Length::from_um(1.0);
  return {{"level", [](const HeightField& f) { return level(f); }},
          {"polynomial", [](const HeightField& f) { return subtract_polynomial(f, fit_polynomial(f, 2)); }},
          {"flatten base", [](const HeightField& f) { return flatten_base(f, 5).field; }},
          {"outliers", [](const HeightField& f) { return mask_outliers(f, 3.0).field; }},
          {"local outliers", [](const HeightField& f) { return mask_local_outliers(f, 3.0).field; }},
          {"fill", [](const HeightField& f) { return fill_missing(f); }},
          {"step lines", [](const HeightField& f) { return correct_step_lines(f).field; }},
          {"s-filter", [=](const HeightField& f) { return s_filter(f, um); }},
          {"l-filter", [=](const HeightField& f) { return l_filter(f, um); }},
          {"turn", [](const HeightField& f) { return turned(f, Angle::from_degrees(30.0)); }},
          {"resample", [=](const HeightField& f) { return resampled(f, um, um); }}};
}

void try_all(const HeightField& field) {
  for (const Correction& correction : corrections()) {
    SCOPED_TRACE(std::string(correction.name) + " of " + std::to_string(field.columns()) + " x " +
                 std::to_string(field.rows()));
    try {
      EXPECT_EQ(correction.apply(field).grid(), field.grid());
    } catch (const InvalidInput& refusal) {
      EXPECT_GT(std::string(refusal.what()).size(), 10U);
    }
  }
}

TEST(SmallestFields, AreCorrectedOrRefusedByEveryStep) {
  for (const Continuation ends : {Continuation::Mirrored, Continuation::Periodic})
    for (std::size_t columns = 1; columns <= 3; ++columns)
      for (std::size_t rows = 1; rows <= 3; ++rows) {
        HeightField field = test::field_of(
            test::micrometre_grid(columns, rows), [](double c, double r) { return c * c - 0.5 * r; }, ends);
        try_all(field);
        field.at(columns - 1, rows - 1) = test::missing;
        try_all(field);
        for (float& z : field.heights_um()) z = test::missing;
        try_all(field);
      }
}

}  // namespace
}  // namespace mezzotint
