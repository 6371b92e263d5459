#pragma once

#include <array>

namespace mezzotint::test {

/// Single-scatter albedo of microfacet lobes at F = 1 with the height-correlated Smith term, α by θ: worked out by
/// quadrature before Mezzotint was written, by none of its code.
inline constexpr std::array<double, 5> albedo_table_thetas_deg = {0.0, 30.0, 45.0, 60.0, 75.0};
struct AlbedoRow {
  double alpha;
  std::array<double, 5> albedo;
};
inline constexpr std::array<AlbedoRow, 5> beckmann_albedos = {{{0.2, {1.0000, .9999, .9969, .9724, .9141}},
                                                               {0.3, {.9997, .9914, .9672, .9233, .9025}},
                                                               {0.5, {.9430, .9028, .8746, .8694, .9053}},
                                                               {0.8, {.6419, .6919, .7490, .8183, .8988}},
                                                               {1.0, {.4616, .5480, .6509, .7666, .8808}}}};
inline constexpr std::array<AlbedoRow, 3> ggx_albedos = {{{0.3, {.8774, .8639, .8454, .8217, .8238}},
                                                          {0.5, {.6879, .6831, .6828, .6982, .7614}},
                                                          {1.0, {.3069, .3352, .3768, .4507, .5906}}}};
inline constexpr double albedo_table_tolerance = 1e-4;  // stated with the table

}  // namespace mezzotint::test
