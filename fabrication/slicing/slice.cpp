#include "fabrication/slicing/slice.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "fabrication/job/job.h"
#include "fabrication/slicing/gray_table.h"
#include "fabrication/slicing/slab_raster.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

// A last layer filled less than that is no layer: it would be dark in 8 bits.
constexpr double least_fill = 1e-3;

GrayTable gray_table(const PrinterProfile& profile, const SliceOptions& options) {
  return options.linear ? GrayTable::linear() : GrayTable::through_cure(profile, options.layer.value_or(profile.layer));
}

class LayerSlicer {
public:
  LayerSlicer(const PixelWindow& window, const PrinterProfile& profile, const SliceOptions& options)
      : window_(window),
        columns_(profile.pixels_x),
        rows_(profile.pixels_y),
        layer_(options.layer.value_or(profile.layer)),
        table_(gray_table(profile, options)),
        profile_(profile),
        proximity_(options.proximity_correction),
        rasters_([window, coverage = options.coverage] { return SlabRaster(window.columns, window.rows, coverage); }) {
    require(window.column + window.columns <= columns_ && window.row + window.rows <= rows_,
            "the window of the slices does not lie in the printer's field");
    require(!proximity_ || !options.linear, "linear gray knows no cure curve, so that proximity cannot be corrected");
  }

  [[nodiscard]] const GrayTable& table() const { return table_; }
  [[nodiscard]] Length layer() const { return layer_; }

  SlicedLayer slice(std::size_t index, const FeedLayer& feed, const PackLayer& pack) {
    SlabRaster& raster = rasters_.local();
    raster.begin(index);
    feed([&raster](std::span<const RasterTriangle> triangles) { raster.add(triangles); });
    SlicedLayer sliced{.index = index, .top = layer_ * static_cast<double>(index + 1)};
    LayerPictureBuilder builder(columns_, rows_);
    std::vector<float> coverage(proximity_ ? window_.columns * window_.rows : 0, 0.0F);
    sliced.figures.open_rows = raster.finish([&](std::size_t row, std::span<const CoverageRun> runs) {
      if (!proximity_) builder.begin_row(row + window_.row);
      for (const CoverageRun& run : runs) {
        count(run, sliced.figures);
        if (proximity_)
          std::fill_n(coverage.begin() + static_cast<std::ptrdiff_t>(row * window_.columns + run.begin),
                      run.end - run.begin, run.coverage);
        else
          add(run.begin, run.end, table_.level(run.coverage), builder, sliced.figures);
      }
    });
    if (proximity_) correct(coverage, builder, sliced.figures);
    sliced.picture = builder.finish();
    if (pack) sliced.packed = pack(sliced.picture);
    return sliced;
  }

private:
  void count(const CoverageRun& run, SliceFigures& figures) const {
    const std::uint64_t length = run.end - run.begin;
    figures.coverage_pixels += double{run.coverage} * static_cast<double>(length);
    if (table_.saturates(run.coverage)) figures.saturated += length;
  }
  void add(std::size_t begin, std::size_t end, std::uint8_t level, LayerPictureBuilder& builder,
           SliceFigures& figures) const {
    builder.add(begin + window_.column, end + window_.column, level);
    figures.gray_sum += (end - begin) * level;
    if (level > 0) figures.lit_pixels += end - begin;
  }
  void correct(const std::vector<float>& coverage, LayerPictureBuilder& builder, SliceFigures& figures) const {
    const ProximityLayer corrected = correct_layer(coverage, window_, profile_, layer_);
    figures.proximity = corrected.figures;
    for (std::size_t row = 0; row < window_.rows; ++row) {
      builder.begin_row(row + window_.row);
      for (std::size_t column = 0; column < window_.columns; ++column)
        add(column, column + 1, corrected.levels[row * window_.columns + column], builder, figures);
    }
  }

  PixelWindow window_;
  std::size_t columns_, rows_;
  Length layer_;
  GrayTable table_;
  PrinterProfile profile_;
  bool proximity_;
  tbb::enumerable_thread_specific<SlabRaster> rasters_;
};

// Some layers for each thread at once, so that unequal ones even out; few enough to keep in memory.
std::size_t layers_at_once() { return 4 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()); }

}  // namespace

SliceFigures& SliceFigures::operator+=(const SliceFigures& other) {
  coverage_pixels += other.coverage_pixels;
  lit_pixels += other.lit_pixels;
  gray_sum += other.gray_sum;
  saturated += other.saturated;
  open_rows += other.open_rows;
  proximity += other.proximity;
  return *this;
}

std::size_t layer_count(double height_layers, const CoverageOptions& options) {
  const bool by_plane = options.mode == CoverageMode::Midplane || options.supersample > 0;
  const double count = std::ceil(height_layers - (by_plane ? 0.5 : least_fill));
  require(count >= 1.0, fmt::format("the part is {:.3g} layers high; it would have no layer", height_layers));
  require(count <= static_cast<double>(largest_layer_count),
          fmt::format("the part is {:.0f} layers high; a job holds up to {}", height_layers, largest_layer_count));
  return static_cast<std::size_t>(count);
}

SliceSummary slice_source(const SlabSource& source, std::size_t layers, const PixelWindow& window,
                          const PrinterProfile& profile, const SliceOptions& options, const PackLayer& pack,
                          const TakeLayer& take, const Progress& progress) {
  LayerSlicer slicer(window, profile, options);
  SliceSummary summary;
  summary.layers = layers;
  summary.largest_coverage = slicer.table().largest_coverage();
  const std::size_t batch = layers_at_once();
  std::vector<FeedLayer> feeds(batch);
  std::vector<SlicedLayer> sliced(batch);
  for (std::size_t begin = 0; begin < layers; begin += batch) {
    report(progress, "slice", static_cast<double>(begin) / static_cast<double>(layers),
           fmt::format("layer {} of {}", begin + 1, layers));
    const std::size_t count = std::min(batch, layers - begin);
    for (std::size_t i = 0; i < count; ++i) feeds[i] = source(begin + i);
    tbb::parallel_for(std::size_t{0}, count,
                      [&](std::size_t i) { sliced[i] = slicer.slice(begin + i, feeds[i], pack); });
    for (std::size_t i = 0; i < count; ++i) {
      summary.total += sliced[i].figures;
      take(std::move(sliced[i]));
    }
  }
  summary.height_mm = slicer.layer().mm() * static_cast<double>(layers);
  summary.volume_mm3 =
      summary.total.coverage_pixels * profile.pixel_pitch.mm() * profile.pixel_pitch.mm() * slicer.layer().mm();
  return summary;
}

SliceSummary slice_part(const PartMesh& part, const PrinterProfile& profile, const SliceOptions& options,
                        const PackLayer& pack, const TakeLayer& take, const Progress& progress) {
  const PlacedPart placed = place_part(part, profile, options.layer.value_or(profile.layer), options.placement);
  const std::size_t layers = layer_count(placed.height_layers, options.coverage);
  return slice_source(mesh_source(part, placed.frame, layers), layers, placed.window, profile, options, pack, take,
                      progress);
}

}  // namespace mezzotint
