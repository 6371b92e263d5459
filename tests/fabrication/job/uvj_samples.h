#pragma once

#include <fstream>
#include <iterator>
#include <string>

#include "fabrication/job/job.h"
#include "fabrication/job/png_picture.h"
#include "fabrication/job/zip_archive.h"
#include "forward/base/random.h"

namespace mezzotint::test {

inline Job sample_job() {
  GrayImage relief{13, 7, {}};
  const RandomStream stream(5, RandomPurpose::Test);
  for (std::size_t i = 0; i < 91; ++i) relief.values.push_back(static_cast<float>(stream.uniform4(i)[0]));
  return make_patch_job("sample \"patch\" µ", relief, PrinterProfile{}, {2, 3});
}

inline void expect_same(const Job& a, const Job& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.printer, b.printer);
  EXPECT_EQ(a.columns, b.columns);
  EXPECT_EQ(a.rows, b.rows);
  EXPECT_EQ(a.pixel_pitch, b.pixel_pitch);
  EXPECT_EQ(a.layer, b.layer);
  EXPECT_EQ(a.led_amplitude, b.led_amplitude);
  ASSERT_EQ(a.layers.size(), b.layers.size());
  for (std::size_t i = 0; i < a.layers.size(); ++i) {
    EXPECT_EQ(a.layers[i].gray, b.layers[i].gray);
    EXPECT_EQ(a.layers[i].exposure_s, b.layers[i].exposure_s);
    EXPECT_EQ(a.layers[i].top, b.layers[i].top);
  }
}

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline void put_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// An archive of another program: no manifest, no previews. Members are named by the test.
class ForeignArchive {
public:
  ForeignArchive& add(const std::string& name, std::string bytes) {
    members_.emplace_back(name, std::move(bytes));
    return *this;
  }
  ForeignArchive& add_slice(std::size_t index, std::size_t columns, std::size_t rows, std::uint8_t gray = 7) {
    const std::vector<std::uint8_t> pixels(columns * rows, gray);
    return add("slice/0000000" + std::to_string(index) + ".png", encode_png(pixels, columns, rows, 1));
  }
  void write(const std::filesystem::path& path) const {
    ZipWriter zip(path);
    for (const auto& [name, bytes] : members_) zip.add(name, bytes, ZipWriter::Packing::Deflate);
    zip.close();
  }

private:
  std::vector<std::pair<std::string, std::string>> members_;
};

}  // namespace mezzotint::test
