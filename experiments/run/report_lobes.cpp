#include <fmt/format.h>

#include "experiments/report/bsdf_components.h"
#include "experiments/report/components.h"
#include "experiments/run/report_page.h"

namespace mezzotint {

namespace {

std::string in_degrees(const DirectionAngles& incidence) {
  return fmt::format("light from θ = {:.0f}°, φ = {:.0f}°", incidence.theta.degrees(), incidence.phi.degrees());
}

std::vector<NamedMap> maps_of(const IncidenceResult& r) {
  const DirectionGrid& grid = r.printed.grid;
  NamedMap target = r.traced_target
                        ? named_map("target (scan, traced)", grid, r.traced_target->reflection, r.incidence)
                        : NamedMap{.name = "target", .grid = grid, .mean = r.target_lobe, .incidence = r.incidence};
  target.target = true;
  const NamedMap printed = named_map("printed", grid, r.printed.reflection, r.incidence);
  NamedMap difference = difference_map("printed − target", printed, target);
  return {target, printed, named_map("measured again", grid, r.measured.reflection, r.incidence), difference};
}

Quantity exact(double value) { return {value, "1", {}}; }

nlohmann::json difference_table(const RunResults& results) {
  std::vector<TableRow> rows;
  for (const auto& r : results.incidences) {
    rows.push_back({{in_degrees(r.incidence), quantity_of(r.printed_to_target.corrected),
                     exact(r.printed_to_target.floor), quantity_of(r.printed_to_own_lobe.corrected),
                     exact(r.own_lobe_to_target_lobe), quantity_of(r.printed.energy.reflected)}});
  }
  return table(
      {.title = "How far the printed lobe is from the target",
       .caption =
           "`relative_l2`, cosine-weighted and corrected for noise. *Own shape*: against the Beckmann lobe of "
           "the print's own slopes, which holds what is not Gaussian in them, and multiple scattering. *Slopes*: that "
           "lobe against the target's, which holds the search's error and this one patch's chance."},
      {"incidence", "printed to target", "noise floor", "own shape", "slopes", "albedo"}, rows);
}

// One chart a direction of the light; none where no map took paths.
void add_convergence(const RunResults& results, double tolerance, Section& section) {
  for (const auto& r : results.incidences) {
    std::vector<Series> curves = {convergence_of("predicted", r.predicted), convergence_of("printed", r.printed),
                                  convergence_of("measured again", r.measured)};
    if (r.traced_target) curves.push_back(convergence_of("target (scan)", *r.traced_target));
    const auto chart = convergence_chart({.title = "Error while tracing, " + in_degrees(r.incidence),
                                          .caption = "Relative standard error of each map of the reflection, after "
                                                     "each pass. A map that took no paths has no curve.",
                                          .span = Span::Half},
                                         curves, tolerance);
    if (chart) section.components.push_back(*chart);
  }
}

}  // namespace

Section lobe_section(const Experiment& experiment, const RunResults& results) {
  Section section{.title = "The lobe",
                  .text =
                      "The reflectance that was asked for, beside that of the printed relief, traced through its "
                      "full geometry, on one colour scale."};
  const auto& own = results.incidences.front().target_to_its_lobe;
  if (experiment.target.kind == "scan" && own) {
    section.text = fmt::format(
        "The reflectance of the scan, traced, beside that of the printed relief, on one colour scale.\n\nThe scan "
        "itself is "
        "no Beckmann lobe: its `relative_l2` to that of its own slopes is {:.3f} ± {:.3f}. What the pattern cannot "
        "show "
        "of it stays as a difference here.",
        own->corrected.value, own->corrected.standard_error);
  }
  for (const auto& r : results.incidences) {
    section.components.push_back(direction_maps({.title = "BRDF, " + in_degrees(r.incidence)}, maps_of(r)));
  }
  auto lobes = maps_of(results.incidences.front());
  lobes.resize(2);
  section.components.push_back(difference_table(results));
  section.components.push_back(
      lobe_viewer({.title = "The lobes in space",
                   .caption = in_degrees(results.incidences.front().incidence) + "; the target as wires."},
                  lobes));
  add_convergence(results, experiment.simulation.tolerance, section);
  return section;
}

}  // namespace mezzotint
