#include "tests/loop/workplace.h"

#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace mezzotint::test {

namespace fs = std::filesystem;

namespace {

// Noise has no period, so the measurement has one place on the design; 64 pixels are 0.5 mm.
constexpr std::string_view experiment = R"(title = "A small loop"

[target]
kind      = "beckmann"
alpha_x   = 0.30
alpha_y   = 0.15
tolerance = 0.5
rotation_tolerance_deg = 15.0

[pattern]
kind          = "noise"
scale_um      = { free = [30.2, 200.0] }
stretch       = { free = [1.0, 8.0] }
direction_deg = 0.0
height_um     = 14.0

[simulation]
incidence_deg = [[20.0, 0.0]]
resolution    = 16
tolerance     = 0.2

[search]
max_evaluations = 30
draws           = 2
fresh_draws     = 4

[print]
patch_pixels = 48
subsamples   = 2
base_layers  = 1

[measurement]
shift_x_um   = 4.0
shift_y_um   = -3.0
rotation_deg = 0.5
)";

constexpr std::string_view pattern = R"([pattern]
kind            = "sinusoid"
wavelength_u_um = 32.0
wavelength_v_um = 64.0
direction_deg   = 0.0
height_um       = 6.0

[grid]
columns  = 64
rows     = 64
pitch_um = 2.0
)";

std::string bytes_of(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

Workplace::Workplace() {
  write("small.toml", experiment);
  write("pattern.toml", pattern);
  write("printer.toml", "name = \"dlp9000\"\n");
  // A tetrahedron without its base.
  write("part.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
}

Ending Workplace::mezzotint(const std::vector<std::string>& arguments, const Conditions& conditions) const {
  return RunningProgram(path(), arguments, conditions).wait();
}

void Workplace::write(const char* name, std::string_view text) const {
  std::ofstream(folder_ / name, std::ios::binary) << text;
}

std::string Workplace::read(const char* name) const { return bytes_of(folder_ / name); }

nlohmann::json Workplace::read_json(const char* name) const { return nlohmann::json::parse(read(name)); }

Files Workplace::files(const char* folder) const {
  Files found;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / folder)) {
    if (entry.is_regular_file()) found[fs::relative(entry.path(), folder_ / folder).string()] = bytes_of(entry.path());
  }
  return found;
}

std::string small_experiment(std::string_view part, std::string_view by) {
  std::string text(experiment);
  const auto place = text.find(part);
  if (place == std::string::npos) throw std::logic_error("small.toml has no " + std::string(part));
  return text.replace(place, part.size(), by);
}

std::string differences(Files a, Files b) {
  a.erase("timing.json");
  b.erase("timing.json");
  std::string names;
  for (const auto& [name, bytes] : a) {
    if (!b.contains(name) || b[name] != bytes) names += name + " ";
  }
  for (const auto& [name, bytes] : b) {
    if (!a.contains(name)) names += name + " ";
  }
  return names;
}

std::vector<std::string> words(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

}  // namespace mezzotint::test
