#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "forward/base/progress.h"
#include "forward/base/quantity.h"
#include "forward/surface/resample.h"
#include "measurement/texture/autocorrelation.h"
#include "measurement/texture/functional_parameters.h"
#include "measurement/texture/normal_distribution.h"
#include "measurement/texture/profile.h"
#include "measurement/texture/roughness.h"
#include "measurement/texture/spatial_parameters.h"

namespace mezzotint {

/// What is to be evaluated of a surface, and how.
struct TextureRequest {
  bool levelled = true;       ///< by the least-squares plane, first
  Length s_filter, l_filter;  ///< removes shorter, longer wavelengths; 0: none
  struct Line {
    FieldPoint from, to;
  };
  std::optional<Line> line;  ///< of a profile
  ProfileFilter profile_filter;
};

/// A parameter with its symbol and the name that ISO 25178-2 or ISO 21920-2 gives it.
struct TextureParameter {
  std::string symbol, name;
  Quantity quantity;
  bool hangs_on_bandwidth = false;  ///< slopes: they hold for the wavelengths that were seen
};

/// A profile along a line.
struct ProfileFindings {
  Profile profile;              ///< as it was cut
  std::optional<Profile> mean;  ///< its mean line, where there is a lambda_c: roughness is what lies between the two
  ProfileParameters parameters;
};

/// All that is found of a surface's texture. A flat surface, or one of fewer than 16 × 16 samples, has no
/// autocorrelation and no spatial parameters.
struct TextureFindings {
  HeightField field;  ///< levelled and filtered
  AreaRoughness roughness;
  FunctionalParameters functional;
  std::optional<Autocorrelation> autocorrelation;
  std::optional<SpatialParameters> spatial;
  NormalDistribution normals;
  std::optional<ProfileFindings> profile;
  Length shortest, longest;  ///< wavelengths that slopes hold: two samples, or the S-filter; the field, or the L-filter
  std::vector<std::string> notes;

  [[nodiscard]] double missing_share() const;
};

/// @throws InvalidInput as the evaluations do: filters, profiles outside of the field, too few samples.
[[nodiscard]] TextureFindings texture_of(const HeightField& measured, const TextureRequest& request,
                                         const Progress& progress = {});

/// Areal parameters in the order of the standard, then those of the profile.
[[nodiscard]] std::vector<TextureParameter> areal_parameters(const TextureFindings& findings);
[[nodiscard]] std::vector<TextureParameter> profile_parameters(const TextureFindings& findings);

/// {"Sa": {"value", "unit", "standard_error", "name"}, …}; with the wavelengths beside what hangs on them, samples,
/// missing share, settings and notes.
[[nodiscard]] nlohmann::ordered_json texture_json(const TextureFindings& findings, const TextureRequest& request);

}  // namespace mezzotint
