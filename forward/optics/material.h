#pragma once

#include <complex>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace mezzotint {

/// Reflects everything: Fresnel 1 at every angle. For white furnaces and for the shape of a lobe.
struct Mirror {};
/// A clear medium, κ = 0: light refracts in and may come out again; on its way inside it loses light by Beer–Lambert.
struct Dielectric {
  double eta = 1.5;
  double absorption_per_um = 0.0;
};
/// An opaque medium, index η + iκ with κ > 0: what is not reflected is absorbed.
struct Conductor {
  double eta = 0.2;
  double kappa = 3.0;
};
/// The half-space under the relief, seen from air. Refractive indices are relative to air.
using Material = std::variant<Mirror, Dielectric, Conductor>;

/// "mirror", "dielectric:1.5", "dielectric:1.5,0.001" (absorption per µm), "conductor:0.2,3.0".
/// @throws InvalidInput with the forms that are understood; η must be in [1.0001, 10] for a dielectric
///         and in (0, 20] for a conductor, κ in (0, 50], the absorption in [0, 1000].
[[nodiscard]] Material parse_material(std::string_view text);
[[nodiscard]] std::string to_string(const Material& material);

/// One material for all light, or three of one kind for the channels R, G, B: the indices are written one after the
/// other, "dielectric:1.51/1.52/1.53", "conductor:0.2,3.9/0.9,2.4/1.1,1.9".
/// @throws InvalidInput as parse_material, and for two or more than three.
[[nodiscard]] std::vector<Material> parse_materials(std::string_view text);

/// Unpolarised Fresnel reflectance seen from air, cos_incident in [0, 1].
[[nodiscard]] double reflectance(const Material& material, double cos_incident);

/// Unpolarised Fresnel reflectance of a smooth interface; `relative_index` is n(beyond) / n(here), so
/// below 1 for light that leaves a medium (1 from the critical angle on). The cosine of the refracted
/// ray, 0 at total internal reflection, is returned too.
/// Source   Born & Wolf, Principles of Optics, §1.5.
struct DielectricFresnel {
  double reflectance = 1.0;
  double cos_refracted = 0.0;
};
[[nodiscard]] DielectricFresnel dielectric_fresnel(double cos_incident, double relative_index);

/// The same for a complex index η + iκ relative to air.
[[nodiscard]] double conductor_fresnel(double cos_incident, std::complex<double> index);

}  // namespace mezzotint
