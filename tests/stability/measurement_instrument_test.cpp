#include "measurement/correction/plane.h"
#include "measurement/instrument/virtual_profilometer.h"
#include "tests/stability/scene.h"
#include "tests/stability/surfaces.h"

namespace mezzotint {
namespace {

using test::percent;

constexpr const char* theme = "Measurement";

HeightField scaled(HeightField field, double factor) {
  for (float& z : field.heights_um()) z = static_cast<float>(factor * double{z});
  return field;
}

VirtualProfilometer instrument() {
  VirtualProfilometer made;
  made.pitch = 1.0_um;
  return made;
}

double missing_share(const HeightField& field) {
  return static_cast<double>(field.missing_count()) / static_cast<double>(field.grid().size());
}

TEST(Dropouts, AtSteepSlopesLeaveTheGentleParts) {
  const HeightField relief = test::texture(256, 16.0);
  const double truth = area_roughness(relief).Sdq.value;
  std::vector<double> seen, missing;
  std::string told;
  for (const double aperture : {0.8, 0.6, 0.4}) {
    VirtualProfilometer with = instrument();
    with.aperture = aperture;
    const HeightField scan = level(measure_virtually(relief, with));
    seen.push_back(area_roughness(scan).Sdq.value / truth);
    missing.push_back(missing_share(scan));
    told = test::texture_note(scan, "beside missing samples");
    EXPECT_EQ(told.empty(), missing.back() == 0.0);
  }
  EXPECT_LT(seen[2], 0.8);
  // Where four fifths are missing, the gentle rest is all alike; that so much is missing is said instead.
  VirtualProfilometer with = instrument();
  with.aperture = 0.4;
  const HeightField rest = level(measure_virtually(scaled(relief, 3.0), with));
  EXPECT_GT(missing_share(rest), 0.8);
  EXPECT_FALSE(test::texture_note(rest, "are missing: what was found").empty());
  // Holes that have nothing to do with slopes are no ground for either.
  with.aperture = 0.0;
  with.hole_share = with.missing_share = 0.02;
  with.hole_diameter = 6.0_um;
  EXPECT_TRUE(test::texture_note(level(measure_virtually(relief, with)), "beside missing").empty());
  test::record(
      {theme, "Sdq of a scan with missing samples",
       fmt::format("Sdq = {:.2f} through apertures of 0.8, 0.6 and 0.4 (slopes up to 1.33, 0.75 and 0.44)", truth),
       fmt::format("What is steeper is missing, {}, {} and {} of the samples; Sdq of the survivors is {}, {} and {} of "
                   "the truth.",
                   percent(missing[0]), percent(missing[1]), percent(missing[2]), percent(seen[0]), percent(seen[1]),
                   percent(seen[2])),
       "Slopes beside missing samples against those elsewhere; of the rest, how much is missing.", told});
}

TEST(Bandwidth, OfTheInstrumentIsNotInItsSamples) {
  const HeightField relief = test::texture(256, 8.0);
  const AreaRoughness truth = area_roughness(relief);
  std::vector<AreaRoughness> seen;
  for (const double bandwidth_um : {2.0, 8.0, 16.0}) {
    VirtualProfilometer with = instrument();
    with.bandwidth = Length::from_um(bandwidth_um);
    seen.push_back(area_roughness(measure_virtually(relief, with)));
  }
  // White noise under Gaussians of cut-offs 8 and b is white noise under one of √(8² + b²); Sq goes as 1 ÷ cut-off, and
  // Sdq as its square. One patch, so both move by some per cent.
  const auto left = [](double b) { return 8.0 / std::hypot(8.0, b); };
  EXPECT_NEAR(seen[1].Sq.value / truth.Sq.value, left(8.0), 0.03);
  EXPECT_NEAR(seen[2].Sdq.value / truth.Sdq.value, left(16.0) * left(16.0), 0.03);
  test::record(
      {theme, "Sq, Sdq through optics",
       "a texture of Sal = 3.8 µm at a lateral period limit of 2, 8 and 16 µm, samples 1 µm apart",
       fmt::format("Sq is {}, {} and {} of the truth, Sdq {}, {} and {}. The spacing does not tell.",
                   percent(seen[0].Sq.value / truth.Sq.value), percent(seen[1].Sq.value / truth.Sq.value),
                   percent(seen[2].Sq.value / truth.Sq.value), percent(seen[0].Sdq.value / truth.Sdq.value),
                   percent(seen[1].Sdq.value / truth.Sdq.value), percent(seen[2].Sdq.value / truth.Sdq.value)),
       "Not noticed: a blurred surface looks like a smooth one. Compare scans through the same --s-filter, longer "
       "than the instrument's limit.",
       "Sdq and Sdr hold wavelengths from … to … um; finer structure, which the instrument did not see, has slopes "
       "too"});
}

TEST(Offsets, OfAbsoluteHeightsInSinglePrecisionAreSteps) {
  const HeightField relief = scaled(test::texture(256, 16.0), 0.02);
  // As a file of absolute heights in metres has them.
  HeightField stored = relief;
  for (float& z : stored.heights_um())
    z = static_cast<float>(1e6 * (double{static_cast<float>(0.076 + 1e-6 * double{z})} - 0.076));
  const AreaRoughness truth = area_roughness(relief), found = area_roughness(stored);
  const std::string told = height_step_note(stored, found);
  EXPECT_FALSE(told.empty());
  EXPECT_TRUE(height_step_note(relief, truth).empty());
  EXPECT_NEAR(found.Sdq.value, std::hypot(truth.Sdq.value, 7.4506e-3 / std::sqrt(3.0)), 0.02 * truth.Sdq.value);
  test::record(
      {theme, "absolute heights in single precision", "Sq = 20 nm at 76 mm, metres as floats, samples 1 µm apart",
       fmt::format("Heights come in steps of 7.45 nm: Sq is {:+.1f} %, Sdq {:+.0f} % off. A file that the program "
                   "writes keeps the datum apart and loses nothing.",
                   100.0 * (found.Sq.value / truth.Sq.value - 1.0), 100.0 * (found.Sdq.value / truth.Sdq.value - 1.0)),
       "Neighbours that differ by whole steps; where their rounding makes a tenth of Sdq it says so.", told});
}

}  // namespace
}  // namespace mezzotint
