#include "fabrication/job/job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

void require_valid_layers(const Job& job) {
  Length below;
  for (std::size_t i = 0; i < job.layers.size(); ++i) {
    const JobLayer& layer = job.layers[i];
    require(layer.gray.size() == job.columns * job.rows,
            fmt::format("layer {} of the job has {} pixels; {} x {} are right", i, layer.gray.size(), job.columns,
                        job.rows));
    require(positive(layer.exposure_s), fmt::format("layer {} of the job needs a positive exposure", i));
    require(positive(layer.top.um()) && layer.top > below,
            fmt::format("layer {} of the job does not lie above the one before it", i));
    below = layer.top;
  }
}

// Base layers are white where the relief is, and dark around it.
JobLayer framed_layer(const GrayImage& relief, const PatchStackOptions& options, bool is_base) {
  const std::size_t columns = relief.columns + 2 * options.margin;
  const std::size_t rows = relief.rows + 2 * options.margin;
  JobLayer layer;
  layer.gray.assign(columns * rows, 0);
  for (std::size_t row = 0; row < relief.rows; ++row) {
    for (std::size_t column = 0; column < relief.columns; ++column) {
      const long level = is_base ? 255 : std::lround(255.0 * static_cast<double>(relief.at(column, row)));
      layer.gray[(row + options.margin) * columns + column + options.margin] = static_cast<std::uint8_t>(level);
    }
  }
  return layer;
}

void require_printable_patch(const GrayImage& relief, const PrinterProfile& profile, const PatchStackOptions& options) {
  require_valid(profile);
  require_valid(relief);
  require(profile.gray_levels <= 256,
          fmt::format("a job holds 8-bit pictures; the {} gray levels of the printer do not fit", profile.gray_levels));
  require(options.base_layers < largest_layer_count, "a job holds up to 100000 layers");
  const bool fits = options.margin <= largest_job_side && relief.columns + 2 * options.margin <= profile.pixels_x &&
                    relief.rows + 2 * options.margin <= profile.pixels_y;
  require(fits, fmt::format("a patch of {} x {} pixels with a margin of {} is larger than the printer's {} x {}",
                            relief.columns, relief.rows, options.margin, profile.pixels_x, profile.pixels_y));
}

}  // namespace

void require_valid(const Job& job) {
  require(
      job.columns >= 1 && job.rows >= 1 && job.columns <= largest_job_side && job.rows <= largest_job_side &&
          job.columns * job.rows <= largest_layer_pixels,
      fmt::format("a layer of {} x {} pixels; up to 65535 a side and 2^28 in all are allowed", job.columns, job.rows));
  require(!job.layers.empty() && job.layers.size() <= largest_layer_count,
          fmt::format("a job of {} layers; 1 to 100000 are allowed", job.layers.size()));
  require(job.layers.size() <= largest_job_pixels / (job.columns * job.rows), "a job of more than 2^32 pixels");
  require(positive(job.pixel_pitch.um()), "a job needs a positive pixel pitch");
  require(positive(job.layer.um()), "a job needs a positive layer thickness");
  require(job.led_amplitude >= 1 && job.led_amplitude <= 255, "the LED amplitude of a job must be within 1 and 255");
  require_valid_layers(job);
}

GrayImage layer_image(const Job& job, std::size_t index) {
  require(index < job.layers.size(), "the job has no such layer");
  GrayImage image{job.columns, job.rows, {}};
  image.values.reserve(job.layers[index].gray.size());
  for (const std::uint8_t level : job.layers[index].gray) image.values.push_back(static_cast<float>(level / 255.0));
  return image;
}

Job make_patch_job(const std::string& name, const GrayImage& relief, const PrinterProfile& profile,
                   const PatchStackOptions& options) {
  require_printable_patch(relief, profile, options);
  const GrayImage levels = quantize(relief, profile);
  Job job;
  job.name = name;
  job.printer = profile.name;
  job.columns = relief.columns + 2 * options.margin;
  job.rows = relief.rows + 2 * options.margin;
  job.pixel_pitch = profile.pixel_pitch;
  job.layer = profile.layer;
  job.led_amplitude = profile.led_amplitude;
  job.layers.assign(options.base_layers, framed_layer(levels, options, true));
  job.layers.push_back(framed_layer(levels, options, false));
  for (std::size_t i = 0; i < job.layers.size(); ++i) {
    job.layers[i].exposure_s = profile.exposure_s;
    job.layers[i].top = profile.layer * static_cast<double>(i + 1);
  }
  require_valid(job);
  return job;
}

}  // namespace mezzotint
