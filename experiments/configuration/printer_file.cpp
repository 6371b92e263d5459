#include "experiments/configuration/printer_file.h"

#include "experiments/configuration/toml_table.h"

namespace mezzotint {

namespace {

Length um(TomlTable& table, std::string_view key, Range range, Length fallback) {
  return Length::from_um(table.number(key, range, fallback.um()));
}

void read_pixels(TomlTable& table, PrinterProfile& printer) {
  printer.pixels_x = static_cast<std::size_t>(table.integer("pixels_x", 1, 65535, std::int64_t(printer.pixels_x)));
  printer.pixels_y = static_cast<std::size_t>(table.integer("pixels_y", 1, 65535, std::int64_t(printer.pixels_y)));
  printer.pixel_pitch = um(table, "pixel_pitch_um", {0.1, 1000.0}, printer.pixel_pitch);
  printer.layer = um(table, "layer_um", {0.1, 1000.0}, printer.layer);
  printer.exposure_s = table.number("exposure_s", {1e-3, 3600.0}, printer.exposure_s);
  printer.led_amplitude = static_cast<int>(table.integer("led_amplitude", 1, 255, printer.led_amplitude));
  printer.gray_levels = static_cast<int>(table.integer("gray_levels", 2, 256, printer.gray_levels));
}

void read_cure(TomlTable table, CureCurve& cure) {
  cure.alpha = um(table, "alpha_um", {-1000.0, 1000.0}, cure.alpha);
  cure.beta = um(table, "beta_um", {1e-3, 1000.0}, cure.beta);
  cure.gamma = table.number("gamma", {-1.0, 0.99}, cure.gamma);
  table.finish();
}

void read_blur(TomlTable table, PrinterProfile& printer) {
  const bool gaussian = table.choice("kernel", {"gaussian", "lorentzian"}, "gaussian") == "gaussian";
  printer.spread.kernel = gaussian ? PixelSpread::Kernel::Gaussian : PixelSpread::Kernel::Lorentzian;
  if (gaussian)
    printer.spread.width = um(table, "sigma_um", {0.0, 100.0}, printer.spread.width);
  else
    printer.spread.width = Length::from_um(table.number("half_width_um", {0.0, 100.0}));
  printer.spread.calibrated = table.boolean("calibrated", printer.spread.calibrated);
  table.finish();
}

void read_ground(TomlTable table, PrinterProfile& printer) {
  printer.ground_amplitude = um(table, "amplitude_um", {0.0, 100.0}, printer.ground_amplitude);
  printer.ground_is_calibrated = table.boolean("calibrated", printer.ground_is_calibrated);
  if (table.has("octaves")) {
    printer.ground.clear();
    for (TomlTable& octave : table.tables("octaves")) {
      printer.ground.push_back(
          {octave.number("weight", {0.0, 10.0}), Length::from_um(octave.number("scale_um", {0.01, 1e5}))});
      octave.finish();
    }
  }
  table.finish();
}

std::optional<double> interval_end(TomlTable& table, std::string_view key) {
  if (!table.has(key)) return {};
  return table.number(key, {-1e6, 1e6});
}

std::string sha256(TomlTable& table) {
  std::string text = table.text("source_sha256");
  const bool is_one = text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (!is_one) table.complain("source_sha256", "a SHA-256 has 64 hexadecimal digits, in lower case");
  return text;
}

CureRecord read_record(TomlTable table) {
  CureRecord record;
  record.source = table.text("source");
  record.source_sha256 = sha256(table);
  record.steps = table.integer("steps", 2, 1000000);
  record.alpha_um = {interval_end(table, "alpha_low_95_um"), interval_end(table, "alpha_high_95_um")};
  record.beta_um = {interval_end(table, "beta_low_95_um"), interval_end(table, "beta_high_95_um")};
  record.gamma = {interval_end(table, "gamma_low_95"), interval_end(table, "gamma_high_95")};
  record.gamma_determined = table.boolean("gamma_determined");
  record.chi_squared = table.number("chi_squared", {0.0, 1e12});
  record.degrees_of_freedom = table.integer("degrees_of_freedom", -3, 1000000);
  table.finish();
  return record;
}

}  // namespace

std::optional<CureRecord> read_cure_record(const std::filesystem::path& path) {
  const TomlFile file(path);
  TomlTable table(file);
  if (!table.has("calibration")) return {};
  return read_record(table.table("calibration"));
}

PrinterProfile read_printer(const std::filesystem::path& path) {
  const TomlFile file(path);
  TomlTable table(file);
  PrinterProfile printer;
  printer.name = table.text("name", path.stem().string());
  read_pixels(table, printer);
  read_cure(table.table("cure"), printer.cure);
  read_blur(table.table("blur"), printer);
  read_ground(table.table("ground"), printer);
  if (table.has("calibration")) (void)read_record(table.table("calibration"));
  table.finish();
  try {
    require_valid(printer);
  } catch (const InvalidInput& error) {
    throw ConfigurationError(path.string() + ": " + error.what());
  }
  return printer;
}

}  // namespace mezzotint
