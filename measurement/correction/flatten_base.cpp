#include "measurement/correction/flatten_base.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "forward/surface/row_bands.h"
#include "measurement/correction/plane_rows.h"
#include "measurement/correction/polynomial_sums.h"

namespace mezzotint {

namespace {

constexpr int most_iterations = 12;  // a degree
constexpr double width_of_base = 3.0;
constexpr double half_of_a_gaussian = 1.3489795;  // its middle half is so many standard deviations wide
constexpr std::size_t bins = 8192;
// The way through the degrees is walked on so many rows at least; all of them count at the end.
constexpr std::size_t least_rows = 128;

/// Heights above a polynomial that are base.
struct Base {
  SurfacePolynomial form;
  float low_um = 0.0F, high_um = 0.0F;

  [[nodiscard]] bool holds(float above_um) const { return (above_um >= low_um) & (above_um <= high_um); }
};

struct Range {
  float low = std::numeric_limits<float>::infinity(), high = -low;
  Range& operator+=(const Range& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
    return *this;
  }
};

struct Histogram {
  std::vector<std::uint32_t> counts = std::vector<std::uint32_t>(bins + 1, 0);  // the last: missing
  Histogram& operator+=(const Histogram& other) {
    std::ranges::transform(counts, other.counts, counts.begin(), std::plus<>());
    return *this;
  }
};

/// Some rows of a field, which stand for all.
class Rows {
public:
  // All of which anything was measured.
  explicit Rows(const HeightField& field) : field_(field) {
    for (std::size_t row = 0; row < field.rows(); ++row) {
      const auto heights_um = row_of(field, row);
      if (!std::ranges::all_of(heights_um, [](float z) { return std::isnan(z); })) rows_.push_back(row);
    }
  }
  // A part of them, each from another place within its step, so that no lay keeps in step with them.
  [[nodiscard]] Rows thinned() const {
    constexpr double golden = 0.6180339887498949;
    const std::size_t step = std::max<std::size_t>(1, rows_.size() / least_rows);
    Rows some = *this;
    some.rows_.clear();
    for (std::size_t k = 0; (k + 1) * step <= rows_.size(); ++k) {
      const double turn = golden * static_cast<double>(k);
      some.rows_.push_back(
          rows_[k * step + static_cast<std::size_t>((turn - std::floor(turn)) * static_cast<double>(step))]);
    }
    return some;
  }

  // visit(sums, row, its heights above the polynomial), band by band.
  template <class Sums, class Visit>
  [[nodiscard]] Sums sum_above(const SurfacePolynomial& form, const Sums& zero, const Visit& visit) const {
    return sum_of_bands(rows_.size(), zero, [&](std::size_t first, std::size_t end) {
      Sums sums = zero;
      std::vector<float> above_um(field_.columns());
      for (std::size_t k = first; k < end; ++k) {
        heights_above(form, rows_[k], above_um);
        visit(sums, rows_[k], above_um);
      }
      return sums;
    });
  }

  void heights_above(const SurfacePolynomial& form, std::size_t row, std::span<float> above_um) const {
    subtract_row_polynomial(row_of(field_, row), PolynomialRow(form, field_, row).get(), above_um);
  }

