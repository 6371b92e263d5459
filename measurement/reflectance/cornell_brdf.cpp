#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/text_values.h"
#include "measurement/reflectance/reflectance_parsers.h"
#include "measurement/reflectance/text_samples.h"

namespace mezzotint {

namespace {

constexpr std::size_t most_wavelengths = 4096;

// Words across lines, without comments.
class CornellReader {
public:
  CornellReader(const std::filesystem::path& path, std::span<const std::byte> bytes)
      : path_(path), scanner_(path, bytes) {}

  MeasuredReflectance read() {
    measured_.format = "Cornell BRDF";
    measured_.quantity = "BRDF at scattered directions";
    measured_.assumption = "isotropic: the sample may be turned at will, and its mirror image is alike";
    read_wavelengths();
    std::vector<ScatteredSample> samples;
    while (next_line()) samples.push_back(read_row());
    watch_.finish(path_, measured_);
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
  // Goes to the next line that holds numbers.
  bool next_line() {
    while (words_.empty() && !scanner_.at_end()) {
      const std::string_view line = trimmed(scanner_.take_line());
      if (line.starts_with('#')) {
        keep_title(line);
      } else {
        words_ = words_of(line);
        next_ = 0;
      }
    }
    return !words_.empty();
  }

  double take() {
    if (next_ >= words_.size()) words_.clear();
    if (!next_line()) scanner_.fail("the file ends in the middle of a row; it was cut off");
    const double value = finite_number(words_[next_], scanner_);
    if (++next_ >= words_.size()) words_.clear();
    return value;
  }

  void read_wavelengths() {
    if (!next_line()) scanner_.fail("the file holds no numbers");
    const std::size_t count = count_of(words_[0], "wavelengths", most_wavelengths, scanner_);
    static_cast<void>(take());
    double before = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const double nm = take();
      if (!(nm > before)) scanner_.fail("wavelengths must increase, in nm");
      measured_.channels.push_back({fmt::format("{:.6g} nm", nm), Length::from_nm(nm)});
      before = nm;
    }
  }

  ScatteredSample read_row() {
    if (words_.size() != 4 + measured_.channels.size()) {
      scanner_.fail(fmt::format("has {} numbers; a row has {}: four angles and a sample a wavelength", words_.size(),
                                4 + measured_.channels.size()));
    }
    const double theta_i = take(), phi_i = take(), theta_s = take(), phi_s = take();
    const double most = std::numbers::pi / 2.0 + 1e-4;
    if (theta_i < 0.0 || theta_i > most || theta_s < 0.0 || theta_s > most || std::abs(phi_i) > 7.0 ||
        std::abs(phi_s) > 7.0)
      scanner_.fail("angles are in radians: from the normal 0 to π/2, about it within a turn");
    const double phi = phi_s - phi_i;
    ScatteredSample row{Angle::from_radians(theta_i), {theta_s * std::cos(phi), theta_s * std::sin(phi)}, {}};
    for (std::size_t c = 0; c < measured_.channels.size(); ++c) {
      const double value = take();
      watch_.add(value, scanner_);
      row.values.push_back(static_cast<float>(value));
    }
    return row;
  }

  void keep_title(std::string_view line) {
    line.remove_prefix(1);
    line = trimmed(line);
    if (line.empty() || measured_.provenance.size() >= 3 || !measured_.channels.empty()) return;
    measured_.provenance.emplace(fmt::format("comment {}", measured_.provenance.size() + 1), clean_text(line));
  }

  const std::filesystem::path& path_;
  TextScanner scanner_;
  MeasuredReflectance measured_;
  SampleWatch watch_;
  std::vector<std::string_view> words_;
  std::size_t next_ = 0;
};

}  // namespace

bool looks_like_cornell(std::span<const std::byte> bytes) {
  // Comments, then a lone count.
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text.starts_with('#') && text.find("# num wls") != std::string_view::npos;
}

MeasuredReflectance parse_cornell(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  return CornellReader(path, bytes).read();
}

}  // namespace mezzotint
