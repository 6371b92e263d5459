#include "experiments/study/label_places.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace mezzotint {

std::vector<double> label_places(const std::vector<double>& wanted, double distance, double last) {
  std::vector<std::size_t> order(wanted.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return wanted[a] < wanted[b]; });
  std::vector<double> places = wanted;
  for (std::size_t k = 1; k < order.size(); ++k)
    places[order[k]] = std::max(places[order[k]], places[order[k - 1]] + distance);
  double limit = last;
  for (std::size_t k = order.size(); k-- > 0; limit = places[order[k]] - distance)
    places[order[k]] = std::min(places[order[k]], limit);
  return places;
}

}  // namespace mezzotint
