// Measures our tracer against Embree, and what a run adds to its tracer. Leave the machine alone meanwhile; the load is
// printed with the figures.
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <hwy/highway.h>

#include "tests/benchmark/end_to_end.h"
#include "tests/benchmark/tracer_race.h"

namespace {

using namespace mezzotint::benchmark;

double load() {
  std::array<double, 1> average{};
  return getloadavg(average.data(), 1) == 1 ? average[0] : -1.0;
}

// The best instruction set that this machine has of those that we compile for.
const char* vectors() {
  const std::int64_t both = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(both & -both);
}

constexpr const char* usage =
    "usage: mezzotint_benchmark [--json FILE] [--repetitions N] [--gradient S] [--bits N]\n"
    "                           [--without-embree] [--small] [PART...]\n"
    "parts: race (against Embree), threads, end-to-end; all without one. --small: 1024² alone.\n";

struct Arguments {
  RaceOptions race;
  std::string json, parts;
  bool small = false;
  [[nodiscard]] bool has(const char* part) const { return parts.empty() || parts.find(part) != std::string::npos; }
};

Arguments parse(int count, char** words) {
  Arguments result;
  for (int k = 1; k < count; ++k) {
    const std::string word = words[k];
    const auto value = [&] {
      if (++k == count) throw std::string(usage);
      return std::string(words[k]);
    };
    if (word == "--json")
      result.json = value();
    else if (word == "--repetitions")
      result.race.repetitions = std::stoi(value());
    else if (word == "--gradient")
      result.race.gradient = std::stod(value());
    else if (word == "--bits")
      result.race.bits = static_cast<std::uint32_t>(std::stoul(value()));
    else if (word == "--without-embree")
      result.race.embree = false;
    else if (word == "--small")
      result.small = true;
    else if (word[0] != '-')
      result.parts += word + " ";
    else
      throw std::string(usage);
  }
  return result;
}

nlohmann::json run(const Arguments& arguments) {
  nlohmann::json all = {{"load_before", load()}};
  fmt::print("load {:.2f}, vectors {}\n", load(), vectors());
  RaceOptions large = arguments.race;
  large.size = 4096;
  if (arguments.has("race")) {
    all["race"].push_back(race(arguments.race));
    if (!arguments.small) all["race"].push_back(race(large));
  }
  if (arguments.has("threads")) all["two_threads"] = race_two_threads(arguments.race);
  if (arguments.has("end-to-end")) all["end_to_end"] = end_to_end(arguments.race);
  fmt::print("\nload {:.2f}\n", load());
  all["load_after"] = load();
  return all;
}

}  // namespace

int main(int count, char** words) {
  try {
    const Arguments arguments = parse(count, words);
    const nlohmann::json result = run(arguments);
    if (!arguments.json.empty()) std::ofstream(arguments.json) << result.dump(2) << "\n";
  } catch (const std::string& message) {
    fmt::print(stderr, "{}", message);
    return 2;
  }
}
