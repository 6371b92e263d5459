#include "measurement/texture/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "forward/base/error.h"
#include "measurement/texture/block_jackknife.h"

namespace mezzotint {

Profile profile_along(const HeightField& field, FieldPoint from, FieldPoint to) {
  const Grid& grid = field.grid();
  const double width = static_cast<double>(grid.columns - 1) * grid.pitch_x.um();
  const double depth = static_cast<double>(grid.rows - 1) * grid.pitch_y.um();
  for (const FieldPoint& point : {from, to}) {
    require(point.x_um >= 0.0 && point.x_um <= width && point.y_um >= 0.0 && point.y_um <= depth,
            "a profile must stay within the field: x from 0 to " + std::to_string(width) + " µm, y from 0 to " +
                std::to_string(depth) + " µm");
  }
  const double dx = to.x_um - from.x_um, dy = to.y_um - from.y_um, length = std::hypot(dx, dy);
  // As many samples as the line passes along its longer axis.
  const double steps = std::round(std::max(std::abs(dx) / grid.pitch_x.um(), std::abs(dy) / grid.pitch_y.um()));
  require(steps >= 16.0, "a profile must be 16 spacings long at least");
  Profile profile{Length::from_um(length / steps), {}};
  const auto count = static_cast<std::size_t>(steps) + 1;
  profile.heights_um.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double share = static_cast<double>(k) / steps;
    profile.heights_um.push_back(height_um_at(field, {from.x_um + share * dx, from.y_um + share * dy}));
  }
  return profile;
}

Profile mean_line(const Profile& profile, Length cutoff) {
  require(std::isfinite(cutoff.um()) && cutoff.um() > 0.0, "a filter needs a positive cut-off wavelength");
  const double alpha = std::sqrt(std::numbers::ln2 / std::numbers::pi);
  const auto count = static_cast<std::ptrdiff_t>(profile.heights_um.size());
  const double wide = std::min(cutoff / profile.spacing, 100.0 * static_cast<double>(count));
  const auto reach = std::min(count, static_cast<std::ptrdiff_t>(std::ceil(1.2 * wide)));
  std::vector<double> weight(static_cast<std::size_t>(reach) + 1);
  for (std::size_t k = 0; k < weight.size(); ++k)
    weight[k] = std::exp(-std::numbers::pi * std::pow(static_cast<double>(k) / (alpha * wide), 2));
  Profile result{profile.spacing, std::vector<double>(profile.heights_um.size(), std::nan(""))};
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    if (std::isnan(profile.heights_um[static_cast<std::size_t>(i)])) continue;
    double s0 = 0.0, s1 = 0.0, s2 = 0.0, t0 = 0.0, t1 = 0.0;
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, i - reach); j <= std::min(count - 1, i + reach); ++j) {
      const double z = profile.heights_um[static_cast<std::size_t>(j)];
      if (std::isnan(z)) continue;
      const auto x = static_cast<double>(j - i);
      const double w = weight[static_cast<std::size_t>(std::abs(j - i))];
      s0 += w;
      s1 += w * x;
      s2 += w * x * x;
      t0 += w * z;
      t1 += w * x * z;
    }
    const double determinant = s0 * s2 - s1 * s1;
    constexpr double rounding = 1e-12;
    result.heights_um[static_cast<std::size_t>(i)] =
        determinant > rounding * s0 * s2 ? (t0 * s2 - t1 * s1) / determinant : t0 / s0;
  }
  return result;
}

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

void take_out_line(Profile& profile) {
  double n = 0.0, x = 0.0, z = 0.0, xx = 0.0, xz = 0.0;
  const auto middle = 0.5 * static_cast<double>(profile.heights_um.size() - 1);
  for (std::size_t k = 0; k < profile.heights_um.size(); ++k) {
    if (std::isnan(profile.heights_um[k])) continue;
    const double at = static_cast<double>(k) - middle;
    n += 1.0;
    x += at;
    z += profile.heights_um[k];
    xx += at * at;
    xz += at * profile.heights_um[k];
  }
  require(n >= 16.0, "profile parameters need 16 measured heights at least");
  const double slope = (n * xz - x * z) / (n * xx - x * x), offset = (z - slope * x) / n;
  for (std::size_t k = 0; k < profile.heights_um.size(); ++k)
    profile.heights_um[k] -= offset + slope * (static_cast<double>(k) - middle);
}

void subtract(Profile& profile, const Profile& line) {
  for (std::size_t k = 0; k < profile.heights_um.size(); ++k) profile.heights_um[k] -= line.heights_um[k];
}

Quantity mean_of(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += value;
  const auto n = static_cast<double>(values.size());
  const double mean = sum / n;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, "µm", values.size() > 1 ? std::sqrt(squares / (n - 1.0) / n) : nan};
}

/// Sums over a stretch of the profile.
struct Section {
  double n = 0.0, absolute = 0.0, second = 0.0, third = 0.0, fourth = 0.0;
  double highest = 0.0, lowest = 0.0;  // at least the mean line
  double slopes = 0.0, square_slopes = 0.0;

  void add(const Section& other) {
    n += other.n;
    absolute += other.absolute;
    second += other.second;
    third += other.third;
    fourth += other.fourth;
    highest = std::max(highest, other.highest);
    lowest = std::min(lowest, other.lowest);
    slopes += other.slopes;
    square_slopes += other.square_slopes;
  }
  [[nodiscard]] double mean_deviation() const { return absolute / n; }
  [[nodiscard]] double rms() const { return std::sqrt(second / n); }
  [[nodiscard]] double skewness() const { return third / n / std::pow(rms(), 3); }
  [[nodiscard]] double kurtosis() const { return fourth / n / std::pow(rms(), 4); }
  [[nodiscard]] double rms_slope() const { return slopes > 0.0 ? std::sqrt(square_slopes / slopes) : nan; }
};

