#include "forward/optics/bsdf.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/base/file_output.h"
#include "forward/optics/exr_input.h"

namespace mezzotint {

namespace {

namespace fs = std::filesystem;

constexpr const char* prefix = "mezzotint:";
constexpr const char* provenance_prefix = "mezzotint:provenance.";
constexpr std::size_t longest_key = 200;  // OpenEXR's names have 255 characters at most

std::string order_name(std::size_t order) { return "reflection.order_" + std::to_string(order + 1); }

bool has_intervals(const Bsdf& bsdf) { return !bsdf.reflection.low_95.empty(); }

// One list of what the file holds, for the writer and the reader.
template <class B>  // Bsdf or const Bsdf
auto channels_of(B& bsdf) {
  const auto entry = [](std::string name, auto& map) { return std::pair(std::move(name), &map); };
  std::vector channels{entry("reflection", bsdf.reflection.mean),
                       entry("reflection.standard_error", bsdf.reflection.standard_error),
                       entry("reflection.half_a", bsdf.reflection.half_a),
                       entry("reflection.half_b", bsdf.reflection.half_b),
                       entry("transmission", bsdf.transmission.mean),
                       entry("transmission.standard_error", bsdf.transmission.standard_error),
                       entry("transmission.half_a", bsdf.transmission.half_a),
                       entry("transmission.half_b", bsdf.transmission.half_b)};
  if (has_intervals(bsdf)) {
    channels.push_back(entry("reflection.low_95", bsdf.reflection.low_95));
    channels.push_back(entry("reflection.high_95", bsdf.reflection.high_95));
    channels.push_back(entry("transmission.low_95", bsdf.transmission.low_95));
    channels.push_back(entry("transmission.high_95", bsdf.transmission.high_95));
  }
  for (std::size_t k = 0; k < bsdf.reflection_orders.size(); ++k) {
    channels.push_back(entry(order_name(k), bsdf.reflection_orders[k].mean));
    channels.push_back(entry(order_name(k) + ".standard_error", bsdf.reflection_orders[k].standard_error));
  }
  return channels;
}

template <class Audit>  // EnergyAudit or const EnergyAudit
auto shares_of(Audit& energy) {
  const auto entry = [](const char* name, auto& share) {
    return std::pair<std::string, decltype(&share)>(std::string(prefix) + "energy." + name, &share);
  };
  return std::array{entry("reflected", energy.reflected), entry("transmitted", energy.transmitted),
                    entry("absorbed", energy.absorbed), entry("left_sideways", energy.left_sideways),
                    entry("cut_off", energy.cut_off)};
}

void require_writable(const Bsdf& bsdf) {
  require_valid(bsdf.grid);
  for (const auto& [name, map] : channels_of(bsdf)) {
    require(map->size() == bsdf.grid.size(),
            fmt::format("the map \"{}\" has {} values, its grid {} bins", name, map->size(), bsdf.grid.size()));
  }
  for (const auto& [key, value] : bsdf.provenance) {
    require(!key.empty() && key.size() <= longest_key && key.find('\0') == std::string::npos,
            fmt::format("the provenance key \"{}\" is not 1 to {} characters long", key, longest_key));
  }
}

void set_number(OIIO::ImageSpec& spec, const std::string& name, double value) {
  spec.attribute(name, OIIO::TypeDesc::DOUBLE, &value);
}

OIIO::ImageSpec spec_of(const Bsdf& bsdf) {
  OIIO::ImageSpec spec(static_cast<int>(bsdf.grid.width), static_cast<int>(bsdf.grid.height), 0, OIIO::TypeDesc::FLOAT);
  for (const auto& [name, map] : channels_of(bsdf)) spec.channelnames.push_back(name);
  spec.nchannels = static_cast<int>(spec.channelnames.size());
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "");  // otherwise the time of writing: the same result shall give the same bytes
  spec.attribute(std::string(prefix) + "first_line", "y = -1");
  set_number(spec, std::string(prefix) + "incidence_theta_deg", bsdf.incidence.theta.degrees());
  set_number(spec, std::string(prefix) + "incidence_phi_deg", bsdf.incidence.phi.degrees());
  for (const auto& [name, share] : shares_of(bsdf.energy)) {
    set_number(spec, name, share->value);
    set_number(spec, name + ".standard_error", share->standard_error);
  }
  for (const auto& [key, value] : bsdf.provenance) {
    if (!value.empty()) spec.attribute(provenance_prefix + key, value);  // OpenImageIO's reader drops empty text
  }
  return spec;
}

std::vector<float> interleaved(const Bsdf& bsdf) {
  const auto channels = channels_of(bsdf);
  std::vector<float> pixels(bsdf.grid.size() * channels.size());
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const DirectionMap& map = *channels[c].second;
    for (std::size_t k = 0; k < map.size(); ++k) pixels[k * channels.size() + c] = static_cast<float>(map[k]);
  }
  return pixels;
}

