#include "experiments/run/target_maps.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/optics/bsdf.h"
#include "measurement/reflectance/reflectance_file.h"
#include "measurement/reflectance/reflectance_map.h"

namespace mezzotint {

namespace {

// An albedo may exceed 1 by rounding, and by this many standard errors.
constexpr double albedo_slack = 1e-4, most_errors = 4.0;
// Noise about 0 of maps that state no error.
constexpr double noise_share = 0.05;

std::string in_words(const DirectionAngles& light) {
  return fmt::format("({:.4g}°, {:.4g}°)", light.theta.degrees(), light.phi.degrees());
}

std::string place_of(const DirectionGrid& grid, std::size_t bin) {
  const double x = 2.0 * (static_cast<double>(bin % grid.width) + 0.5) / static_cast<double>(grid.width) - 1.0;
  const double y = 2.0 * (static_cast<double>(bin / grid.width) + 0.5) / static_cast<double>(grid.height) - 1.0;
  const double theta = std::asin(std::min(1.0, std::hypot(x, y)));
  return in_words({Angle::from_radians(theta), Angle::from_radians(std::atan2(y, x))});
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

DirectionGrid grid_of(const SimulationSpecification& simulation) {
  return {simulation.resolution, simulation.resolution};
}

void add(TargetMaps& target, const DirectionAngles& light, DirectionMap map, DirectionMap measured = {}) {
  target.incidences.push_back(light);
  if (measured.empty()) measured.assign(map.size(), 1.0);
  target.measured.push_back(std::move(measured));
  target.maps.push_back(std::move(map));
}

TargetMaps maps_of(const MicrofacetLobe& lobe, const SimulationSpecification& simulation) {
  TargetMaps target{grid_of(simulation), {}, {}, {}, false, {}};
  for (const DirectionAngles& light : simulation.incidences)
    add(target, light, reflection_map(lobe, simulation.material, light, target.grid));
  return target;
}

// A file of three channels counts by its luminance.
MapEstimate luminance_of(const std::vector<Bsdf>& channels) {
  if (channels.size() == 1) return channels[0].reflection;
  constexpr double weights[3] = {0.2126, 0.7152, 0.0722};
  MapEstimate sum{DirectionMap(channels[0].grid.size()), DirectionMap(channels[0].grid.size()), {}, {}, {}, {}};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < sum.mean.size(); ++k) {
      sum.mean[k] += weights[c] * channels[c].reflection.mean[k];
      sum.standard_error[k] += weights[c] * channels[c].reflection.standard_error[k];
    }
  }
  return sum;
}

void require_new_light(const TargetMaps& target, const std::vector<std::filesystem::path>& files,
                       const DirectionAngles& light) {
  for (std::size_t i = 0; i < target.incidences.size(); ++i) {
    const double cosine = to_direction(target.incidences[i]).dot(to_direction(light));
    require(std::acos(std::min(1.0, cosine)) > Angle::from_degrees(0.05).radians(),
            fmt::format("\"{}\" and \"{}\" are for the same light, {}; a target has one map a direction",
                        files[i].string(), files[target.incidences.size()].string(), in_words(light)));
  }
}

TargetMaps maps_of(const WantedMaps& wanted, const SimulationSpecification& simulation) {
  TargetMaps target{grid_of(simulation), {}, {}, {}, false, {}};
  for (const auto& file : wanted.files) {
    const std::vector<Bsdf> channels = read_channels_exr(file);
    const Bsdf& bsdf = channels[0];
    require(bsdf.grid == target.grid,
            fmt::format("\"{}\" has {} x {} bins; [simulation] resolution asks for {} x {}, and all maps of a target "
                        "have one grid: {}",
                        file.string(), bsdf.grid.width, bsdf.grid.height, target.grid.width, target.grid.height,
                        bsdf.grid.width == bsdf.grid.height
                            ? fmt::format("set resolution = {}, or make the file anew", bsdf.grid.width)
                            : "make the file anew, with as many rows as columns"));
    require_new_light(target, wanted.files, bsdf.incidence);
    MapEstimate map = luminance_of(channels);
    require_possible("\"" + file.string() + "\"", bsdf.incidence, bsdf.grid, map.mean, map.standard_error);
    add(target, bsdf.incidence, std::move(map.mean));
  }
  return target;
}

std::vector<DirectionAngles> lights_of(const MeasuredReflectance& measured, const SimulationSpecification& simulation) {
  if (simulation.incidences_given || measured.incidences.empty()) return simulation.incidences;
  // What can be had from between the listed directions can be had from the default ones.
  if (measured.between_incidences && std::ranges::all_of(simulation.incidences, [&](const auto& light) {
        return refusal_of_incidence(measured, light).empty();
      }))
    return simulation.incidences;
  std::vector<DirectionAngles> lights;
  for (const DirectionAngles& light : measured.incidences) {
    if (light.theta.degrees() <= 89.0) lights.push_back(light);
  }
  return lights;
}

TargetMaps maps_of(const WantedMeasurement& wanted, const SimulationSpecification& simulation) {
  const MeasuredReflectance measured = read_reflectance(wanted.file);
  const std::string name = "\"" + wanted.file.string() + "\"";
  TargetMaps target{grid_of(simulation), {}, {}, {}, wanted.any_brightness, {}};
  for (const DirectionAngles& light : lights_of(measured, simulation)) {
    const std::string refusal = refusal_of_incidence(measured, light);
    require(refusal.empty(), name + ": " + refusal + "; say so in [simulation] incidence_deg");
    ReflectanceMap map = reflectance_map(measured, light, wanted.channel, target.grid);
    require(
        map.not_measured_share <= wanted.most_missing,
        fmt::format("{}: for light from {} {:.1f} % of the disc of directions was not measured; at most {:.1f} % may "
                    "be missing ([target] most_missing)",
                    name, in_words(light), 100.0 * map.not_measured_share, 100.0 * wanted.most_missing));
    require_possible(name, light, target.grid, map.map, {});
    if (map.not_measured_share > 0.0) {
      target.notes.push_back(
          fmt::format("for light from {} {:.1f} % of the disc was not measured and counts for nothing", in_words(light),
                      100.0 * map.not_measured_share));
    }
    add(target, light, std::move(map.map), std::move(map.measured));
  }
  if (!measured.assumption.empty()) target.notes.push_back(name + " is taken as: " + measured.assumption);
  return target;
}

double gauss(double distance, double width) { return std::exp(-0.5 * distance * distance / (width * width)); }

// Light of a shape at (u, v) from its middle, along its own axes.
double light_of(const SquareShape& square, double u, double v) {
  return std::max(std::abs(u), std::abs(v)) <= square.half_width ? 1.0 : 0.0;
}
double light_of(const RingShape& ring, double u, double v) {
  return std::abs(std::hypot(u, v) - ring.radius) <= 0.5 * ring.width ? 1.0 : 0.0;
}
double light_of(const TwoLobesShape& lobes, double u, double v) {
  return gauss(std::hypot(u - lobes.distance, v), lobes.width) + gauss(std::hypot(u + lobes.distance, v), lobes.width);
}
double light_of(const TiltShape& tilt, double u, double v) { return gauss(std::hypot(u, v), tilt.width); }

DirectionMap painted(const WantedPainting& painting, const DirectionAngles& light, const DirectionGrid& grid) {
  constexpr std::size_t samples = 16;
  const Direction to_light = to_direction(light);
  const double cosine = std::cos(painting.rotation.radians()), sine = std::sin(painting.rotation.radians());
  return std::visit(
      [&](const auto& lobe) {
        return average_over_bins(
            grid,
            [&](const Direction& viewer) {
              if constexpr (std::is_same_v<std::decay_t<decltype(lobe)>, LobePicture>) {
                return light_at(lobe, viewer.x(), viewer.y());
              } else {
                const double x = viewer.x() + to_light.x() - painting.centre_x;
                const double y = viewer.y() + to_light.y() - painting.centre_y;
                return light_of(lobe, cosine * x + sine * y, cosine * y - sine * x);
              }
            },
            samples);
      },
      painting.lobe);
}

TargetMaps maps_of(const WantedPainting& painting, const SimulationSpecification& simulation) {
  TargetMaps target{grid_of(simulation), {}, {}, {}, !painting.albedo.has_value(), {}};
  const std::vector<double> areas = projected_solid_angles(target.grid);
  for (const DirectionAngles& light : painting.incidences) {
    DirectionMap map = painted(painting, light, target.grid);
    const double sum = dot(map, areas);
    require(sum > 0.0, "the painted lobe is dark on a grid of " + std::to_string(target.grid.width) +
                           " bins a side; it is too thin, raise [simulation] resolution");
    const double wanted = painting.albedo.value_or(reflectance(simulation.material, std::cos(light.theta.radians())));
    for (double& value : map) value *= wanted / sum;
    require_possible("the painted lobe", light, target.grid, map, {});
    add(target, light, std::move(map));
  }
  return target;
}

TargetMaps maps_of(const WantedAnisotropy&, const SimulationSpecification&) {
  throw InvalidInput("an anisotropy alone names no lobe, so it has no maps");
}
TargetMaps maps_of(const WantedScan&, const SimulationSpecification&) {
  throw InvalidInput("the maps of a scan are those that its relief scatters; they are computed, not given");
}
TargetMaps maps_of(const WantedRegions&, const SimulationSpecification&) {
  throw InvalidInput("a target of regions has maps region by region");
}

// No relief makes a material reflect more than it does.
void note_brightness(TargetMaps& target, const SimulationSpecification& simulation) {
  if (target.any_brightness) return;
  const std::vector<double> areas = projected_solid_angles(target.grid);
  for (std::size_t i = 0; i < target.maps.size(); ++i) {
    const double albedo = dot(target.maps[i], areas);
    const double flat = reflectance(simulation.material, std::cos(target.incidences[i].theta.radians()));
    if (albedo <= 1.5 * flat) continue;
    target.notes.push_back(fmt::format(
        "for light from {} the target reflects {:.3g} of the light, a flat surface of the material {:.3g}: its shape "
        "may be met, its brightness cannot",
        in_words(target.incidences[i]), albedo, flat));
  }
}

}  // namespace

