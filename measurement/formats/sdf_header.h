#pragma once

#include <map>
#include <string>

#include "measurement/formats/byte_reader.h"
#include "measurement/formats/height_assembly.h"
#include "measurement/formats/text_scanner.h"

namespace mezzotint {

/// Record 1 of an SDF file.
struct SdfHeader {
  bool ascii = false;
  /// BCR-1.0 of 1993, the forerunner: it marks missing points by the largest value of the type in place of the
  /// smallest, and its first profile has the largest y.
  bool forerunner = false;
  bool wide_counts = false;  ///< ISO-2.0: 32 bits
  PromisedGrid grid;
  double z_scale_m = 1.0;
  int data_type = 0;  ///< 0 … 7: uint8, uint16, uint32, float, int8, int16, int32, double
  std::map<std::string, std::string> provenance;
};

/// The first 8 bytes.
/// @throws FileError for another version than ISO-1.0, ISO-2.0 and BCR-1.0
[[nodiscard]] SdfHeader sdf_version(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// The rest of record 1, in either form. Compressed and checksummed data are refused.
void take_sdf_header(SdfHeader& header, ByteReader& reader);
void take_sdf_header(SdfHeader& header, TextScanner& scanner);

[[nodiscard]] std::size_t sdf_bytes_of(int data_type);
/// The value of a point in binary data; NaN where it is marked as missing.
[[nodiscard]] double sdf_value(const SdfHeader& header, const std::byte* bytes);
/// A point that was read as text, likewise.
[[nodiscard]] double sdf_value(const SdfHeader& header, double value);

}  // namespace mezzotint
