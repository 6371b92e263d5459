#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "forward/base/error.h"
#include "measurement/texture/autocorrelation.h"
#include "measurement/texture/functional_parameters.h"
#include "measurement/texture/normal_distribution.h"
#include "measurement/texture/power_spectrum.h"
#include "measurement/texture/profile.h"
#include "measurement/texture/roughness.h"
#include "measurement/texture/spatial_parameters.h"
#include "tests/measurement/relief.h"

// Fields of one to five samples a side: every parameter is found, or said to be none.

namespace mezzotint {
namespace {

using Parameter = std::function<void(const HeightField&)>;

std::vector<std::pair<const char*, Parameter>> parameters() {
  return {{"roughness", [](const HeightField& f) { (void)area_roughness(f); }},
          {"functional", [](const HeightField& f) { (void)functional_parameters(f); }},
          {"spatial", [](const HeightField& f) { (void)spatial_parameters(f); }},
          {"autocorrelation", [](const HeightField& f) { (void)autocorrelation(f); }},
          {"power spectrum",
           [](const HeightField& f) {
             const PowerSpectrum spectrum = power_spectrum(f);
             (void)radial_spectrum(spectrum);
             (void)angular_spectrum(spectrum);
           }},
          {"normals", [](const HeightField& f) { (void)normal_distribution(f); }},
          {"profile", [](const HeightField& f) {
             (void)profile_along(f, {0.0, 0.0}, {1.0, 1.0});
           }}};
}

TEST(SmallestFields, HaveParametersOrNone) {
  for (const Continuation ends : {Continuation::Mirrored, Continuation::Periodic})
    for (std::size_t columns = 1; columns <= 5; ++columns)
      for (std::size_t rows = 1; rows <= 5; ++rows)
        for (const bool whole : {true, false}) {
          HeightField field = test::field_of(
              test::micrometre_grid(columns, rows), [](double c, double r) { return c * c - 0.5 * r; }, ends);
          if (!whole) field.at(columns / 2, rows / 2) = test::missing;
          for (const auto& [name, parameter] : parameters()) {
            SCOPED_TRACE(std::string(name) + " of " + std::to_string(columns) + " x " + std::to_string(rows));
            try {
              parameter(field);
            } catch (const InvalidInput& refusal) {
              EXPECT_GT(std::string(refusal.what()).size(), 10U);
            }
          }
        }
}

}  // namespace
}  // namespace mezzotint
