#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/text_values.h"
#include "measurement/reflectance/reflectance_parsers.h"
#include "measurement/reflectance/text_samples.h"

namespace mezzotint {

namespace {

constexpr std::size_t most_angles = 4096;

struct ZemaxHeader {
  bool symmetric = true;
  std::vector<std::string> channels;
  std::vector<double> incidences, azimuths, radials;  // degrees
};

class ZemaxReader {
public:
  ZemaxReader(const std::filesystem::path& path, std::span<const std::byte> bytes)
      : path_(path), scanner_(path, bytes) {}

  MeasuredReflectance read() {
    measured_.format = "Zemax BSDF";
    measured_.quantity = "BRDF on angles about the mirrored ray; samples of exactly 0 are taken as not measured";
    measured_.assumption = "isotropic, as the format's one sample rotation says";
    measured_.between_incidences = true;
    const ZemaxHeader header = read_header();
    PolarLobes lobes = empty_lobes(header);
    for (std::size_t c = 0; c < header.channels.size(); ++c) {
      expect(header.channels[c]);
      expect("DataBegin");
      for (PolarLobe& lobe : lobes.lobes) read_block(lobe, c, header);
      expect("DataEnd");
      measured_.channels.push_back({header.channels[c], {}});
    }
    watch_.finish(path_, measured_);
    measured_.data = std::move(lobes);
    return std::move(measured_);
  }

private:
  // The next line that says something.
  std::string_view take_content() {
    while (!scanner_.at_end()) {
      const std::string_view line = trimmed(scanner_.take_line());
      if (line.empty()) continue;
      if (line.front() != '#') return line;
      keep_comment(line, measured_);
    }
    scanner_.fail("the file ends early; it was cut off");
  }

  void expect(std::string_view wanted) {
    const std::string_view line = take_content();
    if (line != wanted) {
      scanner_.fail(fmt::format("reads \"{}\" where \"{}\" must stand", clean_text(line.substr(0, 40)), wanted));
    }
  }

  std::string_view value_of(std::string_view key) {
    const std::vector<std::string_view> words = words_of(take_content());
    if (words.size() != 2 || words[0] != key)
      scanner_.fail(fmt::format("must read \"{} VALUE\", the lines of the head in the order of the format", key));
    return words[1];
  }

  std::vector<double> angles_of(std::string_view key, double low, double high) {
    const std::size_t count = count_of(value_of(key), "angles", most_angles, scanner_);
    const std::vector<std::string_view> words = words_of(take_content());
    if (words.size() != count)
      scanner_.fail(fmt::format("has {} angles where \"{}\" promises {}", words.size(), key, count));
    std::vector<double> angles;
    for (const std::string_view word : words) {
      const double angle = finite_number(word, scanner_);
      if (angle < low || angle > high || (!angles.empty() && angle <= angles.back())) {
        scanner_.fail(
            fmt::format("angles of \"{}\" must increase within [{}, {}] degrees; found {}", key, low, high, angle));
      }
      angles.push_back(angle);
    }
    return angles;
  }

  ZemaxHeader read_header() {
    ZemaxHeader header;
    measured_.provenance["source"] = clean_text(value_of("Source"));
    const std::string_view symmetry = value_of("Symmetry");
    header.symmetric = symmetry == "PlaneSymmetrical";
    if (!header.symmetric && symmetry != "ASymmetrical" && symmetry != "Asymmetrical")
      scanner_.fail("symmetry must be PlaneSymmetrical or ASymmetrical; ASymmetrical4D is not read");
    const std::string_view content = value_of("SpectralContent");
    if (content == "Monochrome") {
      header.channels = {"Monochrome"};
    } else if (content == "XYZ") {
      header.channels = {"TristimulusX", "TristimulusY", "TristimulusZ"};
    } else {
      scanner_.fail("spectral content must be Monochrome or XYZ");
    }
    if (value_of("ScatterType") != "BRDF") scanner_.fail("only BRDF is read: a relief's target is what it reflects");
    if (angles_of("SampleRotation", -360.0, 360.0).size() != 1)
      scanner_.fail("several sample rotations are not read; split the file into one a rotation");
    header.incidences = angles_of("AngleOfIncidence", 0.0, 90.0);
    header.azimuths = angles_of("ScatterAzimuth", 0.0, header.symmetric ? 180.0 : 360.0);
    header.radials = angles_of("ScatterRadial", 0.0, 180.0);
    // Each value takes two characters of the file at least.
    const double claimed = static_cast<double>(header.incidences.size() * header.channels.size()) *
                           static_cast<double>(header.azimuths.size() * header.radials.size());
    if (2.0 * claimed > static_cast<double>(scanner_.remaining()) + 2.0)
      scanner_.fail(fmt::format("the head promises {:.0f} samples, more than the rest of the file can hold", claimed));
    return header;
  }

  PolarLobes empty_lobes(const ZemaxHeader& header) {
    const auto radians = [](const std::vector<double>& degrees) {
      std::vector<double> result;
      for (const double angle : degrees) result.push_back(Angle::from_degrees(angle).radians());
      return result;
    };
    PolarLobes lobes{PolarLobes::Axis::Mirrored, header.symmetric, true, true, {}};
    for (const double theta : header.incidences) {
      PolarLobe lobe{{Angle::from_degrees(theta), {}}, radians(header.azimuths), radians(header.radials), {}};
      lobe.values.resize(header.channels.size() * header.azimuths.size() * header.radials.size());
      measured_.incidences.push_back(lobe.incidence);
      lobes.lobes.push_back(std::move(lobe));
    }
    return lobes;
  }

  void read_block(PolarLobe& lobe, std::size_t channel, const ZemaxHeader& header) {
    const double tis = finite_number(value_of("TIS"), scanner_);
    measured_.provenance[fmt::format("{} TIS at {:g}°", header.channels[channel], lobe.incidence.theta.degrees())] =
        fmt::format("{:g}", tis);
    float* out = lobe.values.data() + channel * header.azimuths.size() * header.radials.size();
    for (std::size_t row = 0; row < header.azimuths.size(); ++row) {
      const std::vector<std::string_view> words = words_of(take_content());
      if (words.size() != header.radials.size())
        scanner_.fail(
            fmt::format("has {} samples; a row has {}, one a radial angle", words.size(), header.radials.size()));
      for (const std::string_view word : words) {
        const double sample = finite_number(word, scanner_);
        watch_.add(sample, scanner_);
        *out++ = static_cast<float>(sample == 0.0 ? not_measured : sample);
      }
    }
  }

  const std::filesystem::path& path_;
  TextScanner scanner_;
  MeasuredReflectance measured_;
  SampleWatch watch_;
};

}  // namespace

bool looks_like_zemax(std::span<const std::byte> bytes) { return first_content_begins(bytes, "Source"); }

MeasuredReflectance parse_zemax(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  return ZemaxReader(path, bytes).read();
}

}  // namespace mezzotint
