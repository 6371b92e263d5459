#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "forward/process/gray_image.h"

namespace mezzotint {

/// One layer of a print: an 8-bit picture and how long it is shown.
///
/// Shape    rows × columns of the job; row 0 of `gray` is at y = 0 (the archive's PNG has row 0 on top).
struct JobLayer {
  std::vector<std::uint8_t> gray;
  double exposure_s = 3.0;
  Length top;  ///< height of the layer's upper face over the platform
};

/// What a printer needs to know to print, and nothing else.
struct Job {
  std::string name;
  std::string printer;  ///< name of the profile that it was made for; empty where an archive does not say it
  std::size_t columns = 0;
  std::size_t rows = 0;
  Length pixel_pitch;
  Length layer;
  int led_amplitude = 230;
  std::vector<JobLayer> layers;
};

/// The largest job: pixels a side, pixels a layer, layers, and pixels in all layers together.
inline constexpr std::size_t largest_job_side = 65535;
inline constexpr std::size_t largest_layer_pixels = std::size_t{1} << 28;
inline constexpr std::size_t largest_layer_count = 100000;
inline constexpr std::size_t largest_job_pixels = std::size_t{1} << 32;

/// @throws InvalidInput for a job larger than that, layers of another shape, lengths or times that are not
///         positive, an LED amplitude outside of 1…255, or layers that do not rise.
void require_valid(const Job& job);

/// The picture of one layer, as gray values in [0, 1].
/// @throws InvalidInput where there is no such layer.
[[nodiscard]] GrayImage layer_image(const Job& job, std::size_t index);

/// A patch of relief as a stack: `base_layers` at full gray, then the relief's own layer, in the middle of
/// a picture with `margin` dark pixels on every side.
/// @throws InvalidInput where the picture is larger than the printer's, or a gray level would not fit 8 bits.
struct PatchStackOptions {
  std::size_t base_layers = 5;
  std::size_t margin = 8;
};
[[nodiscard]] Job make_patch_job(const std::string& name, const GrayImage& relief, const PrinterProfile& profile,
                                 const PatchStackOptions& options = {});

/// To a .uvj archive (a zip: config.json, slice/%08d.png, preview/{tiny,huge}.png, and manifest.json with the
/// SHA-256 of every other member). The same job gives the same bytes. Written aside, then renamed.
/// @throws InvalidInput for a job that is not valid, DeviceError where the archive cannot be written.
void write_uvj(const Job& job, const std::filesystem::path& path);

/// Reads and checks an archive: layer count, sizes, bit depth, exposure table; and where there is a
/// manifest.json (ours), that every member is listed and has its hash.
/// Other programs' .uvj files have none: they are read too, at the pixel pitch that their display size gives.
/// @throws FileError naming the member and what is wrong with it.
[[nodiscard]] Job read_uvj(const std::filesystem::path& path);

}  // namespace mezzotint
