#include <algorithm>
#include <array>
#include <fstream>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/job_description.h"
#include "experiments/command_line/json_words.h"
#include "experiments/command_line/part_arguments.h"
#include "forward/base/quantity.h"
#include "forward/bsdf_table/bsdf_table_file.h"
#include "forward/optics/bsdf.h"
#include "forward/surface/mesh_file.h"
#include "measurement/formats/surface_file.h"
#include "measurement/reflectance/reflectance_file.h"
#include "measurement/reflectance/reflectance_map.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

Json describe(const SurfaceFile& surface) {
  const Grid& grid = surface.field.grid();
  Json json = {
      {"format", surface.format},
      {"title", surface.title},
      {"columns", grid.columns},
      {"rows", grid.rows},
      {"pitch_x", Quantity{grid.pitch_x.um(), "µm", {}}},
      {"pitch_y", Quantity{grid.pitch_y.um(), "µm", {}}},
      {"width", Quantity{grid.pitch_x.um() * static_cast<double>(grid.columns), "µm", {}}},
      {"depth", Quantity{grid.pitch_y.um() * static_cast<double>(grid.rows), "µm", {}}},
      {"samples", grid.size() - surface.field.missing_count()},
      {"missing", surface.field.missing_count()},
      {"missing_share",
       Quantity{static_cast<double>(surface.field.missing_count()) / static_cast<double>(grid.size()), "1", {}}},
      {"periodic", surface.field.periodic()},
      {"datum", Quantity{surface.field.datum().um(), "µm", {}}}};
  if (surface.field.missing_count() < grid.size()) {
    const HeightRange range = height_range(surface.field);
    json["lowest"] = Quantity{range.lowest.um(), "µm", {}};
    json["highest"] = Quantity{range.highest.um(), "µm", {}};
    json["range"] = Quantity{(range.highest - range.lowest).um(), "µm", {}};
  }
  json["assumption"] = surface.assumption;
  json["provenance"] = surface.provenance;
  return json;
}

Json describe(const Bsdf& bsdf) {
  const auto share = [](const Estimate& e) { return Quantity{e.value, "1", e.standard_error}; };
  return {{"format", "BSDF (OpenEXR)"},
          {"width", bsdf.grid.width},
          {"height", bsdf.grid.height},
          {"incidence_theta", Quantity{bsdf.incidence.theta.degrees(), "°", {}}},
          {"incidence_phi", Quantity{bsdf.incidence.phi.degrees(), "°", {}}},
          {"albedo", share(bsdf.energy.reflected)},
          {"transmitted", share(bsdf.energy.transmitted)},
          {"absorbed", share(bsdf.energy.absorbed)},
          {"left_sideways", share(bsdf.energy.left_sideways)},
          {"cut_off", share(bsdf.energy.cut_off)},
          {"provenance", bsdf.provenance}};
}

Json describe(const std::vector<Bsdf>& channels) {
  if (channels.size() == 1) return describe(channels[0]);
  Json json = describe(channels[0]);
  for (const char* of_one : {"albedo", "transmitted", "absorbed", "left_sideways", "cut_off", "provenance"})
    json.erase(of_one);
  json["channels"] = "R, G, B";
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const Json channel = describe(channels[c]);
    for (const auto& [key, value] : channel.items()) {
      if (!json.contains(key)) json[channel_name(c, channels.size()) + "." + key] = value;
    }
  }
  return json;
}

