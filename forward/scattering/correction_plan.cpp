#include "forward/scattering/correction_plan.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

namespace mezzotint {

namespace {

// Every cell that light falls on keeps this part of the mean density, so that nothing which the pilot missed gets a
// weight of more than its inverse.
constexpr double least_density = 0.05;
// Transmission counts so much beside reflection.
constexpr double worth_of_transmission = 0.1;
// A class counts as if this part of so many more points had been seen to meet the surface.
constexpr double unseen = 1e-3, prior_points = 4.0;
// The same for judgements by how near the next cell is that was judged otherwise: two cells away, one, beside it. A
// border runs through the cells beside it, so that a part of them is judged wrongly; few pilots may not tell.
constexpr std::array<double, 3> expected_wrong = {unseen, 0.01, 0.25};
// No judgement is doubted less: of a class with so few mistakes the pilot sees none or one.
constexpr float least_doubt = 5e-4F;
// Chances of meeting the surface again that are near enough to certain.
constexpr float surely_not = 0.004F, surely = 0.99F;
// Where fewer pilots than this share meet the surface, points are drawn evenly.
constexpr double quiet_share = 1e-3;

/// A frequency that is drawn to what is expected of it where it was seen seldom.
struct Frequency {
  double seen = 0.0, of = 0.0;
  void add(double value) {
    seen += value;
    of += 1.0;
  }
  [[nodiscard]] double drawn_to(double expected) const {
    return (seen + prior_points * expected) / (of + prior_points);
  }
};

}  // namespace

CorrectionPlan::PilotGrid CorrectionPlan::pilot_grid(const PeriodicTile& tile) {
  return {(tile.columns() + block - 1) / block, (tile.rows() + block - 1) / block};
}

CorrectionPlan::CorrectionPlan(const PeriodicTile& tile, std::vector<std::uint8_t> lit,
                               const std::vector<PilotOutcome>& outcomes)
    : columns_(tile.columns()),
      rows_(tile.rows()),
      grid_(pilot_grid(tile)),
      lit_(std::move(lit)),
      meets_(lit_.size(), 0) {
  const auto met = std::count_if(outcomes.begin(), outcomes.end(), [](const PilotOutcome& one) {
    return one.faces_light && (!one.lit || one.reflected_met || one.refracted_met);
  });
  quiet_ = static_cast<double>(met) <= quiet_share * static_cast<double>(outcomes.size()) &&
           std::all_of(lit_.begin(), lit_.end(), [](std::uint8_t cell) { return cell == 2; });
  if (quiet_) return;
  learn_scale(outcomes);
  learn_meetings(outcomes);
}

void CorrectionPlan::learn_scale(const std::vector<PilotOutcome>& outcomes) {
  double reflected = 0.0, refracted = 0.0;
  Frequency on;
  for (const PilotOutcome& one : outcomes) {
    if (!one.lit) continue;
    reflected += double{one.reflected};
    refracted += double{one.refracted};
    if (one.reflected_met) on.add(double{one.reflected_on} * double{one.reflected_on});
  }
  const auto all = static_cast<double>(outcomes.size());
  if (reflected > 0.0) per_reflected_ = static_cast<float>(std::pow(all / reflected, 2));
  if (refracted > 0.0) per_refracted_ = static_cast<float>(worth_of_transmission * std::pow(all / refracted, 2));
  reflected_on_ = static_cast<float>(on.drawn_to(1.0));
}

// How many of a block and its eight neighbours met the surface again.
std::vector<std::uint8_t> CorrectionPlan::count_around(const std::vector<PilotOutcome>& outcomes,
                                                       bool PilotOutcome::*met) const {
  std::vector<std::uint8_t> counts(outcomes.size());
  for (std::uint32_t row = 0; row < grid_.rows; ++row) {
    for (std::uint32_t column = 0; column < grid_.columns; ++column) {
      int count = 0;
      for (const std::uint32_t up : {grid_.rows - 1, 0U, 1U})
        for (const std::uint32_t right : {grid_.columns - 1, 0U, 1U}) {
          const std::size_t other =
              std::size_t{(row + up) % grid_.rows} * grid_.columns + (column + right) % grid_.columns;
          count += outcomes[other].lit && outcomes[other].*met ? 1 : 0;
        }
      counts[std::size_t{row} * grid_.columns + column] = static_cast<std::uint8_t>(count);
    }
  }
  return counts;
}

void CorrectionPlan::learn_meetings(const std::vector<PilotOutcome>& outcomes) {
  crowd_ = count_around(outcomes, &PilotOutcome::reflected_met);
  crowd_below_ = count_around(outcomes, &PilotOutcome::refracted_met);
  std::array<std::array<Frequency, way_classes>, crowd_classes> seen;
  std::array<Frequency, crowd_classes> of_crowd, below;
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    const PilotOutcome& one = outcomes[k];
    if (!one.lit) continue;
    // A pilot's own outcome is left out of its class, so that the chances hold for other points as well.
    const std::size_t others = crowd_[k] - (one.reflected_met ? 1U : 0U);
    of_crowd[others].add(one.reflected_met ? 1.0 : 0.0);
    seen[others][way_class(one.way_up)].add(one.reflected_met ? 1.0 : 0.0);
    below[crowd_below_[k] - (one.refracted_met ? 1U : 0U)].add(one.refracted_met ? 1.0 : 0.0);
  }
  for (std::size_t crowd = 0; crowd < crowd_classes; ++crowd) {
    const double typical = of_crowd[crowd].drawn_to(unseen);
    for (std::size_t way = 0; way < way_classes; ++way)
      chance_[crowd][way] = static_cast<float>(seen[crowd][way].drawn_to(typical));
    chance_below_[crowd] = static_cast<float>(below[crowd].drawn_to(unseen));
  }
  // From a block and its neighbours to neighbours alone: what the classes count.
  for (auto* crowds : {&crowd_, &crowd_below_})
    for (std::uint8_t& count : *crowds) count = static_cast<std::uint8_t>((8 * count + 4) / 9);
}

