#include "experiments/run/run_files.h"

#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "forward/base/file_output.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

Json quantity(double value, const char* unit, double standard_error) { return Quantity{value, unit, standard_error}; }

}  // namespace

Json to_json(const Registration& r) {
  return {{"shift_x", quantity(r.shift_x.value.um(), "µm", r.shift_x.standard_error.um())},
          {"shift_y", quantity(r.shift_y.value.um(), "µm", r.shift_y.standard_error.um())},
          {"rotation", quantity(r.rotation.value.degrees(), "°", r.rotation.standard_error.degrees())},
          {"correlation", r.correlation},
          {"runner_up", r.runner_up},
          {"overlap", r.overlap}};
}

Json to_json(const AreaRoughness& roughness) {
  return {{"Sa", roughness.Sa},   {"Sq", roughness.Sq},           {"Sz", roughness.Sz},
          {"Ssk", roughness.Ssk}, {"Sku", roughness.Sku},         {"Sdq", roughness.Sdq},
          {"Sdr", roughness.Sdr}, {"samples", roughness.samples}, {"missing", roughness.missing}};
}

Json read_json(const std::filesystem::path& path) {
  const auto bytes = read_file(path);
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  Json json = Json::parse(text, text + bytes.size(), nullptr, false);
  if (json.is_discarded()) throw FileError(path, "", "is not valid JSON");
  return json;
}

void write_json(const Json& json, const std::filesystem::path& path) { write_file(path, json.dump(2) + "\n"); }

}  // namespace mezzotint
