#include "experiments/configuration/png_end.h"

#include <algorithm>
#include <array>
#include <vector>

#include "forward/base/file_input.h"

namespace mezzotint {

bool is_cut_off_png(const std::filesystem::path& path) {
  constexpr std::array<unsigned char, 12> end = {0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xAE, 0x42, 0x60, 0x82};
  const std::vector<std::byte> bytes = read_file(path);
  const auto same = [](std::byte a, unsigned char b) { return std::to_integer<unsigned char>(a) == b; };
  return bytes.size() < end.size() || !std::equal(bytes.end() - end.size(), bytes.end(), end.begin(), same);
}

}  // namespace mezzotint
