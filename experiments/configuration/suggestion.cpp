#include "experiments/configuration/suggestion.h"

#include <algorithm>
#include <array>

namespace mezzotint {

namespace {

// Damerau–Levenshtein distance (optimal string alignment): a swap of neighbours counts once.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + change});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

// The part of a key before its unit; empty for a key without a unit.
std::string_view quantity_of(std::string_view key) {
  constexpr std::array<std::string_view, 10> units = {"um", "mm", "nm", "m", "cm", "deg", "rad", "s", "ms", "micron"};
  const auto underscore = key.rfind('_');
  if (underscore == std::string_view::npos) return {};
  const bool is_unit = std::ranges::find(units, key.substr(underscore + 1)) != units.end();
  return is_unit ? key.substr(0, underscore) : std::string_view{};
}

}  // namespace

std::optional<std::string> closest_match(std::string_view word, const std::vector<std::string>& candidates) {
  const std::size_t limit = std::max<std::size_t>(1, word.size() / 3);
  std::optional<std::string> best;
  std::size_t least = limit + 1;
  for (const auto& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance >= least) continue;
    least = distance;
    best = candidate;
  }
  return best;
}

std::optional<std::string> same_quantity_in_our_unit(std::string_view key, const std::vector<std::string>& candidates) {
  const std::string_view quantity = quantity_of(key).empty() ? key : quantity_of(key);
  const auto found = std::ranges::find_if(
      candidates, [&](const std::string& candidate) { return candidate != key && quantity_of(candidate) == quantity; });
  return found == candidates.end() ? std::nullopt : std::optional(*found);
}

std::string suggest(std::string_view word, const std::vector<std::string>& candidates) {
  if (const auto unit = same_quantity_in_our_unit(word, candidates)) {
    return "; the unit is part of the key: \"" + *unit + "\"";
  }
  if (const auto close = closest_match(word, candidates)) return "; did you mean \"" + *close + "\"?";
  std::string known = "; known here: ";
  for (std::size_t i = 0; i < candidates.size(); ++i) known += (i > 0 ? ", " : "") + candidates[i];
  return candidates.empty() ? "" : known;
}

}  // namespace mezzotint
