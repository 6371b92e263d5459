#include <fmt/format.h>

#include <cmath>

#include "fabrication/job/checked_json.h"
#include "fabrication/job/uvj_layout.h"

namespace mezzotint {

namespace {

// Millimetres of a file to micrometres on a grid of picometres, so that 0.018 mm is 18 µm to the last bit.
Length from_file_mm(double mm) { return Length::from_um(std::round(mm * 1e9) / 1e6); }

// What the exposure table says of one layer: its own entry, else that of its group.
struct ExposureTable {
  CheckedJson normal;
  CheckedJson bottom;
  std::size_t bottom_count;
  std::optional<CheckedJson> layers;

  [[nodiscard]] const CheckedJson& group(std::size_t layer) const { return layer < bottom_count ? bottom : normal; }

  [[nodiscard]] CheckedJson value(std::size_t layer, const char* key) const {
    if (layers && layers->element(layer).has("Exposure")) {
      const CheckedJson own = layers->element(layer).at("Exposure");
      if (own.has(key)) return own.at(key);
    }
    return group(layer).at(key);
  }

  [[nodiscard]] double seconds(std::size_t layer) const { return value(layer, "LightOnTime").positive(); }

  // Full intensity where the file is silent, as the standard says.
  [[nodiscard]] int led_amplitude(std::size_t layer) const {
    const bool own =
        layers && layers->element(layer).has("Exposure") && layers->element(layer).at("Exposure").has("LightPWM");
    if (!own && !group(layer).has("LightPWM")) return 255;
    return static_cast<int>(value(layer, "LightPWM").whole(1, 255));
  }
};

ExposureTable exposure_table(const CheckedJson& root, std::size_t layer_count) {
  const CheckedJson properties = root.at("Properties");
  const CheckedJson bottom = properties.at("Bottom");
  ExposureTable table{properties.at("Exposure"), bottom, bottom.at("Count").whole(0, largest_layer_count), {}};
  if (!root.has("Layers") || root.at("Layers").value().is_null()) return table;
  const CheckedJson layers = root.at("Layers");
  const std::size_t entries = layers.array_size();
  if (entries != 0 && entries != layer_count) {
    layers.refuse(fmt::format("has {} entries; \"Properties.Size.Layers\" says {}", entries, layer_count));
  }
  if (entries != 0) table.layers.emplace(layers);
  return table;
}

void read_size(const CheckedJson& size, Job& job, const MemberPlace& place) {
  job.columns = size.at("X").whole(1, largest_job_side);
  job.rows = size.at("Y").whole(1, largest_job_side);
  if (job.columns * job.rows > largest_layer_pixels) {
    place.refuse(fmt::format("layers of {} x {} pixels; up to 2^28 are read", job.columns, job.rows));
  }
  job.layer = from_file_mm(size.at("LayerHeight").positive());
  const double pitch_x_mm = size.at("Millimeter").at("X").positive() / static_cast<double>(job.columns);
  const double pitch_y_mm = size.at("Millimeter").at("Y").positive() / static_cast<double>(job.rows);
  job.pixel_pitch = from_file_mm(pitch_x_mm);
  // UVtools rounds the display's size to .01 mm: half of that over the whole picture is no other pitch.
  const double slack_mm = 0.006 / static_cast<double>(std::min(job.columns, job.rows));
  if (std::abs(pitch_x_mm - pitch_y_mm) > slack_mm)
    place.refuse("the pixels are not square; only square ones are read");
}

void read_layers(const CheckedJson& root, Job& job, std::size_t layer_count, const MemberPlace& place) {
  const ExposureTable table = exposure_table(root, layer_count);
  const bool lower_faces = table.layers && table.layers->element(0).at("Z").at_least_zero() == 0.0;
  job.led_amplitude = table.led_amplitude(0);
  job.layers.resize(layer_count);
  for (std::size_t i = 0; i < layer_count; ++i) {
    JobLayer& layer = job.layers[i];
    layer.exposure_s = table.seconds(i);
    if (table.led_amplitude(i) != job.led_amplitude) {
      place.refuse(fmt::format("layer {} has another \"LightPWM\" than the first; one for all layers is read", i));
    }
    const Length lower = lower_faces ? job.layer : Length{};
    layer.top = table.layers ? from_file_mm(table.layers->element(i).at("Z").at_least_zero()) + lower
                             : job.layer * static_cast<double>(i + 1);
    if (!(layer.top > (i == 0 ? Length{} : job.layers[i - 1].top))) {
      place.refuse(fmt::format("\"Layers[{}].Z\" does not lie above the layer before it", i));
    }
  }
}

}  // namespace

Job read_config(std::span<const std::byte> text, const MemberPlace& place) {
  const nlohmann::json json = parse_json_object(text, place);
  const CheckedJson root(json, "", place);
  const CheckedJson size = root.at("Properties").at("Size");
  Job job;
  read_size(size, job, place);
  const std::size_t layer_count = size.at("Layers").whole(1, largest_layer_count);
  read_layers(root, job, layer_count, place);
  return job;
}

MemberHashes read_manifest(std::span<const std::byte> text, const MemberPlace& place, Job& job) {
  const nlohmann::json json = parse_json_object(text, place);
  const CheckedJson root(json, "", place);
  if (root.at("format").text() != "mezzotint print job") place.refuse("is not the manifest of a mezzotint print job");
  if (root.at("version").whole(0, 1000000) != 1) place.refuse("is of another version; version 1 is read");
  if (root.at("first_row").text() != "y_max") place.refuse("\"first_row\" must be \"y_max\"");
  if (root.at("gray_bits").whole(1, 64) != 8) place.refuse("\"gray_bits\" must be 8");
  const Length pitch = Length::from_um(root.at("pixel_pitch_um").positive());
  const Length layer = Length::from_um(root.at("layer_um").positive());
  // config.json holds both in mm, the pitch times the number of pixels: rounding only.
  if (std::abs(pitch / job.pixel_pitch - 1.0) > 1e-6) place.refuse("\"pixel_pitch_um\" disagrees with config.json");
  if (std::abs(layer / job.layer - 1.0) > 1e-6) place.refuse("\"layer_um\" disagrees with config.json");
  job.pixel_pitch = pitch;
  job.layer = layer;
  job.name = root.at("name").text();
  if (root.has("led_amplitude")) job.led_amplitude = static_cast<int>(root.at("led_amplitude").whole(1, 255));
  job.printer = root.at("printer").text();
  MemberHashes hashes;
  const CheckedJson listed = root.at("sha256");
  if (!listed.value().is_object()) listed.refuse("must be an object");
  for (const auto& [name, hash] : listed.value().items()) hashes[name] = listed.at(name).text();
  return hashes;
}

}  // namespace mezzotint
