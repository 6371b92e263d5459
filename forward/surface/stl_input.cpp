#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/surface/mesh_parsers.h"
#include "forward/surface/text_words.h"
#include "forward/surface/vertex_welder.h"

namespace mezzotint {

namespace {

constexpr std::size_t header_bytes = 84, facet_bytes = 50;

std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value |= std::to_integer<std::uint32_t>(bytes[at + k]) << (8 * k);
  return value;
}

VertexWelder::Place place_at(std::span<const std::byte> bytes, std::size_t at) {
  VertexWelder::Place place{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    place[axis] = double{std::bit_cast<float>(word_at(bytes, at + 4 * axis))};
  return place;
}

bool is_finite(const VertexWelder::Place& place) {
  return std::isfinite(place[0]) && std::isfinite(place[1]) && std::isfinite(place[2]);
}

void check_count(const std::filesystem::path& path, const std::string& place, std::size_t triangles) {
  if (triangles > most_mesh_elements) throw FileError(path, place, "has more than 2^28 triangles");
}

RawMesh parse_binary(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  if (bytes.size() < header_bytes) throw FileError(path, "header", "ends within its first 84 bytes; it is truncated");
  const std::size_t count = word_at(bytes, 80), held = (bytes.size() - header_bytes) / facet_bytes;
  if (count > held) {
    throw FileError(path, "byte 80",
                    fmt::format("says {} triangles, but has bytes for {}; it is truncated or no STL", count, held));
  }
  check_count(path, "byte 80", count);
  RawMesh mesh{.format = "stl (binary)"};
  VertexWelder welder(count / 2);  // as many as a closed surface has
  mesh.triangles.resize(count);
  constexpr std::size_t ahead = 8;
  for (std::size_t facet = 0; facet < count; ++facet) {
    const std::size_t begin = header_bytes + facet * facet_bytes;
    for (std::size_t corner = 1; corner <= 3; ++corner) {
      if (facet + ahead < count) welder.prefetch(place_at(bytes, begin + ahead * facet_bytes + 12 * corner));
      const VertexWelder::Place place = place_at(bytes, begin + 12 * corner);
      if (!is_finite(place)) refuse_vertex(path, "byte " + std::to_string(begin + 12 * corner));
      mesh.triangles[facet][corner - 1] = welder.number(place).value;
    }
  }
  mesh.vertices = welder.take_vertices();
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
std::array<std::uint32_t, 3> read_facet(const std::filesystem::path& path, TextWords& text, VertexWelder& welder) {
  expect(path, text, "normal");
  for (int k = 0; k < 3; ++k) (void)text.word_of_text();
  expect(path, text, "outer");
  expect(path, text, "loop");
  std::array<std::uint32_t, 3> triangle{};
  for (std::uint32_t& corner : triangle) {
    expect(path, text, "vertex");
    const std::array<double, 3> place = three_numbers(path, text);
    if (!is_finite(place)) refuse_vertex(path, text.place());
    corner = welder.number(place).value;
  }
  expect(path, text, "endloop");
  expect(path, text, "endfacet");
  return triangle;
}

RawMesh parse_text(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  RawMesh mesh{.format = "stl (text)"};
  TextWords text(bytes);
  VertexWelder welder;
  while (text.next_line()) {  // "solid NAME", its facets, "endsolid NAME"; there may be several
    const std::string_view opening = text.word();
    if (opening.empty()) continue;
    if (opening != "solid") fail(path, text, "solid", opening);
    if (!text.next_line()) fail(path, text, "endsolid", {});
    for (std::string_view word = text.word_of_text(); word != "endsolid"; word = text.word_of_text()) {
      if (word != "facet") fail(path, text, "facet", word);
      mesh.triangles.push_back(read_facet(path, text, welder));
    }
    check_count(path, text.place(), mesh.triangles.size());
  }
  mesh.vertices = welder.take_vertices();
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
