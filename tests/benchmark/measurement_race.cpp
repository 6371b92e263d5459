// Measurement side by side with Gwyddion's library: the slides' chain and every step that both have. One thread each,
// CPU time of the process, medians of interleaved repeats; then our own wall time with one thread and with two. Not a
// test.
//
//   measurement_race [--repetitions N] [--sizes N,N…] [--json FILE] [STEP…]    a step by the beginning of its name

#include <ctime>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <nlohmann/json.hpp>

#include "measurement/correction/fill.h"
#include "measurement/correction/flatten_base.h"
#include "measurement/correction/gaussian_filter.h"
#include "measurement/correction/orientation.h"
#include "measurement/correction/outliers.h"
#include "measurement/correction/plane.h"
#include "measurement/correction/polynomial.h"
#include "measurement/formats/surface_file.h"
#include "measurement/texture/autocorrelation.h"
#include "measurement/texture/bearing_curve.h"
#include "measurement/texture/power_spectrum.h"
#include "measurement/texture/roughness.h"
#include "tests/benchmark/gwyddion_peer.h"
#include "tests/benchmark/measure.h"
#include "tests/benchmark/measured_scan.h"
#include "tests/benchmark/measurement_answers.h"

namespace {

using namespace mezzotint;
using benchmark::GwyddionField;
using benchmark::median;

struct Step {
  std::string name;
  bool holes = false;                       ///< on the scan with holes
  std::function<void(HeightField&&)> ours;  ///< gets a copy of its own, as Gwyddion does, outside of what is timed
  std::function<void(GwyddionField&)> theirs;
};

HeightField slides_chain(HeightField scan) {
  HeightField filled = fill_missing(mask_outliers(std::move(scan), 3.0).field);
  return fill_missing(mask_outliers(flatten_base(std::move(filled)).field, 3.0).field);
}

HeightField without_form(HeightField field, int degree) {
  const SurfacePolynomial form = fit_polynomial(field, degree);
  return subtract_polynomial(std::move(field), form);
}

void slides_chain(GwyddionField& scan) {
  scan.mask_outliers(3.0);
  scan.fill();
  scan.flatten_base();
  scan.mask_outliers(3.0);
  scan.fill();
}

template <class T>
void use(const T& result) {
  static_cast<void>(result);
}

std::vector<Step> all_steps(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "ours.gwy", other = folder / "theirs.gwy";
  const Length cutoff = Length::from_um(10.0), long_cutoff = Length::from_um(80.0);  // the spacing is 1 µm
  const Angle turn = Angle::from_degrees(7.0);
  return {
      {"chain", false, [](HeightField&& f) { use(slides_chain(std::move(f))); },
       [](GwyddionField& g) { slides_chain(g); }},
      {"outliers", false, [](HeightField&& f) { use(mask_outliers(std::move(f), 3.0)); },
       [](GwyddionField& g) { g.mask_outliers(3.0); }},
      {"fill", true, [](HeightField&& f) { use(fill_missing(std::move(f))); }, [](GwyddionField& g) { g.fill(); }},
      {"flatten base", false, [](HeightField&& f) { use(flatten_base(std::move(f))); },
       [](GwyddionField& g) { g.flatten_base(); }},
      {"plane", false, [](HeightField&& f) { use(level(std::move(f))); }, [](GwyddionField& g) { g.level(); }},
      {"polynomial 2", false, [](HeightField&& f) { use(without_form(std::move(f), 2)); },
       [](GwyddionField& g) { g.level_by_polynomial(2); }},
      {"polynomial 5", false, [](HeightField&& f) { use(without_form(std::move(f), 5)); },
       [](GwyddionField& g) { g.level_by_polynomial(5); }},
      {"filter 10 samples", false, [=](HeightField&& f) { use(s_filter(f, cutoff)); },
       [](GwyddionField& g) { g.filter(10.0); }},
      {"filter 80 samples", false, [=](HeightField&& f) { use(s_filter(f, long_cutoff)); },
       [](GwyddionField& g) { g.filter(80.0); }},
      {"Sa to Sdr", false, [](HeightField&& f) { use(area_roughness(f)); },
       [](GwyddionField& g) { use(g.statistics()); }},
      {"autocorrelation", false, [](HeightField&& f) { use(autocorrelation(f)); },
       [](GwyddionField& g) { use(g.autocorrelation()); }},
      {"power spectrum", false, [](HeightField&& f) { use(power_spectrum(f)); },
       [](GwyddionField& g) { use(g.power_spectrum()); }},
      {"bearing curve", false, [](HeightField&& f) { use(BearingCurve(f)); },
       [](GwyddionField& g) { use(g.bearing_curve(0)); }},
      {"turn by 7 degrees", false, [=](HeightField&& f) { use(turned(f, turn)); },
       [=](GwyddionField& g) { g.turn(turn.radians()); }},
      {"resample, finer", false,
       [](HeightField&& f) { use(resampled(f, f.grid().pitch_x * 0.8, f.grid().pitch_y * 0.8)); },
       [](GwyddionField& g) { g.resample_by(1.25); }},
      {"write .gwy", false, [=](HeightField&& f) { write_gwy(f, "", {}, file); },
       [=](GwyddionField& g) { g.write(other); }},
      {"read .gwy", false, [=](HeightField&&) { use(read_gwy(file)); },
       [=](GwyddionField&) { use(GwyddionField(file)); }},
  };
}

double process_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Clock, class Work>
double seconds(const Clock& clock, const Work& work) {
  const double start = clock();
  work();
  return clock() - start;
}

struct Figures {
  std::vector<double> ours, theirs, one, two;
};

Figures race(const Step& step, const HeightField& scan, int repetitions) {
  Figures figures;
  const GwyddionField prepared(scan);
  for (int k = 0; k < repetitions; ++k) {
    {
      const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
      HeightField own = scan;
      figures.one.push_back(seconds(
          wall_seconds, [&] { figures.ours.push_back(seconds(process_seconds, [&] { step.ours(std::move(own)); })); }));
      GwyddionField copy(prepared);
      figures.theirs.push_back(seconds(process_seconds, [&] { step.theirs(copy); }));
    }
    const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
    HeightField own = scan;
    figures.two.push_back(seconds(wall_seconds, [&] { step.ours(std::move(own)); }));
  }
  return figures;
}

double least(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }

nlohmann::json run_size(std::size_t size, const std::vector<Step>& steps, int repetitions) {
  const HeightField scan = benchmark::measured_scan(size), holes = benchmark::scan_with_holes(size);
  fmt::print("\n{0} x {0} samples, {1} repetitions\n{2:<18} {3:>9} {4:>11} {5:>8} {6:>12}\n", size, repetitions, "step",
             "ours, ms", "Gwyddion, ms", "ratio", "two threads");
  nlohmann::json rows = nlohmann::json::array();
  for (const Step& step : steps) {
    const Figures f = race(step, step.holes ? holes : scan, repetitions);
    const double ours = median(f.ours), theirs = median(f.theirs), speed_up = least(f.one) / least(f.two);
    fmt::print("{:<18} {:>9.1f} {:>11.1f} {:>8.2f} {:>12.2f}\n", step.name, 1e3 * ours, 1e3 * theirs, theirs / ours,
               speed_up);
    std::fflush(stdout);
    rows.push_back({{"size", size},
                    {"step", step.name},
                    {"ours_s", ours},
                    {"gwyddion_s", theirs},
                    {"ratio", theirs / ours},
                    {"two_threads", speed_up}});
  }
  return rows;
}

}  // namespace

