#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "inverse/design/design.h"

namespace mezzotint {

/// A family of patterns for studies of the search: what is free, and the narrower ranges that truths are drawn from.
struct Family {
  char letter;  ///< S sinusoid, R ridges and sinusoid, N noise of two octaves, C all three kinds
  Pattern pattern;
  std::vector<FreeParameter> free, truth;
  std::size_t pixels, draws;
  double tolerance;  ///< of the slope covariance, for a recovery to count
};

/// All four, or those whose letters are named.
[[nodiscard]] std::vector<Family> families(const std::string& letters = "SRNC");

/// The parameters of a truth, drawn from the family's ranges; the same for the same number.
[[nodiscard]] Pattern truth_of(const Family& family, std::uint64_t number);

/// |eigenvalue − 1| of found relative to truth, the larger one: both variances, and the axis as far as it matters.
[[nodiscard]] double largest_error(const SlopeCovariance& found, const SlopeCovariance& truth);

[[nodiscard]] double median(std::vector<double> values);
[[nodiscard]] double cpu_seconds();

}  // namespace mezzotint
