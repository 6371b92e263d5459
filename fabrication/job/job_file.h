#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "fabrication/job/job.h"
#include "fabrication/job/layer_picture.h"
#include "forward/base/progress.h"

namespace mezzotint {

/// The formats of a job on disk.
///
/// Uvj     a zip of config.json, slice/%08d.png and previews; every layer has its own exposure
/// Sl1     a zip of config.ini, prusaslicer.ini and NAME%05d.png: PrusaSlicer's; one exposure for all layers but the
///         first
/// Folder  the members of a .uvj as files
///
/// All that we write hold manifest.json as well: the SHA-256 of every other member, and what the format has no place
/// for. Other programs pass over it.
enum class JobFormat { Uvj, Sl1, Folder };

/// By the path's ending: .uvj, .sl1; a folder where it ends in "/", is a folder, or has no ending.
/// @throws InvalidInput for another ending.
[[nodiscard]] JobFormat job_format(const std::filesystem::path& path);
[[nodiscard]] std::string_view format_name(JobFormat format);

/// A job written layer by layer, its pictures never in memory together. The same job gives the same bytes. Written
/// aside, then renamed: before `close` there is nothing under the final name, and without it nothing is left.
class JobWriter {
public:
  /// @param frame  the job without its layers
  /// @throws InvalidInput for a job that is not valid, or a path of no known format or that is taken;
  ///         DeviceError where the folder cannot be written.
  JobWriter(Job frame, const std::filesystem::path& path);
  ~JobWriter();

  /// @param png  the picture by `encode_layer_png`, which may be done for several layers at a time
  /// @throws DeviceError where the disk is full.
  void add(LayerPicture picture, std::string_view png, double exposure_s, Length top);

  /// @throws InvalidInput where there is no layer, or the format cannot hold the exposures; DeviceError as above.
  void close();

private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// A job read layer by layer.
class JobReader {
public:
  /// Reads and checks all but the layers' pictures: layer count, sizes, exposure table, and where there is a
  /// manifest.json that every member is listed, and the hashes of all but the pictures.
  /// @throws FileError naming the member and what is wrong with it.
  explicit JobReader(const std::filesystem::path& path);
  ~JobReader();

  [[nodiscard]] JobFormat format() const;
  /// The job, its layers without their pictures.
  [[nodiscard]] const Job& frame() const;
  /// Whether there is a manifest with hashes.
  [[nodiscard]] bool has_hashes() const;

  /// The 8-bit pixels of a layer, row 0 at y = 0; hash, size and depth are checked.
  /// @throws FileError naming the member and what is wrong with it.
  [[nodiscard]] std::vector<std::uint8_t> read_layer(std::size_t index) const;

private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The whole job in memory, from any format.
/// @throws FileError as JobReader, and where all layers together have more than 2^32 pixels.
[[nodiscard]] Job read_job(const std::filesystem::path& path);

/// A job's figures from all of its pictures, each read and checked once.
struct JobFigures {
  std::uint64_t lit_pixels = 0, full_pixels = 0, gray_sum = 0;
  std::size_t empty_layers = 0;
  double shortest_exposure_s = 0.0, longest_exposure_s = 0.0, light_s = 0.0;
};
[[nodiscard]] JobFigures check_job(const JobReader& job, const Progress& progress = {});

}  // namespace mezzotint
