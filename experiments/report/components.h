#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/report/report.h"
#include "forward/optics/direction.h"
#include "forward/optics/direction_map.h"
#include "forward/surface/height_field.h"

namespace mezzotint {

/// How much of the page's width a component takes; on a narrow window each takes all.
enum class Span { Full, TwoThirds, Half, Third };

/// What every component has.
struct Panel {
  std::string title;
  std::string caption;  ///< a sentence below it; the markup of Section::text
  Span span = Span::Full;
  std::string alt;  ///< what a listener hears in place of the picture; the title where empty
};

/// A direction map with a name.
///
/// Frame    row 0 is y = −1 (see DirectionGrid); the page draws y upward.
struct NamedMap {
  std::string name;
  DirectionGrid grid;
  DirectionMap mean;
  DirectionMap standard_error;  ///< empty: exact
  std::optional<DirectionAngles> incidence;
  bool difference = false;  ///< drawn on a scale of its own, about zero
  bool target = false;      ///< drawn as wires in the lobe viewer
  std::string note;         ///< a few words below the map
};

/// An estimated map with its standard errors.
[[nodiscard]] NamedMap named_map(std::string name, const DirectionGrid& grid, const MapEstimate& map,
                                 const DirectionAngles& incidence);

/// a − b, bin by bin; the standard errors are added in quadrature (a and b independent).
/// @throws InvalidInput for maps on different grids.
[[nodiscard]] NamedMap difference_map(std::string name, const NamedMap& a, const NamedMap& b);

/// How the values of a group of maps are shown.
struct MapScale {
  std::string label = "BRDF";
  std::string difference_label = "Difference";
  std::string unit = "1/sr";
  bool logarithmic = false;  ///< what the page starts with; the reader can change it
};

/// Maps side by side on one colour scale (differences on another), with a common probe.
/// @throws InvalidInput for no maps, or a map whose size is not that of its grid.
[[nodiscard]] nlohmann::json direction_maps(const Panel& panel, const std::vector<NamedMap>& maps,
                                            const MapScale& scale = {});

/// The same maps as lobes in three dimensions, one over the other.
[[nodiscard]] nlohmann::json lobe_viewer(const Panel& panel, const std::vector<NamedMap>& maps,
                                         const MapScale& scale = {});

struct NamedRelief {
  std::string name;
  const HeightField& field;
};

/// Longer side of a relief in the page, in samples; longer ones become block means, and the page says so. A block of
/// which less than half was measured is missing.
inline constexpr std::size_t longest_relief_side = 512;

/// Reliefs as pictures on one colour scale in µm; missing samples are hatched.
/// @throws InvalidInput for no reliefs.
[[nodiscard]] nlohmann::json relief_maps(const Panel& panel, const std::vector<NamedRelief>& reliefs);

/// Reliefs in three dimensions, one at a time.
/// @throws InvalidInput for no reliefs.
[[nodiscard]] nlohmann::json relief_viewer(const Panel& panel, const std::vector<NamedRelief>& reliefs);

/// Values over the plane about its middle: an autocorrelation, a spectrum.
///
/// Frame    row 0 is the lowest y; the middle of the grid is the origin.
struct PlaneMap {
  std::string name;
  std::size_t columns = 0, rows = 0;
  double step_x = 1.0, step_y = 1.0;  ///< in the quantity's `step_unit`
  std::vector<float> values;
  std::vector<std::array<double, 2>> outline;  ///< a closed line over it; may leave the map
};

/// What is drawn of a PlaneMap.
struct PlaneQuantity {
  std::string label, symbol, unit;
  std::string step_unit = "um";
  std::string outline;  ///< what the outline is; empty: there is none
};

/// Such maps as pictures on one colour scale.
/// @throws InvalidInput for no maps, or a map whose size is not that of its grid.
[[nodiscard]] nlohmann::json plane_maps(const Panel& panel, const std::vector<PlaneMap>& maps,
                                        const PlaneQuantity& quantity);

/// A row of a table: text, numbers, or a Quantity (written with the digits of its standard error).
struct TableRow {
  std::vector<nlohmann::json> cells;
  Outcome outcome = Outcome::Information;
};
/// @throws InvalidInput for no columns, or a row of another length.
[[nodiscard]] nlohmann::json table(const Panel& panel, const std::vector<std::string>& columns,
                                   const std::vector<TableRow>& rows);

/// Any Vega-Lite specification. The page adds its fonts and colours; "$ink", "$quiet", "$accent" and
/// "$series-1" … "$series-6" in it (outside of "data") stand for colours of the theme.
[[nodiscard]] nlohmann::json vega_lite_chart(const Panel& panel, nlohmann::json specification);

/// Notes and warnings that belong to a place in the text.
[[nodiscard]] nlohmann::json messages(const std::vector<Message>& list);

}  // namespace mezzotint
