#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/study/chart_point.h"
#include "experiments/study/scene.h"
#include "forward/base/progress.h"
#include "forward/optics/material.h"

namespace mezzotint {

/// What a study of error against time goes through.
struct StudyOptions {
  std::vector<std::string> families = study_families();
  std::vector<double> gradients = {0.05, 0.3, 1.0};
  std::vector<double> thetas_deg = {0.0, 30.0, 60.0, 85.0};
  std::optional<StudyRelief> scan;  ///< at its own gradient
  std::size_t cells = 512;          ///< a side of each relief, but for the scan
  std::size_t resolution = 64;      ///< bins a side of the maps
  Material material = Dielectric{1.5};
  std::vector<double> auto_tolerances = {0.05, 0.01};  ///< for the points that `auto` chooses
  std::uint64_t reference_samples = std::uint64_t{1} << 22;
  std::uint64_t most_samples = std::uint64_t{1} << 20;  ///< larger budgets are left out
  std::uint64_t seed = 1;
};

/// One scene of a study.
struct StudyScene {
  std::string relief;
  double gradient = 0.0;
  double theta_deg = 0.0;
  bool operator==(const StudyScene&) const = default;
};

/// One method with one budget on one scene. The error is relative_l2 of the reflection to the reference, whose noise is
/// taken out; trees and pyramids were built before the time that is told.
struct StudyPoint : ChartPoint {
  StudyScene scene;
  int runs = 1;             ///< with a seed each; short runs are repeated
  double bias = 0.0;        ///< the error with the run's own noise taken out too: what no more paths will lower
  double bias_error = 0.0;  ///< standard error of it
  std::string chosen;       ///< the rung that `auto` took
};

/// The scenes of a study, in the order in which they are measured.
[[nodiscard]] std::vector<StudyScene> scenes_of(const StudyOptions& options);

/// Measures all methods on all scenes, on one thread. Takes minutes.
[[nodiscard]] std::vector<StudyPoint> run_study(const StudyOptions& options, const Progress& progress);

/// Marks the points of each scene that no other point beats in both time and error.
void mark_pareto_front(std::vector<StudyPoint>& points);

/// What is drawn of them.
[[nodiscard]] std::vector<ChartPoint> chart_points(const std::vector<StudyPoint>& points);

[[nodiscard]] nlohmann::json to_json(const StudyOptions& options, const std::vector<StudyPoint>& points);

}  // namespace mezzotint
