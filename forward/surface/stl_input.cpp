#include <bit>
#include <unordered_map>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/surface/mesh_parsers.h"
#include "forward/surface/text_words.h"

namespace mezzotint {

namespace {

constexpr std::size_t header_bytes = 84, facet_bytes = 50;

std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value |= std::to_integer<std::uint32_t>(bytes[at + k]) << (8 * k);
  return value;
}

// One vertex for all corners at the same place.
class Welder {
public:
  Welder(const std::filesystem::path& path, RawMesh& mesh) : path_(path), mesh_(mesh) {}

  std::uint32_t number(const std::string& place, std::array<double, 3> corner) {
    for (double& coordinate : corner) coordinate += 0.0;  // −0 is 0
    const auto next = static_cast<std::uint32_t>(mesh_.vertices.size());
    const auto [known, is_new] = numbers_.try_emplace(corner, next);
    if (is_new) add_vertex(path_, place, corner, mesh_);
    return known->second;
  }

private:
  struct Hash {
    std::size_t operator()(const std::array<double, 3>& corner) const {
      std::uint64_t hash = 0;
      for (const double coordinate : corner)
        hash = (std::rotl(hash, 23) ^ std::bit_cast<std::uint64_t>(coordinate)) * 0x9E3779B97F4A7C15U;
      return static_cast<std::size_t>(hash ^ (hash >> 32U));
    }
  };
  const std::filesystem::path& path_;
  RawMesh& mesh_;
  std::unordered_map<std::array<double, 3>, std::uint32_t, Hash> numbers_;
};

RawMesh parse_binary(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  if (bytes.size() < header_bytes) throw FileError(path, "header", "ends within its first 84 bytes; it is truncated");
  const std::size_t count = word_at(bytes, 80), held = (bytes.size() - header_bytes) / facet_bytes;
  if (count > held) {
    throw FileError(path, "byte 80",
                    fmt::format("says {} triangles, but has bytes for {}; it is truncated or no STL", count, held));
  }
  RawMesh mesh{.format = "stl (binary)"};
  Welder welder(path, mesh);
  for (std::size_t facet = 0; facet < count; ++facet) {
    const std::size_t begin = header_bytes + facet * facet_bytes;
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      std::array<double, 3> place{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        place[axis] = double{std::bit_cast<float>(word_at(bytes, begin + 12 * (corner + 1) + 4 * axis))};
      triangle[corner] = welder.number("byte " + std::to_string(begin), place);
    }
    add_polygon(triangle, mesh);
  }
  return mesh;
}

[[noreturn]] void fail(const std::filesystem::path& path, const TextWords& text, std::string_view wanted,
                       std::string_view found) {
  throw FileError(path, text.place(),
                  found.empty() ? fmt::format("ends where \"{}\" is due; it is truncated", wanted)
                                : fmt::format("has \"{}\" where \"{}\" is due", found.substr(0, 40), wanted));
}

void expect(const std::filesystem::path& path, TextWords& text, std::string_view wanted) {
  const std::string_view found = text.word_of_text();
  if (found != wanted) fail(path, text, wanted, found);
}

std::array<double, 3> three_numbers(const std::filesystem::path& path, TextWords& text) {
  std::array<double, 3> numbers{};
  for (double& number : numbers) {
    const std::string_view word = text.word_of_text();
    const auto value = real_in(word);
    if (!value) fail(path, text, "a number", word);
    number = *value;
  }
  return numbers;
}

// After "facet": normal, three corners, "endfacet".
std::array<std::uint32_t, 3> read_facet(const std::filesystem::path& path, TextWords& text, Welder& welder) {
  expect(path, text, "normal");
  for (int k = 0; k < 3; ++k) (void)text.word_of_text();
  expect(path, text, "outer");
  expect(path, text, "loop");
  std::array<std::uint32_t, 3> triangle{};
  for (std::uint32_t& corner : triangle) {
    expect(path, text, "vertex");
    const std::array<double, 3> place = three_numbers(path, text);
    corner = welder.number(text.place(), place);
  }
  expect(path, text, "endloop");
  expect(path, text, "endfacet");
  return triangle;
}

RawMesh parse_text(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  RawMesh mesh{.format = "stl (text)"};
  TextWords text(bytes);
  Welder welder(path, mesh);
  while (text.next_line()) {  // "solid NAME", its facets, "endsolid NAME"; there may be several
    const std::string_view opening = text.word();
    if (opening.empty()) continue;
    if (opening != "solid") fail(path, text, "solid", opening);
    if (!text.next_line()) fail(path, text, "endsolid", {});
    for (std::string_view word = text.word_of_text(); word != "endsolid"; word = text.word_of_text()) {
      if (word != "facet") fail(path, text, "facet", word);
      add_polygon(read_facet(path, text, welder), mesh);
    }
  }
  return mesh;
}

// A binary file may begin with "solid" too; a text goes on with a facet or its end.
bool is_text(std::span<const std::byte> bytes) {
  constexpr std::size_t enough = 4096;
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), enough));
  if (bytes.size() >= header_bytes && bytes.size() == header_bytes + facet_bytes * std::size_t{word_at(bytes, 80)})
    return false;
  return head.starts_with("solid") &&
         (head.find("facet") != std::string_view::npos || head.find("endsolid") != std::string_view::npos);
}

}  // namespace

RawMesh parse_stl(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  return is_text(bytes) ? parse_text(path, bytes) : parse_binary(path, bytes);
}

}  // namespace mezzotint
