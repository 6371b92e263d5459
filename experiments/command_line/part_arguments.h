#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "fabrication/part/mesh_facts.h"
#include "fabrication/part/part_file.h"

namespace CLI {
class App;
}

namespace mezzotint {

/// Adds `--unit`: what a number of a mesh file is worth.
void add_unit(CLI::App& app, std::string& unit);

/// What `--unit` says; nothing where it was not given.
[[nodiscard]] std::optional<Length> unit_named(const std::string& unit);

/// Facts of a part's surface for people and for `--json`.
[[nodiscard]] nlohmann::ordered_json describe(const MeshFacts& facts);

}  // namespace mezzotint