std::size_t CorrectionPlan::way_class(float way_up) {
  if (!(way_up > 0.0F)) return 0;
  return std::min(way_classes - 1, 1 + static_cast<std::size_t>(way_up * static_cast<float>(way_classes - 1)));
}

bool CorrectionPlan::judge(std::uint32_t column, std::uint32_t row, float way_up) {
  const float chance =
      way_up > 0.0F ? chance_[crowd_[std::size_t{row / block} * grid_.columns + column / block]][way_class(way_up)]
                    : 1.0F;
  const std::size_t cell = std::size_t{row} * columns_ + column;
  meets_[cell] = chance > 0.5F ? 1 : 0;
  return chance <= surely_not || chance >= surely || lit_[cell] == 0;
}

// 3 · judgement, plus 2 where one of the eight neighbours was judged otherwise, 1 where one of theirs was.
std::vector<std::uint8_t> CorrectionPlan::with_neighbours(const std::vector<std::uint8_t>& judged) const {
  std::vector<std::uint8_t> differs(judged.size()), classes(judged.size());
  const std::size_t columns = columns_;
  // Puts what `use` makes of a cell and the bits that differ around it into `to`.
  const auto around = [&](const std::vector<std::uint8_t>& from, std::vector<std::uint8_t>& to, const auto& use) {
    tbb::parallel_for(std::uint32_t{0}, rows_, [&](std::uint32_t row) {
      const std::uint8_t* here = from.data() + row * columns;
      const std::uint8_t* above = from.data() + (row + 1 == rows_ ? 0 : row + 1) * columns;
      const std::uint8_t* below = from.data() + (row == 0 ? rows_ - 1 : row - 1) * columns;
      std::uint8_t* result = to.data() + row * columns;
      const std::uint8_t* mine = judged.data() + row * columns;
      const std::uint8_t* adjacent = differs.data() + row * columns;
      const auto compare = [&](std::size_t left, std::size_t k, std::size_t right) {
        const int one = here[k];
        const int other = (here[left] ^ one) | (here[right] ^ one) | (above[k] ^ one) | (below[k] ^ one) |
                          (above[left] ^ one) | (above[right] ^ one) | (below[left] ^ one) | (below[right] ^ one);
        result[k] = use(mine[k], adjacent[k], other != 0);
      };
      compare(columns - 1, 0, 1);
      for (std::size_t k = 1; k + 1 < columns; ++k) compare(k - 1, k, k + 1);
      compare(columns - 2, columns - 1, 0);
    });
  };
  around(judged, differs, [](int, int, bool other) { return static_cast<std::uint8_t>(other ? 1 : 0); });
  around(differs, classes, [](int mine, int adjacent, bool other) {
    return static_cast<std::uint8_t>(3 * mine + (adjacent != 0 ? 2 : other ? 1 : 0));
  });
  return classes;
}

