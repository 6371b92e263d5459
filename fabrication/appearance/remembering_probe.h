#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "fabrication/appearance/relief_probe.h"

/// Inside of fabrication/appearance.

namespace mezzotint {

/// A probe that keeps the points that it met last: neighbouring triangles and layers ask for the same ones.
class RememberingProbe {
public:
  explicit RememberingProbe(ReliefProbe probe) : probe_(std::move(probe)), entries_(kept) {}

  double operator()(const SurfacePoint& point) {
    Entry& entry = entries_[slot_of(point)];
    if (entry.triangle == point.triangle && entry.place_mm == point.place_mm) return entry.height_um;
    entry = {point.place_mm, point.triangle, probe_(point)};
    return entry.height_um;
  }

private:
  static constexpr std::size_t kept = std::size_t{1} << 13U;
  struct Entry {
    Eigen::Vector3d place_mm = Eigen::Vector3d::Zero();
    std::uint32_t triangle = 0xFFFFFFFFU;  ///< no triangle's number
    double height_um = 0.0;
  };
  static std::size_t slot_of(const SurfacePoint& point) {
    std::uint64_t mixed = point.triangle;
    for (const double value : {point.place_mm.x(), point.place_mm.y(), point.place_mm.z()})
      mixed = (mixed ^ std::bit_cast<std::uint64_t>(value)) * 0x9E3779B97F4A7C15U;
    return mixed >> (64U - 13U);
  }

  ReliefProbe probe_;
  std::vector<Entry> entries_;
};

}  // namespace mezzotint
