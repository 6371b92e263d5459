#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "forward/optics/bsdf.h"
#include "forward/optics/direction.h"
#include "measurement/reflectance/adaptive_tensor.h"
#include "measurement/reflectance/half_angle_table.h"
#include "measurement/reflectance/polar_lobes.h"
#include "measurement/reflectance/scattered_lobes.h"

namespace mezzotint {

/// One colour of a measurement.
struct MeasuredChannel {
  std::string name;                  ///< "R", "650 nm", "Monochrome"
  std::optional<Length> wavelength;  ///< where the file states one
};

/// A BRDF that somebody measured, as its file holds it.
///
/// Frame    ours: directions point away from the surface, z is the normal. An isotropic sample may be turned at will;
///          the light of a file of one plane of incidence comes from any φ. See each reader for the frame of its file.
/// Units    1/sr; a file of BRDF · cosθ has been divided by the cosine (`quantity` says so).
/// Missing  directions that were not measured are NaN: they are never extrapolated.
struct MeasuredReflectance {
  std::string format;      ///< "RGL tensor", "MERL", "Zemax BSDF", "FRED BSDF", "Cornell BRDF", "ALTA"
  std::string quantity;    ///< what the numbers of the file are, and what was done to them
  std::string assumption;  ///< what the file does not say
  Provenance provenance;
  std::vector<MeasuredChannel> channels;
  bool isotropic = true;
  /// Directions of the light that the file lists; none where it is a table of all of them.
  std::vector<DirectionAngles> incidences;
  /// Whether its authors interpolate between those; outside of them nothing is known in any case.
  bool between_incidences = false;
  std::variant<PolarLobes, ScatteredLobes, HalfAngleTable, AdaptiveTensor> data;
};

/// Which colour is meant: a channel's name, or a wavelength (interpolated between the channels), or neither of the two:
/// luminance. That is 0.2126 R + 0.7152 G + 0.0722 B, the Y of X, Y, Z, and of a spectrum the mean weighted by the
/// photopic luminosity V(λ) (equal-energy light).
/// Source   ITU-R BT.709; Wyman, Sloan & Shirley 2013 for V(λ).
struct ChannelChoice {
  std::string name;
  std::optional<Length> wavelength;
};

/// Weights of the channels for a choice; they sum to 1.
/// @throws InvalidInput for a name that is not there, or a wavelength outside of those measured, with what is there.
[[nodiscard]] ChannelWeights channel_weights(const MeasuredReflectance& measured, const ChannelChoice& choice = {});

/// The BRDF for one pair of directions; NaN where it was not measured, which includes directions below the horizon.
[[nodiscard]] double evaluate(const MeasuredReflectance& measured, const Direction& to_light,
                              const Direction& to_viewer, const ChannelWeights& weights);

/// Why nothing is known for a direction of the light, with what is there instead; empty where something is known.
[[nodiscard]] std::string refusal_of_incidence(const MeasuredReflectance& measured, const DirectionAngles& to_light);

}  // namespace mezzotint
