#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/configuration/pattern_table.h"
#include "experiments/configuration/search_table.h"
#include "forward/optics/direction.h"
#include "forward/optics/material.h"
#include "measurement/instrument/virtual_profilometer.h"

namespace mezzotint {

/// `[target]` as it stands in the file; a scan is read and corrected when the run needs it.
struct TargetSpecification {
  std::string kind;                     ///< "beckmann", "anisotropy", "scan"
  double alpha_x = 0.0, alpha_y = 0.0;  ///< beckmann
  Angle rotation;
  double ratio = 1.0, mean_alpha = 0.0;  ///< anisotropy
  std::filesystem::path scan;            ///< scan
  double outliers = 5.0;                 ///< samples beyond that many standard deviations are taken out; 0: none
  std::optional<double> tolerance;       ///< left out: 0.05 of the slopes' variances; a lobe is then not judged
  Angle rotation_tolerance = Angle::from_degrees(2.0);
};

/// `[simulation]`: how BSDFs are computed.
struct SimulationSpecification {
  std::vector<DirectionAngles> incidences;
  Length wavelength = Length::from_nm(550.0);
  Material material = Dielectric{1.5};
  std::string model = "auto";  ///< or "paths"
  std::size_t resolution = 64;
  double tolerance = 0.02;  ///< wanted relative standard error of a map
  std::uint64_t most_samples = std::uint64_t{1} << 24;
};

/// `[print]`: the patch as a job.
struct PrintSpecification {
  std::size_t base_layers = 5;
  std::size_t margin_pixels = 8;
};

/// An experiment file: what to reach, with what, and how to judge it.
struct Experiment {
  std::filesystem::path file;
  std::string name;  ///< the file's stem: names the run folder
  std::string title;
  std::string canonical_text;  ///< all settings, `--set` included
  TargetSpecification target;
  PrinterProfile printer;
  PatternSpecification pattern;
  PatchOptions patch;
  SimulationSpecification simulation;
  SearchSpecification search;
  PrintSpecification print;
  VirtualProfilometer measurement;
};

/// @throws ConfigurationError with file, line, column, and what would be right.
[[nodiscard]] Experiment read_experiment(const std::filesystem::path& path,
                                         const std::vector<std::string>& settings = {});

}  // namespace mezzotint
