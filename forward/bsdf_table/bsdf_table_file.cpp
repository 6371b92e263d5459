#include "forward/bsdf_table/bsdf_table_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/bsdf_table/bsdf_table_header.h"
#include "forward/optics/exr_input.h"
#include "forward/optics/exr_output.h"

namespace mezzotint {

namespace {

namespace fs = std::filesystem;

constexpr const char* header_name = "mezzotint:bsdf_table";
constexpr std::array<const char*, 2> map_names{"reflection", "transmission"};
constexpr std::array<const char*, 3> plane_names{"", ".standard_error", ".level"};

using MapMember = AdaptiveMap BsdfTableNode::*;
constexpr std::array<MapMember, 2> map_members{&BsdfTableNode::reflection, &BsdfTableNode::transmission};

// Pixel by pixel, channel by channel: how many maps a node has, and all numbers.
struct Picture {
  TableMosaic mosaic;
  std::size_t maps = 1;
  std::vector<float> pixels;

  [[nodiscard]] std::size_t channels() const { return maps * plane_names.size(); }
  [[nodiscard]] float* at(std::size_t node, std::size_t column, std::size_t row, std::size_t map) {
    return &pixels[mosaic.pixel(node, column, row) * channels() + map * plane_names.size()];
  }
  [[nodiscard]] const float* at(std::size_t node, std::size_t column, std::size_t row, std::size_t map) const {
    return &pixels[mosaic.pixel(node, column, row) * channels() + map * plane_names.size()];
  }
};

void put_map(const AdaptiveMap& map, std::size_t node, std::size_t which, Picture& picture) {
  for (std::size_t row = 0; row < picture.mosaic.map.height; ++row) {
    for (std::size_t column = 0; column < picture.mosaic.map.width; ++column) {
      const AdaptiveMap::Square square = map.at_bin(column, row);
      float* pixel = picture.at(node, column, row, which);
      pixel[0] = square.value;
      pixel[1] = square.standard_error;
      pixel[2] = static_cast<float>(square.level);
    }
  }
}

Picture picture_of(const BsdfTable& table) {
  Picture picture{{table.grid, table.nodes.size()}, 1, {}};
  const bool transmits = std::any_of(table.nodes.begin(), table.nodes.end(),
                                     [](const BsdfTableNode& node) { return !node.transmission.empty(); });
  if (transmits) picture.maps = 2;
  const TableMosaic& mosaic = picture.mosaic;
  require(mosaic.height() <= TableMosaic::most_bins_a_side,
          fmt::format("{} maps of {} x {} bins do not fit into one file of 4096 x 4096", mosaic.maps, mosaic.map.width,
                      mosaic.map.height));
  picture.pixels.resize(mosaic.width() * mosaic.height() * picture.channels());
  std::size_t place = 0;
  for (const IncidenceRing& ring : table.incidences.rings) {
    for (const std::size_t node : ring.nodes) {
      for (std::size_t k = 0; k < picture.maps; ++k) put_map(table.nodes[node].*map_members[k], place, k, picture);
      ++place;
    }
  }
  return picture;
}

OIIO::ImageSpec spec_of(const Picture& picture, const std::string& header) {
  OIIO::ImageSpec spec(static_cast<int>(picture.mosaic.width()), static_cast<int>(picture.mosaic.height()),
                       static_cast<int>(picture.channels()), OIIO::TypeDesc::FLOAT);
  spec.channelnames.clear();
  for (std::size_t k = 0; k < picture.maps; ++k) {
    for (const char* plane : plane_names) spec.channelnames.push_back(std::string(map_names[k]) + plane);
  }
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "");  // otherwise the time of writing: the same table shall give the same bytes
  spec.attribute("mezzotint:first_line", "y = -1");
  spec.attribute(header_name, header);
  return spec;
}

// The place of every channel, and of the header: an EXR keeps channels in the order of the alphabet.
std::vector<std::size_t> channel_places(const OIIO::ImageSpec& spec, std::size_t maps, const fs::path& path) {
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < maps; ++k) {
    for (const char* plane : plane_names) {
      const std::string name = std::string(map_names[k]) + plane;
      const auto found = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
      if (found == spec.channelnames.end()) throw FileError(path, "header", "lacks the channel \"" + name + "\"");
      places.push_back(static_cast<std::size_t>(found - spec.channelnames.begin()));
    }
  }
  return places;
}

void require_window(const OIIO::ImageSpec& spec, const TableMosaic& mosaic, const fs::path& path) {
  if (spec.width == static_cast<int>(mosaic.width()) && spec.height == static_cast<int>(mosaic.height())) return;
  throw FileError(path, "header",
                  fmt::format("is {} x {} pixels; its {} maps of {} x {} bins take {} x {}", spec.width, spec.height,
                              mosaic.maps, mosaic.map.width, mosaic.map.height, mosaic.width(), mosaic.height()));
}

