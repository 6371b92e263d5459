#pragma once

#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace mezzotint::test {

/// A row of the public meshes' reference facts, made by another reader.
struct ReferenceFacts {
  std::string file;
  std::size_t triangles = 0, vertices = 0, degenerate = 0, boundary = 0, non_manifold = 0, inconsistent = 0;
  double volume = 0.0, area = 0.0;
  std::array<double, 3> low{}, high{};
};

/// The rows of meshes that have a triangle.
inline std::vector<ReferenceFacts> read_reference_facts(const std::filesystem::path& path) {
  std::vector<ReferenceFacts> all;
  std::ifstream stream(path);
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    for (char& c : line)
      if (c == ',') c = ' ';
    std::istringstream words(line);
    ReferenceFacts facts;
    std::string kind;
    words >> facts.file >> kind >> facts.triangles >> facts.vertices >> facts.degenerate >> facts.boundary >>
        facts.non_manifold >> facts.inconsistent >> facts.volume >> facts.area;
    for (double& value : facts.low) words >> value;
    for (double& value : facts.high) words >> value;
    if (facts.triangles > 0 && words) all.push_back(facts);
  }
  return all;
}

}  // namespace mezzotint::test
