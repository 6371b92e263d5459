#include "fabrication/device/virtual_printer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "fabrication/device/layer_stack.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

void require_fits(const Job& job, const PrinterProfile& profile, const VirtualPrinterOptions& options) {
  require_valid(profile);
  require_valid(job);
  require(options.subsamples >= 1 && options.subsamples <= 16, "subsamples must be within 1 and 16");
  require(std::isfinite(options.stage_error.um()) && options.stage_error >= Length{},
          "the error of a platform step must be 0 or more");
  require(
      std::abs(job.pixel_pitch / profile.pixel_pitch - 1.0) < 1e-6,
      fmt::format("the job has pixels of {} um, the printer of {} um", job.pixel_pitch.um(), profile.pixel_pitch.um()));
  require(job.columns <= profile.pixels_x && job.rows <= profile.pixels_y,
          fmt::format("the job's picture of {} x {} pixels is larger than the printer's {} x {}", job.columns, job.rows,
                      profile.pixels_x, profile.pixels_y));
  require(job.led_amplitude == profile.led_amplitude,
          fmt::format("the job asks for an LED amplitude of {}, but the cure curve was measured at {}",
                      job.led_amplitude, profile.led_amplitude));
}

// What stands on the platform, as seen from above.
class Print {
public:
  Print(const Job& job, const PrinterProfile& profile, const VirtualPrinterOptions& options)
      : job_(job),
        profile_(profile),
        options_(options),
        places_(place_layers(job, options)),
        surface_um_(size(), 0.0F),
        cured_(size(), false),
        dose_(profile.cure, size()),
        reach_um_(size()) {}

  // From the last layer down: what cures first in a column is its top.
  void add_layer(std::size_t index) {
    const LayerPlace place = places_[index];
    const bool is_last = index + 1 == job_.layers.size();
    dose_.descend(stack_layer(profile_, job_.layers[index], place.gap), light_of(index));
    dose_.reach_um(reach_um_);
    const float filled_um = static_cast<float>(place.gap.um() * filled_share);
    for (std::size_t i = 0; i < reach_um_.size(); ++i) {
      if (cured_[i] || reach_um_[i] <= 0.0F) continue;
      const bool filled = reach_um_[i] >= filled_um && !is_last;
      const double height_um = filled ? place.gap.um() : std::min<double>(reach_um_[i], place.gap.um());
      // Relative to the relief's own face, where float has its finest steps.
      surface_um_[i] = static_cast<float>(height_um + (place.lower - face()).um());
      cured_[i] = true;
    }
  }

  void show_platform() {
    for (std::size_t i = 0; i < surface_um_.size(); ++i) {
      if (!cured_[i]) surface_um_[i] = static_cast<float>(-face().um());
    }
  }

  void add_ground_where_cured() {
    const GroundSplit split = split_ground(profile_, options_.wavelength);
    if (split.geometric.empty()) return;
    HeightField ground(grid(), Continuation::Mirrored);
    add_ground(ground, profile_, split.geometric, options_.seed);
    for (std::size_t i = 0; i < surface_um_.size(); ++i) {
      if (cured_[i]) surface_um_[i] += ground.heights_um()[i];
    }
  }

  [[nodiscard]] HeightField take() {
    return HeightField(grid(), Continuation::Mirrored, std::move(surface_um_), face());
  }

private:
  [[nodiscard]] Grid grid() const {
    const Length pitch = profile_.pixel_pitch / static_cast<double>(options_.subsamples);
    const Grid grid{job_.columns * options_.subsamples, job_.rows * options_.subsamples, pitch, pitch};
    require_valid_grid(grid);
    return grid;
  }
  [[nodiscard]] std::size_t size() const { return grid().size(); }

  // The lower face of the relief.
  [[nodiscard]] Length face() const { return places_.back().lower; }

  // The light of a layer; that of a base is worked out once.
  [[nodiscard]] std::span<const float> light_of(std::size_t index) {
    if (!light_ || job_.layers[index].gray != job_.layers[index + 1].gray)
      light_ = spread_light(layer_image(job_, index), profile_, {options_.subsamples, Surround::Dark});
    return light_->values;
  }

  const Job& job_;
  const PrinterProfile& profile_;
  const VirtualPrinterOptions& options_;
  std::vector<LayerPlace> places_;
  std::vector<float> surface_um_;
  std::vector<bool> cured_;
  DepthDose dose_;
  std::vector<float> reach_um_;
  std::optional<GrayImage> light_;
};

}  // namespace

HeightField print_virtually(const Job& job, const PrinterProfile& profile, const VirtualPrinterOptions& options,
                            const Progress& progress) {
  require_fits(job, profile, options);
  require_height_field(job, profile);
  Print print(job, profile, options);
  const auto count = static_cast<double>(job.layers.size());
  for (std::size_t done = 0; done < job.layers.size(); ++done) {
    const std::size_t index = job.layers.size() - 1 - done;
    report(progress, "print", static_cast<double>(done) / count, fmt::format("layer {}", index + 1));
    print.add_layer(index);
  }
  print.show_platform();
  print.add_ground_where_cured();
  report(progress, "print", 1.0);
  return print.take();
}

}  // namespace mezzotint
