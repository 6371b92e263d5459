#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "forward/optics/microfacet.h"

// Packs an analytic microfacet model in the layout of the RGL database, from the paper alone: nothing of the reader is
// used. The warp is found by bisection of the integrals of the bilinear density.
namespace mezzotint::test {

struct TensorSizes {
  std::size_t theta = 9, phi = 1;        ///< directions of the light
  double turn = 2.0 * std::numbers::pi;  ///< that phi covers, from −π
  std::size_t visible = 96, samples = 48, normals = 160;
};

struct TensorFieldBytes {
  std::string name;
  std::uint8_t type;
  std::vector<std::uint64_t> shape;
  std::string bytes;
};

template <class Number>
void append(std::string& bytes, Number number) {
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof number);
}

inline TensorFieldBytes float_field(std::string name, std::vector<std::uint64_t> shape,
                                    const std::vector<double>& numbers) {
  TensorFieldBytes field{std::move(name), 10, std::move(shape), {}};
  for (const double number : numbers) append(field.bytes, static_cast<float>(number));
  return field;
}

inline std::string packed(const std::vector<TensorFieldBytes>& fields) {
  std::uint64_t offset = 18;
  for (const auto& field : fields) offset += 2 + field.name.size() + 2 + 1 + 8 + 8 * field.shape.size();
  std::string head("tensor_file\0\1\0", 14), data;
  append(head, static_cast<std::uint32_t>(fields.size()));
  for (const auto& field : fields) {
    append(head, static_cast<std::uint16_t>(field.name.size()));
    head += field.name;
    append(head, static_cast<std::uint16_t>(field.shape.size()));
    append(head, field.type);
    append(head, offset + data.size());
    for (const std::uint64_t length : field.shape) append(head, length);
    data += field.bytes;
  }
  return head + data;
}

