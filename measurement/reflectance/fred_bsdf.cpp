#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/text_values.h"
#include "measurement/reflectance/reflectance_parsers.h"
#include "measurement/reflectance/text_samples.h"

namespace mezzotint {

namespace {

struct FredSample {
  double theta, phi, value;  // degrees, degrees
};

struct FredBlock {
  double theta_i, phi_i;  // of the mirrored ray, degrees
  std::size_t line;
  std::vector<FredSample> samples;
};

struct FredFormat {
  double degrees = 1.0;  // an angle of the file in degrees
  double scale = 1.0;
};

class FredReader {
public:
  FredReader(const std::filesystem::path& path, std::span<const std::byte> bytes)
      : path_(path), scanner_(path, bytes) {}

  MeasuredReflectance read() {
    measured_.format = "FRED BSDF";
    measured_.quantity = "BRDF on angles from the normal; directions that are not listed were not measured";
    read_head();
    read_blocks();
    watch_.finish(path_, measured_);
    assemble();
    return std::move(measured_);
  }

private:
  void read_head() {
    bool typed = false, formatted = false;
    while (!scanner_.at_end() && !(typed && formatted)) {
      const auto words = words_of(scanner_.take_line());
      if (words.empty() || words[0].starts_with('#') || words[0].starts_with("//")) continue;
      if (words[0] == "type") {
        if (words.size() != 2 || words[1] != "bsdf_data") scanner_.fail("must read \"type bsdf_data\"");
        typed = true;
      } else if (words[0] == "format") {
        read_format(words);
        formatted = true;
      } else {
        scanner_.fail("stands before \"type bsdf_data\" and \"format …\"");
      }
    }
    if (!typed || !formatted) scanner_.fail("needs a line \"type bsdf_data\" and a line \"format …\"");
  }

  void read_format(const std::vector<std::string_view>& words) {
    for (std::size_t i = 1; i < words.size(); ++i) {
      if (words[i] == "angles=deg" || words[i] == "bsdf=value") continue;
      if (words[i] == "angles=rad") {
        format_.degrees = 180.0 / std::numbers::pi;
      } else if (words[i].starts_with("scale=")) {
        format_.scale = finite_number(words[i].substr(6), scanner_);
        if (!(format_.scale > 0.0)) scanner_.fail("the scale must be above 0");
      } else {
        scanner_.fail(fmt::format("\"{}\" is not known; angles=deg or rad, bsdf=value and scale=… are read",
                                  clean_text(words[i].substr(0, 40))));
      }
    }
  }

  void read_blocks() {
    while (!scanner_.at_end()) {
      const auto words = words_of(scanner_.take_line());
      if (words.empty() || words[0].starts_with('#') || words[0].starts_with("//")) continue;
      std::vector<double> numbers;
      for (const std::string_view word : words) numbers.push_back(finite_number(word, scanner_));
      if (numbers.size() != 2 && numbers.size() != 3)
        scanner_.fail(fmt::format("has {} numbers; a light has 2, a viewer has 3", numbers.size()));
      const double theta = numbers[0] * format_.degrees, phi = numbers[1] * format_.degrees;
      if (theta < 0.0 || theta > 90.0 || std::abs(phi) > 360.0)
        scanner_.fail("angles must lie in 0 … 90° from the normal, and within a turn about it");
      if (numbers.size() == 2) {
        blocks_.push_back({theta, phi, scanner_.line(), {}});
        continue;
      }
      if (blocks_.empty()) scanner_.fail("a viewer stands before the first light");
      watch_.add(numbers[2] * format_.scale, scanner_);
      blocks_.back().samples.push_back({theta, phi - blocks_.back().phi_i, numbers[2] * format_.scale});
    }
  }

  // One plane of incidence stands for all; a light whose azimuths stay on one side is symmetric.
  void assemble() {
    const bool one_plane =
        std::ranges::all_of(blocks_, [this](const FredBlock& block) { return block.phi_i == blocks_[0].phi_i; });
    bool one_sided = one_plane;
    for (const FredBlock& block : blocks_) {
      for (const FredSample& sample : block.samples) {
        const double turned = std::remainder(sample.phi, 360.0);
        one_sided = one_sided && (turned > -1e-6 || turned < -180.0 + 1e-6);
      }
    }
    PolarLobes lobes{PolarLobes::Axis::Normal, one_sided, one_plane, false, {}};
    for (const FredBlock& block : blocks_) lobes.lobes.push_back(lobe_of(block, one_sided, one_plane));
    measured_.isotropic = one_plane;
    if (one_plane) measured_.assumption = "isotropic, since the light comes from one azimuth only";
    measured_.channels = {{"BSDF", {}}};
    for (const PolarLobe& lobe : lobes.lobes) measured_.incidences.push_back(lobe.incidence);
    measured_.data = std::move(lobes);
  }

