#include "experiments/configuration/search_table.h"

#include <algorithm>

#include "experiments/configuration/suggestion.h"

namespace mezzotint {

namespace {

constexpr const char* automatic = "automatic";

MeasureSum read_objective(TomlTable& table) {
  std::vector<std::string> names = {automatic};
  for (const Measure measure : all_measures) names.emplace_back(name_of(measure));
  if (!table.is_table("objective")) {
    const std::string name = table.choice("objective", names, automatic);
    for (const Measure measure : all_measures) {
      if (name == name_of(measure)) return {{measure, 1.0}};
    }
    return {};
  }
  TomlTable weights = table.table("objective");
  MeasureSum sum;
  for (const Measure measure : all_measures) {
    const double weight = weights.number(name_of(measure), {0.0, 1e6}, 0.0);
    if (weight > 0.0) sum.push_back({measure, weight});
  }
  weights.finish();
  if (sum.empty())
    table.complain("objective", "a sum of objectives needs one with a weight above 0, like { cube_root = 1.0 }");
  return sum;
}

}  // namespace

bool SearchSpecification::by_slopes() const {
  return !objective.empty() && std::ranges::all_of(objective, [](const WeightedMeasure& term) {
    return term.measure == Measure::SlopeCovariance;
  });
}

SearchSpecification read_search(TomlTable table, bool has_lobe) {
  SearchSpecification search;
  MinimizeOptions& minimize = search.minimize;
  minimize.algorithm = table.text("algorithm", minimize.algorithm);
  if (!is_known_algorithm(minimize.algorithm)) {
    table.complain("algorithm",
                   "NLopt knows no algorithm \"" + minimize.algorithm + "\"" +
                       suggest(minimize.algorithm,
                               {"LN_BOBYQA", "LN_SBPLX", "LN_COBYLA", "LN_NELDERMEAD", "LN_PRAXIS", "LN_NEWUOA_BOUND",
                                "GN_DIRECT_L", "GN_CRS2_LM", "GN_ISRES", "GN_ESCH", "GN_AGS", "G_MLSL_LDS", "LD_LBFGS",
                                "LD_SLSQP", "LD_MMA", "LD_CCSAQ", "LD_TNEWTON", "LD_VAR2"}));
  }
  search.objective = read_objective(table);
  if (!has_lobe && search.by_light()) {
    table.complain("objective", "an anisotropy alone names no lobe; its objective is \"slope_covariance\"");
  }
  minimize.max_evaluations = static_cast<int>(table.integer("max_evaluations", 0, 1'000'000, minimize.max_evaluations));
  minimize.relative_tolerance = table.number("relative_tolerance", {1e-12, 0.5}, minimize.relative_tolerance);
  minimize.seed =
      static_cast<std::uint64_t>(table.integer("seed", 0, std::int64_t{1} << 38, std::int64_t(minimize.seed)));
  search.draws = static_cast<std::size_t>(table.integer("draws", 1, 256, std::int64_t(search.draws)));
  search.fresh_draws = static_cast<std::size_t>(table.integer("fresh_draws", 2, 256, std::int64_t(search.fresh_draws)));
  table.finish();
  return search;
}

}  // namespace mezzotint
