#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/gwy_field.h"
#include "measurement/formats/height_assembly.h"
#include "measurement/formats/parsers.h"
#include "measurement/formats/text_values.h"

namespace mezzotint {

namespace {

constexpr std::string_view magic = "GWYP";

// N of "/N/data".
std::optional<std::uint32_t> channel_of(const GwyComponent& component) {
  std::string_view name = component.name;
  if (component.object_type != "GwyDataField" || !name.starts_with('/') || !name.ends_with("/data")) return {};
  name = name.substr(1, name.size() - 6);
  std::uint32_t channel = 0;
  const auto [end, problem] = std::from_chars(name.data(), name.data() + name.size(), channel);
  if (problem != std::errc() || end != name.data() + name.size()) return {};
  return component.name == fmt::format("/{}/data", channel) ? std::optional(channel) : std::nullopt;
}

struct Channel {
  std::optional<GwyField> heights, mask;
  std::string title;
  std::map<std::string, std::string> meta;
};

std::map<std::string, std::string> read_meta(const GwyComponent& component) {
  constexpr std::size_t most_entries = 1000;
  std::map<std::string, std::string> meta;
  for_each_component(component.payload, [&](const GwyComponent& entry) {
    if (entry.type == 's' && meta.size() < most_entries) meta[clean_text(entry.name)] = clean_text(gwy_text(entry));
  });
  return meta;
}

ByteReader open_container(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  if (!looks_like_gwy(bytes)) {
    throw FileError(path, "byte 0",
                    "a .gwy file begins with \"GWYP\" (files of Gwyddion 1 are not read; save it anew)");
  }
  ByteReader reader(path, bytes);
  reader.take(magic.size(), "the first word");
  if (reader.take_text("the type of the outermost object") != "GwyContainer") {
    throw FileError(path, byte_place(magic.size()), "the outermost object must be a GwyContainer");
  }
  const auto size = reader.take_number<std::uint32_t>("the size of the outermost object");
  return reader.take_part(size, "the outermost object");
}

std::vector<std::uint32_t> channels_of(const std::filesystem::path& path, const ByteReader& container) {
  std::vector<std::uint32_t> channels;
  for_each_component(container, [&](const GwyComponent& component) {
    if (const auto channel = channel_of(component)) channels.push_back(*channel);
  });
  if (channels.empty()) {
    throw FileError(path, "", "holds no height image; a GwyDataField named /0/data (or /1/data, …) is needed");
  }
  std::sort(channels.begin(), channels.end());
  return channels;
}

std::string list_of(const std::vector<std::uint32_t>& channels) {
  constexpr std::size_t most_listed = 20;
  std::string list;
  for (std::size_t i = 0; i < std::min(channels.size(), most_listed); ++i) {
    list += fmt::format("{}/{}/data", list.empty() ? "" : ", ", channels[i]);
  }
  return channels.size() > most_listed ? list + ", …" : list;
}

// The one that is asked for, or the first.
std::uint32_t chosen_channel(const std::filesystem::path& path, const std::vector<std::uint32_t>& channels,
                             const std::optional<std::uint32_t>& wanted, std::string& assumption) {
  if (wanted) {
    if (std::find(channels.begin(), channels.end(), *wanted) != channels.end()) return *wanted;
    throw FileError(path, fmt::format("/{}/data", *wanted),
                    fmt::format("there is no such channel; there are {}", list_of(channels)));
  }
  if (channels.size() > 1) {
    add_assumption(assumption, fmt::format("the first of {} channels is read ({}); FILE#/N/data reads another",
                                           channels.size(), list_of(channels)));
  }
  return channels.front();
}

Channel read_channel(const ByteReader& container, std::uint32_t number) {
  const std::string prefix = fmt::format("/{}/", number);
  Channel channel;
  for_each_component(container, [&](const GwyComponent& component) {
    if (!component.name.starts_with(prefix)) return;
    const std::string_view name = component.name.substr(prefix.size());
    if (name == "data") channel.heights = read_gwy_field(component);
    if (name == "mask" && component.type == 'o') channel.mask = read_gwy_field(component);
    if (name == "data/title" && component.type == 's') channel.title = clean_text(gwy_text(component));
    if (name == "meta" && component.type == 'o') channel.meta = read_meta(component);
  });
  return channel;
}

double checked_unit(const std::filesystem::path& path, const GwyField& field, const std::string& unit,
                    std::string_view axis, std::string& assumption) {
  const auto metres = metres_of_unit(unit);
  if (!metres) {
    throw FileError(path, byte_place(field.offset),
                    fmt::format("the {} unit is \"{}\"; m, mm, µm, nm or pm is needed", axis, unit));
  }
  if (unit.empty()) add_assumption(assumption, fmt::format("no {} unit: metres assumed", axis));
  return *metres;
}

Continuation take_continuation(Channel& channel, std::string& assumption) {
  const auto entry = channel.meta.find(std::string(gwy_continuation_key));
  if (entry == channel.meta.end()) return Continuation::Mirrored;
  const bool periodic = entry->second == gwy_periodic_entry(channel.heights->columns, channel.heights->rows);
  if (!periodic) {
    add_assumption(assumption, fmt::format("says \"{}\" but has {} × {} samples: taken as not periodic", entry->second,
                                           channel.heights->columns, channel.heights->rows));
  }
  channel.meta.erase(entry);
  return periodic ? Continuation::Periodic : Continuation::Mirrored;
}

void require_matching_mask(const std::filesystem::path& path, const GwyField& heights, const GwyField& mask) {
  if (mask.columns == heights.columns && mask.rows == heights.rows) return;
  throw FileError(path, byte_place(mask.offset),
                  fmt::format("the mask has {} × {} samples; the {} × {} of the heights are needed", mask.columns,
                              mask.rows, heights.columns, heights.rows));
}

}  // namespace

bool looks_like_gwy(std::span<const std::byte> bytes) { return begins_with(bytes, magic); }

// Source   Gwyddion user guide, "Gwyddion native format".
SurfaceFile parse_gwy_channel(const std::filesystem::path& path, std::span<const std::byte> bytes,
                              const std::optional<std::uint32_t>& wanted) {
  const ByteReader container = open_container(path, bytes);
  std::string assumption;
  const std::uint32_t number = chosen_channel(path, channels_of(path, container), wanted, assumption);
  Channel channel = read_channel(container, number);
  const std::string place = fmt::format("/{}/data", number);
  const GwyField& heights = *channel.heights;
  const double lateral = checked_unit(path, heights, heights.lateral_unit, "lateral", assumption);
  const double vertical = checked_unit(path, heights, heights.value_unit, "height", assumption);
  const Grid grid =
      checked_grid(path, place,
                   {heights.columns, heights.rows, heights.width * lateral / static_cast<double>(heights.columns),
                    heights.height * lateral / static_cast<double>(heights.rows)});
  if (channel.mask) require_matching_mask(path, heights, *channel.mask);
  const Continuation continuation = take_continuation(channel, assumption);
  const auto height_m = [&heights, vertical](std::size_t i) {
    const double z = heights.value(i) * vertical;
    return std::isfinite(z) ? z : std::numeric_limits<double>::quiet_NaN();
  };
  const auto unmasked_m = [&](std::size_t i) {
    return channel.mask->value(i) >= 0.5 ? std::numeric_limits<double>::quiet_NaN() : height_m(i);
  };
  // Gwyddion shows the first row on top.
  HeightField field = channel.mask ? assemble_heights(path, place, grid, FirstRow::Top, continuation, unmasked_m)
                                   : assemble_heights(path, place, grid, FirstRow::Top, continuation, height_m);
  return {std::move(field), "gwy", channel.title, std::move(channel.meta), assumption};
}

SurfaceFile parse_gwy(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  return parse_gwy_channel(path, bytes, std::nullopt);
}

}  // namespace mezzotint