void require_possible(const std::string& name, const DirectionAngles& to_light, const DirectionGrid& grid,
                      const DirectionMap& map, const DirectionMap& noise) {
  const std::string at = name + ": for light from " + in_words(to_light) + " ";
  const std::vector<double> areas = projected_solid_angles(grid);
  require(map.size() == areas.size(), at + "the map has not one value a bin");
  double largest = 0.0, variance = 0.0;
  for (std::size_t k = 0; k < map.size(); ++k) {
    require(std::isfinite(map[k]), at + "the map is not finite toward " + place_of(grid, k));
    largest = std::max(largest, map[k]);
    if (!noise.empty()) variance += std::pow(areas[k] * noise[k], 2);
  }
  for (std::size_t k = 0; k < map.size(); ++k) {
    const double allowed = noise.empty() ? noise_share * largest : most_errors * noise[k] + 1e-6 * largest;
    require(map[k] >= -allowed, fmt::format("{}the map is {:.4g} toward {}; noise explains no less than {:.4g}", at,
                                            map[k], place_of(grid, k), -allowed));
  }
  const double albedo = dot(map, areas);
  require(albedo > 0.0, at + "the map is dark");
  const double allowed = 1.0 + albedo_slack + most_errors * std::sqrt(variance);
  const auto peak = static_cast<std::size_t>(std::max_element(map.begin(), map.end()) - map.begin());
  require(
      albedo <= allowed,
      fmt::format("{}the target is brighter than a mirror: it reflects {:.4g} times the light that comes in, {:.3g} % "
                  "too much; it is brightest toward {}",
                  at, albedo, 100.0 * (albedo - 1.0), place_of(grid, peak)));
}

TargetMaps wanted_maps(const TargetSpecification& target, const SimulationSpecification& simulation) {
  TargetMaps maps = std::visit([&](const auto& wanted) { return maps_of(wanted, simulation); }, target.wanted);
  note_brightness(maps, simulation);
  return maps;
}

}  // namespace mezzotint