Json describe(const MeshFile& file) {
  std::array<double, 3> low = {}, high = {};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [least, most] = std::minmax_element(file.mesh.vertices_um.begin(), file.mesh.vertices_um.end(),
                                                   [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
    low[axis] = double{(*least)[axis]};
    high[axis] = double{(*most)[axis]};
  }
  return {{"format", "mesh, " + file.format},
          {"triangles", file.mesh.triangles.size()},
          {"vertices", file.mesh.vertices_um.size()},
          {"width", Quantity{high[0] - low[0], "µm", {}}},
          {"depth", Quantity{high[1] - low[1], "µm", {}}},
          {"lowest", Quantity{low[2], "µm", {}}},
          {"highest", Quantity{high[2], "µm", {}}},
          {"assumption", file.assumption}};
}

Json describe(const BsdfTable& table) {
  Json directions = Json::object();
  for (const BsdfTableNode& node : table.nodes) {
    directions[fmt::format("{:.2f}°, {:.2f}°", node.incidence.theta.degrees(), node.incidence.phi.degrees())] =
        Quantity{node.energy.reflected.value, "1", node.energy.reflected.standard_error};
  }
  return {{"format", "BSDF table (OpenEXR)"}, {"width", table.grid.width},
          {"height", table.grid.height},      {"rings", table.incidences.rings.size()},
          {"incidences", table.nodes.size()}, {"albedo_by_incidence", directions},
          {"provenance", table.provenance}};
}

// What a lobe that was measured from a listed direction covers, and how much light it holds.
Json lobe_of_incidence(const MeasuredReflectance& measured, const DirectionAngles& light) {
  constexpr std::size_t samples = 4;
  const ReflectanceMap map =
      reflectance_map(measured, light, {.name = measured.channels.front().name}, {32, 32}, samples);
  return fmt::format("{:.4f} reflected (channel {}), {:.1f} % of the disc not measured", map.albedo,
                     measured.channels.front().name, 100.0 * map.not_measured_share);
}

Json describe(const MeasuredReflectance& measured) {
  constexpr std::size_t most_lobes = 16;
  Json lobes = Json::object();
  for (std::size_t i = 0; i < std::min(measured.incidences.size(), most_lobes); ++i) {
    const DirectionAngles& light = measured.incidences[i];
    if (light.theta.degrees() >= 89.99) continue;
    lobes[fmt::format("{:.2f}°, {:.2f}°", light.theta.degrees(), light.phi.degrees())] =
        lobe_of_incidence(measured, light);
  }
  Json json = {{"format", "measured BRDF, " + measured.format}, {"quantity", measured.quantity},
               {"channels", measured.channels.size()},          {"first_channel", measured.channels.front().name},
               {"last_channel", measured.channels.back().name}, {"isotropic", measured.isotropic},
               {"incidences", measured.incidences.size()},      {"between_incidences", measured.between_incidences}};
  if (measured.incidences.empty()) json["incidences"] = "all, in a table";
  if (!lobes.empty()) json["lobes_by_incidence"] = lobes;
  json["assumption"] = measured.assumption;
  json["provenance"] = measured.provenance;
  return json;
}

bool begins_with(const std::filesystem::path& path, std::string_view magic) {
  // A pipe would be waited for.
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  std::ifstream stream(path, std::ios::binary);
  std::string head(magic.size(), '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  return stream && head == magic;
}

// A mesh may be a piece of relief or a part: both are said, for 3MF the part alone.
Json describe_mesh(const std::filesystem::path& path, std::optional<Length> unit) {
  const PartFile part = read_part(path, {.unit = unit});
  Json json = is_mesh_path(path) ? describe(read_mesh(path, unit)) : Json{{"format", "mesh, " + part.format}};
  json["part"] = describe(mesh_facts(part.mesh));
  if (!part.mesh.group_names.empty()) json["part"]["groups"] = part.mesh.group_names;
  if (!part.notes.empty()) json["part"]["notes"] = part.notes;
  return json;
}

Json describe_any(const std::filesystem::path& path, const std::string& unit, const Progress& progress) {
  if (is_part_path(path)) return describe_mesh(path, unit_named(unit));
  require(unit.empty(), "--unit is for meshes (.obj, .ply, .stl, .3mf)");
  if (path.extension() == ".uvj" || path.extension() == ".sl1") return describe_job(path, progress);
  // An OpenEXR file is a relief where it has a sidecar, else a BSDF.
  if (begins_with(path, "\x76\x2f\x31\x01") && !has_sidecar(path)) {
    return is_bsdf_table(path) ? describe(read_bsdf_table(path)) : describe(read_channels_exr(path));
  }
  if (is_reflectance_file(path)) return describe(read_reflectance(path));
  const SurfaceFile surface = read_surface(path);
  Json json = describe(surface);
  if (const auto quality = sample_quality(path, surface))
    json["quality"] = {{"lowest", quality->lowest}, {"median", quality->median}, {"highest", quality->highest}};
  return json;
}

}  // namespace

Command add_info(CLI::App& program) {
  auto* app = program.add_subcommand(
      "info",
      "What a file is: surface, mesh, part, BSDF, measured BRDF or job; size, spacing, units, range, provenance");
  struct Arguments {
    std::string file, unit;
  };
  auto arguments = std::make_shared<Arguments>();
  app->add_option("FILE", arguments->file, "File")->required();
  add_unit(*app, arguments->unit);
  return {app, [arguments](const CommandContext& context) {
            const Json json = describe_any(arguments->file, arguments->unit, context.progress);
            context.print(json, in_words(json));
            return ExitStatus::Done;
          }};
}

}  // namespace mezzotint
