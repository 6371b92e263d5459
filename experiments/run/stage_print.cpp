#include "experiments/run/design_file.h"
#include "experiments/run/patch.h"
#include "experiments/run/run_files.h"
#include "experiments/run/stages.h"
#include "fabrication/device/virtual_printer.h"
#include "fabrication/job/job.h"
#include "inverse/design/printed_texture.h"
#include "measurement/formats/surface_file.h"
#include "measurement/instrument/virtual_profilometer.h"

namespace mezzotint {

namespace {

// The printer's own draw of the day; the search never uses seeds as large, and `mezzotint print --seed` takes it.
constexpr std::uint64_t print_seed_offset = std::uint64_t{1} << 49;

GrayImage gray_of_patch(const Experiment& experiment, const Design& design) {
  const PatternInstance instance = draw_instance(design.pattern, design.print_seed);
  const HeightField heights = pixel_heights(instance, experiment.printer, experiment.patch.pixels);
  return quantize(expose(heights, experiment.printer).image, experiment.printer);
}

}  // namespace

std::vector<std::string> run_print(const StageContext& context) {
  const Experiment& experiment = context.experiment;
  const Design design = design_from_json(read_json(context.folder / "design.json"));
  const GrayImage gray = gray_of_patch(experiment, design);
  const ProcessOptions process{.subsamples = experiment.patch.subsamples, .surround = Surround::Mirror};
  write_gwy(inner_patch(print_layer(gray, experiment.printer, process), experiment), "design", {},
            context.folder / "design.gwy");
  const PrintedTexture texture(experiment.printer, experiment.patch, {design.print_seed});
  write_gwy(inner_patch(texture.print(design.pattern, 0, GrayLevels::Quantized), experiment), "predicted", {},
            context.folder / "predicted.gwy");

  const PatchStackOptions stack{.base_layers = experiment.print.base_layers, .margin = experiment.print.margin_pixels};
  write_uvj(make_patch_job(experiment.name, gray, experiment.printer, stack), context.folder / "job.uvj");
  // The printer gets the archive, as a machine would, not what is in memory.
  const HeightField printed = print_virtually(read_uvj(context.folder / "job.uvj"), experiment.printer,
                                              {.subsamples = experiment.patch.subsamples,
                                               .wavelength = experiment.simulation.wavelength,
                                               .seed = print_seed_offset + experiment.search.minimize.seed},
                                              context.progress);
  write_gwy(printed, "printed", {{"device", "virtual printer"}}, context.folder / "printed.gwy");
  return {"design.gwy", "predicted.gwy", "job.uvj", "printed.gwy"};
}

std::vector<std::string> run_measure(const StageContext& context) {
  const HeightField picture = read_gwy(context.folder / "printed.gwy").field;
  const HeightField seen = inner_patch_of_picture(picture, context.experiment);
  write_gwy(measure_virtually(seen, context.experiment.measurement), "measured",
            {{"instrument", "virtual profilometer"}}, context.folder / "measured.gwy");
  return {"measured.gwy"};
}

}  // namespace mezzotint
