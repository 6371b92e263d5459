#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fabrication/appearance/tangent_relief.h"
#include "fabrication/part/part_mesh.h"

namespace mezzotint {

/// A picture of labels that is laid onto a part along an axis, like a slide that is projected from far away.
///
/// Frame    seen against the axis (from above for +z, where x is the part's x and y its y); else x is horizontal. Row 0
///          at the bottom. It is laid on what faces the axis; its back and what lies beyond its edges have no label.
struct ProjectedLabels {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  Length pixel = Length::from_um(10.0);
  std::size_t columns = 0, rows = 0;
  std::vector<std::uint8_t> labels;  ///< row by row
  /// Where its corner lies in its plane; in the middle of the part where left out.
  std::optional<Length> corner_x, corner_y;
};

/// A part of the surface with a pattern of its own, or with none.
struct AppearanceRegion {
  std::optional<Pattern> pattern;
  int label = 0;      ///< of a picture
  std::string group;  ///< of faces, by its name in the mesh file; where it is not empty, it counts
};

/// What a part looks like: patterns in the part's own coordinates.
struct Appearance {
  Angle crease = Angle::from_degrees(40.0);  ///< faces that meet at a larger one have an edge between them
  FieldGuide field;                          ///< where the patterns' x axis points
  std::optional<Pattern> pattern;            ///< wherever no region says otherwise; none leaves the surface as it is
  std::optional<ProjectedLabels> picture;
  std::vector<AppearanceRegion> regions;
};

/// A part's surface with its relief, ready to be sliced, and what is to be known of it.
struct ClothedPart {
  SmoothSurface surface;
  SurfaceRelief relief;
  bool has_field = false;
  std::size_t singularities = 0;    ///< of the direction field
  std::vector<PhaseFigures> waves;  ///< of ridges and sinusoids, in the order of their patterns
};

/// @throws InvalidInput for patterns that a surface cannot have (`tangent_relief`), a group that the part has not (the
///         message names those that it has), a region with a label but no picture, and as `smooth_surface`.
[[nodiscard]] ClothedPart clothe(const PartMesh& part, const Appearance& appearance);

}  // namespace mezzotint
