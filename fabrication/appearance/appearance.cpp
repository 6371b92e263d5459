#include "fabrication/appearance/appearance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

using Eigen::Vector3d;

// The most triangles that a surface is refined to for waves: their phases' equations take some hundred MB then.
constexpr std::size_t most_triangles = 300'000;
constexpr std::uint16_t no_pattern = 0xFFFF;

template <class Visit>
void for_each_pattern(const Appearance& appearance, const Visit& visit) {
  if (appearance.pattern) visit(*appearance.pattern);
  for (const AppearanceRegion& region : appearance.regions)
    if (region.pattern) visit(*region.pattern);
}

// Round noise is the same in every direction.
bool needs_field(const Pattern& pattern) {
  if (const auto* noise = std::get_if<Noise>(&pattern)) return noise->stretch != 1.0;
  if (const auto* motion = std::get_if<FractionalBrownianMotion>(&pattern)) return motion->stretch != 1.0;
  if (const auto* turbulence = std::get_if<Turbulence>(&pattern)) return turbulence->stretch != 1.0;
  return true;
}

// Axes of the picture's plane.
struct PicturePlane {
  Vector3d x, y, axis;
  explicit PicturePlane(const Vector3d& along) : axis(along.normalized()) {
    const Vector3d horizontal = Vector3d::UnitZ().cross(axis);
    x = horizontal.norm() > 1e-6 ? Vector3d(horizontal.normalized()) : Vector3d(Vector3d::UnitX());
    y = axis.cross(x);
  }
};

// Which pattern lies where: an index, one for all where there are no regions.
class RegionMap {
public:
  RegionMap(const PartMesh& part, const SmoothSurface& surface, const Appearance& appearance)
      : of_group_(part.group_names.size(), first_of(appearance)), of_label_(256, first_of(appearance)) {
    std::uint16_t next = appearance.pattern ? 1 : 0;
    for (const AppearanceRegion& region : appearance.regions) {
      const std::uint16_t index = region.pattern ? next++ : no_pattern;
      if (region.group.empty())
        of_label_.at(static_cast<std::size_t>(region.label)) = index;
      else
        of_group_[group_number(part, region.group)] = index;
      by_group_ = by_group_ || !region.group.empty();
    }
    first_ = first_of(appearance);
    if (by_group_) {
      for (const std::uint32_t source : surface.sources) groups_.push_back(part.groups[source]);
    }
    if (appearance.picture) place_picture(*appearance.picture, surface);
  }

  [[nodiscard]] std::uint16_t at(const SmoothSurface& surface, const SurfacePoint& point) const {
    if (by_group_) {
      const std::uint16_t index = of_group_[groups_[point.triangle]];
      if (index != first_ || !picture_) return index;
    }
    return picture_ ? under_picture(surface, point) : first_;
  }

private:
  static std::uint16_t first_of(const Appearance& appearance) { return appearance.pattern ? 0 : no_pattern; }

  static std::size_t group_number(const PartMesh& part, const std::string& name) {
    require(!part.groups.empty(), "the part has no groups of faces; \"" + name + "\" cannot be found in it");
    const auto found = std::ranges::find(part.group_names, name);
    std::string names;
    for (const std::string& known : part.group_names) names += (names.empty() ? "\"" : ", \"") + known + "\"";
    require(found != part.group_names.end(), "the part has no group of faces \"" + name + "\"; it has " + names);
    return static_cast<std::size_t>(found - part.group_names.begin());
  }

  void place_picture(const ProjectedLabels& picture, const SmoothSurface& surface) {
    picture_ = picture;
    plane_ = PicturePlane(picture.axis);
    std::array<double, 4> box = {1e300, -1e300, 1e300, -1e300};
    for (const auto& corners : surface.corners) {
      for (const std::uint32_t vertex : corners) {
        const double x = surface.vertices_mm[vertex].dot(plane_.x), y = surface.vertices_mm[vertex].dot(plane_.y);
        box = {std::min(box[0], x), std::max(box[1], x), std::min(box[2], y), std::max(box[3], y)};
      }
    }
    const double width = static_cast<double>(picture.columns) * picture.pixel.mm(),
                 height = static_cast<double>(picture.rows) * picture.pixel.mm();
    left_mm_ = picture.corner_x ? picture.corner_x->mm() : 0.5 * (box[0] + box[1] - width);
    bottom_mm_ = picture.corner_y ? picture.corner_y->mm() : 0.5 * (box[2] + box[3] - height);
  }

