// No tests: the builders of the other files here (the name lets CMake find it).
#include "tests/measurement/formats/instrument_builders.h"

#include <algorithm>

#include <zlib.h>

namespace mezzotint::test {

namespace {

std::string text_of(std::string text, std::size_t size, char filling = '\0') {
  text.resize(size, filling);
  return text;
}

std::string deflated(const std::string& content) {
  uLongf size = compressBound(content.size());
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(content.data()),
           content.size());
  packed.resize(size);
  return packed;
}

std::string sur_points(const SurRecipe& recipe) {
  std::string points;
  for (const std::int32_t count : recipe.counts) {
    if (recipe.bits == 16) {
      append(points, static_cast<std::int16_t>(count));
    } else {
      append(points, count);
    }
  }
  return points;
}

std::string sur_streams(const std::string& points, int streams) {
  std::string directory, packed;
  append(directory, static_cast<std::uint32_t>(streams));
  const std::size_t step = points.size() / static_cast<std::size_t>(streams);
  for (int i = 0; i < streams; ++i) {
    const std::size_t begin = step * static_cast<std::size_t>(i);
    const std::string part = points.substr(begin, i + 1 == streams ? std::string::npos : step);
    const std::string stream = deflated(part);
    append(directory, static_cast<std::uint32_t>(part.size()));
    append(directory, static_cast<std::uint32_t>(stream.size()));
    packed += stream;
  }
  return directory + packed;
}

}  // namespace

std::string build_sur(const SurRecipe& recipe) {
  const std::string points = sur_points(recipe);
  const std::string data = recipe.streams == 0 ? points : sur_streams(points, recipe.streams);
  std::string b = recipe.streams == 0 ? "DIGITAL SURF" : "DSCOMPRESSED";
  append(b, recipe.byte_order);
  append(b, recipe.objects);
  append(b, std::int16_t{1});
  append(b, recipe.type);
  b += text_of("coin", 30, ' ') + text_of("J\xF6rg", 30, ' ');  // Latin-1
  b += std::string(6, '\0');
  append(b, static_cast<std::int16_t>(recipe.marked ? 1 : 0));
  append(b, std::int16_t{0});
  b += std::string(8, '\0');
  append(b, recipe.bits);
  append(b, recipe.lowest);
  append(b, std::int32_t{1 << 20});
  append(b, recipe.columns);
  append(b, recipe.rows);
  append(b, recipe.columns * recipe.rows);
  for (const float step : {recipe.step_x, recipe.step_y, recipe.step_z}) append(b, step);
  for (const char* name : {"X", "Y", "Z"}) b += text_of(name, 16, ' ');
  for (const std::string& unit : {recipe.unit_xy, recipe.unit_xy, recipe.unit_z}) b += text_of(unit, 16, ' ');
  for (int axis = 0; axis < 3; ++axis) b += text_of("inch", 16, ' ');  // for display; must not matter
  for (int axis = 0; axis < 3; ++axis) append(b, 3.7F);
  b += std::string(6 + 12, '\0');
  for (const int part : {30, 59, 23, 31, 12, 2019, 2}) append(b, static_cast<std::int16_t>(part));
  append(b, 0.0F);
  append(b, static_cast<std::uint32_t>(recipe.streams == 0 ? 0 : data.size()));
  b += std::string(6, '\0');
  append(b, static_cast<std::int16_t>(recipe.comment.size()));
  append(b, std::int16_t{3});
  b += std::string(128, '\0');
  append(b, 0.0F);
  append(b, 0.0F);
  append(b, recipe.offset_z);
  return text_of(b, 512) + recipe.comment + "pri" + data;
}

std::string build_sdf_header(const SdfRecipe& recipe) {
  std::string b = recipe.version + text_of("maker", 10, ' ') + "311220192359" + "311220192359";
  for (const std::uint32_t count : {recipe.columns, recipe.rows}) {
    if (recipe.version.ends_with("2.0")) {
      append(b, count);
    } else {
      append(b, static_cast<std::uint16_t>(count));
    }
  }
  for (const double scale : {2e-6, 4e-6, recipe.z_scale, -1.0}) append(b, scale);
  append(b, recipe.compression);
  append(b, recipe.data_type);
  append(b, recipe.check);
  return b;
}

