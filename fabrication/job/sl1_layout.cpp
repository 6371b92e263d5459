#include "fabrication/job/sl1_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fabrication/job/ini_text.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

constexpr double longest_exposure_s = 1e5, thickest_layer_mm = 10.0, largest_display_mm = 1e5;

// Divided, not multiplied by 1e-3: 18 µm becomes 0.018 and not 0.018000000000000002.
double in_mm(Length length) { return length.um() / 1000.0; }
// Millimetres of a file to micrometres on a grid of picometres.
Length from_file_mm(double mm) { return Length::from_um(std::round(mm * 1e9) / 1e6); }

void require_holdable(const Job& job) {
  for (std::size_t i = 1; i < job.layers.size(); ++i) {
    const Length thickness = job.layers[i].top - job.layers[i - 1].top;
    require(std::abs((thickness - job.layer).um()) < 1e-6,
            fmt::format("a .sl1 archive has one thickness for all layers; layer {} has another: write a .uvj", i));
    require(job.layers[i].exposure_s == job.layers[1].exposure_s,
            fmt::format("a .sl1 archive has one exposure for all layers after the first; layer {} has another: write a "
                        ".uvj",
                        i));
  }
}

double common_exposure_s(const Job& job) { return job.layers[job.layers.size() > 1 ? 1 : 0].exposure_s; }

// The exposure of a layer on its way from the first to the common one.
double faded_exposure_s(double first, double common, std::size_t fade, std::size_t layer) {
  if (layer > fade) return common;
  return first + (common - first) * static_cast<double>(layer) / static_cast<double>(fade + 1);
}

Length pitch_of(const IniText& slicer, const MemberPlace& place) {
  const auto columns = slicer.whole("display_pixels_x", 1, largest_job_side);
  const auto rows = slicer.whole("display_pixels_y", 1, largest_job_side);
  const double x = slicer.number("display_width", 1e-6, largest_display_mm) / static_cast<double>(columns);
  const double y = slicer.number("display_height", 1e-6, largest_display_mm) / static_cast<double>(rows);
  if (std::abs(x / y - 1.0) > 1e-3) place.refuse("the display's pixels are not square; only square ones are read");
  return from_file_mm(x);
}

}  // namespace

std::string sl1_slice_member(const std::string& name, std::size_t index) {
  return fmt::format("{}{:05}.png", name, index);
}

std::string write_sl1_config(const Job& job, double used_ml) {
  require_holdable(job);
  double light_s = 0.0;
  for (const JobLayer& layer : job.layers) light_s += layer.exposure_s;
  return fmt::format(
      "action = print\nexpTime = {}\nexpTimeFirst = {}\nexpUserProfile = 0\nhollow = 0\njobDir = {}\nlayerHeight = {}\n"
      "materialName = \nnumFade = 0\nnumFast = {}\nnumSlow = 0\nprintProfile = \nprintTime = {:.6f}\nprinterModel = "
      "{}\n"
      "printerProfile = {}\nprinterVariant = \nusedMaterial = {:.6f}\n",
      common_exposure_s(job), job.layers[0].exposure_s, job.name, in_mm(job.layer), job.layers.size(), light_s,
      job.printer, job.printer, used_ml);
}

std::string write_sl1_slicer(const Job& job) {
  const Length width = job.pixel_pitch * static_cast<double>(job.columns);
  const Length height = job.pixel_pitch * static_cast<double>(job.rows);
  return fmt::format(
      "display_height = {}\ndisplay_mirror_x = 0\ndisplay_mirror_y = 0\ndisplay_orientation = landscape\n"
      "display_pixels_x = {}\ndisplay_pixels_y = {}\ndisplay_width = {}\nexposure_time = {}\nfaded_layers = 0\n"
      "gamma_correction = 1\ninitial_exposure_time = {}\ninitial_layer_height = {}\nlayer_height = {}\n"
      "printer_technology = SLA\n",
      in_mm(height), job.columns, job.rows, in_mm(width), common_exposure_s(job), job.layers[0].exposure_s,
      in_mm(job.layers[0].top), in_mm(job.layer));
}

Job read_sl1_config(std::span<const std::byte> config_text, const MemberPlace& config_place,
                    std::span<const std::byte> slicer_text, const MemberPlace& slicer_place) {
  const IniText config(config_text, config_place), slicer(slicer_text, slicer_place);
  Job job;
  job.name = config.text("jobDir");
  job.columns = slicer.whole("display_pixels_x", 1, largest_job_side);
  job.rows = slicer.whole("display_pixels_y", 1, largest_job_side);
  if (slicer.has("display_orientation") && slicer.text("display_orientation") == "portrait")
    std::swap(job.columns, job.rows);
  if (job.columns * job.rows > largest_layer_pixels) slicer_place.refuse("layers of more than 2^28 pixels");
  job.pixel_pitch = pitch_of(slicer, slicer_place);
  job.layer = from_file_mm(config.number("layerHeight", 1e-6, thickest_layer_mm));
  job.led_amplitude = 255;
  const Length first = slicer.has("initial_layer_height")
                           ? from_file_mm(slicer.number("initial_layer_height", 1e-6, thickest_layer_mm))
                           : job.layer;
  const double common_s = config.number("expTime", 1e-6, longest_exposure_s);
  const double first_s = config.number("expTimeFirst", 1e-6, longest_exposure_s);
  const std::size_t fade = config.whole("numFade", 0, largest_layer_count);
  job.layers.resize(config.whole("numFast", 0, largest_layer_count) + config.whole("numSlow", 0, largest_layer_count));
  if (job.layers.empty() || job.layers.size() > largest_layer_count)
    config_place.refuse("\"numFast\" and \"numSlow\" together must be 1 to 100000 layers");
  for (std::size_t i = 0; i < job.layers.size(); ++i) {
    job.layers[i].exposure_s = faded_exposure_s(first_s, common_s, fade, i);
    job.layers[i].top = first + job.layer * static_cast<double>(i);
  }
  return job;
}

}  // namespace mezzotint
