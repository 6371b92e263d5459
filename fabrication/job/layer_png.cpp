#include "fabrication/job/layer_png.h"

#include <zlib.h>

#include <algorithm>

#include "fabrication/job/run_deflate.h"

namespace mezzotint {

namespace {

constexpr std::uint8_t filter_none = 0, filter_sub = 1;
constexpr std::size_t farthest_back = 32768;
// A row of fewer runs is cheaper to write than to point at.
constexpr std::size_t simple_runs = 8;

std::string big_endian(std::uint64_t value) {
  std::string bytes;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes.push_back(static_cast<char>((value >> shift) & 255U));
  return bytes;
}

void append_chunk(std::string& png, const std::string& name, const std::string& data) {
  png += big_endian(data.size());
  uLong crc = crc32(0, reinterpret_cast<const Bytef*>(name.data()), static_cast<uInt>(name.size()));
  crc = crc32_z(crc, reinterpret_cast<const Bytef*>(data.data()), data.size());
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

// Differences from pixel to pixel: fewer kinds of bytes where the gray goes smoothly up and down.
void put_differences(std::span<const GrayRun> runs, std::size_t columns, RunDeflater& deflater) {
  deflater.put(filter_sub, 1);
  std::size_t done = 0;
  std::uint8_t before = 0;
  const auto step = [&](std::uint8_t level, std::size_t count) {
    deflater.put(static_cast<std::uint8_t>(level - before), 1);
    deflater.put(0, count - 1);
    before = level;
  };
  for (const GrayRun& run : runs) {
    if (run.begin > done) step(0, run.begin - done);
    step(run.level, static_cast<std::size_t>(run.end - run.begin));
    done = run.end;
  }
  if (columns > done) step(0, columns - done);
}

}  // namespace

std::string encode_layer_png(const LayerPicture& picture) {
  RunDeflater deflater;
  std::span<const GrayRun> above;
  bool can_repeat = false;
  for (std::size_t row = picture.rows; row-- > 0;) {
    const std::span<const GrayRun> runs = runs_of_row(picture, row);
    const bool rich = runs.size() > simple_runs;
    if (can_repeat && rich && std::equal(runs.begin(), runs.end(), above.begin(), above.end())) {
      deflater.repeat_stretch();
      continue;
    }
    deflater.begin_stretch();
    if (runs.size() > picture.columns / 8) {
      put_differences(runs, picture.columns, deflater);
    } else {
      put_runs(runs, picture.columns, deflater);
    }
    deflater.end_stretch();
    above = runs;
    can_repeat = picture.columns >= 2 && picture.columns < farthest_back;
  }
  std::string png = "\x89PNG\r\n\x1A\n";
  std::string header = big_endian(picture.columns) + big_endian(picture.rows);
  header += {8, 0, 0, 0, 0};  // 8 bits, gray, deflate, filters by row, not interlaced
  append_chunk(png, "IHDR", header);
  append_chunk(png, "IDAT", deflater.finish());
  append_chunk(png, "IEND", "");
  return png;
}

}  // namespace mezzotint
