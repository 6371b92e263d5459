#include "measurement/correction/step_lines.h"

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "tests/measurement/relief.h"

namespace mezzotint {
namespace {

HeightField tilted_noise() {
  HeightField field = test::white_noise(test::micrometre_grid(200, 40), 6);
  for (std::size_t row = 0; row < 40; ++row)
    for (std::size_t column = 0; column < 200; ++column)
      field.at(column, row) = 0.05F * field.at(column, row) + 0.1F * static_cast<float>(row);
  return field;
}

TEST(StepLines, AreTakenOutAndTheSlopeStays) {
  const HeightField whole = tilted_noise();
  HeightField stepped = whole;
  for (std::size_t row = 0; row < 40; ++row)
    for (std::size_t column = 0; column < 200; ++column)
      stepped.at(column, row) += (row >= 11 ? 2.0F : 0.0F) - (row >= 29 ? 3.0F : 0.0F);
  const StepLineResult result = correct_step_lines(stepped);
  // A median of 200 differences of 0.07 µm: 0.006 µm, with the median of the slope around it.
  EXPECT_NEAR(result.steps_um[10], 2.0, 0.03);
  EXPECT_NEAR(result.steps_um[28], -3.0, 0.03);
  for (std::size_t column = 0; column < 200; column += 17)
    EXPECT_NEAR(result.field.at(column, 39), whole.at(column, 39), 0.1);
}

TEST(StepLines, MissingSamplesAreNoSteps) {
  HeightField field = tilted_noise();
  for (std::size_t column = 0; column < 200; ++column) field.at(column, 20) = test::missing;
  const StepLineResult result = correct_step_lines(field);
  EXPECT_EQ(result.field.missing_count(), 200U);
  EXPECT_NEAR(result.field.at(5, 39), field.at(5, 39), 0.1);
}

TEST(StepLines, NeedTwoRows) {
  EXPECT_THROW((void)correct_step_lines(HeightField(test::micrometre_grid(9, 1), Continuation::Mirrored)),
               InvalidInput);
}

}  // namespace
}  // namespace mezzotint
