#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace mezzotint {
namespace {

namespace fs = std::filesystem;
const fs::path root = MEZZOTINT_SOURCE_DIR;

// The folder tree is the architecture: experiments → inverse, fabrication → measurement → forward, and inside of
// forward from the ground floor up.
const std::map<std::string, int> houses = {
    {"forward", 0}, {"measurement", 1}, {"inverse", 2}, {"fabrication", 2}, {"experiments", 3}};
const std::map<std::string, int> forward_rooms = {{"base", 0},    {"surface", 1},  {"pattern", 2},    {"optics", 2},
                                                  {"process", 3}, {"tracing", 3},  {"bsdf_table", 3}, {"scattering", 4},
                                                  {"ladder", 5},  {"rendering", 6}};

struct Include {
  fs::path file;
  std::string target;
};

std::vector<fs::path> sources() {
  std::vector<fs::path> files;
  for (const auto& [house, floor] : houses) {
    for (const auto& entry : fs::recursive_directory_iterator(root / house)) {
      const auto ending = entry.path().extension();
      if (ending == ".h" || ending == ".cpp") files.push_back(fs::relative(entry.path(), root));
    }
  }
  return files;
}

std::vector<Include> includes(const std::regex& pattern) {
  std::vector<Include> found;
  for (const auto& file : sources()) {
    std::ifstream stream(root / file);
    std::smatch match;
    for (std::string line; std::getline(stream, line);) {
      if (std::regex_search(line, match, pattern)) found.push_back({file, match[1]});
    }
  }
  return found;
}

std::string part(const fs::path& path, int index) { return std::next(path.begin(), index)->string(); }

TEST(Architecture, DependenciesRunDownwardOnly) {
  const auto own = includes(std::regex(R"(^\s*#include "([^"]+)\")"));
  ASSERT_GT(own.size(), 50U) << "the sources were not found";
  for (const auto& [file, target] : own) {
    const std::string from = part(file, 0), to = part(target, 0);
    ASSERT_TRUE(houses.contains(to)) << file << " includes " << target << "; name it by its path from the root";
    const bool downward = from == to || houses.at(from) > houses.at(to);
    EXPECT_TRUE(downward) << file << " includes " << target;
  }
}

TEST(Architecture, RoomsOfForwardStandOnOneAnother) {
  for (const auto& [file, target] : includes(std::regex(R"(^\s*#include "(forward/[^"]+)\")"))) {
    if (part(file, 0) != "forward") continue;
    const std::string from = part(file, 1), to = part(target, 1);
    ASSERT_TRUE(forward_rooms.contains(from) && forward_rooms.contains(to)) << file << " includes " << target;
    const bool downward = from == to || forward_rooms.at(from) > forward_rooms.at(to);
    EXPECT_TRUE(downward) << file << " includes " << target;
  }
}

TEST(Architecture, FabricationAloneIncludesCgal) {
  for (const auto& [file, target] : includes(std::regex(R"(^\s*#include <(CGAL/[^>]+)>)"))) {
    EXPECT_EQ(part(file, 0), "fabrication") << file << " includes " << target;
  }
}

TEST(Architecture, NoFileIsLongerThan500Lines) {
  for (const auto& file : sources()) {
    std::ifstream stream(root / file);
    const auto lines = std::count(std::istreambuf_iterator<char>(stream), {}, '\n');
    EXPECT_LE(lines, 500) << file << ": is it still one idea?";
  }
}

}  // namespace
}  // namespace mezzotint
