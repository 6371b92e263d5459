#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "inverse/gamut/gamut_map.h"

namespace mezzotint {

/// A target that was asked about, and what every asked kind of pattern makes of it.
struct AskedTarget {
  AlphaPair alpha;
  std::vector<GamutVerdict> verdicts;  ///< kind by kind

  /// The kind that reaches it with most room, else the nearest one.
  [[nodiscard]] const GamutVerdict& best() const;
  [[nodiscard]] bool is_reached() const { return best().place != GamutPlace::Outside; }
};

/// All that `mezzotint gamut` found.
struct GamutFindings {
  PrinterProfile printer;
  GamutMap map;
  std::vector<AskedTarget> targets;
};

/// "0.2, 0.05".
[[nodiscard]] std::string in_words(const AlphaPair& alpha);
/// "α 0.3, 0.2: inside with noise", and why not where not; one or two lines.
[[nodiscard]] std::string in_words(const AskedTarget& target);

/// gamut.json: formula, regions with every point of their borders, verdicts. Without times: the same bits every time.
[[nodiscard]] nlohmann::ordered_json to_json(const GamutFindings& findings);
[[nodiscard]] nlohmann::ordered_json to_json(const GamutFormula& formula);
[[nodiscard]] nlohmann::ordered_json to_json(const AskedTarget& target);
[[nodiscard]] nlohmann::ordered_json to_json(const GamutVerdict& verdict);
/// gamut.csv: a border point a line.
[[nodiscard]] std::string to_csv(const GamutMap& map);

/// "scale_um = 43.1, …" of a pattern, parts one after the other.
[[nodiscard]] std::string parameters_in_words(const Pattern& pattern);

}  // namespace mezzotint
