#include "fabrication/job/layer_png.h"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "fabrication/job/run_deflate.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::uint8_t filter_none = 0, filter_sub = 1;
constexpr std::size_t farthest_back = 32768;
// A row of fewer runs is cheaper to write than to point at.
constexpr std::size_t simple_runs = 8;
// Pixels a run, on average, below which a picture is a matter for bytes rather than runs.
constexpr std::size_t rich_picture = 16;
constexpr int compression_level = 1;  // docs/slicing.md: higher ones take twice the time for 2 %

std::string big_endian(std::uint64_t value) {
  std::string bytes;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes.push_back(static_cast<char>((value >> shift) & 255U));
  return bytes;
}

void append_chunk(std::string& png, const std::string& name, const std::string& data) {
  png += big_endian(data.size());
  const std::uint32_t crc = libdeflate_crc32(libdeflate_crc32(0, name.data(), name.size()), data.data(), data.size());
  png += name;
  png += data;
  png += big_endian(crc);
}

void put_runs(std::span<const GrayRun> runs, std::size_t columns, RunDeflater& deflater) {
  deflater.put(filter_none, 1);
  std::size_t done = 0;
  for (const GrayRun& run : runs) {
    deflater.put(0, run.begin - done);
    deflater.put(run.level, static_cast<std::size_t>(run.end - run.begin));
    done = run.end;
  }
  deflater.put(0, columns - done);
}

std::string deflate_runs(const LayerPicture& picture) {
  RunDeflater deflater;
  std::span<const GrayRun> above;
  bool can_repeat = false;
  for (std::size_t row = picture.rows; row-- > 0;) {
    const std::span<const GrayRun> runs = runs_of_row(picture, row);
    const bool is_rich = runs.size() > simple_runs;
    if (can_repeat && is_rich && std::equal(runs.begin(), runs.end(), above.begin(), above.end())) {
      deflater.repeat_stretch();
      continue;
    }
    deflater.begin_stretch();
    put_runs(runs, picture.columns, deflater);
    deflater.end_stretch();
    above = runs;
    can_repeat = picture.columns >= 2 && picture.columns < farthest_back;
  }
  return deflater.finish();
}

void append_line(const LayerPicture& picture, std::size_t row, std::uint8_t filter, std::vector<std::uint8_t>& lines) {
  lines.push_back(filter);
  lines.resize(lines.size() + picture.columns, 0);
  std::uint8_t* const line = lines.data() + lines.size() - picture.columns;
  for (const GrayRun& run : runs_of_row(picture, row)) std::fill(line + run.begin, line + run.end, run.level);
  if (filter == filter_none) return;
  for (std::size_t column = picture.columns; column-- > 1;)
    line[column] = static_cast<std::uint8_t>(line[column] - line[column - 1]);
}

// Bits a byte that a code for single bytes would need, from every sixteenth row.
double entropy(const LayerPicture& picture, std::uint8_t filter) {
  std::vector<std::uint8_t> lines;
  for (std::size_t row = 0; row < picture.rows; row += 16) append_line(picture, row, filter, lines);
  std::array<double, 256> counts = {};
  for (const std::uint8_t byte : lines) ++counts[byte];
  double bits = 0.0;
  for (const double count : counts) {
    if (count > 0.0) bits -= count * std::log2(count / static_cast<double>(lines.size()));
  }
  return bits;
}

std::string deflate_bytes(const LayerPicture& picture) {
  const std::uint8_t filter = entropy(picture, filter_sub) < entropy(picture, filter_none) ? filter_sub : filter_none;
  std::vector<std::uint8_t> lines;
  lines.reserve((picture.columns + 1) * picture.rows);
  for (std::size_t row = picture.rows; row-- > 0;) append_line(picture, row, filter, lines);
  const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
      libdeflate_alloc_compressor(compression_level), libdeflate_free_compressor);
  if (!compressor) throw MethodError("out of memory for the compression of a layer");
  std::string out(libdeflate_zlib_compress_bound(compressor.get(), lines.size()), '\0');
  out.resize(libdeflate_zlib_compress(compressor.get(), lines.data(), lines.size(), out.data(), out.size()));
  return out;
}

}  // namespace

std::string encode_layer_png(const LayerPicture& picture) {
  const bool is_rich = picture.runs.size() > picture.columns * picture.rows / rich_picture;
  std::string png = "\x89PNG\r\n\x1A\n";
  std::string header = big_endian(picture.columns) + big_endian(picture.rows);
  header += {8, 0, 0, 0, 0};  // 8 bits, gray, deflate, filters by row, not interlaced
  append_chunk(png, "IHDR", header);
  append_chunk(png, "IDAT", is_rich ? deflate_bytes(picture) : deflate_runs(picture));
  append_chunk(png, "IEND", "");
  return png;
}

}  // namespace mezzotint
