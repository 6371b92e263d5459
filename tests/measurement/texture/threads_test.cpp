#include <functional>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "measurement/texture/autocorrelation.h"
#include "measurement/texture/functional_parameters.h"
#include "measurement/texture/power_spectrum.h"
#include "measurement/texture/roughness.h"
#include "tests/measurement/relief.h"

// A parameter has the same bits with any number of threads.

namespace mezzotint {
namespace {

using Numbers = std::vector<double>;

Numbers with_threads(std::size_t threads, const std::function<Numbers()>& work) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  return work();
}

TEST(Parameters, HaveTheSameBitsWithAnyNumberOfThreads) {
  const HeightField field = test::white_noise(test::micrometre_grid(301, 517), 6);
  const std::pair<const char*, std::function<Numbers()>> parameters[] = {
      {"autocorrelation", [&] { return autocorrelation(field).values; }},
      {"power spectrum", [&] { return power_spectrum(field).density_um4; }},
      {"roughness",
       [&] {
         const AreaRoughness r = area_roughness(field);
         return Numbers{r.Sa.value,  r.Sq.value,  r.Ssk.value,         r.Sku.value,
                        r.Sdq.value, r.Sdr.value, *r.Sa.standard_error};
       }},
      {"functional", [&] {
         const FunctionalParameters f = functional_parameters(field);
         return Numbers{f.Sk.value, f.Spk.value, f.Vvv.value, *f.Sk.standard_error};
       }}};
  for (const auto& [name, parameter] : parameters)
    EXPECT_EQ(with_threads(1, parameter), with_threads(4, parameter)) << name;
}

}  // namespace
}  // namespace mezzotint