  [[nodiscard]] std::uint16_t under_picture(const SmoothSurface& surface, const SurfacePoint& point) const {
    const auto& nodes = surface.nodes[point.triangle];
    Vector3d normal = Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      normal += point.weights[static_cast<Eigen::Index>(k)] * surface.normals[nodes.at(k)];
    if (normal.dot(plane_.axis) <= 1e-3) return first_;
    const double column = std::floor((point.place_mm.dot(plane_.x) - left_mm_) / picture_->pixel.mm()),
                 row = std::floor((point.place_mm.dot(plane_.y) - bottom_mm_) / picture_->pixel.mm());
    if (!(column >= 0.0 && column < static_cast<double>(picture_->columns) && row >= 0.0 &&
          row < static_cast<double>(picture_->rows)))
      return first_;
    const std::size_t pixel = static_cast<std::size_t>(row) * picture_->columns + static_cast<std::size_t>(column);
    return of_label_[picture_->labels[pixel]];
  }

  std::vector<std::uint16_t> of_group_, of_label_;
  std::uint16_t first_ = no_pattern;
  bool by_group_ = false;
  std::vector<std::uint32_t> groups_;  // a triangle
  std::optional<ProjectedLabels> picture_;
  PicturePlane plane_{Vector3d::UnitZ()};
  double left_mm_ = 0.0, bottom_mm_ = 0.0;
};

SurfaceRelief joined(std::vector<SurfaceRelief> reliefs, std::shared_ptr<const RegionMap> map,
                     std::shared_ptr<const FieldSurface> on) {
  SurfaceRelief result;
  for (const SurfaceRelief& relief : reliefs) {
    result.lowest = std::min(result.lowest, relief.lowest);
    result.highest = std::max(result.highest, relief.highest);
  }
  result.make_probe = [reliefs = std::move(reliefs), map = std::move(map), on = std::move(on)]() -> ReliefProbe {
    std::vector<ReliefProbe> probes;
    for (const SurfaceRelief& relief : reliefs) probes.push_back(relief.make_probe());
    return [probes = std::move(probes), map, on](const SurfacePoint& point) {
      const std::uint16_t index = map->at(on->surface, point);
      return index == no_pattern ? 0.0 : probes[index](point);
    };
  };
  return result;
}

void require_valid(const Appearance& appearance) {
  require(appearance.pattern || !appearance.regions.empty(),
          "an appearance needs a pattern, or regions with patterns of their own");
  for (const AppearanceRegion& region : appearance.regions) {
    require(!region.group.empty() || appearance.picture,
            "a region with a label needs a picture that says where it lies; or name a group of faces");
    require(region.label >= 0 && region.label <= 255, "a region's label lies within 0 and 255");
  }
  if (!appearance.picture) return;
  const ProjectedLabels& picture = *appearance.picture;
  require(picture.columns > 0 && picture.rows > 0 && picture.labels.size() == picture.columns * picture.rows,
          "a picture of labels needs one label a pixel");
  require(picture.axis.norm() > 0.0 && picture.pixel > Length{},
          "a picture of labels needs an axis and pixels with a size");
}

}  // namespace

ClothedPart clothe(const PartMesh& part, const Appearance& appearance) {
  require_valid(appearance);
  auto on = std::make_shared<FieldSurface>(FieldSurface{smooth_surface(part, appearance.crease), {}});
  std::optional<Length> longest;
  bool field = false;
  for_each_pattern(appearance, [&](const Pattern& pattern) {
    if (const auto edge = longest_edge_for(pattern)) longest = std::min(*edge, longest.value_or(*edge));
    field = field || needs_field(pattern);
  });
  if (longest) on->surface = refined(std::move(on->surface), *longest, most_triangles);
  if (field) on->field = direction_field(on->surface, appearance.field);

  ClothedPart clothed;
  std::vector<SurfaceRelief> reliefs;
  for_each_pattern(appearance, [&](const Pattern& pattern) {
    TangentRelief relief = tangent_relief(pattern, on);
    reliefs.push_back(std::move(relief.relief));
    clothed.waves.insert(clothed.waves.end(), relief.waves.begin(), relief.waves.end());
  });
  clothed.has_field = field;
  clothed.singularities = on->field.singularities.size();
  clothed.surface = on->surface;
  if (appearance.regions.empty()) {
    clothed.relief = std::move(reliefs.front());
  } else {
    auto map = std::make_shared<const RegionMap>(part, on->surface, appearance);
    clothed.relief = joined(std::move(reliefs), std::move(map), on);
  }
  return clothed;
}

}  // namespace mezzotint
