#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/byte_reader.h"
#include "measurement/formats/text_values.h"
#include "measurement/reflectance/reflectance_parsers.h"
#include "measurement/reflectance/tensor_file.h"

namespace mezzotint {

namespace {

using Fields = std::map<std::string, TensorField>;
using Shape = std::vector<std::size_t>;

constexpr double pi = std::numbers::pi;

class TensorReader {
public:
  TensorReader(const std::filesystem::path& path, std::span<const std::byte> bytes)
      : path_(path), fields_(tensor_fields(path, bytes)) {}

  [[nodiscard]] const TensorField* find(const std::string& name) const {
    const auto found = fields_.find(name);
    return found == fields_.end() ? nullptr : &found->second;
  }
  [[nodiscard]] const TensorField& field(const std::string& name) const {
    if (const TensorField* found = find(name)) return *found;
    throw FileError(path_, "", fmt::format("has no field \"{}\"; it is a tensor file, but no BRDF of RGL", name));
  }
  /// A field of floats; `any` in a shape stands for any length.
  [[nodiscard]] const TensorField& floats(const std::string& name, const Shape& wanted) const {
    const TensorField& field = this->field(name);
    if (field.type != TensorField::Type::Float32) fail(field, 0, fmt::format("\"{}\" must hold 32-bit floats", name));
    const bool fits = std::equal(field.shape.begin(), field.shape.end(), wanted.begin(), wanted.end(),
                                 [](std::size_t has, std::size_t wants) { return wants == any || has == wants; });
    if (!fits)
      fail(field, 0, fmt::format("\"{}\" has shape {}, which does not fit the other fields", name, words(field)));
    return field;
  }
  static constexpr std::size_t any = 0;

  /// The numbers of a field; complains about those that `is_good` refuses.
  template <class Check>
  [[nodiscard]] std::vector<float> values(const std::string& name, const Shape& wanted, const Check& is_good,
                                          const char* rule) const {
    const TensorField& field = floats(name, wanted);
    std::vector<float> result(field.bytes.size() / sizeof(float));
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i] = little_endian<float>(field.bytes.data() + i * sizeof(float));
      if (!is_good(result[i]))
        fail(field, i * sizeof(float), fmt::format("\"{}\" holds {}; {}", name, result[i], rule));
    }
    return result;
  }
  [[nodiscard]] UnitSquareGrid grid(const std::string& name, const Shape& wanted) const {
    const auto is_good = [](float value) { return std::isfinite(value) && value >= 0.0F; };
    UnitSquareGrid result{0, 0, values(name, wanted, is_good, "its numbers must be finite and not negative")};
    set_size(result, name);
    return result;
  }
  void set_size(UnitSquareGrid& grid, const std::string& name) const {
    const TensorField& field = this->field(name);
    grid.columns = field.shape.back();
    grid.rows = field.shape[field.shape.size() - 2];
    if (grid.columns < 2 || grid.rows < 2) fail(field, 0, fmt::format("\"{}\" needs two nodes a side or more", name));
  }
  /// Increasing angles within [low, high].
  [[nodiscard]] std::vector<double> angles(const std::string& name, double low, double high) const {
    double before = -HUGE_VAL;
    const auto is_good = [&](float value) {
      const bool good = double{value} > before && double{value} >= low - 1e-4 && double{value} <= high + 1e-4;
      before = double{value};
      return good;
    };
    const auto numbers = values(name, {any}, is_good, "its angles must increase and lie in range (radians)");
    return {numbers.begin(), numbers.end()};
  }
  [[noreturn]] void fail(const TensorField& field, std::size_t byte, const std::string& problem) const {
    throw FileError(path_, byte_place(static_cast<std::size_t>(field.offset) + byte), problem);
  }

private:
  static std::string words(const TensorField& field) {
    std::string text;
    for (const std::size_t length : field.shape) text += (text.empty() ? "" : " x ") + std::to_string(length);
    return text;
  }
  const std::filesystem::path& path_;
  Fields fields_;
};

std::string description_of(const TensorReader& reader) {
  const TensorField* field = reader.find("description");
  if (field == nullptr || field->type != TensorField::Type::UInt8) return "";
  return clean_text({reinterpret_cast<const char*>(field->bytes.data()), field->bytes.size()});
}