Picture read_picture(OIIO::ImageInput& file, const OIIO::ImageSpec& spec, const BsdfTable& table,
                     const fs::path& path) {
  Picture picture{{table.grid, table.nodes.size()}, 1, {}};
  const bool transmits =
      std::find(spec.channelnames.begin(), spec.channelnames.end(), map_names[1]) != spec.channelnames.end();
  if (transmits) picture.maps = 2;
  const std::vector<std::size_t> places = channel_places(spec, picture.maps, path);
  if (static_cast<std::size_t>(spec.nchannels) != places.size()) throw FileError(path, "header", "has other channels");
  require_window(spec, picture.mosaic, path);
  std::vector<float> raw(picture.mosaic.width() * picture.mosaic.height() * places.size());
  if (!file.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, raw.data())) {
    throw FileError(path, "pixels", "cannot be read whole; the file is truncated or damaged: " + file.geterror());
  }
  picture.pixels.resize(raw.size());
  for (std::size_t k = 0; k < raw.size(); ++k) {
    picture.pixels[k] = raw[k / places.size() * places.size() + places[k % places.size()]];
  }
  return picture;
}

class MapReader {
public:
  MapReader(const Picture& picture, std::size_t node, std::size_t which, const fs::path& path)
      : picture_(picture), node_(node), which_(which), path_(path) {}

  AdaptiveMap read(const std::vector<double>& areas) const {
    AdaptiveMap map(picture_.mosaic.map, areas,
                    [&](std::size_t x, std::size_t y, unsigned level) { return square_of(x, y, level); });
    return map.integral() > 0.0 ? std::move(map) : AdaptiveMap();
  }

private:
  std::optional<AdaptiveMap::Square> square_of(std::size_t x, std::size_t y, unsigned level) const {
    const float* first = picture_.at(node_, x, y, which_);
    const auto is_number = [](float value) { return std::isfinite(value) && value >= 0.0F; };
    if (!is_number(first[0]) || !is_number(first[1])) fail("has a value that is negative or no number", x, y);
    const float own_level = first[2];
    if (level > 0 && own_level >= 0.0F && own_level < static_cast<float>(level)) return std::nullopt;
    if (own_level != static_cast<float>(level)) fail("has a level of joined bins that cannot be", x, y);
    require_alike(x, y, level);
    return AdaptiveMap::Square{first[0], first[1], level};
  }
  void require_alike(std::size_t x, std::size_t y, unsigned level) const {
    const std::size_t side = std::size_t{1} << level;
    const DirectionGrid& grid = picture_.mosaic.map;
    const float* first = picture_.at(node_, x, y, which_);
    for (std::size_t row = y; row < std::min(y + side, grid.height); ++row) {
      for (std::size_t column = x; column < std::min(x + side, grid.width); ++column) {
        if (!std::equal(first, first + plane_names.size(), picture_.at(node_, column, row, which_))) {
          fail("has joined bins that differ", column, row);
        }
      }
    }
  }
  [[noreturn]] void fail(const std::string& problem, std::size_t column, std::size_t row) const {
    throw FileError(path_, fmt::format("{}, map {}, bin ({}, {})", map_names[which_], node_, column, row), problem);
  }

  const Picture& picture_;
  std::size_t node_, which_;
  const fs::path& path_;
};

}  // namespace

void write_bsdf_table(const BsdfTable& table, const fs::path& path) {
  require_valid(table);
  const Picture picture = picture_of(table);
  write_exr_picture(spec_of(picture, to_header(table)), picture.pixels, path);
}

bool is_bsdf_table(const fs::path& path) {
  return !std::string(open_exr(path).spec.get_string_attribute(header_name)).empty();
}

BsdfTable read_bsdf_table(const fs::path& path) {
  const auto [bytes, memory, file, spec] = open_exr(path);
  const std::string header = spec.get_string_attribute(header_name);
  if (header.empty()) throw FileError(path, "header", "is no BSDF table of Mezzotint; it may hold a single BSDF");
  BsdfTable table = from_header(header, path);
  const Picture picture = read_picture(*file, spec, table, path);
  const std::vector<double> areas = projected_solid_angles(table.grid);
  for (std::size_t node = 0; node < table.nodes.size(); ++node) {
    for (std::size_t k = 0; k < picture.maps; ++k) {
      table.nodes[node].*map_members[k] = MapReader(picture, node, k, path).read(areas);
    }
  }
  return table;
}

}  // namespace mezzotint
