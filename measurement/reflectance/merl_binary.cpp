#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/byte_reader.h"
#include "measurement/reflectance/reflectance_parsers.h"

namespace mezzotint {

namespace {

constexpr std::int32_t dimensions[3] = {HalfAngleTable::half_angles, HalfAngleTable::difference_angles,
                                        HalfAngleTable::azimuths};
constexpr double scales[3] = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};
constexpr std::size_t header_bytes = 3 * sizeof(std::int32_t);
constexpr std::size_t whole_bytes = header_bytes + 3 * HalfAngleTable::channel_size * sizeof(double);

}  // namespace

// Three counts make a weak magic: the product of sensible ones, and a length that fits or nearly does, are asked for
// by the parser.
bool looks_like_merl(std::span<const std::byte> bytes) {
  if (bytes.size() < header_bytes) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (little_endian<std::int32_t>(bytes.data() + i * sizeof(std::int32_t)) != dimensions[i]) return false;
  }
  return true;
}

MeasuredReflectance parse_merl(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  ByteReader reader(path, bytes);
  for (const std::int32_t wanted : dimensions) {
    const auto count = reader.take_number<std::int32_t>("number of angles");
    if (count != wanted)
      reader.fail(fmt::format("has {} angles where a MERL file has {}; 90, 90, 180 are read", count, wanted));
  }
  if (bytes.size() != whole_bytes) {
    throw FileError(path, byte_place(bytes.size()),
                    fmt::format("ends after {} bytes; a MERL file of 90 x 90 x 180 has {}", bytes.size(), whole_bytes));
  }
  HalfAngleTable table;
  table.values.resize(3 * HalfAngleTable::channel_size);
  std::size_t missing = 0;
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    const double value = little_endian<double>(bytes.data() + header_bytes + i * sizeof(double));
    if (!std::isfinite(value)) {
      throw FileError(path, byte_place(header_bytes + i * sizeof(double)),
                      "holds a sample that is not finite; what was not measured is negative in a MERL file");
    }
    missing += value < 0.0 ? 1 : 0;
    table.values[i] = static_cast<float>(value < 0.0 ? not_measured : value * scales[i / HalfAngleTable::channel_size]);
  }
  MeasuredReflectance measured;
  measured.format = "MERL";
  measured.quantity = "BRDF, scaled channel by channel; a pair of directions takes the bin it falls in";
  measured.assumption = "R, G and B are linear, with the primaries of ITU-R BT.709";
  measured.provenance["missing_samples"] = std::to_string(missing);
  measured.channels = {{"R", {}}, {"G", {}}, {"B", {}}};
  measured.data = std::move(table);
  return measured;
}

}  // namespace mezzotint
