#include <algorithm>
#include <cmath>

#include "forward/optics/material.h"

namespace mezzotint {

namespace {

double square(double x) { return x * x; }

}  // namespace

DielectricFresnel dielectric_fresnel(double cos_incident, double relative_index) {
  const double cos_i = std::clamp(cos_incident, 0.0, 1.0);
  const double sine_squared = (1.0 - cos_i) * (1.0 + cos_i) / square(relative_index);
  if (sine_squared >= 1.0) return {1.0, 0.0};
  const double cos_t = std::sqrt(1.0 - sine_squared);
  const double across = (cos_i - relative_index * cos_t) / (cos_i + relative_index * cos_t);
  const double along = (relative_index * cos_i - cos_t) / (relative_index * cos_i + cos_t);
  return {0.5 * (square(across) + square(along)), cos_t};
}

double conductor_fresnel(double cos_incident, std::complex<double> index) {
  const double cos_i = std::clamp(cos_incident, 0.0, 1.0);
  const std::complex<double> permittivity = index * index;
  // Index times the cosine inside; the principal root decays into the medium, as κ ≥ 0 asks.
  const std::complex<double> inside = std::sqrt(permittivity - (1.0 - cos_i) * (1.0 + cos_i));
  const double across = std::norm(cos_i - inside) / std::norm(cos_i + inside);
  const double along = std::norm(permittivity * cos_i - inside) / std::norm(permittivity * cos_i + inside);
  return 0.5 * (across + along);
}

double reflectance(const Material& material, double cos_incident) {
  struct {
    double cosine;
    double operator()(const Mirror&) const { return 1.0; }
    double operator()(const Dielectric& medium) const { return dielectric_fresnel(cosine, medium.eta).reflectance; }
    double operator()(const Conductor& metal) const { return conductor_fresnel(cosine, {metal.eta, metal.kappa}); }
  } const of_air_to{cos_incident};
  return std::visit(of_air_to, material);
}

}  // namespace mezzotint
