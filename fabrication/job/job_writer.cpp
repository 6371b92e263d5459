#include <fmt/format.h>

#include <algorithm>

#include "fabrication/job/folder_members.h"
#include "fabrication/job/job_file.h"
#include "fabrication/job/layer_png.h"
#include "fabrication/job/preview.h"
#include "fabrication/job/sl1_layout.h"
#include "fabrication/job/uvj_layout.h"
#include "fabrication/job/zip_archive.h"
#include "forward/base/digest.h"
#include "forward/base/error.h"

namespace mezzotint {

JobFormat job_format(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::path ending = path.extension();
  if (!path.has_filename() || std::filesystem::is_directory(path, ignored)) return JobFormat::Folder;
  if (ending == ".uvj") return JobFormat::Uvj;
  if (ending == ".sl1") return JobFormat::Sl1;
  require(ending.empty(), path.string() + ": a job is a .uvj, a .sl1 or a folder (its name ends in \"/\")");
  return JobFormat::Folder;
}

std::string_view format_name(JobFormat format) {
  switch (format) {
    case JobFormat::Uvj:
      return "uvj";
    case JobFormat::Sl1:
      return "sl1";
    case JobFormat::Folder:
      return "folder";
  }
  return "";
}

namespace {

// What is part of a file's name, and of a line of an .ini.
std::string plain_name(const std::string& name) {
  std::string plain;
  for (const char letter : name)
    plain.push_back(static_cast<unsigned char>(letter) < ' ' || letter == '/' || letter == '\\' ? '_' : letter);
  return plain.empty() ? "job" : plain;
}

void require_valid_frame(const Job& frame) {
  Job one_layer = frame;
  require(frame.columns <= largest_job_side && frame.rows <= largest_job_side,
          "a layer of more than 65535 pixels a side");
  one_layer.layers.assign(1, {std::vector<std::uint8_t>(frame.columns * frame.rows), 1.0, frame.layer});
  require_valid(one_layer);
}

std::unique_ptr<MemberOutput> open_output(JobFormat format, const std::filesystem::path& path) {
  if (format == JobFormat::Folder) return std::make_unique<FolderWriter>(path);
  return std::make_unique<ZipWriter>(path);
}

}  // namespace

class JobWriter::Impl {
public:
  Impl(Job frame, const std::filesystem::path& path) : job_(std::move(frame)), format_(job_format(path)) {
    job_.layers.clear();
    require_valid_frame(job_);
    output_ = open_output(format_, path);
  }

  void add(LayerPicture picture, std::string_view png, double exposure_s, Length top) {
    const std::size_t index = job_.layers.size();
    require(picture.columns == job_.columns && picture.rows == job_.rows,
            fmt::format("layer {} has {} x {} pixels; {} x {} are right", index, picture.columns, picture.rows,
                        job_.columns, job_.rows));
    require(exposure_s > 0.0, fmt::format("layer {} needs a positive exposure", index));
    require(top > (index == 0 ? Length{} : job_.layers.back().top),
            fmt::format("layer {} does not lie above the one before it", index));
    require(index < largest_layer_count, "a job holds up to 100000 layers");
    put(slice_name(index), png, MemberOutput::Packing::Store);  // a PNG is packed already
    job_.layers.push_back({{}, exposure_s, top});
    keep_for_preview(std::move(picture));
  }

  void close() {
    require(!job_.layers.empty(), "a job needs a layer");
    constexpr auto deflate = MemberOutput::Packing::Deflate;
    if (format_ == JobFormat::Sl1) {
      const double pixel_mm2 = job_.pixel_pitch.mm() * job_.pixel_pitch.mm();
      const Job named = with_plain_name();
      put(sl1_config_member, write_sl1_config(named, lit_ * pixel_mm2 * job_.layer.mm() * 1e-3), deflate);
      put(sl1_slicer_member, write_sl1_slicer(named), deflate);
      put_previews(sl1_tiny_preview, sl1_huge_preview);
    } else {
      put(config_member, write_config(job_), deflate);
      put_previews(tiny_preview_member, huge_preview_member);
    }
    output_->add(manifest_member, write_manifest(job_, hashes_), deflate);
    output_->close();
  }

private:
  [[nodiscard]] Job with_plain_name() const {
    Job named = job_;
    named.name = plain_name(job_.name);
    named.printer = plain_name(job_.printer);
    return named;
  }
  [[nodiscard]] std::string slice_name(std::size_t index) const {
    return format_ == JobFormat::Sl1 ? sl1_slice_member(plain_name(job_.name), index) : slice_member(index);
  }

  void put(const std::string& name, std::string_view bytes, MemberOutput::Packing packing) {
    hashes_[name] = sha256_hex(std::as_bytes(std::span(bytes)));
    output_->add(name, bytes, packing);
  }
  void put_previews(const std::string& tiny, const std::string& huge) {
    put(tiny, preview_png(preview_, tiny_columns, tiny_rows), MemberOutput::Packing::Store);
    put(huge, preview_png(preview_, huge_columns, huge_rows), MemberOutput::Packing::Store);
  }

  // The last layer that is at least half as large as the largest: of a patch its relief, of a ball no mere cap.
  void keep_for_preview(LayerPicture picture) {
    const PictureFigures figures = figures_of(picture);
    lit_ += static_cast<double>(figures.gray_sum) / 255.0;
    largest_ = std::max(largest_, figures.lit);
    if (2 * figures.lit >= largest_) preview_ = std::move(picture);
  }

  Job job_;
  JobFormat format_;
  std::unique_ptr<MemberOutput> output_;
  MemberHashes hashes_;
  LayerPicture preview_;
  std::uint64_t largest_ = 0;
  double lit_ = 0.0;  ///< pixels × gray / 255
};

JobWriter::JobWriter(Job frame, const std::filesystem::path& path)
    : impl_(std::make_unique<Impl>(std::move(frame), path)) {}
JobWriter::~JobWriter() = default;
void JobWriter::add(LayerPicture picture, std::string_view png, double exposure_s, Length top) {
  impl_->add(std::move(picture), png, exposure_s, top);
}
void JobWriter::close() { impl_->close(); }

void write_uvj(const Job& job, const std::filesystem::path& path) {
  require_valid(job);
  JobWriter writer(job, path);
  std::string png;
  for (std::size_t i = 0; i < job.layers.size(); ++i) {
    LayerPicture picture = to_runs(job.layers[i].gray, job.columns, job.rows);
    // The layers of a base are equal.
    if (i == 0 || job.layers[i].gray != job.layers[i - 1].gray) png = encode_layer_png(picture);
    writer.add(std::move(picture), png, job.layers[i].exposure_s, job.layers[i].top);
  }
  writer.close();
}

}  // namespace mezzotint
