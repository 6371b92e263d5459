#include <fmt/format.h>

#include <algorithm>

#include "fabrication/job/folder_members.h"
#include "fabrication/job/job_file.h"
#include "fabrication/job/png_picture.h"
#include "fabrication/job/sl1_layout.h"
#include "fabrication/job/uvj_layout.h"
#include "fabrication/job/zip_archive.h"
#include "forward/base/digest.h"

namespace mezzotint {

namespace {

// Members besides the slices that an archive of another program may hold.
constexpr std::size_t most_other_members = 1000;

// A JSON or INI file grows with the number of layers; what is larger than that is a bomb.
std::uint64_t most_text_bytes(std::size_t member_count) {
  return (64U << 10U) + (std::uint64_t{4} << 10U) * member_count;
}

// Rows of a PNG have one byte more than pixels, and deflate may add a thousandth; the rest is for other chunks.
std::uint64_t most_png_bytes(const Job& job) {
  const std::uint64_t raw = (job.columns + 1) * job.rows;
  return raw + raw / 100 + (1U << 20U);
}

constexpr std::uint64_t most_preview_bytes = std::uint64_t{64} << 20U;

std::unique_ptr<MemberInput> open_input(JobFormat format, const std::filesystem::path& path) {
  constexpr std::size_t most = largest_layer_count + most_other_members;
  if (format == JobFormat::Folder) return std::make_unique<FolderReader>(path, most);
  return std::make_unique<ZipReader>(path, most);
}

void turn_over(std::vector<std::uint8_t>& gray, std::size_t columns, std::size_t rows) {
  for (std::size_t row = 0; row < rows / 2; ++row) {
    const auto low = gray.begin() + static_cast<std::ptrdiff_t>(row * columns);
    const auto high = gray.begin() + static_cast<std::ptrdiff_t>((rows - 1 - row) * columns);
    std::swap_ranges(low, low + static_cast<std::ptrdiff_t>(columns), high);
  }
}

}  // namespace

class JobReader::Impl {
public:
  Impl(const std::filesystem::path& path, JobFormat format)
      : path_(path), format_(format), input_(open_input(format, path)), names_(input_->names()) {
    format_ == JobFormat::Sl1 ? read_sl1() : read_uvj_config();
    if (input_->has(manifest_member)) {
      hashes_ = read_manifest(input_->read(manifest_member, most_text()), place(manifest_member), job_);
      check_list();
      check_others();
    }
    check_slice_count();
    check_frame();
  }

  [[nodiscard]] JobFormat format() const { return format_; }
  [[nodiscard]] const Job& frame() const { return job_; }
  [[nodiscard]] bool has_hashes() const { return !hashes_.empty(); }

  [[nodiscard]] std::vector<std::uint8_t> read_layer(std::size_t index) const {
    require(index < job_.layers.size(), "the job has no such layer");
    const std::string member = slice_name(index);
    const std::vector<std::byte> png = input_->read(member, most_png_bytes(job_));
    check_hash(member, png);
    std::vector<std::uint8_t> gray = decode_gray_png(png, job_.columns, job_.rows, place(member));
    turn_over(gray, job_.columns, job_.rows);
    return gray;
  }

private:
  [[nodiscard]] MemberPlace place(const std::string& member) const { return {path_, member}; }
  [[nodiscard]] std::uint64_t most_text() const { return most_text_bytes(names_.size()); }

  void read_uvj_config() {
    const std::vector<std::byte> config = input_->read(config_member, most_text());
    job_ = read_config(config, place(config_member));
    job_.name = path_.stem().string();
    slices_ = "slice/";
  }

  void read_sl1() {
    const std::vector<std::byte> config = input_->read(sl1_config_member, most_text());
    const std::vector<std::byte> slicer = input_->read(sl1_slicer_member, most_text());
    job_ = read_sl1_config(config, place(sl1_config_member), slicer, place(sl1_slicer_member));
    slices_ = job_.name;
  }

  [[nodiscard]] std::string slice_name(std::size_t index) const {
    return format_ == JobFormat::Sl1 ? sl1_slice_member(slices_, index) : slice_member(index);
  }
  // A picture of a layer, of this job or one too many.
  [[nodiscard]] bool is_slice(const std::string& name) const {
    return name.starts_with(slices_) && name.ends_with(".png") && !name.starts_with("thumbnail/");
  }

  // Every member is listed in the manifest, and every listed one is there.
  void check_list() const {
    for (const auto& [name, hash] : hashes_) {
      if (!input_->has(name)) place(name).refuse("is listed in manifest.json but missing from the archive");
    }
    for (const std::string& name : names_) {
      if (name != manifest_member && !hashes_.contains(name)) place(name).refuse("is not listed in manifest.json");
    }
  }

