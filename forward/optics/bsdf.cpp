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
#include "forward/optics/exr_input.h"
#include "forward/optics/exr_output.h"

namespace mezzotint {

namespace {

namespace fs = std::filesystem;

// Of all names but those that three channels share.
constexpr const char* shared_prefix = "mezzotint:";
constexpr std::size_t longest_key = 200;  // OpenEXR's names have 255 characters at most

std::string order_name(std::size_t order) { return "reflection.order_" + std::to_string(order + 1); }

// What names of a channel's maps end in, and what those of its attributes begin with.
std::string ending_of(const std::string& channel) { return channel.empty() ? "" : "." + channel; }
std::string prefix_of(const std::string& channel) {
  return channel.empty() ? shared_prefix : shared_prefix + channel + ".";
}
std::string provenance_prefix(const std::string& channel) { return prefix_of(channel) + "provenance."; }

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
auto shares_of(Audit& energy, const std::string& channel) {
  const auto entry = [&](const char* name, auto& share) {
    return std::pair<std::string, decltype(&share)>(prefix_of(channel) + "energy." + name, &share);
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

void set_attributes(const Bsdf& bsdf, const std::string& channel, OIIO::ImageSpec& spec) {
  for (const auto& [name, share] : shares_of(bsdf.energy, channel)) {
    set_number(spec, name, share->value);
    set_number(spec, name + ".standard_error", share->standard_error);
  }
  for (const auto& [key, value] : bsdf.provenance) {
    if (!value.empty())
      spec.attribute(provenance_prefix(channel) + key, value);  // OpenImageIO's reader drops empty text
  }
}

OIIO::ImageSpec spec_of(std::span<const Bsdf> channels) {
  const Bsdf& first = channels.front();
  OIIO::ImageSpec spec(static_cast<int>(first.grid.width), static_cast<int>(first.grid.height), 0,
                       OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "");  // otherwise the time of writing: the same result shall give the same bytes
  spec.attribute(std::string(shared_prefix) + "first_line", "y = -1");
  set_number(spec, std::string(shared_prefix) + "incidence_theta_deg", first.incidence.theta.degrees());
  set_number(spec, std::string(shared_prefix) + "incidence_phi_deg", first.incidence.phi.degrees());
  if (channels.size() > 1) spec.attribute(std::string(shared_prefix) + "channels", "R, G, B");
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const std::string channel = channel_name(c, channels.size());
    for (const auto& [name, map] : channels_of(channels[c])) spec.channelnames.push_back(name + ending_of(channel));
    set_attributes(channels[c], channel, spec);
  }
  spec.nchannels = static_cast<int>(spec.channelnames.size());
  return spec;
}

std::vector<float> interleaved(std::span<const Bsdf> channels) {
  std::vector<const DirectionMap*> maps;
  for (const Bsdf& bsdf : channels)
    for (const auto& [name, map] : channels_of(bsdf)) maps.push_back(map);
  std::vector<float> pixels(channels.front().grid.size() * maps.size());
  for (std::size_t c = 0; c < maps.size(); ++c)
    for (std::size_t k = 0; k < maps[c]->size(); ++k) pixels[k * maps.size() + c] = static_cast<float>((*maps[c])[k]);
  return pixels;
}

void write_all(std::span<const Bsdf> channels, const fs::path& path) {
  for (const Bsdf& bsdf : channels) require_writable(bsdf);
  write_exr_picture(spec_of(channels), interleaved(channels), path);
}

double number_at(const OIIO::ImageSpec& spec, const std::string& name, const fs::path& path) {
  const OIIO::ParamValue* value = spec.find_attribute(name, OIIO::TypeDesc::DOUBLE);
  if (value == nullptr)
    throw FileError(path, "header", "lacks the number \"" + name + "\"; is it a BSDF of Mezzotint?");
  return value->get<double>();
}

void read_attributes(const OIIO::ImageSpec& spec, const std::string& channel, const fs::path& path, Bsdf& bsdf) {
  bsdf.incidence.theta = Angle::from_degrees(number_at(spec, std::string(shared_prefix) + "incidence_theta_deg", path));
  bsdf.incidence.phi = Angle::from_degrees(number_at(spec, std::string(shared_prefix) + "incidence_phi_deg", path));
  for (const auto& [name, share] : shares_of(bsdf.energy, channel)) {
    *share = {number_at(spec, name, path), number_at(spec, name + ".standard_error", path)};
  }
  const std::string marker = provenance_prefix(channel);
  for (const OIIO::ParamValue& value : spec.extra_attribs) {
    const std::string name = value.name().string();
    if (name.starts_with(marker)) bsdf.provenance[name.substr(marker.size())] = value.get_string(0);
  }
}

// So many maps by order of interaction does the file hold.
std::size_t order_count(const OIIO::ImageSpec& spec, const std::string& channel) {
  std::size_t count = 0;
  const auto& names = spec.channelnames;
  while (count < 64 && std::find(names.begin(), names.end(), order_name(count) + ending_of(channel)) != names.end())
    ++count;
  return count;
}

// So that the list of channels names the intervals, where the file holds them.
void expect_intervals(const OIIO::ImageSpec& spec, const std::string& channel, Bsdf& bsdf) {
  const auto& names = spec.channelnames;
  if (std::find(names.begin(), names.end(), "reflection.low_95" + ending_of(channel)) != names.end())
    bsdf.reflection.low_95.resize(1);
}

void read_maps(const OIIO::ImageSpec& spec, const std::vector<float>& pixels, const std::string& of_channel,
               const fs::path& path, Bsdf& bsdf) {
  const auto stride = static_cast<std::size_t>(spec.nchannels);
  for (const auto& [plain_name, map] : channels_of(bsdf)) {
    const std::string name = plain_name + ending_of(of_channel);
    const auto found = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
    if (found == spec.channelnames.end()) throw FileError(path, "header", "lacks the channel \"" + name + "\"");
    const auto channel = static_cast<std::size_t>(found - spec.channelnames.begin());
    map->resize(bsdf.grid.size());
    for (std::size_t k = 0; k < map->size(); ++k) (*map)[k] = double{pixels[k * stride + channel]};
  }
}

}  // namespace

std::string channel_name(std::size_t channel, std::size_t channels) {
  constexpr std::array names = {"R", "G", "B"};
  return channels == 1 ? "" : names.at(channel);
}

void write_exr(const Bsdf& bsdf, const fs::path& path) { write_all({&bsdf, 1}, path); }

void write_channels_exr(std::span<const Bsdf> channels, const fs::path& path) {
  require(channels.size() == 3, "a file of several channels has three, R, G and B");
  for (const Bsdf& bsdf : channels) {
    require(bsdf.grid == channels[0].grid && bsdf.reflection_orders.size() == channels[0].reflection_orders.size() &&
                bsdf.incidence.theta.radians() == channels[0].incidence.theta.radians() &&
                bsdf.incidence.phi.radians() == channels[0].incidence.phi.radians(),
            "the channels of one file have one grid, one direction of the light and the same orders");
  }
  write_all(channels, path);
}

std::vector<Bsdf> read_channels_exr(const fs::path& path) {
  const auto [bytes, memory, file, spec] = open_exr(path);
  const bool coloured = spec.find_attribute(std::string(shared_prefix) + "channels") != nullptr;
  std::vector<Bsdf> channels(coloured ? 3 : 1);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const std::string channel = channel_name(c, channels.size());
    channels[c].grid = {static_cast<std::size_t>(spec.width), static_cast<std::size_t>(spec.height)};
    read_attributes(spec, channel, path, channels[c]);
    channels[c].reflection_orders.resize(order_count(spec, channel));
    expect_intervals(spec, channel, channels[c]);
  }
  std::vector<float> pixels(channels[0].grid.size() * static_cast<std::size_t>(spec.nchannels));
  if (!file->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data())) {
    throw FileError(path, "pixels", "cannot be read whole; the file is truncated or damaged: " + file->geterror());
  }
  for (std::size_t c = 0; c < channels.size(); ++c)
    read_maps(spec, pixels, channel_name(c, channels.size()), path, channels[c]);
  return channels;
}

Bsdf read_exr(const fs::path& path) {
  std::vector<Bsdf> channels = read_channels_exr(path);
  if (channels.size() != 1) throw FileError(path, "header", "holds three channels, R, G and B; one is wanted here");
  return std::move(channels.front());
}

}  // namespace mezzotint
