#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "forward/base/progress.h"
#include "forward/optics/material.h"

namespace mezzotint {

/// What a study of error against time goes through.
struct StudyOptions {
  std::vector<double> gradients = {0.05, 0.3, 0.8};
  std::vector<double> thetas_deg = {0.0, 30.0, 60.0, 80.0};
  std::size_t cells = 512;      ///< a side of each relief
  std::size_t resolution = 64;  ///< bins a side of the maps
  Material material = Dielectric{1.5};
  double auto_tolerance = 0.05;  ///< for the point that `auto` chooses
  std::uint64_t seed = 1;
};

/// One method with one budget on one scene.
struct StudyPoint {
  std::string relief;
  double gradient = 0.0;
  double theta_deg = 0.0;
  std::string method;
  std::uint64_t samples = 0;  ///< 0: none
  double seconds = 0.0;       ///< CPU time of one thread; trees and pyramids were built before
  double error = 0.0;         ///< relative_l2 of the reflection to the reference, its own noise included
  double floor = 0.0;         ///< relative standard error of the reference: nothing below it can be told
  bool on_front = false;      ///< no other method is both faster and nearer
};

/// Measures all methods on all scenes, on one thread. Takes minutes.
[[nodiscard]] std::vector<StudyPoint> run_study(const StudyOptions& options, const Progress& progress);

/// Marks the points of each scene that no other point beats in both time and error.
void mark_pareto_front(std::vector<StudyPoint>& points);

[[nodiscard]] nlohmann::json to_json(const StudyOptions& options, const std::vector<StudyPoint>& points);

}  // namespace mezzotint