double number_at(const OIIO::ImageSpec& spec, const std::string& name, const fs::path& path) {
  const OIIO::ParamValue* value = spec.find_attribute(name, OIIO::TypeDesc::DOUBLE);
  if (value == nullptr)
    throw FileError(path, "header", "lacks the number \"" + name + "\"; is it a BSDF of Mezzotint?");
  return value->get<double>();
}

void read_attributes(const OIIO::ImageSpec& spec, const fs::path& path, Bsdf& bsdf) {
  bsdf.incidence.theta = Angle::from_degrees(number_at(spec, std::string(prefix) + "incidence_theta_deg", path));
  bsdf.incidence.phi = Angle::from_degrees(number_at(spec, std::string(prefix) + "incidence_phi_deg", path));
  for (const auto& [name, share] : shares_of(bsdf.energy)) {
    *share = {number_at(spec, name, path), number_at(spec, name + ".standard_error", path)};
  }
  const std::string_view marker = provenance_prefix;
  for (const OIIO::ParamValue& value : spec.extra_attribs) {
    const std::string name = value.name().string();
    if (name.starts_with(marker)) bsdf.provenance[name.substr(marker.size())] = value.get_string(0);
  }
}

// So many maps by order of interaction does the file hold.
std::size_t order_count(const OIIO::ImageSpec& spec) {
  std::size_t count = 0;
  const auto& names = spec.channelnames;
  while (count < 64 && std::find(names.begin(), names.end(), order_name(count)) != names.end()) ++count;
  return count;
}

// So that the list of channels names the intervals, where the file holds them.
void expect_intervals(const OIIO::ImageSpec& spec, Bsdf& bsdf) {
  const auto& names = spec.channelnames;
  if (std::find(names.begin(), names.end(), "reflection.low_95") != names.end()) bsdf.reflection.low_95.resize(1);
}

void read_channels(const OIIO::ImageSpec& spec, const std::vector<float>& pixels, const fs::path& path, Bsdf& bsdf) {
  const auto stride = static_cast<std::size_t>(spec.nchannels);
  for (const auto& [name, map] : channels_of(bsdf)) {
    const auto found = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
    if (found == spec.channelnames.end()) throw FileError(path, "header", "lacks the channel \"" + name + "\"");
    const auto channel = static_cast<std::size_t>(found - spec.channelnames.begin());
    map->resize(bsdf.grid.size());
    for (std::size_t k = 0; k < map->size(); ++k) (*map)[k] = double{pixels[k * stride + channel]};
  }
}

}  // namespace

void write_exr(const Bsdf& bsdf, const fs::path& path) {
  require_writable(bsdf);
  const OIIO::ImageSpec spec = spec_of(bsdf);
  const std::vector<float> pixels = interleaved(bsdf);
  write_aside(path, [&](const fs::path& temporary) {
    // By the format's name: the ending of the path is the caller's affair.
    const std::unique_ptr<OIIO::ImageOutput> file = OIIO::ImageOutput::create("exr");
    if (!file) throw DeviceError("cannot write " + path.string() + ": OpenImageIO has no OpenEXR here");
    if (!file->open(temporary.string(), spec) || !file->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) ||
        !file->close()) {
      throw DeviceError("cannot write " + path.string() + ": " + file->geterror());
    }
  });
}

Bsdf read_exr(const fs::path& path) {
  const auto [bytes, memory, file, spec] = open_exr(path);
  Bsdf bsdf;
  bsdf.grid = {static_cast<std::size_t>(spec.width), static_cast<std::size_t>(spec.height)};
  read_attributes(spec, path, bsdf);
  bsdf.reflection_orders.resize(order_count(spec));
  expect_intervals(spec, bsdf);
  std::vector<float> pixels(bsdf.grid.size() * static_cast<std::size_t>(spec.nchannels));
  if (!file->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data())) {
    throw FileError(path, "pixels", "cannot be read whole; the file is truncated or damaged: " + file->geterror());
  }
  read_channels(spec, pixels, path, bsdf);
  return bsdf;
}

}  // namespace mezzotint