void CorrectionPlan::learn_doubt(const std::vector<PilotOutcome>& outcomes) {
  lit_class_ = with_neighbours(lit_);
  meet_class_ = with_neighbours(meets_);
  std::array<Frequency, lit_classes> wrongly_lit;
  std::array<Frequency, meet_classes> again;
  for (const PilotOutcome& one : outcomes) {
    if (!one.faces_light) continue;
    const std::size_t cell = std::size_t{one.row} * columns_ + one.column;
    const double wrong = (one.lit ? 1.0 : 0.0) - double{lit_share(cell)};
    wrongly_lit[lit_class_[cell]].add(wrong * wrong);
    if (one.lit && one.way_up > 0.0F) again[meet_class_[cell]].add(one.reflected_met ? 1.0 : 0.0);
  }
  for (std::size_t k = 0; k < lit_classes; ++k)
    wrongly_lit_[k] = static_cast<float>(wrongly_lit[k].drawn_to(expected_wrong[k % 3]));
  for (std::size_t k = 0; k < meet_classes; ++k) {
    const double wrong = expected_wrong[k % 3];
    meets_again_[k] = static_cast<float>(again[k].drawn_to(k < 3 ? wrong : 1.0 - wrong));
    wrong_way_[k] = std::max(least_doubt, k < 3 ? meets_again_[k] : 1.0F - meets_again_[k]);
  }
}

float CorrectionPlan::likely_square(std::size_t cell, float way_up, float reflected, float refracted) const {
  const float wrongly = wrongly_lit_[lit_class_[cell]], lit = lit_share(cell);
  const std::size_t meets = meet_class_[cell];
  // What was taken for gone and is not, or the other way round; and where what meets the surface goes then.
  const float straight = way_up > 0.0F ? wrongly + lit * wrong_way_[meets] : 0.0F;
  const float further = (lit + wrongly) * (way_up > 0.0F ? meets_again_[meets] : 1.0F) * reflected_on_;
  const std::size_t row = cell / columns_, column = cell - row * columns_;
  const float below = chance_below_[crowd_below_[row / block * grid_.columns + column / block]];
  return per_reflected_ * reflected * reflected * (straight + further) +
         per_refracted_ * (refracted * refracted * (wrongly + lit * below));
}

void CorrectionPlan::set_density(std::vector<float> importance) {
  double sum = 0.0, squares = 0.0;
  for (const float one : importance) sum += double{one};
  const auto cells = static_cast<double>(importance.size());
  const auto least = static_cast<float>(least_density * sum / cells);
  if (!(sum > 0.0)) std::fill(importance.begin(), importance.end(), 1.0F);
  sum = 0.0;
  for (float& one : importance) {
    one = one > 0.0F ? std::max(one, least) : 0.0F;
    sum += double{one};
    squares += double{one} * double{one};
  }
  density_share_ = sum * sum / (cells * squares);
  density_.emplace(columns_, rows_, importance);
  lit_class_ = {};
  meet_class_ = {};
}

double CorrectionPlan::dark_share() const {
  double dark = 0.0;
  for (const std::uint8_t cell : lit_) dark += 2.0 - cell;
  return 0.5 * dark / static_cast<double>(lit_.size());
}

double CorrectionPlan::meeting_share() const {
  return static_cast<double>(std::count(meets_.begin(), meets_.end(), 1)) / static_cast<double>(meets_.size());
}

}  // namespace mezzotint
