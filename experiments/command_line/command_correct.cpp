#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "experiments/command_line/command.h"
#include "experiments/command_line/option_checks.h"
#include "experiments/command_line/surface_arguments.h"
#include "forward/base/quantity.h"
#include "measurement/correction/fill.h"
#include "measurement/correction/flatten_base.h"
#include "measurement/correction/gaussian_filter.h"
#include "measurement/correction/orientation.h"
#include "measurement/correction/outliers.h"
#include "measurement/correction/plane.h"
#include "measurement/correction/polynomial.h"
#include "measurement/correction/step_lines.h"
#include "measurement/formats/surface_output.h"

namespace mezzotint {

namespace {

/// A correction on its way: the surface, what was done to it, and what the user should know.
struct Correction {
  HeightField field;
  std::vector<std::string> done, warnings;
};

/// A step takes the option's value as text, which was checked before; nothing for a flag.
using Step = std::function<void(Correction&, const std::string&)>;

void set(Correction& c, HeightField&& field, std::string words) {
  c.field = std::move(field);
  c.done.push_back(std::move(words));
}

void warn(Correction& c, std::string warning) {
  if (!warning.empty()) c.warnings.push_back(std::move(warning));
}

void take_out(Correction& c, OutlierResult&& result, const std::string& words) {
  c.field = std::move(result.field);
  c.done.push_back(fmt::format("{}: {} samples ({:.3g} %) taken out", words, result.removed, 100.0 * result.share));
  warn(c, std::move(result.warning));
}

// X,Y,W,H, checked before.
std::array<std::size_t, 4> four_numbers(const std::string& text) {
  std::array<std::size_t, 4> numbers{};
  const char* at = text.data();
  for (std::size_t& number : numbers) at = std::from_chars(at, text.data() + text.size(), number).ptr + 1;
  return numbers;
}

void crop_to(Correction& c, const std::string& text) {
  const auto [x, y, width, height] = four_numbers(text);
  set(c, crop(c.field, x, y, width, height),
      fmt::format("cropped to {} x {} samples from ({}, {})", width, height, x, y));
}

// Form and texture are what the user says they are: both are told.
void level_by_polynomial(Correction& c, int degree) {
  const double before = root_mean_square_height(level(c.field)).um();
  const SurfacePolynomial polynomial = fit_polynomial(c.field, degree);
  HeightField levelled = subtract_polynomial(std::move(c.field), polynomial);
  const double left = root_mean_square_height(levelled).um();
  const double form = std::sqrt(std::max(0.0, before * before - left * left));
  set(c, std::move(levelled),
      fmt::format(
          "levelled by a polynomial of degree {}, which took out {:.3g} um (rms) of form beyond a plane and left "
          "{:.3g} um",
          degree, form, left));
}

void fill(Correction& c) {
  HeightField filled = fill_missing(c.field);
  warn(c, fill_warning(c.field, filled));
  set(c, std::move(filled), "missing samples filled by Laplace's equation");
}

void take_out_steps(Correction& c) {
  StepLineResult result = correct_step_lines(c.field);
  const auto steps = result.steps_um.size() - static_cast<std::size_t>(std::ranges::count(result.steps_um, 0.0));
  warn(c, result.warning);
  set(c, std::move(result.field), fmt::format("{} steps between lines taken out", steps));
}

void filter_by(Correction& c, const std::string& v, bool smooth) {
  const Length cutoff = Length::from_um(std::stod(v));
  warn(c, filter_warning(c.field, cutoff));
  set(c, smooth ? s_filter(c.field, cutoff) : l_filter(c.field, cutoff),
      fmt::format("{}-filter of {} um", smooth ? 'S' : 'L', v));
}

// plane, poly:N, base or base:N.
void level_by(Correction& c, const std::string& v) {
  const std::size_t colon = v.find(':');
  const std::string kind = v.substr(0, colon);
  const int degree = colon == std::string::npos ? 5 : std::stoi(v.substr(colon + 1));
  if (kind == "plane") return set(c, level(std::move(c.field)), "levelled by the least-squares plane");
  if (kind == "poly") return level_by_polynomial(c, degree);
  FlattenedBase flat = flatten_base(std::move(c.field), degree);
  warn(c, flat.warning);
  set(c, std::move(flat.field),
      fmt::format("base flattened by a polynomial of degree {}, {:.3g} % of the samples", degree,
                  100.0 * flat.base_share));
}

void turn_by(Correction& c, const std::string& v) {
  const double degrees = std::stod(v), quarters = degrees / 90.0;
  const bool exact = quarters == std::round(quarters);
  set(c,
      exact ? turned_by_quarters(c.field, static_cast<int>(quarters)) : turned(c.field, Angle::from_degrees(degrees)),
      fmt::format("turned by {:g} degrees{}", degrees, exact ? "" : ", by cubic convolution"));
}

const std::map<std::string, Step>& steps() {
  static const std::map<std::string, Step> all = {
      {"--crop", crop_to},
      {"--level", level_by},
      {"--turn", turn_by},
      {"--mirror",
       [](Correction& c, const std::string& v) {
         set(c, v == "x" ? mirrored_in_x(c.field) : mirrored_in_y(c.field), "mirrored in " + v);
       }},
      {"--upside-down", [](Correction& c, const std::string&) { set(c, upside_down(c.field), "turned upside down"); }},
      {"--resample",
       [](Correction& c, const std::string& v) {
         const Length pitch = Length::from_um(std::stod(v));
         set(c, resampled(c.field, pitch, pitch), fmt::format("resampled to {} um", v));
       }},
      {"--step-lines", [](Correction& c, const std::string&) { take_out_steps(c); }},
      {"--outliers",
       [](Correction& c, const std::string& v) {
         take_out(c, mask_outliers(std::move(c.field), std::stod(v)), "outliers beyond " + v + " standard deviations");
       }},
      {"--local-outliers",
       [](Correction& c, const std::string& v) {
         take_out(c, mask_local_outliers(std::move(c.field), std::stod(v)),
                  "spikes beyond " + v + " robust deviations from the samples around");
       }},
      {"--fill", [](Correction& c, const std::string&) { fill(c); }},
      {"--s-filter", [](Correction& c, const std::string& v) { filter_by(c, v, true); }},
      {"--l-filter", [](Correction& c, const std::string& v) { filter_by(c, v, false); }}};
  return all;
}

std::string check_level(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string kind = text.substr(0, colon), number = colon == std::string::npos ? "" : text.substr(colon + 1);
  const bool degree =
      !number.empty() && number.size() <= 2 && number.find_first_not_of("0123456789") == std::string::npos;
  if (text == "plane" || text == "base" || ((kind == "poly" || kind == "base") && degree)) return "";
  return "is plane, poly:N, base or base:N with a degree N, not \"" + text + "\"";
}

std::string check_crop(const std::string& text) {
  std::size_t commas = 0, digits = 0;
  bool fine = true;
  for (const char c : text) {
    digits = c == ',' ? 0 : digits + 1;
    commas += c == ',' ? 1 : 0;
    fine &= (c == ',' || (c >= '0' && c <= '9')) && digits <= 9;
  }
  fine &= commas == 3 && text.find(",,") == std::string::npos && text.front() != ',' && text.back() != ',';
  return fine ? "" : "is X,Y,W,H, four whole numbers of samples, not \"" + text + "\"";
}

void add_steps(CLI::App& app) {
  // Every step may be given several times; the order on the command line is that of the work.
  const auto option = [&](const char* name, const char* help) {
    return app.add_option(name)->description(help)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)->expected(1);
  };
  const auto number = [&](const char* name, const char* help, double low, double high) {
    option(name, help)->check(in_range(low, high));
  };
  const auto flag = [&](const char* name, const char* help) { app.add_flag(name)->description(help); };
  option("--crop", "X,Y,W,H: W x H samples from sample (X, Y) on")->check(check_crop);
  option("--level",
         "plane, poly:N (a polynomial of degree N), or base:N (the same through the base alone, whatever stands on it; "
         "N is 5 if left out)")
      ->check(check_level);
  number("--outliers", "Mask samples further than K standard deviations from the plane", 1.0, 100.0);
  number("--local-outliers", "Mask samples further than K robust deviations from the median around them", 1.0, 1000.0);
  flag("--fill", "Fill missing samples by Laplace's equation");
  flag("--step-lines", "Take out steps between lines");
  number("--s-filter", "Remove what is shorter than this wavelength in um (ISO 16610-61)", 1e-3, 1e6);
  number("--l-filter", "Remove what is longer than this wavelength in um", 1e-3, 1e6);
  option("--mirror", "x or y: run that axis the other way")->check(CLI::IsMember({"x", "y"}));
  number("--turn", "Turn counter-clockwise by so many degrees; exact for multiples of 90", -360.0, 360.0);
  flag("--upside-down", "Turn heights over, as for a replica");
  number("--resample", "New spacing of the samples in um", 1e-3, 1e5);
}

// Goes through the options in the order in which they were given.
void work_through(const CLI::App& app, Correction& correction, const Progress& progress) {
  std::vector<const CLI::Option*> wanted;
  for (const CLI::Option* option : app.parse_order())
    if (steps().contains(option->get_name())) wanted.push_back(option);
  std::map<const CLI::Option*, std::size_t> used;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const CLI::Option* option = wanted[k];
    report(progress, "correct", static_cast<double>(k) / static_cast<double>(wanted.size()),
           option->get_name().substr(2));
    const bool flag = option->get_expected_max() == 0;
    steps().at(option->get_name())(correction, flag ? std::string() : option->results().at(used[option]++));
  }
  report(progress, "correct", 1.0);
}

}  // namespace