int main(int count, char** words) {
  int repetitions = 5;
  std::string sizes = "1024,4096", json;
  std::vector<std::string> wanted;
  for (int k = 1; k < count; ++k) {
    const std::string word = words[k];
    const bool more = k + 1 < count;
    if (word == "--repetitions" && more)
      repetitions = std::stoi(words[++k]);
    else if (word == "--sizes" && more)
      sizes = words[++k];
    else if (word == "--json" && more)
      json = words[++k];
    else
      wanted.push_back(word);
  }
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("measurement_race.{}", std::time(nullptr));
  std::filesystem::create_directories(folder);
  std::vector<Step> steps = all_steps(folder);
  if (!wanted.empty())
    std::erase_if(steps, [&](const Step& step) {
      return std::none_of(wanted.begin(), wanted.end(), [&](const auto& w) { return step.name.starts_with(w); });
    });
  if (wanted.empty()) benchmark::print_answers(1024);
  nlohmann::json all;
  for (std::size_t at = 0; at < sizes.size(); at = std::min(sizes.find(',', at), sizes.size() - 1) + 1)
    for (const auto& row : run_size(std::stoul(sizes.substr(at)), steps, repetitions)) all.push_back(row);
  std::filesystem::remove_all(folder);
  if (!json.empty()) std::ofstream(json) << all.dump(2) << "\n";
  return 0;
}