std::string build_text_sdf(const std::string& version, int columns, int rows, int data_type, const std::string& data) {
  return version + "\r\nManufacID = maker\r\nCreateDate = 311220192359\r\nModDate = 311220192359\r\nNumPoints = " +
         std::to_string(columns) + "\r\nNumProfiles = " + std::to_string(rows) +
         "\r\nXscale = 2.0E-6\r\nYscale = 4.0E-6\r\nZscale = 1.0E-9\r\nZresolution = -1\r\nCompression = 0\r\n"
         "DataType = " +
         std::to_string(data_type) + "\r\nCheckType = 0\r\n*\r\n" + data + "\r\n*\r\nend\r\n*\r\n";
}

std::string build_opd(const OpdRecipe& recipe) {
  std::string directory, blocks;
  const auto entry = [&](const std::string& name, std::int16_t type, std::size_t size) {
    directory += text_of(name, 16);
    append(directory, type);
    append(directory, static_cast<std::int32_t>(size));
    append(directory, std::uint16_t{1});
  };
  const auto block = [&](const std::string& name, std::int16_t type, const std::string& content) {
    entry(name, type, content.size());
    blocks += content;
  };
  const auto number = [](auto value) {
    std::string bytes;
    append(bytes, value);
    return bytes;
  };
  constexpr std::size_t entries = 9;
  entry("Directory", 1, 24 * entries);
  block("Mult", 6, number(recipe.mult));
  block(recipe.relief, 3, number(recipe.columns) + number(recipe.rows) + number(recipe.sample_bytes) + recipe.samples);
  block("Title", 5, text_of("coin", 20));
  entry("", 0, 0);
  block("Date", 5, "12/31/2019");
  block("Aspect", 7, number(recipe.aspect));
  block("Pixel_size", 7, number(recipe.pixel_mm));
  block("Wavelength", 7, number(recipe.wavelength_nm));
  return std::string("\x01\x00", 2) + directory + blocks;
}

std::string build_bmp(std::int32_t columns, std::int32_t rows, const std::vector<std::uint8_t>& gray) {
  std::string b = "BM";
  const std::size_t stride = (static_cast<std::size_t>(columns) + 3) / 4 * 4;
  append(b, static_cast<std::uint32_t>(14 + 40 + 1024 + stride * static_cast<std::size_t>(rows)));
  append(b, std::uint32_t{0});
  append(b, std::uint32_t{14 + 40 + 1024});
  append(b, std::uint32_t{40});
  append(b, columns);
  append(b, rows);
  append(b, std::uint16_t{1});
  append(b, std::uint16_t{8});
  b += std::string(24, '\0');
  for (int level = 0; level < 256; ++level) b += std::string(3, static_cast<char>(level)) + '\0';
  for (std::int32_t row = rows; row-- > 0;) {
    for (std::int32_t column = 0; column < columns; ++column) {
      b.push_back(static_cast<char>(gray[static_cast<std::size_t>(row * columns + column)]));
    }
    b += std::string(stride - static_cast<std::size_t>(columns), '\0');
  }
  return b;
}

std::string build_tiff(const TiffRecipe& recipe) {
  const auto put = [&](std::string& bytes, auto value) {
    if (recipe.big_endian) {
      append_big_endian(bytes, value);
    } else {
      append(bytes, value);
    }
  };
  std::string pixels;
  for (const double pixel : recipe.pixels) {
    if (recipe.floats) {
      put(pixels, static_cast<float>(pixel));
    } else if (recipe.bits == 16) {
      put(pixels, static_cast<std::uint16_t>(pixel));
    } else {
      put(pixels, static_cast<std::uint8_t>(pixel));
    }
  }
  if (pixels.size() % 2 == 1) pixels.push_back('\0');
  std::string b = recipe.big_endian ? "MM" : "II";
  put(b, std::uint16_t{42});
  put(b, static_cast<std::uint32_t>(8 + pixels.size()));
  b += pixels;
  const auto entry = [&](std::uint16_t tag, std::uint16_t type, std::uint32_t value) {
    put(b, tag);
    put(b, type);
    put(b, std::uint32_t{1});
    if (type == 3) {
      put(b, static_cast<std::uint16_t>(value));
      b += std::string(2, '\0');
    } else {
      put(b, value);
    }
  };
  put(b, std::uint16_t{10});
  entry(256, 4, recipe.columns);
  entry(257, 4, recipe.rows);
  entry(258, 3, recipe.bits);
  entry(259, 3, 1);
  entry(262, 3, 1);
  entry(273, 4, 8);
  entry(277, 3, 1);
  entry(278, 4, recipe.rows);
  entry(279, 4, static_cast<std::uint32_t>(recipe.pixels.size() * recipe.bits / 8));
  entry(339, 3, recipe.floats ? 3 : 1);
  put(b, std::uint32_t{0});
  return b;
}

