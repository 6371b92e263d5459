#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/text_values.h"
#include "measurement/reflectance/reflectance_parsers.h"
#include "measurement/reflectance/text_samples.h"

namespace mezzotint {

namespace {

constexpr std::size_t most_channels = 4096;
// Where the cosine that a sample is divided by is too small to say anything.
constexpr double horizon = 0.01 * std::numbers::pi / 180.0;

class AltaReader {
public:
  AltaReader(const std::filesystem::path& path, std::span<const std::byte> bytes)
      : path_(path), scanner_(path, bytes) {}

  MeasuredReflectance read() {
    measured_.format = "ALTA";
    measured_.quantity = "BRDF · cosθ_o at scattered directions, divided by the cosine here";
    measured_.assumption = "the numbers hold the cosine of the viewer, which the file does not say; isotropic";
    std::vector<ScatteredSample> samples;
    while (!scanner_.at_end()) {
      const std::string_view line = trimmed(scanner_.take_line());
      if (line.empty()) continue;
      if (line.front() == '#') {
        read_head_line(line);
      } else {
        add_row(words_of(line), samples);
      }
    }
    if (samples.empty()) scanner_.fail("the file holds no samples");
    watch_.finish(path_, measured_);
    measured_.provenance["at_the_horizon"] = std::to_string(at_the_horizon_);
    try {
      ScatteredLobes lobes = scattered_lobes(std::move(samples));
      for (const ScatteredLobe& lobe : lobes.lobes) measured_.incidences.push_back({lobe.theta_i, {}});
      measured_.data = std::move(lobes);
    } catch (const InvalidInput& error) {
      throw FileError(path_, "", error.what());
    }
    return std::move(measured_);
  }

private:
  void read_head_line(std::string_view line) {
    const auto words = words_of(line);
    const bool counts = words[0] == "#DIM" || words[0].starts_with("#PARAM") || words[0] == "#VS";
    if (counts && has_rows_) scanner_.fail("a line of the head stands after the first row");
    const auto value = [&] { return words.size() == 2 ? words[1] : std::string_view{}; };
    if (words[0] == "#DIM") {
      if (words.size() != 3 || words[1] != "3") scanner_.fail("reads \"#DIM 3 N\": three angles, N channels");
      const std::size_t count = count_of(words[2], "channels", most_channels, scanner_);
      measured_.channels.clear();
      for (std::size_t c = 0; c < count; ++c)
        measured_.channels.push_back({count == 3 ? std::string(1, "RGB"[c]) : fmt::format("channel {}", c + 1), {}});
    } else if (words[0] == "#PARAM_IN") {
      if (value() != "ISOTROPIC_TL_TV_PROJ_DPHI")
        scanner_.fail("only the parameterisation ISOTROPIC_TL_TV_PROJ_DPHI is read");
      known_angles_ = true;
    } else if (words[0] == "#PARAM_OUT") {
      if (value() != "INV_STERADIAN_COSINE_FACTOR" && value() != "INV_STERADIAN")
        scanner_.fail("only BRDFs are read: INV_STERADIAN_COSINE_FACTOR or INV_STERADIAN");
      with_cosine_ = value() == "INV_STERADIAN_COSINE_FACTOR";
      measured_.assumption = "isotropic";
      if (!with_cosine_) measured_.quantity = "BRDF at scattered directions";
    } else if (words[0] == "#VS") {
      for (std::size_t i = 1; i < words.size(); ++i) {
        if (words[i] != "0") scanner_.fail("columns of intervals (#VS) are not read");
      }
    } else if (words.size() >= 2 && measured_.provenance.size() < 16) {
      measured_.provenance.emplace(clean_text(words[0].substr(1)),
                                   clean_text(trimmed(line.substr(line.find(words[0]) + words[0].size()))));
    }
  }

  void add_row(const std::vector<std::string_view>& words, std::vector<ScatteredSample>& samples) {
    if (measured_.channels.empty() || !known_angles_)
      scanner_.fail("numbers stand before \"#DIM 3 N\" and \"#PARAM_IN …\"");
    if (words.size() != 3 + measured_.channels.size()) {
      scanner_.fail(fmt::format("has {} numbers; a row has {}: three angles and a sample a channel", words.size(),
                                3 + measured_.channels.size()));
    }
    has_rows_ = true;
    const double theta_l = finite_number(words[0], scanner_);
    const PlanePoint place{finite_number(words[1], scanner_), finite_number(words[2], scanner_)};
    const double theta_v = std::hypot(place.x, place.y);
    if (theta_l < 0.0 || theta_l > std::numbers::pi / 2.0 || theta_v > std::numbers::pi / 2.0 + 1e-4)
      scanner_.fail("angles are in radians, from the normal to the horizon");
    ScatteredSample row{Angle::from_radians(theta_l), place, {}};
    for (std::size_t c = 3; c < words.size(); ++c) {
      const double sample = finite_number(words[c], scanner_);
      watch_.add(sample, scanner_);
      row.values.push_back(static_cast<float>(with_cosine_ ? sample / std::cos(theta_v) : sample));
    }
    if (with_cosine_ && theta_v > std::numbers::pi / 2.0 - horizon) {
      ++at_the_horizon_;
    } else {
      samples.push_back(std::move(row));
    }
  }

  const std::filesystem::path& path_;
  TextScanner scanner_;
  MeasuredReflectance measured_;
  SampleWatch watch_;
  bool known_angles_ = false, with_cosine_ = true, has_rows_ = false;
  std::size_t at_the_horizon_ = 0;
};

}  // namespace

bool looks_like_alta(std::span<const std::byte> bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text.starts_with('#') && text.find("#PARAM_IN") != std::string_view::npos;
}

MeasuredReflectance parse_alta(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  return AltaReader(path, bytes).read();
}

}  // namespace mezzotint
