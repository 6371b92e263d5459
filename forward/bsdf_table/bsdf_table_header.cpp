#include "forward/bsdf_table/bsdf_table_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

using nlohmann::json;
constexpr int version = 1;
constexpr std::size_t most_nodes = std::size_t{1} << 24;  // one bin each

constexpr std::array<std::pair<SymmetryKind, const char*>, 5> symmetry_names{
    {{SymmetryKind::None, "none"},
     {SymmetryKind::Point, "point"},
     {SymmetryKind::Mirror, "mirror"},
     {SymmetryKind::PointAndMirror, "point_and_mirror"},
     {SymmetryKind::Isotropic, "isotropic"}}};

template <class Audit>  // EnergyAudit or const EnergyAudit
auto shares_of(Audit& energy) {
  return std::array{&energy.reflected, &energy.transmitted, &energy.absorbed, &energy.left_sideways, &energy.cut_off};
}

json to_json(const EnergyAudit& energy) {
  json numbers = json::array();
  for (const Estimate* share : shares_of(energy)) {
    require(std::isfinite(share->value) && std::isfinite(share->standard_error),
            "a BSDF table has a share of energy that is no number");
    numbers.push_back(share->value);
    numbers.push_back(share->standard_error);
  }
  return numbers;
}

EnergyAudit energy_from(const json& numbers) {
  EnergyAudit energy;
  require(numbers.is_array() && numbers.size() == 10, "an energy audit has ten numbers");
  std::size_t k = 0;
  for (Estimate* share : shares_of(energy)) {
    share->value = numbers[k++].get<double>();
    share->standard_error = numbers[k++].get<double>();
  }
  return energy;
}

SymmetryKind symmetry_from(const std::string& name) {
  for (const auto& [kind, known] : symmetry_names) {
    if (name == known) return kind;
  }
  throw InvalidInput("unknown symmetry \"" + name + "\"; there are none, point, mirror, point_and_mirror, isotropic");
}

// Rings and nodes, numbered in the order of the file.
void add_nodes(const json& header, BsdfTable& table) {
  const json& energies = header.at("energy");
  require(energies.is_array() && energies.size() <= most_nodes, "the energy audits are no list of nodes");
  for (const json& entry : header.at("rings")) {
    IncidenceRing ring;
    ring.theta = Angle::from_radians(entry.at("theta_rad").get<double>());
    ring.follows_theta = entry.at("follows_theta").get<bool>();
    for (const json& azimuth : entry.at("azimuths_rad")) {
      require(table.nodes.size() < energies.size(), "there are more directions of the light than energy audits");
      ring.azimuths.push_back(Angle::from_radians(azimuth.get<double>()));
      ring.nodes.push_back(table.nodes.size());
      BsdfTableNode node;
      node.energy = energy_from(energies[table.nodes.size()]);
      table.nodes.push_back(std::move(node));
    }
    table.incidences.rings.push_back(std::move(ring));
  }
  require(table.nodes.size() == energies.size(), "there are fewer directions of the light than energy audits");
}

BsdfTable table_from(const json& header) {
  require(header.at("version").get<int>() == version, fmt::format("the table is not of version {}", version));
  BsdfTable table;
  table.grid = {header.at("width").get<std::size_t>(), header.at("height").get<std::size_t>()};
  table.relative_index = header.at("relative_index").get<double>();
  table.incidences.symmetry.kind = symmetry_from(header.at("symmetry").get<std::string>());
  table.incidences.symmetry.axis = Angle::from_radians(header.at("axis_rad").get<double>());
  table.provenance = header.at("provenance").get<Provenance>();
  add_nodes(header, table);
  require_valid(table);
  for (std::size_t ring = 0; ring < table.incidences.rings.size(); ++ring) {
    const std::vector<std::size_t>& nodes = table.incidences.rings[ring].nodes;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      table.nodes[nodes[k]].incidence = incidence_at(table.incidences, ring, k);
    }
  }
  return table;
}

}  // namespace

std::size_t TableMosaic::columns() const { return std::clamp<std::size_t>(most_bins_a_side / map.width, 1, maps); }

std::string to_header(const BsdfTable& table) {
  json rings = json::array(), energies = json::array();
  for (const IncidenceRing& ring : table.incidences.rings) {
    json azimuths = json::array();
    for (const Angle azimuth : ring.azimuths) azimuths.push_back(azimuth.radians());
    rings.push_back(
        {{"theta_rad", ring.theta.radians()}, {"azimuths_rad", azimuths}, {"follows_theta", ring.follows_theta}});
    for (const std::size_t node : ring.nodes) energies.push_back(to_json(table.nodes[node].energy));
  }
  const auto* const name = std::find_if(symmetry_names.begin(), symmetry_names.end(), [&](const auto& entry) {
    return entry.first == table.incidences.symmetry.kind;
  });
  const json header = {{"version", version},
                       {"width", table.grid.width},
                       {"height", table.grid.height},
                       {"relative_index", table.relative_index},
                       {"symmetry", name->second},
                       {"axis_rad", table.incidences.symmetry.axis.radians()},
                       {"rings", rings},
                       {"energy", energies},
                       {"provenance", table.provenance}};
  // Provenance may hold a path that is no UTF-8.
  return header.dump(-1, ' ', false, json::error_handler_t::replace);
}

BsdfTable from_header(const std::string& text, const std::filesystem::path& path) {
  try {
    return table_from(json::parse(text));
  } catch (const json::exception& error) {
    throw FileError(path, "header", fmt::format("its table cannot be read: {}", error.what()));
  } catch (const InvalidInput& error) {
    throw FileError(path, "header", error.what());
  }
}

}  // namespace mezzotint