  [[nodiscard]] PolarLobe lobe_of(const FredBlock& block, bool one_sided, bool one_plane) const {
    const auto fail = [&](const std::string& problem) {
      throw FileError(path_, fmt::format("line {}", block.line), problem);
    };
    std::vector<double> radials, azimuths;
    for (const FredSample& sample : block.samples) {
      radials.push_back(sample.theta);
      if (sample.theta > 0.0) azimuths.push_back(azimuth_of(sample, one_sided));
    }
    make_unique(radials);
    make_unique(azimuths);
    if (radials.size() < 2 || azimuths.size() < 2) fail("the viewers of this light form no grid of two angles");
    const std::size_t cells = radials.size() * azimuths.size();
    if (cells > 4 * block.samples.size()) {
      fail(
          fmt::format("the viewers of this light fill {} of the {} places of a grid of polar and azimuth angles; a "
                      "quarter or more is needed",
                      block.samples.size(), cells));
    }
    // The file names the mirrored ray; the light comes from the other side, or from anywhere.
    const Angle phi = one_plane ? Angle{} : Angle::from_degrees(block.phi_i + 180.0);
    PolarLobe lobe{{Angle::from_degrees(block.theta_i), phi}, {}, {}, {}};
    std::vector<double> values(cells, not_measured);
    for (const FredSample& sample : block.samples) place(sample, one_sided, radials, azimuths, values);
    if (!one_sided) close_turn(azimuths, values, radials.size());
    for (const double angle : azimuths) lobe.azimuth_rad.push_back(Angle::from_degrees(angle).radians());
    for (const double angle : radials) lobe.radial_rad.push_back(Angle::from_degrees(angle).radians());
    lobe.values.assign(values.begin(), values.end());
    return lobe;
  }

  static void place(const FredSample& sample, bool one_sided, const std::vector<double>& radials,
                    const std::vector<double>& azimuths, std::vector<double>& values) {
    const std::size_t column = index_of(radials, sample.theta);
    if (sample.theta <= 0.0) {  // the normal has every azimuth
      for (std::size_t row = 0; row < azimuths.size(); ++row) values[row * radials.size() + column] = sample.value;
      return;
    }
    values[index_of(azimuths, azimuth_of(sample, one_sided)) * radials.size() + column] = sample.value;
  }

  static double azimuth_of(const FredSample& sample, bool one_sided) {
    const double turned = std::remainder(sample.phi, 360.0);
    if (one_sided) return std::abs(turned);
    return turned < -1e-6 ? turned + 360.0 : std::abs(turned);
  }

  static void make_unique(std::vector<double>& angles) {
    std::sort(angles.begin(), angles.end());
    angles.erase(std::unique(angles.begin(), angles.end(), [](double a, double b) { return b - a < 1e-4; }),
                 angles.end());
  }

  static std::size_t index_of(const std::vector<double>& angles, double angle) {
    const auto above = std::lower_bound(angles.begin(), angles.end(), angle - 1e-4);
    return std::min(static_cast<std::size_t>(above - angles.begin()), angles.size() - 1);
  }

  // 360° is 0° again, unless the gap there is wider than any other.
  static void close_turn(std::vector<double>& azimuths, std::vector<double>& values, std::size_t columns) {
    double widest = 0.0;
    for (std::size_t i = 1; i < azimuths.size(); ++i) widest = std::max(widest, azimuths[i] - azimuths[i - 1]);
    if (azimuths.front() + 360.0 - azimuths.back() > 1.5 * widest || azimuths.back() > 360.0 - 1e-4) return;
    azimuths.push_back(azimuths.front() + 360.0);
    const std::vector<double> first(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(columns));
    values.insert(values.end(), first.begin(), first.end());
  }

  const std::filesystem::path& path_;
  TextScanner scanner_;
  FredFormat format_;
  MeasuredReflectance measured_;
  std::vector<FredBlock> blocks_;
  SampleWatch watch_;
};

}  // namespace

bool looks_like_fred(std::span<const std::byte> bytes) { return first_content_begins(bytes, "type bsdf_data"); }

MeasuredReflectance parse_fred(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  return FredReader(path, bytes).read();
}

}  // namespace mezzotint
