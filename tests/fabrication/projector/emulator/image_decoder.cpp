#include "tests/fabrication/projector/emulator/image_decoder.h"

namespace mezzotint::emulator {
namespace {

class Stream {
public:
  Stream(const std::vector<std::uint8_t>& bytes, std::size_t from) : bytes_(bytes), from_(from), at_(from) {}

  unsigned byte() {
    if (at_ >= bytes_.size()) throw BadImage("the stream ends in the middle");
    return bytes_[at_++];
  }
  /// One byte below 128, else seven low bits and then eight high ones.
  std::size_t length() {
    const unsigned low = byte();
    return low < 128 ? low : low - 128 + 128 * byte();
  }
  void align(std::size_t to) {
    while ((at_ - from_) % to != 0) {
      if (byte() != 0) throw BadImage("padding is not zero");
    }
  }
  [[nodiscard]] bool done() const { return at_ == bytes_.size(); }

private:
  const std::vector<std::uint8_t>& bytes_;
  std::size_t from_, at_;
};

/// Pixels fill a line from left to right; a line's end is checked when it is said.
class Canvas {
public:
  explicit Canvas(std::size_t width) : width_(width) {}

  void put(unsigned r, unsigned g, unsigned b) {
    if (x_ == width_) next_line();
    for (const unsigned value : {r, g, b}) pixels.push_back(static_cast<std::uint8_t>(value));
    ++x_;
  }
  void stay_inside(std::size_t count) {
    if (x_ == width_) next_line();
    if (count > width_ - x_) throw BadImage("a run leaves its line");
  }
  void copy_above(std::size_t count) {
    stay_inside(count);
    if (y_ == 0) throw BadImage("a copy from above the first line");
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t above = pixels.size() - 3 * width_;
      put(pixels[above], pixels[above + 1], pixels[above + 2]);
    }
  }
  void end_line() {
    if (x_ != width_) throw BadImage("a line ends early");
    next_line();
  }
  std::vector<std::uint8_t> pixels;

private:
  void next_line() {
    x_ = 0;
    ++y_;
  }
  std::size_t width_, x_ = 0, y_ = 0;
};

void repeat_pixel(Stream& in, Canvas& canvas, std::size_t count) {
  canvas.stay_inside(count);
  const unsigned r = in.byte(), g = in.byte(), b = in.byte();
  for (std::size_t i = 0; i < count; ++i) canvas.put(r, g, b);
}

void raw_pixels(Stream& in, Canvas& canvas, std::size_t count) {
  canvas.stay_inside(count);
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned r = in.byte(), g = in.byte(), b = in.byte();
    canvas.put(r, g, b);
  }
}

void run_length(Stream& in, Canvas& canvas) {
  for (;;) {
    if (const unsigned count = in.byte(); count > 0) {
      repeat_pixel(in, canvas, count);
      continue;
    }
    const unsigned second = in.byte();
    if (second == 1) return in.align(16);
    if (second == 0) {
      canvas.end_line();
      in.align(4);
    } else {
      raw_pixels(in, canvas, second);
    }
  }
}

void enhanced(Stream& in, Canvas& canvas) {
  for (;;) {
    if (const std::size_t count = in.length(); count > 0) {
      repeat_pixel(in, canvas, count);
      continue;
    }
    const std::size_t second = in.length();
    if (second == 0) {
      canvas.end_line();
    } else if (second > 1) {
      raw_pixels(in, canvas, second);
    } else if (const std::size_t copied = in.length(); copied > 0) {
      canvas.copy_above(copied);
    } else {
      return in.align(4);
    }
  }
}

void uncompressed(Stream& in, Canvas& canvas, std::size_t width, std::size_t height) {
  for (std::size_t y = 0; y < height; ++y) {
    raw_pixels(in, canvas, width);
    in.align(16);
  }
}

std::size_t little(const std::vector<std::uint8_t>& bytes, std::size_t at, int count) {
  std::size_t value = 0;
  for (int i = count; i-- > 0;) value = value * 256 + bytes[at + static_cast<std::size_t>(i)];
  return value;
}

}  // namespace

std::vector<std::uint8_t> DecodedImage::plane(unsigned bit) const {
  std::vector<std::uint8_t> gray;
  gray.reserve(width * height);
  for (std::size_t i = 2 - bit / 8; i < rgb.size(); i += 3) gray.push_back(rgb[i]);
  return gray;
}

DecodedImage decode_image(const std::vector<std::uint8_t>& upload) {
  if (upload.size() < 48) throw BadImage("no header");
  if (std::string(upload.begin(), upload.begin() + 4) != "Spld") throw BadImage("no signature");
  DecodedImage image{little(upload, 4, 2), little(upload, 6, 2), {}};
  if (little(upload, 8, 4) != upload.size() - 48) throw BadImage("the byte count is wrong");
  for (std::size_t i = 12; i < 20; ++i) {
    if (upload[i] != 0xff) throw BadImage("bytes 12 to 19 are not FF");
  }
  if (upload[24] > 1 || upload[26] != 1) throw BadImage("not 24 bits a pixel in the known order");
  Stream in(upload, 48);
  Canvas canvas(image.width);
  switch (upload[25]) {
    case 0:
      uncompressed(in, canvas, image.width, image.height);
      break;
    case 1:
      run_length(in, canvas);
      break;
    case 2:
      enhanced(in, canvas);
      break;
    default:
      throw BadImage("unknown compression");
  }
  if (!in.done()) throw BadImage("bytes after the end of the image");
  if (canvas.pixels.size() != 3 * image.width * image.height) throw BadImage("not all pixels are there");
  image.rgb = std::move(canvas.pixels);
  return image;
}

std::vector<std::uint8_t> decode_enhanced_example(const std::vector<std::uint8_t>& stream, std::size_t width) {
  Stream in(stream, 0);
  Canvas canvas(width);
  enhanced(in, canvas);
  return canvas.pixels;
}

}  // namespace mezzotint::emulator
