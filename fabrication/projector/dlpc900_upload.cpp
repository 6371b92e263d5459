#include "fabrication/projector/dlpc900_upload.h"

#include <algorithm>

#include "fabrication/projector/dlpc900_image.h"

namespace mezzotint::dlpc900 {
namespace {

constexpr std::size_t chunk_bytes = largest_data_bytes - 2;  // the data begins with its length

struct ImageCommands {
  Command start, data;
};
constexpr ImageCommands commands_of_controller[] = {{Command::PrimaryImageStart, Command::PrimaryImageData},
                                                    {Command::SecondaryImageStart, Command::SecondaryImageData}};

void upload_image(Link& link, const ImageCommands& commands, const std::vector<std::uint8_t>& image) {
  std::vector<std::uint8_t> start;
  append_number(start, 0, 2);  // the only image
  append_number(start, static_cast<std::uint32_t>(image.size()), 4);
  link.order(commands.start, start);
  for (std::size_t from = 0; from < image.size(); from += chunk_bytes) {
    const std::size_t count = std::min(chunk_bytes, image.size() - from);
    std::vector<std::uint8_t> data;
    append_number(data, static_cast<std::uint32_t>(count), 2);
    const auto first = image.begin() + static_cast<std::ptrdiff_t>(from);
    data.insert(data.end(), first, first + static_cast<std::ptrdiff_t>(count));
    link.order(commands.data, data);
  }
}

}  // namespace

std::vector<std::vector<std::uint8_t>> encode_halves(const ShownPicture& picture, std::size_t controllers) {
  std::vector<std::vector<std::uint8_t>> images;
  const std::size_t columns = picture.columns / controllers;
  for (std::size_t c = 0; c < controllers; ++c) {
    const PlaneView plane{picture.gray, picture.columns, c * columns};
    images.push_back(encode_image_smallest(pack_planes(columns, picture.rows, {plane, {}, {}})));
  }
  return images;
}

UploadEstimate estimate_upload(const std::vector<std::vector<std::uint8_t>>& images) {
  UploadEstimate estimate;
  std::size_t reports = 0;
  for (const auto& image : images) {
    estimate.bytes += image.size();
    const std::size_t whole = image.size() / chunk_bytes, rest = image.size() % chunk_bytes;
    const auto reports_of = [](std::size_t bytes) {
      return (header_bytes + 4 + bytes + report_bytes - 1) / report_bytes;
    };
    reports += 2 + whole * (reports_of(chunk_bytes) + 1) + (rest > 0 ? reports_of(rest) + 1 : 0);
  }
  estimate.duration = std::chrono::milliseconds(reports);
  return estimate;
}

void upload(Link& link, const std::vector<std::vector<std::uint8_t>>& images) {
  for (std::size_t c = 0; c < images.size(); ++c) {
    for (int attempt = 1;; ++attempt) {
      try {
        upload_image(link, commands_of_controller[c], images[c]);
        break;
      } catch (const LightEngineError& error) {
        if (error.fault() != LightFault::Timeout || attempt == 2) throw;
      }
    }
  }
}

}  // namespace mezzotint::dlpc900