Command add_correct(CLI::App& program) {
  auto* app = program.add_subcommand("correct", "Correct a scan, step by step in the order of the options");
  struct Arguments : SurfaceArguments {
    std::string output;
  };
  auto arguments = std::make_shared<Arguments>();
  add_surface_input(*app, "SCAN", *arguments);
  app->add_option("--output,-o", arguments->output, fmt::format("File to write ({})", written_surface_formats))
      ->required();
  add_steps(*app);
  return {app, [app, arguments](const CommandContext& context) {
            SurfaceFile surface = arguments->read();
            const std::size_t missing = surface.field.missing_count();
            Correction correction{std::move(surface.field), {}, {}};
            work_through(*app, correction, context.progress);
            surface.field = std::move(correction.field);
            std::string words;
            for (const std::string& step : correction.done) words += (words.empty() ? "" : "; ") + step;
            surface.provenance["correction"] = words.empty() ? "none" : words;
            write_surface(surface, arguments->output);
            const std::size_t left = surface.field.missing_count();
            nlohmann::ordered_json json = {{"written", arguments->output},    {"missing_before", missing},
                                           {"missing_after", left},           {"steps", correction.done},
                                           {"warnings", correction.warnings}, {"assumption", surface.assumption}};
            json.update(contents(surface.field));
            std::string text;
            for (const std::string& step : correction.done) text += step + "\n";
            context.print(json, text + fmt::format("wrote {}: {} samples missing before, {} after", arguments->output,
                                                   missing, left));
            context.warn(correction.warnings);
            return ExitStatus::Done;
          }};
}

}  // namespace mezzotint
