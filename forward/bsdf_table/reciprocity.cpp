#include "forward/bsdf_table/reciprocity.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace mezzotint {

namespace {

std::vector<double> azimuth_offsets(SymmetryKind kind) {
  constexpr double pi = std::numbers::pi;
  if (kind != SymmetryKind::Isotropic) return {0.0, pi};
  return {0.0, pi / 6, pi / 3, pi / 2, 2 * pi / 3, 5 * pi / 6, pi};
}

class ReciprocitySums {
public:
  explicit ReciprocitySums(double least_significance) : least_significance_(least_significance) {}

  void add(const Estimate& there, const Estimate& back) {
    const double mean = 0.5 * (there.value + back.value), difference = there.value - back.value;
    const double error = std::hypot(there.standard_error, back.standard_error);
    if (!(mean > least_significance_ * 0.5 * error)) {
      ++check_.lost_in_noise;
      return;
    }
    const double relative = std::abs(difference) / mean;
    ++check_.pairs;
    check_.largest_relative = std::max(check_.largest_relative, relative);
    squares_ += relative * relative;
    if (!(error > 0.0)) return;
    ++with_error_;
    squares_in_errors_ += difference * difference / (error * error);
    if (std::abs(difference) > 3.0 * error) ++check_.beyond_three_errors;
  }
  [[nodiscard]] ReciprocityCheck result() const {
    ReciprocityCheck check = check_;
    if (check.pairs > 0) check.rms_relative = std::sqrt(squares_ / static_cast<double>(check.pairs));
    if (with_error_ > 0)
      check.rms_in_standard_errors = std::sqrt(squares_in_errors_ / static_cast<double>(with_error_));
    return check;
  }

private:
  ReciprocityCheck check_;
  double least_significance_;
  double squares_ = 0.0, squares_in_errors_ = 0.0;
  std::size_t with_error_ = 0;
};

}  // namespace

ReciprocityCheck check_reciprocity(const BsdfTable& table, double least_significance) {
  ReciprocitySums sums(least_significance);
  for (std::size_t i = 0; i < table.nodes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (const double offset : azimuth_offsets(table.incidences.symmetry.kind)) {
        DirectionAngles other = table.nodes[j].incidence;
        other.phi = other.phi + Angle::from_radians(offset);
        const Direction a = to_direction(table.nodes[i].incidence), b = to_direction(other);
        sums.add(evaluate(table, a, b), evaluate(table, b, a));
      }
    }
  }
  return sums.result();
}

}  // namespace mezzotint
