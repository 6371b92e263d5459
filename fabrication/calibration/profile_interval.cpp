#include "fabrication/calibration/profile_interval.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mezzotint {

namespace {

constexpr CureParameters least{-1000.0, -7.0, least_gamma};
constexpr CureParameters largest{1000.0, 7.0, largest_gamma};
// Where nothing better is known of a parameter's scale.
constexpr CureParameters first_steps{0.05, 0.005, 0.001};

class Profile {
public:
  Profile(const std::vector<WeighedPoint>& points, const LeastLoss& best, int parameter, const FreeParameters& free,
          double layer_um)
      : points_(points), parameter_(parameter), others_(free), layer_um_(layer_um), lowest_(best) {
    others_[parameter] = false;
  }

  // The least loss with the parameter at `value`, from a neighbour's answer.
  LeastLoss at(double value, const CureParameters& neighbour) {
    CureParameters start = neighbour;
    start[parameter_] = value;
    const CureParameters found = minimize_loss(points_, start, others_, layer_um_);
    LeastLoss answer{found, total_loss(points_, found, layer_um_)};
    if (parameter_ == 2) {
      const LeastLoss fresh = least_loss_at(points_, value, layer_um_);
      if (fresh.loss < answer.loss) answer = fresh;
    }
    if (answer.loss < lowest_.loss) lowest_ = answer;
    return answer;
  }

  double end(const LeastLoss& best, double direction, double rise) {
    const double bound = direction < 0.0 ? least[parameter_] : largest[parameter_];
    const double limit = best.loss + rise;
    double inside = best.parameters[parameter_], step = first_steps[parameter_];
    CureParameters neighbour = best.parameters;
    double outside = inside;
    for (;;) {
      outside = inside + direction * step;
      const bool is_bound = direction * (outside - bound) >= 0.0;
      if (is_bound) outside = bound;
      const LeastLoss there = at(outside, neighbour);
      if (there.loss > limit) break;
      if (is_bound) return direction * std::numeric_limits<double>::infinity();
      inside = outside;
      neighbour = there.parameters;
      step *= 1.5;
    }
    // To a thousandth of what has been gone: the interval itself is no better known.
    const double enough = 1e-3 * std::abs(outside - best.parameters[parameter_]);
    while (std::abs(outside - inside) > enough) {
      const double middle = 0.5 * (inside + outside);
      const LeastLoss there = at(middle, neighbour);
      if (there.loss <= limit) {
        inside = middle;
        neighbour = there.parameters;
      } else {
        outside = middle;
      }
    }
    return 0.5 * (inside + outside);
  }

  [[nodiscard]] const LeastLoss& lowest() const { return lowest_; }

private:
  const std::vector<WeighedPoint>& points_;
  int parameter_;
  FreeParameters others_;
  double layer_um_;
  LeastLoss lowest_;
};

}  // namespace

ProfileInterval profile_interval(const std::vector<WeighedPoint>& points, const LeastLoss& best, int parameter,
                                 const FreeParameters& free, double rise, double layer_um) {
  Profile profile(points, best, parameter, free, layer_um);
  const double low = profile.end(best, -1.0, rise), high = profile.end(best, 1.0, rise);
  return {low, high, profile.lowest()};
}

}  // namespace mezzotint