// The seven-point derivative that ISO 4287 gives for local slopes; NaN at the ends and beside missing values.
double local_slope(const Profile& profile, std::size_t k) {
  if (k < 3 || k + 3 >= profile.heights_um.size()) return nan;
  const double* z = profile.heights_um.data() + k;
  return (z[3] - 9.0 * z[2] + 45.0 * z[1] - 45.0 * z[-1] + 9.0 * z[-2] - z[-3]) / 60.0 / profile.spacing.um();
}

Section section_of(const Profile& profile, std::size_t begin, std::size_t end) {
  Section section;
  for (std::size_t k = begin; k < end; ++k) {
    const double z = profile.heights_um[k];
    if (std::isnan(z)) continue;
    const double slope = local_slope(profile, k), known = std::isnan(slope) ? 0.0 : 1.0;
    section.add({1.0, std::abs(z), z * z, z * z * z, z * z * z * z, z, z, known, known > 0.0 ? slope * slope : 0.0});
  }
  return section;
}

// A statistic of the whole profile, with the standard error from leaving out each sampling length in turn.
template <class Statistic>
Quantity estimate(const std::vector<Section>& sections, const Section& whole, const char* unit,
                  const Statistic& statistic) {
  std::vector<double> without, samples;
  for (std::size_t j = 0; j < sections.size(); ++j) {
    Section rest;
    for (std::size_t k = 0; k < sections.size(); ++k)
      if (k != j) rest.add(sections[k]);
    without.push_back(statistic(rest));
    samples.push_back(sections[j].n);
  }
  return {statistic(whole), unit, jackknife_standard_error(statistic(whole), without, samples)};
}

// Widths, in samples, of elements: from one place where a peak that counts follows a valley that counts to the next. A
// missing value ends an element unfinished.
std::vector<double> element_widths(const std::vector<double>& heights_um, double least_um, double least_width) {
  std::vector<double> widths;
  double begin = nan, last_crossing = nan;
  int side = 0;  // of the last excursion that counts
  for (std::size_t k = 1; k < heights_um.size(); ++k) {
    const double before = heights_um[k - 1], z = heights_um[k];
    if (std::isnan(z) || std::isnan(before)) {
      side = 0;
      begin = last_crossing = nan;
      continue;
    }
    if (before < 0.0 && z >= 0.0) last_crossing = static_cast<double>(k) - z / (z - before);
    if (z <= -least_um) side = -1;
    if (z < least_um || side == 1) continue;
    const double width = last_crossing - begin;
    if (side == -1 && !std::isnan(last_crossing) && !(width < least_width)) {
      if (!std::isnan(width)) widths.push_back(width);
      begin = last_crossing;
    }
    side = 1;
  }
  return widths;
}

std::vector<Section> sampling_lengths_of(const Profile& profile, double samples_a_length) {
  const auto count = profile.heights_um.size();
  const auto lengths = static_cast<std::size_t>(std::floor((static_cast<double>(count) + 1e-6) / samples_a_length));
  const auto edge = [&](std::size_t i) {
    return std::min(count, static_cast<std::size_t>(std::llround(static_cast<double>(i) * samples_a_length)));
  };
  std::vector<Section> sections;
  for (std::size_t k = 0; k < lengths; ++k) sections.push_back(section_of(profile, edge(k), edge(k + 1)));
  return sections;
}

void add_heights(ProfileParameters& result, const std::vector<Section>& sections) {
  std::vector<double> p, v, z;
  for (const Section& section : sections) {
    if (section.n == 0.0) continue;
    p.push_back(section.highest);
    v.push_back(-section.lowest);
    z.push_back(section.highest - section.lowest);
  }
  result.z = mean_of(z);
  result.p = mean_of(p);
  result.v = mean_of(v);
}

}  // namespace

ProfileParameters profile_parameters(const Profile& given, const ProfileFilter& filter) {
  Profile profile = given;
  take_out_line(profile);
  if (filter.lambda_s.um() > 0.0) profile = mean_line(profile, filter.lambda_s);
  const bool roughness = filter.lambda_c.um() > 0.0;
  if (roughness) subtract(profile, mean_line(profile, filter.lambda_c));
  const auto count = static_cast<double>(profile.heights_um.size());
  const double samples_a_length = roughness ? filter.lambda_c / profile.spacing : count;
  const std::vector<Section> sections = sampling_lengths_of(profile, samples_a_length);
  require(!sections.empty(), "the profile is shorter than one sampling length (lambda_c); take a longer one");
  const Section whole = section_of(profile, 0, profile.heights_um.size());

  ProfileParameters result;
  result.letter = roughness ? 'R' : 'P';
  result.sampling_lengths = sections.size();
  add_heights(result, sections);
  result.a = estimate(sections, whole, "µm", [](const Section& s) { return s.mean_deviation(); });
  result.q = estimate(sections, whole, "µm", [](const Section& s) { return s.rms(); });
  result.sk = estimate(sections, whole, "1", [](const Section& s) { return s.skewness(); });
  result.ku = estimate(sections, whole, "1", [](const Section& s) { return s.kurtosis(); });
  result.dq = estimate(sections, whole, "1", [](const Section& s) { return s.rms_slope(); });
  result.t = {whole.highest - whole.lowest, "µm", nan};
  result.missing_share = 1.0 - whole.n / count;
  std::vector<double> widths = element_widths(profile.heights_um, 0.1 * result.z.value, 0.01 * samples_a_length);
  for (double& width : widths) width *= profile.spacing.um();
  result.sm = widths.empty() ? Quantity{nan, "µm", nan} : mean_of(widths);
  return result;
}

}  // namespace mezzotint