// A sample that was not measured is NaN from here on.
double apply_validity(const TensorReader& reader, AdaptiveTensor& tensor) {
  const TensorField* valid = reader.find("valid");
  const std::size_t nodes = tensor.samples.columns * tensor.samples.rows;
  const std::size_t slices = tensor.phi_i_rad.size() * tensor.theta_i_rad.size();
  if (valid == nullptr || valid->type != TensorField::Type::UInt8 || valid->bytes.size() != slices * nodes) return 1.0;
  const auto number = [](std::byte b) { return std::to_integer<int>(b); };
  if (std::ranges::any_of(valid->bytes, [&](std::byte b) { return number(b) > 1; })) return 1.0;
  std::size_t good = 0;
  for (std::size_t i = 0; i < valid->bytes.size(); ++i) {
    if (number(valid->bytes[i]) == 1) {
      ++good;
      continue;
    }
    for (std::size_t c = 0; c < tensor.channels; ++c)
      tensor.samples.values[(i / nodes * tensor.channels + c) * nodes + i % nodes] = std::nanf("");
  }
  return static_cast<double>(good) / static_cast<double>(valid->bytes.size());
}

int reduction_of(const TensorReader& reader, const std::vector<double>& phi) {
  const double turns = 2.0 * pi / (phi.back() - phi.front());
  const double rounded = std::round(turns);
  if (!(rounded == 1.0 || rounded == 2.0 || rounded == 4.0)) {
    reader.fail(reader.field("phi_i"), 0,
                fmt::format("\"phi_i\" covers {:.4g} radians; a turn, half or a quarter of one is understood",
                            phi.back() - phi.front()));
  }
  return static_cast<int>(rounded);
}

std::vector<MeasuredChannel> channels_of(const TensorReader& reader, bool spectral) {
  if (!spectral) return {{"R", {}}, {"G", {}}, {"B", {}}};
  double before = 0.0;
  const auto rising = [&before](float value) {
    const bool good = std::isfinite(value) && double{value} > before;
    before = double{value};
    return good;
  };
  std::vector<MeasuredChannel> channels;
  for (const float nm : reader.values("wavelengths", {TensorReader::any}, rising, "wavelengths must increase, in nm"))
    channels.push_back({fmt::format("{:.6g} nm", nm), Length::from_nm(double{nm})});
  return channels;
}

void read_samples(const TensorReader& reader, AdaptiveTensor& tensor, bool spectral) {
  const std::string name = spectral ? "spectra" : "rgb";
  const auto no_infinity = [](float value) { return !std::isinf(value); };
  tensor.samples.values = reader.values(
      name, {tensor.phi_i_rad.size(), tensor.theta_i_rad.size(), tensor.channels, TensorReader::any, TensorReader::any},
      no_infinity, "samples are finite, or NaN where nothing was measured");
  reader.set_size(tensor.samples, name);
}

AdaptiveTensor tensor_of(const TensorReader& reader, std::size_t channels, bool spectral) {
  AdaptiveTensor tensor;
  tensor.channels = channels;
  tensor.theta_i_rad = reader.angles("theta_i", 0.0, pi / 2.0);
  tensor.phi_i_rad = reader.angles("phi_i", -2.0 * pi, 2.0 * pi);
  tensor.isotropic = tensor.phi_i_rad.size() <= 2;
  if (!tensor.isotropic) tensor.reduction = reduction_of(reader, tensor.phi_i_rad);
  tensor.normals = reader.grid("ndf", {TensorReader::any, TensorReader::any});
  tensor.sigma = reader.grid("sigma", {TensorReader::any, TensorReader::any});
  tensor.visible =
      reader.grid("vndf", {tensor.phi_i_rad.size(), tensor.theta_i_rad.size(), TensorReader::any, TensorReader::any});
  read_samples(reader, tensor, spectral);
  return tensor;
}

}  // namespace

MeasuredReflectance parse_rgl(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  const TensorReader reader(path, bytes);
  const bool spectral = reader.find("spectra") != nullptr;
  MeasuredReflectance measured;
  measured.format = "RGL tensor";
  measured.quantity = "BRDF · cosθ_o in an adaptive parameterisation, divided by the cosine here";
  measured.channels = channels_of(reader, spectral);
  AdaptiveTensor tensor = tensor_of(reader, measured.channels.size(), spectral);
  try {
    integrate_visible(tensor);
  } catch (const InvalidInput& error) {
    reader.fail(reader.field("vndf"), 0, error.what());
  }
  const double valid = apply_validity(reader, tensor);
  measured.isotropic = tensor.isotropic;
  measured.between_incidences = true;
  const std::size_t turns = tensor.isotropic ? 1 : tensor.phi_i_rad.size();
  for (std::size_t p = 0; p < turns; ++p) {
    for (const double theta : tensor.theta_i_rad) {
      measured.incidences.push_back(
          {Angle::from_radians(theta), Angle::from_radians(tensor.isotropic ? 0.0 : tensor.phi_i_rad[p])});
    }
  }
  measured.provenance["description"] = description_of(reader);
  measured.provenance["valid_share"] = fmt::format("{:.4f}", valid);
  if (!spectral) measured.assumption = "R, G and B are linear, with the primaries of ITU-R BT.709";
  measured.data = std::move(tensor);
  return measured;
}

}  // namespace mezzotint
