#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "experiments/configuration/printer_file.h"

namespace mezzotint {

namespace {

// As short as comes back to the last bit, and never an integer.
std::string number(double value) {
  std::ostringstream text;
  text << toml::value<double>(value);
  return text.str();
}

std::string quoted(const std::string& value) {
  std::ostringstream text;
  text << toml::value<std::string>(value);
  return text.str();
}

std::string end(const char* key, const std::optional<double>& value) {
  return value ? fmt::format("{:<20} = {}\n", key, number(*value)) : "";
}

std::string record_text(const CureRecord& record) {
  std::string text =
      "\n[calibration]          # where [cure] comes from; 95 % intervals, an end left out has no bound\n";
  text += fmt::format("{:<20} = {}\n", "source", quoted(record.source));
  text += fmt::format("{:<20} = {}\n", "source_sha256", quoted(record.source_sha256));
  text += fmt::format("{:<20} = {}\n", "steps", record.steps);
  text += end("alpha_low_95_um", record.alpha_um.low) + end("alpha_high_95_um", record.alpha_um.high);
  text += end("beta_low_95_um", record.beta_um.low) + end("beta_high_95_um", record.beta_um.high);
  text += end("gamma_low_95", record.gamma.low) + end("gamma_high_95", record.gamma.high);
  text += fmt::format("{:<20} = {}\n", "gamma_determined", record.gamma_determined);
  text += fmt::format("{:<20} = {}\n", "chi_squared", number(record.chi_squared));
  text += fmt::format("{:<20} = {}\n", "degrees_of_freedom", record.degrees_of_freedom);
  return text;
}

std::string pixels_text(const PrinterProfile& p) {
  return fmt::format(
      "name           = {}\npixels_x       = {}\npixels_y       = {}\npixel_pitch_um = {}\nlayer_um       = {}\n"
      "exposure_s     = {}\nled_amplitude  = {}\ngray_levels    = {}\n",
      quoted(p.name), p.pixels_x, p.pixels_y, number(p.pixel_pitch.um()), number(p.layer.um()), number(p.exposure_s),
      p.led_amplitude, p.gray_levels);
}

std::string blur_text(const PixelSpread& spread) {
  const bool gaussian = spread.kernel == PixelSpread::Kernel::Gaussian;
  return fmt::format("\n[blur]\nkernel     = {}\n{} = {}\ncalibrated = {}\n",
                     quoted(std::string(kernel_name(spread.kernel))), gaussian ? "sigma_um  " : "half_width_um",
                     number(spread.width.um()), spread.calibrated);
}

std::string ground_text(const PrinterProfile& p) {
  std::string text = fmt::format("\n[ground]\namplitude_um = {}\ncalibrated   = {}\noctaves = [\n",
                                 number(p.ground_amplitude.um()), p.ground_is_calibrated);
  for (const GroundOctave& octave : p.ground)
    text += fmt::format("  {{ weight = {}, scale_um = {} }},\n", number(octave.weight), number(octave.scale.um()));
  return text + "]\n";
}

}  // namespace

std::string printer_file_text(const PrinterProfile& profile, const std::optional<CureRecord>& record,
                              const std::string& comment) {
  std::string text;
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);) text += "# " + line + "\n";
  text += pixels_text(profile);
  text += fmt::format(
      "\n[cure]                 # height = alpha + beta ln(gray - gamma)\nalpha_um = {}\nbeta_um  = {}\n"
      "gamma    = {}\n",
      number(profile.cure.alpha.um()), number(profile.cure.beta.um()), number(profile.cure.gamma));
  if (record) text += record_text(*record);
  return text + blur_text(profile.spread) + ground_text(profile);
}

}  // namespace mezzotint
