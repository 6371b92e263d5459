// How layers are best packed into PNGs: our encoder, which sees runs, beside zlib and
// libdeflate, which see bytes. Milliseconds of one thread and kilobytes, a layer of 2560 × 1600 pixels.

#include <libdeflate.h>
#include <zlib.h>

#include <functional>

#include <fmt/format.h>

#include "fabrication/job/layer_png.h"
#include "fabrication/slicing/slice.h"
#include "measure.h"
#include "race_parts.h"

namespace mezzotint::benchmark {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Layer {
  std::string name;
  LayerPicture picture;
};

LayerPicture layer_of(const PartMesh& part, std::size_t index) {
  LayerPicture picture;
  (void)slice_part(part, PrinterProfile{}, {}, {}, [&](SlicedLayer&& layer) {
    if (layer.index == index) picture = std::move(layer.picture);
  });
  return picture;
}

// A smooth relief all over the field: no two pixels are alike.
LayerPicture gray_everywhere() {
  const PrinterProfile printer;
  Bytes gray(printer.pixels_x * printer.pixels_y);
  for (std::size_t i = 0; i < gray.size(); ++i) {
    const double x = static_cast<double>(i % printer.pixels_x), y = static_cast<double>(i / printer.pixels_x);
    const double wave = std::sin(x / 2.9 + std::sin(y / 7.1)) * std::sin(y / 3.7 + std::sin(x / 11.3));
    gray[i] = static_cast<std::uint8_t>(149.0 + 105.0 * wave);
  }
  return to_runs(gray, printer.pixels_x, printer.pixels_y);
}

// PNG's bytes: a filter byte before every row, then the row or its differences to the left.
Bytes scanlines(const LayerPicture& picture, bool differences) {
  const Bytes pixels = to_pixels(picture);
  Bytes lines;
  lines.reserve((picture.columns + 1) * picture.rows);
  for (std::size_t row = picture.rows; row-- > 0;) {
    lines.push_back(differences ? 1 : 0);
    std::uint8_t before = 0;
    for (std::size_t c = 0; c < picture.columns; ++c) {
      const std::uint8_t pixel = pixels[row * picture.columns + c];
      lines.push_back(differences ? static_cast<std::uint8_t>(pixel - before) : pixel);
      before = pixel;
    }
  }
  return lines;
}

std::size_t by_zlib(const Bytes& lines, int level, int strategy) {
  z_stream stream = {};
  deflateInit2(&stream, level, Z_DEFLATED, 15, 9, strategy);
  Bytes out(deflateBound(&stream, lines.size()));
  stream.next_in = const_cast<Bytef*>(lines.data());
  stream.avail_in = static_cast<uInt>(lines.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  const std::size_t size = stream.total_out;
  deflateEnd(&stream);
  return size;
}

std::size_t by_libdeflate(const Bytes& lines, int level) {
  libdeflate_compressor* const compressor = libdeflate_alloc_compressor(level);
  Bytes out(libdeflate_zlib_compress_bound(compressor, lines.size()));
  const std::size_t size = libdeflate_zlib_compress(compressor, lines.data(), lines.size(), out.data(), out.size());
  libdeflate_free_compressor(compressor);
  return size;
}

void row(const std::string& layer, const std::string& way, const std::function<std::size_t()>& pack) {
  std::vector<double> times;
  std::size_t size = 0;
  for (int i = 0; i < 5; ++i) {
    const double begin = thread_seconds();
    size = pack();
    times.push_back(thread_seconds() - begin);
  }
  fmt::print("{:18} {:30} {:10.3f} {:10.1f}\n", layer, way, 1e3 * median(times), static_cast<double>(size) / 1e3);
}

void race(const Layer& layer) {
  row(layer.name, "ours", [&] { return encode_layer_png(layer.picture).size(); });
  for (const bool differences : {false, true}) {
    const Bytes lines = scanlines(layer.picture, differences);
    const std::string filter = differences ? ", differences" : "";
    for (const int level : {1, 6}) {
      row(layer.name, fmt::format("zlib {}{}", level, filter),
          [&] { return by_zlib(lines, level, Z_DEFAULT_STRATEGY); });
    }
    row(layer.name, "zlib runs only" + filter, [&] { return by_zlib(lines, 6, Z_RLE); });
    for (const int level : {1, 6, 12}) {
      row(layer.name, fmt::format("libdeflate {}{}", level, filter), [&] { return by_libdeflate(lines, level); });
    }
  }
}

}  // namespace
}  // namespace mezzotint::benchmark

int main() {
  using namespace mezzotint::benchmark;
  fmt::print("{:18} {:30} {:>10} {:>10}\n", "layer", "way", "ms", "kB");
  race({"empty", mezzotint::to_runs(Bytes(2560 * 1600), 2560, 1600)});
  race({"sphere", layer_of(race_sphere(), 100)});
  race({"gear", layer_of(race_gear(), 50)});
  race({"plate's relief", layer_of(race_plate(770, 645), 56)});
  race({"gray everywhere", gray_everywhere()});
}
