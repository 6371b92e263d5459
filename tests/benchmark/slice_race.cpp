// Slicing beside PrusaSlicer, from the same STL to an archive: CPU time (user and system of the whole command) and
// peak memory, and whether the layers are the same. Skipped, with a message, where prusa-slicer is not installed.
//
//   slice_race MEZZOTINT [RUNS]      MEZZOTINT: the program to race; the median of RUNS (3) counts

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include <fmt/format.h>

#include "child_process.h"
#include "fabrication/job/job_file.h"
#include "fabrication/part/part_file.h"
#include "measure.h"
#include "race_parts.h"

namespace mezzotint::benchmark {
namespace {

namespace fs = std::filesystem;

// The slides' projector, in PrusaSlicer's words; what is left out keeps its defaults.
constexpr const char* settings = R"(printer_technology = SLA
bed_shape = 0x0,19.3024x0,19.3024x12.064,0x12.064
display_width = 19.3024
display_height = 12.064
display_orientation = landscape
display_mirror_x = 0
display_mirror_y = 0
display_pixels_x = 2560
display_pixels_y = 1600
gamma_correction = 1
layer_height = 0.018
initial_layer_height = 0.018
max_print_height = 150
slice_closing_radius = 0
supports_enable = 0
pad_enable = 0
support_object_elevation = 0
faded_layers = 3
exposure_time = 3
initial_exposure_time = 3
min_exposure_time = 1
max_exposure_time = 120
min_initial_exposure_time = 1
max_initial_exposure_time = 300
relative_correction = 1,1
absolute_correction = 0
elefant_foot_compensation = 0
sla_archive_format = SL1
)";

struct Part {
  std::string name;
  PartMesh (*make)();
};

const std::vector<Part> parts = {{"sphere", race_sphere},
                                 {"gear", race_gear},
                                 {"plate 200 k", [] { return race_plate(245, 204); }},
                                 {"plate 2 M", [] { return race_plate(770, 645); }},
                                 {"block 20 mm", race_block}};

ChildCost median_cost(const std::vector<std::string>& words, int runs) {
  std::vector<double> seconds;
  ChildCost cost;
  for (int i = 0; i < runs; ++i) {
    const ChildCost one = run(words);
    if (one.status != 0) throw std::runtime_error(words[0] + " failed");
    seconds.push_back(one.cpu_s);
    cost.peak_mb = std::max(cost.peak_mb, one.peak_mb);
  }
  cost.cpu_s = median(seconds);
  return cost;
}

std::vector<double> layer_sums(const fs::path& archive) {
  const JobReader job(archive);
  std::vector<double> sums;
  for (std::size_t i = 0; i < job.frame().layers.size(); ++i) {
    const auto pixels = job.read_layer(i);
    double sum = 0.0;
    for (const std::uint8_t gray : pixels) sum += gray / 255.0;
    sums.push_back(sum);
  }
  return sums;
}

// The layers' sums against each other, largest difference relative to the largest layer.
void compare(const fs::path& ours, const fs::path& theirs) {
  const std::vector<double> a = layer_sums(ours), b = layer_sums(theirs);
  double largest = 1.0, difference = 0.0, total_a = 0.0, total_b = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    largest = std::max(largest, b[i]);
    difference = std::max(difference, std::abs(a[i] - b[i]));
    total_a += a[i];
    total_b += b[i];
  }
  fmt::print("{:14} layers {} and {}, sums of all layers {:+.4f} %, of one layer up to {:.4f} % of the largest\n", "",
             a.size(), b.size(), 100.0 * (total_a / total_b - 1.0), 100.0 * difference / largest);
}

void race(const std::string& mezzotint, int runs, bool with_peer, const fs::path& folder) {
  std::ofstream(folder / "race.ini") << settings;
  fmt::print("{:14} {:28} {:>9} {:>9} {:>9} {:>9}\n", "part", "program", "CPU s", "times", "peak MB", "archive MB");
  for (const Part& part : parts) {
    const fs::path stl = folder / "part.stl", theirs = folder / "peer.sl1";
    in_a_child([&] { write_stl(part.make(), stl); });
    double peer_s = 0.0;
    const auto row = [&](const std::string& program, const ChildCost& cost, const fs::path& archive) {
      fmt::print("{:14} {:28} {:9.3f} {:9.1f} {:9.0f} {:9.2f}\n", part.name, program, cost.cpu_s, peer_s / cost.cpu_s,
                 cost.peak_mb, static_cast<double>(fs::file_size(archive)) * 1e-6);
      std::fflush(stdout);
    };
    if (with_peer) {
      const int peer_runs = part.name == "plate 2 M" ? 1 : runs;
      const ChildCost cost = median_cost({"prusa-slicer", "--export-sla", "--load", (folder / "race.ini").string(),
                                          "-o", theirs.string(), stl.string()},
                                         peer_runs);
      peer_s = cost.cpu_s;
      row("prusa-slicer", cost, theirs);
    }
    const std::map<std::string, std::vector<std::string>> ways = {
        {"as other slicers", {"--mode", "midplane", "--linear"}}, {"volume, cure curve", {}}};
    for (const auto& [name, options] : ways) {
      const fs::path ours = folder / "ours.sl1";
      std::vector<std::string> words = {mezzotint, "slice", stl.string(), "-o", ours.string(), "-q"};
      words.insert(words.end(), options.begin(), options.end());
      row(name, median_cost(words, runs), ours);
      if (with_peer && !options.empty() && part.name != "block 20 mm") in_a_child([&] { compare(ours, theirs); });
    }
  }
}

}  // namespace
}  // namespace mezzotint::benchmark

int main(int count, char** arguments) {
  using namespace mezzotint::benchmark;
  if (count < 2) {
    fmt::print("slice_race MEZZOTINT [RUNS]\n");
    return 2;
  }
  const int runs = count > 2 ? std::atoi(arguments[2]) : 3;
  const bool with_peer = std::system("command -v prusa-slicer > /dev/null") == 0;
  if (!with_peer) fmt::print("prusa-slicer is not installed: no race, our own figures only\n");
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / fmt::format("slice-race-{}", getpid());
  std::filesystem::create_directory(folder);
  race(arguments[1], runs, with_peer, folder);
  std::filesystem::remove_all(folder);
  return 0;
}