  [[nodiscard]] const HeightField& field() const { return field_; }
  [[nodiscard]] std::size_t size() const { return rows_.size(); }

private:
  const HeightField& field_;
  std::vector<std::size_t> rows_;
};

Range range_above(const SurfacePolynomial& form, const Rows& rows) {
  constexpr std::size_t lanes = 16;
  return rows.sum_above(form, Range{}, [](Range& range, std::size_t, std::span<const float> above_um) {
    std::array<float, lanes> low{}, high{};
    low.fill(range.low);
    high.fill(range.high);
    for (std::size_t i = 0; i + lanes <= above_um.size(); i += lanes)
      for (std::size_t k = 0; k < lanes; ++k) {
        const float z = above_um[i + k];
        low[k] = z < low[k] ? z : low[k];
        high[k] = z > high[k] ? z : high[k];
      }
    for (std::size_t i = above_um.size() / lanes * lanes; i < above_um.size(); ++i)
      if (!std::isnan(above_um[i])) range += {above_um[i], above_um[i]};
    range += {*std::ranges::min_element(low), *std::ranges::max_element(high)};
  });
}

Histogram histogram_above(const SurfacePolynomial& form, const Rows& rows, Range range) {
  const float per_um = static_cast<float>(bins) / (range.high - range.low);
  return rows.sum_above(form, Histogram{}, [=](Histogram& histogram, std::size_t, std::span<const float> above_um) {
    constexpr std::size_t piece = 256;
    std::array<std::int32_t, piece> bin{};
    for (std::size_t begin = 0; begin < above_um.size(); begin += piece) {
      const std::size_t count = std::min(piece, above_um.size() - begin);
      constexpr float last = static_cast<float>(bins) - 1.0F;
      for (std::size_t k = 0; k < count; ++k) {
        const float at = (above_um[begin + k] - range.low) * per_um;
        // NaN compares as neither.
        const float inside = at < last ? at : last;
        bin[k] =
            static_cast<std::int32_t>(above_um[begin + k] == above_um[begin + k] ? inside : static_cast<float>(bins));
      }
      for (std::size_t k = 0; k < count; ++k) ++histogram.counts[static_cast<std::size_t>(bin[k])];
    }
  });
}

// The base above a polynomial: 3 deviations about the shortest interval that holds half of the samples, to one of 8192
// bins of the range.
Base densest_half(const SurfacePolynomial& form, const Rows& rows) {
  const Range range = range_above(form, rows);
  if (!(range.low < range.high)) return {form, range.low, range.high};
  const Histogram histogram = histogram_above(form, rows, range);
  std::size_t total = 0;
  for (std::size_t bin = 0; bin < bins; ++bin) total += histogram.counts[bin];
  std::size_t first = 0, inside = 0, shortest = bins + 1, at = 0;
  for (std::size_t last = 0; last < bins; ++last) {
    inside += histogram.counts[last];
    while (2 * (inside - histogram.counts[first]) >= total) inside -= histogram.counts[first++];
    if (2 * inside >= total && last - first + 1 < shortest) {
      shortest = last - first + 1;
      at = first;
    }
  }
  const double bin_um = (static_cast<double>(range.high) - static_cast<double>(range.low)) / bins;
  const double length = static_cast<double>(shortest) * bin_um;
  const double middle = static_cast<double>(range.low) + static_cast<double>(at) * bin_um + 0.5 * length;
  const double reach = width_of_base * length / half_of_a_gaussian;
  return {form, static_cast<float>(middle - reach), static_cast<float>(middle + reach)};
}

struct BaseCount {
  std::size_t inside = 0, below = 0, changed = 0;
  BaseCount& operator+=(const BaseCount& other) {
    inside += other.inside;
    below += other.below;
    changed += other.changed;
    return *this;
  }
};

// How many samples a base holds, how many lie below it, and for how many another one says otherwise.
BaseCount compare(const Base& base, const Base& before, const Rows& rows) {
  return rows.sum_above(base.form, BaseCount{},
                        [&](BaseCount& count, std::size_t row, std::span<const float> above_um) {
                          std::vector<float> above_before(above_um.size());
                          rows.heights_above(before.form, row, above_before);
                          std::uint32_t inside = 0, below = 0, changed = 0;
                          for (std::size_t c = 0; c < above_um.size(); ++c) {
                            const bool now = base.holds(above_um[c]);
                            inside += now ? 1U : 0U;
                            below += !now && above_um[c] < base.low_um ? 1U : 0U;
                            changed += now != before.holds(above_before[c]) ? 1U : 0U;
                          }
                          count += {inside, below, changed};
                        });
}

// The polynomial through what a base holds.
SurfacePolynomial fit_through(const Base& base, int degree, const Rows& rows) {
  const PolynomialSums none(degree, rows.field());
  return rows
      .sum_above(base.form, none,
                 [&](PolynomialSums& sums, std::size_t row, std::span<float> above_um) {
                   const auto heights_um = row_of(rows.field(), row);
                   for (std::size_t c = 0; c < above_um.size(); ++c)
                     above_um[c] = base.holds(above_um[c]) ? heights_um[c] : std::numeric_limits<float>::quiet_NaN();
                   sums.add_row(row, above_um);
                 })
      .solve();
}

/// The base as far as it is known.
struct Search {
  SurfacePolynomial form;
  std::size_t inside = 0, below = 0;
  int iterations = 0;
  bool settled = false;

  /// Of the samples that are not base.
  [[nodiscard]] double share_below(double measured) const {
    const double others = measured - static_cast<double>(inside);
    return others > 0.0 ? static_cast<double>(below) / others : 0.0;
  }
};

// Fits again until the base stays.
void settle(Search& search, int degree, const Rows& rows) {
  search.settled = false;
  Base before;
  for (int step = 0; step < most_iterations; ++step) {
    const Base base = densest_half(search.form, rows);
    if (step > 0) {
      const BaseCount count = compare(base, before, rows);
      search.inside = count.inside;
      search.below = count.below;
      search.settled = 1000 * count.changed <= count.inside;
      if (search.settled) return;
    }
    // Of the field itself, so that the rounding of many subtractions does not add up.
    search.form = fit_through(base, degree, rows);
    before = base;
    ++search.iterations;
  }
}

std::string warning_of(const FlattenedBase& flat, double below) {
  constexpr double most = 0.75, mostly = 0.9;
  if (!flat.settled) return "the base did not settle: it may not be what most of the surface is; look at the result";
  if (flat.base_share >= most || below < mostly) return "";
  return fmt::format(
      "what was taken for the base is {:.0f} % of the samples, and the others lie below it: plateaus that cover more "
      "than half of a surface are taken for its base. Crop a part with more base, or level by a plane",
      100.0 * flat.base_share);
}

}  // namespace

FlattenedBase flatten_base(HeightField field, int degree) {
  require(degree >= 1 && degree <= highest_degree, "a base is flattened by a polynomial of degree 1 to 12");
  const auto measured = static_cast<double>(field.grid().size() - field.missing_count());
  Search search{fit_polynomial(field, 1)};
  const Rows all(field), some = all.thinned();
  for (int d = 1; d <= degree; ++d) settle(search, d, some);
  if (some.size() < all.size()) settle(search, degree, all);
  FlattenedBase result{subtract_polynomial(std::move(field), search.form)};
  result.base_share = static_cast<double>(search.inside) / measured;
  result.iterations = search.iterations;
  result.settled = search.settled;
  result.warning = warning_of(result, search.share_below(measured));
  return result;
}

}  // namespace mezzotint
