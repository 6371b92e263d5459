#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "experiments/configuration/lobe_picture.h"
#include "experiments/configuration/toml_table.h"
#include "forward/optics/microfacet.h"
#include "forward/pattern/pattern.h"
#include "measurement/reflectance/measured_reflectance.h"

namespace mezzotint {

/// "anisotropy": α_x/α_y and √(α_x·α_y); the direction is open.
struct WantedAnisotropy {
  double ratio = 1.0, mean_alpha = 0.0;
};

/// "scan": a measured relief; read and corrected when the run needs it.
struct WantedScan {
  std::filesystem::path scan;
  double outliers = 5.0;  ///< samples beyond that many standard deviations are taken out; 0: none
};

/// "bsdf": reflection maps in our OpenEXR files, each with its own direction of the light.
struct WantedMaps {
  std::vector<std::filesystem::path> files;
};

/// "measured": a BRDF that somebody measured.
struct WantedMeasurement {
  std::filesystem::path file;
  ChannelChoice channel;
  double most_missing = 0.15;  ///< share of the disc that may lack samples
  bool any_brightness = true;
};

/// Lobes drawn by a formula, in projected coordinates (x, y of the direction) about the middle of the lobe.
struct SquareShape {
  double half_width = 0.2;  ///< even inside
};
struct RingShape {
  double radius = 0.3, width = 0.1;  ///< even between radius ± width/2
};
struct TwoLobesShape {
  double distance = 0.2, width = 0.05;  ///< Gaussian spots at ± distance along x; standard deviation
};
struct TiltShape {
  double width = 0.1;  ///< one Gaussian spot; standard deviation
};

/// "image": a lobe that somebody painted.
struct WantedPainting {
  std::variant<LobePicture, SquareShape, RingShape, TwoLobesShape, TiltShape> lobe;
  /// Of a shape: its middle, from the mirrored direction; and its direction.
  double centre_x = 0.0, centre_y = 0.0;
  Angle rotation;
  std::vector<DirectionAngles> incidences = {{}};
  std::optional<double> albedo;  ///< left out: the light that the material reflects
};

struct TargetRegion;

/// "regions": one target a gray value of a picture.
struct WantedRegions {
  PatternRegions picture;  ///< labels and their place; it has no parts
  std::vector<TargetRegion> regions;
};

/// `[target]` as it stands in the file. Pictures are read with it; scans, maps and measurements when the run needs
/// them.
struct TargetSpecification {
  std::string kind;  ///< "beckmann", "ggx", "anisotropy", "scan", "bsdf", "measured", "image", "regions"
  std::variant<BeckmannLobe, GgxLobe, WantedAnisotropy, WantedScan, WantedMaps, WantedMeasurement, WantedPainting,
               WantedRegions>
      wanted;
  std::optional<double> tolerance;  ///< left out: 0.05 of the slopes' variances; a lobe is then not judged
  Angle rotation_tolerance = Angle::from_degrees(2.0);
};

struct TargetRegion {
  int label = 0;
  TargetSpecification target;
};

/// @throws ConfigurationError with file, line and column for what is missing, unknown, out of range or contradicts
///         itself.
[[nodiscard]] TargetSpecification read_target(TomlTable table);

/// Whether a target is a lobe and names no slopes: what it wants are maps, and the objective must be one of lobes.
[[nodiscard]] bool is_lobe_alone(const TargetSpecification& target);

/// The files that a target is made of, those of its regions included; a run is identified by their content.
[[nodiscard]] std::vector<std::filesystem::path> files_of(const TargetSpecification& target);

}  // namespace mezzotint