/// A density on the unit square, bilinear between nodes, and the square's own points sent through it.
class Bilinear {
public:
  Bilinear(std::size_t nodes, const std::function<double(double, double)>& density) : nodes_(nodes) {
    const double step = 1.0 / static_cast<double>(nodes - 1);
    for (std::size_t row = 0; row < nodes; ++row) {
      for (std::size_t column = 0; column < nodes; ++column)
        values_.push_back(density(static_cast<double>(column) * step, static_cast<double>(row) * step));
    }
    for (std::size_t row = 0; row < nodes; ++row)
      rows_.push_back(integral(line(static_cast<double>(row)), static_cast<double>(nodes - 1)));
  }
  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  /// The y below which a share of all lies, then the x below which a share of that row lies.
  [[nodiscard]] std::pair<double, double> warp(double share_x, double share_y) const {
    const double n = static_cast<double>(nodes_ - 1);
    const double y = bisect(rows_, share_y);
    return {bisect(line(y), share_x) / n, y / n};
  }

private:
  [[nodiscard]] std::vector<double> line(double y) const {
    const auto row = std::min(static_cast<std::size_t>(y), nodes_ - 2);
    const double share = y - static_cast<double>(row);
    std::vector<double> result;
    for (std::size_t c = 0; c < nodes_; ++c)
      result.push_back((1.0 - share) * values_[row * nodes_ + c] + share * values_[(row + 1) * nodes_ + c]);
    return result;
  }
  // ∫ of the piecewise linear function from 0 to `to`.
  static double integral(const std::vector<double>& nodes, double to) {
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      const double t = std::min(1.0, to - static_cast<double>(i));
      if (t <= 0.0) break;
      sum += t * (nodes[i] + 0.5 * t * (nodes[i + 1] - nodes[i]));
    }
    return sum;
  }
  static double bisect(const std::vector<double>& nodes, double share) {
    double low = 0.0, high = static_cast<double>(nodes.size() - 1);
    const double wanted = share * integral(nodes, high);
    for (int i = 0; i < 48; ++i) {
      const double middle = 0.5 * (low + high);
      (integral(nodes, middle) < wanted ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
  std::size_t nodes_;
  std::vector<double> values_, rows_;
};

inline double theta_of_unit(double u) { return u * u * std::numbers::pi / 2.0; }
inline double phi_of_unit(double u) { return (2.0 * u - 1.0) * std::numbers::pi; }

/// The fields of a file for a lobe on a mirror: R, G, B are 1, ½ and ¼ of it.
inline std::vector<TensorFieldBytes> tensor_of(const MicrofacetLobe& lobe, const TensorSizes& sizes) {
  const bool isotropic = sizes.phi == 1;
  const auto direction = [](double theta, double phi) {
    return to_direction({Angle::from_radians(theta), Angle::from_radians(phi)});
  };
  const auto sigma = [&](const Direction& d) { return std::max(d.z(), 0.0) * (1.0 + smith_lambda(lobe, d)); };
  std::vector<double> thetas, phis, normals, areas, visible, samples;
  std::string valid;
  for (std::size_t t = 0; t < sizes.theta; ++t)
    thetas.push_back(80.0 / 180.0 * std::numbers::pi * static_cast<double>(t) / static_cast<double>(sizes.theta - 1));
  for (std::size_t p = 0; p < sizes.phi; ++p) {
    const double share = isotropic ? 0.0 : static_cast<double>(p) / static_cast<double>(sizes.phi - 1);
    phis.push_back(isotropic ? 0.0 : -std::numbers::pi + sizes.turn * share);
  }
  const std::size_t n = sizes.normals;
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t column = 0; column < n; ++column) {
      const double step = 1.0 / static_cast<double>(n - 1);
      const Direction d =
          direction(theta_of_unit(static_cast<double>(column) * step), phi_of_unit(static_cast<double>(row) * step));
      normals.push_back(distribution(lobe, d));
      areas.push_back(column + 1 == n ? areas.back() : sigma(d));
    }
  }
  for (const double phi : phis) {
    for (const double theta : thetas) {
      const Direction light = direction(theta, phi);
      const double turned = isotropic ? phi : 0.0;
      const Bilinear density(sizes.visible, [&](double x, double y) {
        const Direction m = direction(theta_of_unit(x), phi_of_unit(y) + turned);
        return distribution(lobe, m) * std::max(0.0, light.dot(m)) * std::sin(theta_of_unit(x)) * x;
      });
      visible.insert(visible.end(), density.values().begin(), density.values().end());
      std::vector<double> lobe_samples;
      for (std::size_t row = 0; row < sizes.samples; ++row) {
        for (std::size_t column = 0; column < sizes.samples; ++column) {
          const double step = 1.0 / static_cast<double>(sizes.samples - 1);
          const auto [x, y] = density.warp(static_cast<double>(column) * step, static_cast<double>(row) * step);
          const Direction m = direction(theta_of_unit(x), phi_of_unit(y) + turned);
          const Direction viewer = 2.0 * light.dot(m) * m - light;
          const bool above = viewer.z() > 1e-3 && distribution(lobe, m) > 1e-30;
          valid += static_cast<char>(above ? 1 : 0);
          lobe_samples.push_back(above ? brdf(lobe, Mirror{}, light, viewer) * viewer.z() * 4.0 * sigma(light) /
                                             distribution(lobe, m)
                                       : 0.0);
        }
      }
      for (const double channel : {1.0, 0.5, 0.25}) {
        for (const double sample : lobe_samples) samples.push_back(channel * sample);
      }
    }
  }
  const std::string text = "Analytic lobe";
  return {{"description", 1, {text.size()}, text},
          float_field("phi_i", {phis.size()}, phis),
          float_field("theta_i", {thetas.size()}, thetas),
          float_field("ndf", {n, n}, normals),
          float_field("sigma", {n, n}, areas),
          float_field("vndf", {phis.size(), thetas.size(), sizes.visible, sizes.visible}, visible),
          float_field("rgb", {phis.size(), thetas.size(), 3, sizes.samples, sizes.samples}, samples),
          {"valid", 1, {phis.size(), thetas.size(), sizes.samples, sizes.samples}, valid},
          {"jacobian", 1, {1}, std::string(1, '\1')}};
}

}  // namespace mezzotint::test
