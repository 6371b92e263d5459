#include <cmath>
#include <limits>

#include "measurement/formats/sdf_header.h"

namespace mezzotint {

namespace {

// ISO marks by the smallest number of a type, the forerunner by the largest. ISO has no unsigned types; where a file
// uses one all the same, its 0 is a height.
template <class Number>
double checked(const SdfHeader& header, double value) {
  using Limits = std::numeric_limits<Number>;
  if (!header.forerunner && !Limits::is_signed) return value;
  const double marker = static_cast<double>(header.forerunner ? Limits::max() : Limits::lowest());
  return value == marker ? std::numeric_limits<double>::quiet_NaN() : value;
}

double checked_float(const SdfHeader& header, double value, double largest, double limit_of_forerunner) {
  const bool missing = header.forerunner ? value >= limit_of_forerunner : value <= -largest;
  return missing || !std::isfinite(value) ? std::numeric_limits<double>::quiet_NaN() : value;
}

template <class Number>
double decoded(const SdfHeader& header, const std::byte* bytes) {
  return sdf_value(header, static_cast<double>(little_endian<Number>(bytes)));
}

}  // namespace

std::size_t sdf_bytes_of(int data_type) {
  constexpr std::size_t sizes[] = {1, 2, 4, 4, 1, 2, 4, 8};
  return sizes[data_type];
}

// Source   ISO 25178-71, table of data types; for the forerunner EUNA 15178.
double sdf_value(const SdfHeader& header, double value) {
  switch (header.data_type) {
    case 0:
      return checked<std::uint8_t>(header, value);
    case 1:
      return checked<std::uint16_t>(header, value);
    case 2:
      return checked<std::uint32_t>(header, value);
    case 3:
      return checked_float(header, value, std::numeric_limits<float>::max(), 3.4e38);
    case 4:
      return checked<std::int8_t>(header, value);
    case 5:
      return checked<std::int16_t>(header, value);
    case 6:
      return checked<std::int32_t>(header, value);
    default:
      return checked_float(header, value, std::numeric_limits<double>::max(), 1.7e308);
  }
}

double sdf_value(const SdfHeader& header, const std::byte* bytes) {
  switch (header.data_type) {
    case 0:
      return decoded<std::uint8_t>(header, bytes);
    case 1:
      return decoded<std::uint16_t>(header, bytes);
    case 2:
      return decoded<std::uint32_t>(header, bytes);
    case 3:
      return decoded<float>(header, bytes);
    case 4:
      return decoded<std::int8_t>(header, bytes);
    case 5:
      return decoded<std::int16_t>(header, bytes);
    case 6:
      return decoded<std::int32_t>(header, bytes);
    default:
      return decoded<double>(header, bytes);
  }
}

}  // namespace mezzotint
