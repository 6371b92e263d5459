#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/measurement/formats/file_builders.h"

// More files put together byte by byte: .sur, .sdf, .opd and pictures.
namespace mezzotint::test {

struct SurRecipe {
  std::int32_t columns = 0, rows = 0;
  std::vector<std::int32_t> counts;  ///< the top row first
  bool marked = false;               ///< whether lowest − 2 is a point that was not measured
  std::int32_t lowest = 0;
  std::int16_t bits = 32, type = 2, objects = 1, byte_order = 0;
  float step_x = 0.002F, step_y = 0.004F, step_z = 0.5F, offset_z = 0.0F;
  std::string unit_xy = "mm", unit_z = "nm", comment;
  int streams = 0;  ///< 0: not compressed
};
std::string build_sur(const SurRecipe& recipe);

/// Record 1 of a binary .sdf; the data follow.
struct SdfRecipe {
  std::string version = "bISO-1.0";
  std::uint32_t columns = 0, rows = 0;
  std::uint8_t data_type = 6;
  double z_scale = 1e-9;
  std::uint8_t compression = 0, check = 0;
};
std::string build_sdf_header(const SdfRecipe& recipe);
std::string build_text_sdf(const std::string& version, int columns, int rows, int data_type, const std::string& data);

struct OpdRecipe {
  std::uint16_t columns = 0, rows = 0, sample_bytes = 2;
  std::string samples;  ///< column after column, each from the bottom up
  std::string relief = "RAW_DATA";
  float wavelength_nm = 600.0F, pixel_mm = 0.002F, aspect = 2.0F;
  std::int16_t mult = 6;
};
std::string build_opd(const OpdRecipe& recipe);

/// An 8-bit BMP, its first line at the bottom, as Alicona's quality maps.
std::string build_bmp(std::int32_t columns, std::int32_t rows, const std::vector<std::uint8_t>& gray_from_the_top);

/// An uncompressed TIFF of one strip and one channel.
struct TiffRecipe {
  std::uint32_t columns = 0, rows = 0;
  std::uint16_t bits = 16;
  bool big_endian = false, floats = false;
  std::vector<double> pixels;
};
std::string build_tiff(const TiffRecipe& recipe);

/// A PNG of 8 or 16 bits of gray, by zlib, with a text that no reader of heights needs.
std::string build_png(std::uint32_t columns, std::uint32_t rows, int bits, const std::vector<unsigned>& gray);

/// An uncompressed OpenEXR of one channel of floats.
std::string build_exr(std::int32_t columns, std::int32_t rows, const std::vector<float>& values);

/// A number in big-endian order.
template <class Number>
void append_big_endian(std::string& bytes, Number value) {
  std::string little;
  append(little, value);
  bytes.append(little.rbegin(), little.rend());
}

}  // namespace mezzotint::test
