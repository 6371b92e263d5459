#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

/// Inside of measurement/reflectance.

namespace mezzotint {

struct PlanePoint {
  double x, y;
};

/// Points of the plane, joined into triangles (Delaunay), for linear interpolation between samples at any places.
///
/// Gaps     a triangle with a side longer than `longest_side` times the largest of its corners' median sides lies in a
///          gap of the measurement, and is left out. Grids that are finer along one direction have no gaps by that.
/// Source   Bowyer 1981, Watson 1981; points that lie on one circle are told apart by a shift of 1e-9.
class Triangulation {
public:
  static constexpr double longest_side = 2.0;
  /// Time grows as n^1.5 for points that spread over the plane, and as n² at worst.
  static constexpr std::size_t most_points = 16384;

  Triangulation() = default;
  /// Places within 1e-9 of each other are the caller's to avoid.
  explicit Triangulation(std::vector<PlanePoint> points);

  struct Corners {
    std::array<std::uint32_t, 3> point;
    std::array<double, 3> weight;  ///< they sum to 1
  };
  /// The triangle around a place (within 1e-9); nothing in a gap and outside of all.
  [[nodiscard]] std::optional<Corners> around(PlanePoint place) const;

  [[nodiscard]] const std::vector<PlanePoint>& points() const { return points_; }
  [[nodiscard]] std::size_t triangles() const { return triangles_.size(); }

private:
  using Triangle = std::array<std::uint32_t, 3>;
  void leave_out_gaps();
  void fill_cells();
  [[nodiscard]] std::size_t cell_of(double value, double low) const;

  std::vector<PlanePoint> points_;
  std::vector<Triangle> triangles_;
  double low_x_ = 0.0, low_y_ = 0.0, cell_side_ = 1.0;
  std::vector<std::vector<std::uint32_t>> cells_;  ///< the triangles that may reach into a cell
};

}  // namespace mezzotint
