#include "forward/optics/material.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr std::string_view forms =
    "\"mirror\", \"dielectric:ETA\" (ETA from 1.0001 to 10), \"dielectric:ETA,ABSORPTION\" (per µm, 0 to 1000) or "
    "\"conductor:ETA,KAPPA\" (ETA above 0, up to 20; "
    "KAPPA above 0, up to 50)";

// The whole text as one finite number; nothing else.
std::optional<double> number(std::string_view text) {
  double value = 0.0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<Material> dielectric(std::string_view arguments) {
  const std::size_t comma = arguments.find(',');
  const std::optional<double> eta = number(arguments.substr(0, comma));
  const auto absorption = comma == std::string_view::npos ? std::optional(0.0) : number(arguments.substr(comma + 1));
  if (!eta || !(*eta >= 1.0001 && *eta <= 10.0)) return std::nullopt;
  if (!absorption || !(*absorption >= 0.0 && *absorption <= 1000.0)) return std::nullopt;
  return Dielectric{*eta, *absorption};
}

std::optional<Material> conductor(std::string_view arguments) {
  const std::size_t comma = arguments.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const std::optional<double> eta = number(arguments.substr(0, comma));
  const std::optional<double> kappa = number(arguments.substr(comma + 1));
  if (!eta || !kappa) return std::nullopt;
  if (!(*eta > 0.0 && *eta <= 20.0 && *kappa > 0.0 && *kappa <= 50.0)) return std::nullopt;
  return Conductor{*eta, *kappa};
}

std::optional<Material> understood(std::string_view text) {
  constexpr std::string_view clear = "dielectric:", metal = "conductor:";
  if (text == "mirror") return Mirror{};
  if (text.starts_with(clear)) return dielectric(text.substr(clear.size()));
  if (text.starts_with(metal)) return conductor(text.substr(metal.size()));
  return std::nullopt;
}

}  // namespace

Material parse_material(std::string_view text) {
  const std::optional<Material> material = understood(text);
  require(material.has_value(), fmt::format("material \"{}\" is not understood; write {}", text, forms));
  return *material;
}

std::vector<Material> parse_materials(std::string_view text) {
  const std::size_t colon = std::min(text.find(':'), text.size() - 1);
  const std::string kind(text.substr(0, text.empty() ? 0 : colon + 1));
  std::vector<Material> materials;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t slash = rest.find('/');
    const std::string_view part = rest.substr(0, slash);
    materials.push_back(parse_material(materials.empty() ? std::string(part) : kind + std::string(part)));
    rest = slash == std::string_view::npos ? std::string_view() : rest.substr(slash + 1);
    require(slash == std::string_view::npos || !rest.empty(), fmt::format("material \"{}\" ends in \"/\"", text));
  }
  require(materials.size() == 1 || materials.size() == 3,
          fmt::format("material \"{}\" has {} indices; write one for all light, or three for R, G, B", text,
                      materials.size()));
  return materials;
}

std::string to_string(const Material& material) {
  // The shortest digits that read back as the same number.
  struct {
    std::string operator()(const Mirror&) const { return "mirror"; }
    std::string operator()(const Dielectric& medium) const {
      return medium.absorption_per_um == 0.0 ? fmt::format("dielectric:{}", medium.eta)
                                             : fmt::format("dielectric:{},{}", medium.eta, medium.absorption_per_um);
    }
    std::string operator()(const Conductor& metal) const {
      return fmt::format("conductor:{},{}", metal.eta, metal.kappa);
    }
  } const text;
  return std::visit(text, material);
}

}  // namespace mezzotint