  void check_hash(const std::string& member, std::span<const std::byte> bytes) const {
    if (hashes_.empty()) return;
    if (sha256_hex(bytes) != hashes_.at(member)) {
      place(member).refuse("does not have the SHA-256 of manifest.json; the archive was changed or damaged");
    }
  }

  // Whatever is no slice: what was read before the hashes were known, and previews.
  void check_others() const {
    for (const auto& [name, hash] : hashes_) {
      if (!is_slice(name)) check_hash(name, input_->read(name, most_preview_bytes));
    }
  }

  void check_slice_count() const {
    const auto slices = static_cast<std::size_t>(
        std::count_if(names_.begin(), names_.end(), [this](const auto& name) { return is_slice(name); }));
    if (slices > job_.layers.size()) {
      const std::string& config = format_ == JobFormat::Sl1 ? sl1_config_member : config_member;
      place(format_ == JobFormat::Sl1 ? slices_ : "slice")
          .refuse(fmt::format("holds {} pictures; {} says {} layers", slices, config, job_.layers.size()));
    }
    for (std::size_t i = 0; i < job_.layers.size(); ++i) {
      if (!input_->has(slice_name(i))) place(slice_name(i)).refuse("is missing from the archive");
    }
  }

  void check_frame() const {
    for (std::size_t i = 0; i < job_.layers.size(); ++i) {
      const bool rises = job_.layers[i].top > (i == 0 ? Length{} : job_.layers[i - 1].top);
      if (!rises) place(config_member).refuse(fmt::format("layer {} does not lie above the one before it", i));
    }
    const bool positive = job_.pixel_pitch.um() > 0.0 && job_.layer.um() > 0.0;
    if (!positive) place(config_member).refuse("the pixel pitch and the layer must be positive");
  }

  std::filesystem::path path_;
  JobFormat format_;
  std::unique_ptr<MemberInput> input_;
  std::vector<std::string> names_;
  std::string slices_;  ///< how the names of the layers' pictures begin
  Job job_;
  MemberHashes hashes_;
};

JobReader::JobReader(const std::filesystem::path& path) : impl_(std::make_unique<Impl>(path, job_format(path))) {}
JobReader::~JobReader() = default;
JobFormat JobReader::format() const { return impl_->format(); }
const Job& JobReader::frame() const { return impl_->frame(); }
bool JobReader::has_hashes() const { return impl_->has_hashes(); }
std::vector<std::uint8_t> JobReader::read_layer(std::size_t index) const { return impl_->read_layer(index); }

namespace {

Job read_whole(const std::filesystem::path& path) {
  const JobReader reader(path);
  Job job = reader.frame();
  if (job.layers.size() > largest_job_pixels / (job.columns * job.rows)) {
    throw FileError(path, config_member, "all layers together have more than 2^32 pixels");
  }
  for (std::size_t i = 0; i < job.layers.size(); ++i) job.layers[i].gray = reader.read_layer(i);
  return job;
}

}  // namespace

Job read_job(const std::filesystem::path& path) {
  Job job = read_whole(path);
  try {
    require_valid(job);
  } catch (const InvalidInput& error) {
    throw FileError(path, config_member, error.what());
  }
  return job;
}

Job read_uvj(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw FileError(path, "", "is not a regular file");
  require(path.extension() == ".uvj", path.string() + ": is no .uvj");
  return read_job(path);
}

JobFigures check_job(const JobReader& job, const Progress& progress) {
  JobFigures figures;
  const std::vector<JobLayer>& layers = job.frame().layers;
  figures.shortest_exposure_s = figures.longest_exposure_s = layers.front().exposure_s;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    report(progress, "check", static_cast<double>(i) / static_cast<double>(layers.size()),
           fmt::format("layer {} of {}", i + 1, layers.size()));
    const PictureFigures of_layer = figures_of(to_runs(job.read_layer(i), job.frame().columns, job.frame().rows));
    figures.lit_pixels += of_layer.lit;
    figures.full_pixels += of_layer.full;
    figures.gray_sum += of_layer.gray_sum;
    figures.empty_layers += of_layer.lit == 0 ? 1 : 0;
    figures.shortest_exposure_s = std::min(figures.shortest_exposure_s, layers[i].exposure_s);
    figures.longest_exposure_s = std::max(figures.longest_exposure_s, layers[i].exposure_s);
    figures.light_s += layers[i].exposure_s;
  }
  return figures;
}

}  // namespace mezzotint
