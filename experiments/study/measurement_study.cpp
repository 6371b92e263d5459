#include "experiments/study/measurement_study.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "experiments/study/measurement_comparisons.h"
#include "experiments/study/repeated_runs.h"
#include "experiments/study/study_methods.h"
#include "forward/base/error.h"
#include "forward/base/random.h"
#include "measurement/correction/fill.h"
#include "measurement/correction/gaussian_filter.h"
#include "measurement/instrument/virtual_profilometer.h"

namespace mezzotint {

namespace {

// A run is repeated until it has taken so long, since clocks are coarse.
constexpr double least_seconds = 2e-3;
constexpr const char* plain = "texture";
constexpr const char* tilted = "tilted texture";

/// Gaussian heights of Sq about 1 µm, under a Gaussian filter of this cut-off.
HeightField texture(std::size_t side, double cutoff_um, std::uint64_t seed) {
  const RandomStream random(seed, RandomPurpose::StudyTexture);
  const auto rim = static_cast<std::size_t>(std::ceil(1.2 * cutoff_um)), width = side + 2 * rim;
  const Length pitch = Length::from_um(1.0);
  HeightField white({width, width, pitch, pitch}, Continuation::Mirrored);
  const double scale = cutoff_um * std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi);
  for (std::size_t i = 0; i < white.grid().size(); ++i)
    white.heights_um()[i] = static_cast<float>(scale * random.normal4(i)[0]);
  return crop(s_filter(white, Length::from_um(cutoff_um)), rim, rim, side, side);
}

void tilt(HeightField& field, double slope) {
  for (std::size_t i = 0; i < field.grid().size(); ++i)
    field.heights_um()[i] += static_cast<float>(slope * static_cast<double>(i % field.columns()));
}

/// Root mean square of a difference, of all samples or of those that are missing in `where`.
double rms_difference(const HeightField& a, const HeightField& b, const HeightField* where = nullptr) {
  double squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < a.grid().size(); ++i) {
    if (where != nullptr && !std::isnan(where->heights_um()[i])) continue;
    squares += std::pow(double{a.heights_um()[i]} - double{b.heights_um()[i]}, 2);
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

/// A method with one budget, on one field: the error that it makes.
struct Contender {
  std::string method;
  std::uint64_t budget;
  std::function<HeightField(const HeightField&)> surface;
  std::function<double(const HeightField&, std::uint64_t)> sq_um;
};

/// Errors and times of a contender over the fields of a panel.
struct Tally {
  std::vector<double> squares, seconds;
};

class PanelStudy {
public:
  PanelStudy(const MeasurementStudyOptions& options, MeasurementQuestion question, const char* surface,
             double length_um)
      : options_(options), question_(question), surface_(surface), length_um_(length_um), contenders_(contenders()) {}

  MeasurementPanel measured() {
    std::vector<Tally> tallies(contenders_.size());
    for (int field = 0; field < options_.fields; ++field)
      add(options_.seed + static_cast<std::uint64_t>(field), tallies);
    MeasurementPanel panel{question_, surface_, length_um_, {}};
    for (std::size_t k = 0; k < contenders_.size(); ++k) panel.points.push_back(point_of(contenders_[k], tallies[k]));
    for (ChartPoint& point : panel.points)
      point.on_front = std::ranges::none_of(panel.points, [&](const ChartPoint& other) { return beats(other, point); });
    return panel;
  }

private:
  [[nodiscard]] double side() const { return static_cast<double>(options_.cells); }
  [[nodiscard]] Length length() const { return Length::from_um(length_um_); }

  [[nodiscard]] std::vector<Contender> contenders() const {
    switch (question_) {
      case MeasurementQuestion::Filling:
        return filling();
      case MeasurementQuestion::Filtering:
        return filtering();
      case MeasurementQuestion::Sampling:
        break;
    }
    return sampling();
  }

  [[nodiscard]] static std::vector<Contender> filling() {
    std::vector<Contender> list = {{"plane", 0, fill_by_plane, {}}, {"Laplace, solved", 0, fill_missing, {}}};
    for (const int sweeps : {3, 10, 30, 100, 300, 1000})
      list.push_back({"relaxation",
                      static_cast<std::uint64_t>(sweeps),
                      [=](const HeightField& f) { return fill_by_relaxation(f, sweeps); },
                      {}});
    return list;
  }

  [[nodiscard]] std::vector<Contender> filtering() const {
    const Length cutoff = length();
    std::vector<Contender> list = {
        {"ends by regression", 0, [=](const HeightField& f) { return s_filter(f, cutoff); }, {}},
        {"ends wrapped", 0, [=](const HeightField& f) { return smooth_wrapped(f, cutoff); }, {}}};
    for (const int tenths : {2, 3, 4, 6, 8, 12})
      list.push_back({"plain sums, ends renormalised",
                      static_cast<std::uint64_t>(tenths),
                      [=](const HeightField& f) { return smooth_by_sums(f, cutoff, 0.1 * tenths); },
                      {}});
    return list;
  }

  [[nodiscard]] std::vector<Contender> sampling() const {
    const std::size_t cells = options_.cells;
    const auto of_rows = [](std::size_t rows) {
      return [=](const HeightField& f, std::uint64_t) { return sq_of_rows(f, rows); };
    };
    std::vector<Contender> list = {{"all samples", cells * cells, {}, of_rows(cells)}};
    for (std::size_t step = 32; step >= 2; step /= 2) {
      const std::size_t samples = cells * cells / (step * step);
      list.push_back({"every n-th sample", samples, {}, [=](const HeightField& f, std::uint64_t) {
                        return sq_of_every(f, step);
                      }});
      list.push_back({"random samples", samples, {}, [=](const HeightField& f, std::uint64_t seed) {
                        return sq_of_random(f, samples, seed);
                      }});
    }
    for (std::size_t rows = std::max<std::size_t>(1, cells / 256); rows < cells; rows *= 2)
      list.push_back({"block of rows", rows * cells, {}, of_rows(rows)});
    return list;
  }

  void add(std::uint64_t seed, std::vector<Tally>& tallies) const {
    switch (question_) {
      case MeasurementQuestion::Filling:
        return add_filling(seed, tallies);
      case MeasurementQuestion::Filtering:
        return add_filtering(seed, tallies);
      case MeasurementQuestion::Sampling:
        return add_sampling(seed, tallies);
    }
  }

  void add_filling(std::uint64_t seed, std::vector<Tally>& tallies) const {
    const HeightField whole = texture(options_.cells, side() / 8.0, seed);
    VirtualProfilometer instrument{.pitch = whole.grid().pitch_x, .hole_share = 0.2, .hole_diameter = length()};
    instrument.seed = seed;
    const HeightField holed = measure_virtually(whole, instrument);
    if (holed.missing_count() == 0) return;
    const double sq = root_mean_square_height(whole).um();
    run_surfaces(holed, tallies, [&](const HeightField& filled) { return rms_difference(filled, whole, &holed) / sq; });
  }

  void add_filtering(std::uint64_t seed, std::vector<Tally>& tallies) const {
    const auto rim = static_cast<std::size_t>(std::ceil(1.2 * length_um_));
    HeightField large = texture(options_.cells + 2 * rim, side() / 8.0, seed);
    if (surface_ == tilted) tilt(large, 10.0 / side());
    const HeightField field = crop(large, rim, rim, options_.cells, options_.cells);
    const HeightField truth = crop(s_filter(large, length()), rim, rim, options_.cells, options_.cells);
    const double sq = root_mean_square_height(truth).um();
    run_surfaces(field, tallies, [&](const HeightField& smooth) { return rms_difference(smooth, truth) / sq; });
  }

  void add_sampling(std::uint64_t seed, std::vector<Tally>& tallies) const {
    const HeightField field = texture(options_.cells, length_um_, seed);
    const double sq = sq_of_every(field, 1);
    for (std::size_t k = 0; k < contenders_.size(); ++k) {
      double found = 0.0;
      tallies[k].seconds.push_back(seconds_of([&] { found = contenders_[k].sq_um(field, seed); }));
      tallies[k].squares.push_back(std::pow(found / sq - 1.0, 2));
    }
  }

  template <class Error>
  void run_surfaces(const HeightField& field, std::vector<Tally>& tallies, const Error& error) const {
    for (std::size_t k = 0; k < contenders_.size(); ++k) {
      HeightField result = field;
      tallies[k].seconds.push_back(seconds_of([&] { result = contenders_[k].surface(field); }));
      tallies[k].squares.push_back(std::pow(error(result), 2));
    }
  }

  template <class Run>
  static double seconds_of(const Run& run) {
    const double start = cpu_seconds();
    double taken = 0.0, runs = 0.0;
    do {
      run();
      runs += 1.0;
      taken = cpu_seconds() - start;
    } while (taken < least_seconds);
    return taken / runs;
  }

  static ChartPoint point_of(const Contender& contender, const Tally& tally) {
    // What is smaller is not drawn: rounding, or the whole against itself.
    constexpr double smallest_told = 1e-4;
    const double root = std::sqrt(mean_of(tally.squares));
    const Estimate time = median_of(tally.seconds);
    ChartPoint point{contender.method, contender.budget};
    point.seconds = time.value;
    point.seconds_error = time.standard_error;
    point.error = root;
    point.error_spread = root > 0.0 ? error_of_mean(tally.squares) / (2.0 * root) : 0.0;
    point.floor = smallest_told;
    return point;
  }

  const MeasurementStudyOptions& options_;
  MeasurementQuestion question_;
  std::string surface_;
  double length_um_;
  std::vector<Contender> contenders_;
};

}  // namespace

const std::vector<MeasurementQuestion>& measurement_questions() {
  static const std::vector<MeasurementQuestion> all = {MeasurementQuestion::Filling, MeasurementQuestion::Filtering,
                                                       MeasurementQuestion::Sampling};
  return all;
}

std::string_view in_words(MeasurementQuestion question) {
  switch (question) {
    case MeasurementQuestion::Filling:
      return "filling";
    case MeasurementQuestion::Filtering:
      return "filtering";
    case MeasurementQuestion::Sampling:
      return "sampling";
  }
  return "";
}

const std::vector<std::string>& methods_for(MeasurementQuestion question) {
  static const std::map<MeasurementQuestion, std::vector<std::string>> all = {
      {MeasurementQuestion::Filling, {"plane", "relaxation", "Laplace, solved"}},
      {MeasurementQuestion::Filtering, {"ends wrapped", "plain sums, ends renormalised", "ends by regression"}},
      {MeasurementQuestion::Sampling, {"block of rows", "random samples", "every n-th sample", "all samples"}}};
  return all.at(question);
}

std::vector<MeasurementPanel> run_measurement_study(const MeasurementStudyOptions& options, const Progress& progress) {
  require(options.cells >= 64 && options.fields >= 1, "a study of measurement needs 64 cells a side and one field");
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  std::vector<MeasurementPanel> panels;
  for (const auto& [question, surface] : {std::pair{MeasurementQuestion::Filling, plain},
                                          {MeasurementQuestion::Filtering, plain},
                                          {MeasurementQuestion::Filtering, tilted},
                                          {MeasurementQuestion::Sampling, plain}}) {
    for (const double share : {64.0, 16.0, 4.0}) {
      const double length_um = static_cast<double>(options.cells) / share;
      report(progress, "chart", static_cast<double>(panels.size()) / 12.0,
             fmt::format("{}, {}, {:.3g} um", in_words(question), surface, length_um));
      panels.push_back(PanelStudy(options, question, surface, length_um).measured());
    }
  }
  return panels;
}

nlohmann::json to_json(const std::vector<MeasurementPanel>& panels) {
  nlohmann::json rows = nlohmann::json::array();
  for (const MeasurementPanel& panel : panels)
    for (const ChartPoint& point : panel.points)
      rows.push_back({{"question", in_words(panel.question)},
                      {"surface", panel.surface},
                      {"length_um", panel.length_um},
                      {"method", point.method},
                      {"budget", point.samples},
                      {"seconds", point.seconds},
                      {"seconds_standard_error", point.seconds_error},
                      {"error", point.error},
                      {"error_standard_error", point.error_spread},
                      {"on_front", point.on_front}});
  return rows;
}

}  // namespace mezzotint
