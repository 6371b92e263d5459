#pragma once

#include <compare>
#include <numbers>

namespace mezzotint {

/// A length, stored in micrometres.
///
/// Units    Written with a literal (`7.54_um`, `18.0_mm`) or a named constructor, read with `um()` or
///          `mm()`, so that no bare number crosses a public function without its unit.
class Length {
public:
  constexpr Length() = default;
  [[nodiscard]] static constexpr Length from_um(double value) { return Length(value); }
  [[nodiscard]] static constexpr Length from_mm(double value) { return Length(value * 1e3); }
  [[nodiscard]] static constexpr Length from_m(double value) { return Length(value * 1e6); }
  [[nodiscard]] static constexpr Length from_nm(double value) { return Length(value * 1e-3); }

  [[nodiscard]] constexpr double um() const { return um_; }
  [[nodiscard]] constexpr double mm() const { return um_ * 1e-3; }
  [[nodiscard]] constexpr double m() const { return um_ * 1e-6; }

  constexpr auto operator<=>(const Length&) const = default;
  constexpr Length operator-() const { return Length(-um_); }
  constexpr Length operator+(Length other) const { return Length(um_ + other.um_); }
  constexpr Length operator-(Length other) const { return Length(um_ - other.um_); }
  constexpr Length operator*(double factor) const { return Length(um_ * factor); }
  constexpr Length operator/(double divisor) const { return Length(um_ / divisor); }
  constexpr double operator/(Length other) const { return um_ / other.um_; }

private:
  explicit constexpr Length(double um) : um_(um) {}
  double um_ = 0.0;
};

constexpr Length operator*(double factor, Length length) { return length * factor; }

/// A plane angle, stored in radians; degrees at the border (files, command line).
class Angle {
public:
  constexpr Angle() = default;
  [[nodiscard]] static constexpr Angle from_radians(double value) { return Angle(value); }
  [[nodiscard]] static constexpr Angle from_degrees(double value) { return Angle(value * std::numbers::pi / 180.0); }

  [[nodiscard]] constexpr double radians() const { return radians_; }
  [[nodiscard]] constexpr double degrees() const { return radians_ * 180.0 / std::numbers::pi; }

  constexpr auto operator<=>(const Angle&) const = default;
  constexpr Angle operator-() const { return Angle(-radians_); }
  constexpr Angle operator+(Angle other) const { return Angle(radians_ + other.radians_); }
  constexpr Angle operator-(Angle other) const { return Angle(radians_ - other.radians_); }
  constexpr Angle operator*(double factor) const { return Angle(radians_ * factor); }

private:
  explicit constexpr Angle(double radians) : radians_(radians) {}
  double radians_ = 0.0;
};

inline namespace literals {
constexpr Length operator""_um(long double value) { return Length::from_um(static_cast<double>(value)); }
constexpr Length operator""_mm(long double value) { return Length::from_mm(static_cast<double>(value)); }
constexpr Length operator""_nm(long double value) { return Length::from_nm(static_cast<double>(value)); }
constexpr Angle operator""_deg(long double value) { return Angle::from_degrees(static_cast<double>(value)); }
}  // namespace literals

}  // namespace mezzotint
