#include <cmath>

#include "forward/base/error.h"
#include "measurement/formats/parsers.h"
#include "tests/measurement/formats/instrument_builders.h"
#include "tests/test_data.h"

namespace mezzotint {
namespace {

using test::as_bytes;
using test::build_opd;
using test::OpdRecipe;

SurfaceFile parse(const OpdRecipe& recipe) { return parse_opd("test.opd", as_bytes(build_opd(recipe))); }

std::string complaint(const std::string& bytes) {
  try {
    static_cast<void>(parse_opd("test.opd", as_bytes(bytes)));
  } catch (const FileError& error) {
    return error.what();
  }
  return "no complaint";
}

template <class Number>
OpdRecipe three_by_two(const std::vector<Number>& column_by_column) {
  OpdRecipe recipe;
  recipe.columns = 3;
  recipe.rows = 2;
  recipe.sample_bytes = sizeof(Number);
  for (const Number value : column_by_column) test::append(recipe.samples, value);
  return recipe;
}

TEST(Opd, IntegersCountPartsOfAWavelengthColumnAfterColumnFromTheBottom) {
  const SurfaceFile surface = parse(three_by_two<std::int16_t>({10, 20, 30, 40, 50, 60}));
  const HeightField& field = surface.field;
  // A count is 600 nm / 6.
  EXPECT_NEAR(field.at(0, 0) + field.datum().um(), 1.0, 1e-6);
  EXPECT_NEAR(field.at(0, 1) + field.datum().um(), 2.0, 1e-6);
  EXPECT_NEAR(field.at(2, 0) + field.datum().um(), 5.0, 1e-6);
  EXPECT_NEAR(field.grid().pitch_x.um(), 2.0, 1e-6);  // a float of mm
  EXPECT_NEAR(field.grid().pitch_y.um(), 4.0, 1e-6);
  EXPECT_EQ(surface.title, "coin");
  EXPECT_EQ(surface.provenance.at("Date"), "12/31/2019");
}

TEST(Opd, FloatsCountWholeWavelengths) {
  OpdRecipe recipe = three_by_two<float>({1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F});
  recipe.relief = "OPD";
  const HeightField field = parse(recipe).field;
  EXPECT_NEAR(field.at(1, 1) + field.datum().um(), 4 * 0.6, 1e-6);
}

TEST(Opd, BadSamplesAreMissing) {
  EXPECT_EQ(parse(three_by_two<std::int16_t>({32765, 32766, 32767, -32768, 0, 1})).field.missing_count(), 2U);
  EXPECT_EQ(parse(three_by_two<float>({1e38F, std::nanf(""), 1.0F, 2.0F, 3.0F, -4.0F})).field.missing_count(), 2U);
}

TEST(Opd, RefusesWhatIsMissingOrContradictsItself) {
  OpdRecipe recipe = three_by_two<std::int16_t>({1, 2, 3, 4, 5, 6});
  recipe.relief = "Image";
  EXPECT_NE(complaint(build_opd(recipe)).find("holds no relief"), std::string::npos);
  recipe = three_by_two<std::int16_t>({1, 2, 3, 4, 5});
  EXPECT_NE(complaint(build_opd(recipe)).find("needs 12 bytes"), std::string::npos);
  recipe = three_by_two<std::int16_t>({1, 2, 3, 4, 5, 6});
  recipe.mult = 0;
  EXPECT_NE(complaint(build_opd(recipe)).find("Mult is 0; a positive number"), std::string::npos);
  recipe = three_by_two<std::int16_t>({1, 2, 3, 4, 5, 6});
  recipe.sample_bytes = 1;
  EXPECT_NE(complaint(build_opd(recipe)).find("samples of 1 bytes"), std::string::npos);
  recipe = three_by_two<std::int16_t>({1, 2, 3, 4, 5, 6});
  recipe.pixel_mm = std::nanf("");
  EXPECT_NE(complaint(build_opd(recipe)).find("Pixel_size"), std::string::npos);
}

// The same measurement as converted by Gwyddion, sample by sample.
TEST(Opd, ARealFileIsWhatGwyddionMakesOfIt) {
  const auto folder = test::external_data_folder() / "surface";
  MEZZOTINT_NEEDS_DATA(folder / "surfalize_test_2.opd");
  const HeightField field = read_surface(folder / "surfalize_test_2.opd").field;
  const HeightField peer = read_surface(folder / "surfalize_test_2_opd.gwy").field;
  ASSERT_EQ(field.columns(), peer.columns());
  ASSERT_EQ(field.rows(), peer.rows());
  const double shift_um = (field.datum() - peer.datum()).um();
  double largest_um = 0.0;
  for (std::size_t i = 0; i < field.grid().size(); ++i) {
    const float z = field.heights_um()[i], w = peer.heights_um()[i];
    ASSERT_EQ(std::isnan(z), std::isnan(w)) << i;
    if (!std::isnan(z)) largest_um = std::max(largest_um, std::abs(z + shift_um - w));
  }
  EXPECT_LT(largest_um, 1e-6);  // two floats of up to 6 µm
}

}  // namespace
}  // namespace mezzotint
