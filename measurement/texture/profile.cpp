#include "measurement/texture/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "forward/base/error.h"

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

struct Section {
  double a = 0.0, q = 0.0, p = 0.0, v = 0.0;
};

Section section_of(const std::vector<double>& heights_um, std::size_t begin, std::size_t end) {
  Section section;
  double n = 0.0, highest = -HUGE_VAL, lowest = HUGE_VAL;
  for (std::size_t k = begin; k < end; ++k) {
    const double z = heights_um[k];
    if (std::isnan(z)) continue;
    n += 1.0;
    section.a += std::abs(z);
    section.q += z * z;
    highest = std::max(highest, z);
    lowest = std::min(lowest, z);
  }
  if (n == 0.0) return {nan, nan, nan, nan};
  return {section.a / n, std::sqrt(section.q / n), std::max(0.0, highest), std::max(0.0, -lowest)};
}

// Places (in samples) where a peak that counts follows a valley that counts: where elements begin.
std::vector<double> upward_crossings(const std::vector<double>& heights_um, double least_um, double least_width) {
  std::vector<double> crossings;
  double last_crossing = nan;
  int side = 0;  // of the last excursion that counts
  for (std::size_t k = 1; k < heights_um.size(); ++k) {
    const double before = heights_um[k - 1], z = heights_um[k];
    if (std::isnan(z) || std::isnan(before)) {
      side = 0;
      last_crossing = nan;
      continue;
    }
    if (before < 0.0 && z >= 0.0) last_crossing = static_cast<double>(k) - z / (z - before);
    if (z <= -least_um) side = -1;
    if (z < least_um || side == 1) continue;
    const bool wide = crossings.empty() || last_crossing - crossings.back() >= least_width;
    if (side == -1 && !std::isnan(last_crossing) && wide) crossings.push_back(last_crossing);
    side = 1;
  }
  return crossings;
}

double mean_square_slope(const Profile& profile) {
  double sum = 0.0, n = 0.0;
  // The seven-point derivative that ISO 4287 gives for local slopes.
  for (std::size_t k = 3; k + 3 < profile.heights_um.size(); ++k) {
    const double* z = profile.heights_um.data() + k;
    const double slope = (z[3] - 9.0 * z[2] + 45.0 * z[1] - 45.0 * z[-1] + 9.0 * z[-2] - z[-3]) / 60.0;
    if (std::isnan(slope)) continue;
    sum += slope * slope;
    n += 1.0;
  }
  return n > 0.0 ? std::sqrt(sum / n) / profile.spacing.um() : nan;
}

}  // namespace

ProfileParameters profile_parameters(const Profile& given, const ProfileFilter& filter) {
  Profile profile = given;
  take_out_line(profile);
  const auto count = profile.heights_um.size();
  if (filter.lambda_s.um() > 0.0) profile = mean_line(profile, filter.lambda_s);
  const bool roughness = filter.lambda_c.um() > 0.0;
  if (roughness) subtract(profile, mean_line(profile, filter.lambda_c));
  const double samples_a_length = roughness ? filter.lambda_c / profile.spacing : static_cast<double>(count);
  const double lengths = std::floor((static_cast<double>(count) + 1e-6) / samples_a_length);
  require(lengths >= 1.0, "the profile is shorter than one sampling length (lambda_c); take a longer one");

  ProfileParameters result;
  result.letter = roughness ? 'R' : 'P';
  result.sampling_lengths = static_cast<std::size_t>(lengths);
  std::vector<double> a, q, p, v, z;
  for (std::size_t k = 0; k < result.sampling_lengths; ++k) {
    const auto edge = [&](std::size_t i) {
      return std::min(count, static_cast<std::size_t>(std::llround(static_cast<double>(i) * samples_a_length)));
    };
    const Section section = section_of(profile.heights_um, edge(k), edge(k + 1));
    if (std::isnan(section.a)) continue;
    a.push_back(section.a);
    q.push_back(section.q);
    p.push_back(section.p);
    v.push_back(section.v);
    z.push_back(section.p + section.v);
  }
  result.z = mean_of(z);
  result.p = mean_of(p);
  result.v = mean_of(v);
  const Section whole = section_of(profile.heights_um, 0, count);
  result.a = {whole.a, "µm", mean_of(a).standard_error};
  result.q = {whole.q, "µm", mean_of(q).standard_error};
  result.t = {whole.p + whole.v, "µm", nan};
  double n = 0.0, third = 0.0, fourth = 0.0;
  for (const double height : profile.heights_um) {
    if (std::isnan(height)) continue;
    n += 1.0;
    third += std::pow(height, 3);
    fourth += std::pow(height, 4);
  }
  result.sk = {third / n / std::pow(whole.q, 3), "1", nan};
  result.ku = {fourth / n / std::pow(whole.q, 4), "1", nan};
  result.dq = {mean_square_slope(profile), "1", nan};
  result.missing_share = 1.0 - n / static_cast<double>(count);
  const std::vector<double> crossings =
      upward_crossings(profile.heights_um, 0.1 * result.z.value, 0.01 * samples_a_length);
  std::vector<double> widths;
  for (std::size_t k = 1; k < crossings.size(); ++k)
    widths.push_back((crossings[k] - crossings[k - 1]) * profile.spacing.um());
  result.sm = widths.empty() ? Quantity{nan, "µm", nan} : mean_of(widths);
  return result;
}

}  // namespace mezzotint