std::string build_png(std::uint32_t columns, std::uint32_t rows, int bits, const std::vector<unsigned>& gray) {
  std::string b("\x89PNG\r\n\x1A\n", 8);
  const auto chunk = [&](const std::string& type, const std::string& data) {
    append_big_endian(b, static_cast<std::uint32_t>(data.size()));
    const std::string body = type + data;
    b += body;
    append_big_endian(b, static_cast<std::uint32_t>(
                             crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()))));
  };
  std::string header;
  append_big_endian(header, columns);
  append_big_endian(header, rows);
  header += {static_cast<char>(bits), '\0', '\0', '\0', '\0'};
  chunk("IHDR", header);
  chunk("gAMA", std::string("\x00\x00\xB1\x8F", 4));  // would bend the heights, if it were heeded
  chunk("tEXt", std::string("Comment\0relief", 14));
  std::string lines;
  for (std::size_t row = 0; row < gray.size() / columns; ++row) {  // all of them, unless the header promises more
    lines.push_back('\0');                                         // no filter
    for (std::size_t column = 0; column < columns; ++column) {
      const unsigned level = gray[row * columns + column];
      if (bits == 16) {
        append_big_endian(lines, static_cast<std::uint16_t>(level));
      } else {
        lines.push_back(static_cast<char>(level));
      }
    }
  }
  chunk("IDAT", deflated(lines));
  chunk("IEND", "");
  return b;
}

std::string build_exr(std::int32_t columns, std::int32_t rows, const std::vector<float>& values) {
  std::string b("\x76\x2f\x31\x01\x02\x00\x00\x00", 8);
  const auto attribute = [&](const std::string& name, const std::string& type, const std::string& value) {
    b += name + '\0' + type + '\0';
    append(b, static_cast<std::uint32_t>(value.size()));
    b += value;
  };
  std::string channels = std::string("Y\0", 2), window;
  append(channels, std::uint32_t{2});
  append(channels, std::uint32_t{0});
  append(channels, std::uint32_t{1});
  append(channels, std::uint32_t{1});
  channels.push_back('\0');
  for (const std::int32_t bound : {0, 0, columns - 1, rows - 1}) append(window, bound);
  std::string one, zeros;
  append(one, 1.0F);
  append(zeros, 0.0F);
  append(zeros, 0.0F);
  attribute("channels", "chlist", channels);
  attribute("compression", "compression", std::string(1, '\0'));
  attribute("dataWindow", "box2i", window);
  attribute("displayWindow", "box2i", window);
  attribute("lineOrder", "lineOrder", std::string(1, '\0'));
  attribute("pixelAspectRatio", "float", one);
  attribute("screenWindowCenter", "v2f", zeros);
  attribute("screenWindowWidth", "float", one);
  b.push_back('\0');
  const auto lines = static_cast<std::int32_t>(values.size()) / columns;  // all, unless the header promises more
  const std::size_t line_bytes = 4 * static_cast<std::size_t>(columns) + 8;
  const std::size_t start = b.size() + 8 * static_cast<std::size_t>(lines);
  for (std::size_t row = 0; row < static_cast<std::size_t>(lines); ++row) {
    append(b, std::uint64_t{start + row * line_bytes});
  }
  for (std::int32_t row = 0; row < lines; ++row) {
    append(b, row);
    append(b, static_cast<std::uint32_t>(4 * columns));
    for (std::int32_t column = 0; column < columns; ++column) {
      append(b, values[static_cast<std::size_t>(row * columns + column)]);
    }
  }
  return b;
}

}  // namespace mezzotint::test
