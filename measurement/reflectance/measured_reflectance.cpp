#include "measurement/reflectance/measured_reflectance.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"

namespace mezzotint {

namespace {

// V(λ), fitted by two skewed bells: Wyman, Sloan & Shirley 2013.
double luminosity(double nm) {
  const auto bell = [nm](double height, double mean, double below, double above) {
    const double t = (nm - mean) * (nm < mean ? below : above);
    return height * std::exp(-0.5 * t * t);
  };
  return bell(0.821, 568.8, 0.0213, 0.0247) + bell(0.286, 530.9, 0.0613, 0.0322);
}

std::string names_of(const MeasuredReflectance& measured) {
  constexpr std::size_t most_listed = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(measured.channels.size(), most_listed); ++i)
    text += (text.empty() ? "" : ", ") + measured.channels[i].name;
  return measured.channels.size() > most_listed ? text + ", …, " + measured.channels.back().name : text;
}

bool has_wavelengths(const MeasuredReflectance& measured) {
  return std::ranges::all_of(measured.channels, [](const MeasuredChannel& c) { return c.wavelength.has_value(); });
}

ChannelWeights weights_of_name(const MeasuredReflectance& measured, const std::string& name) {
  ChannelWeights weights(measured.channels.size(), 0.0);
  for (std::size_t c = 0; c < weights.size(); ++c) {
    if (measured.channels[c].name != name) continue;
    weights[c] = 1.0;
    return weights;
  }
  throw InvalidInput(fmt::format("the measurement has no channel \"{}\"; it has {}", name, names_of(measured)));
}

ChannelWeights weights_of_wavelength(const MeasuredReflectance& measured, Length wavelength) {
  require(has_wavelengths(measured),
          fmt::format("the channels of the measurement state no wavelength; name one of {}", names_of(measured)));
  std::vector<double> nm;
  for (const MeasuredChannel& channel : measured.channels) nm.push_back(1e3 * channel.wavelength->um());
  const Place place = place_among(nm, 1e3 * wavelength.um(), 1e-6);
  require(place.known, fmt::format("{:.6g} nm was not measured; {:.6g} to {:.6g} nm were", 1e3 * wavelength.um(),
                                   nm.front(), nm.back()));
  ChannelWeights weights(nm.size(), 0.0);
  weights[place.index] = 1.0 - place.share;
  if (place.share > 0.0) weights[place.index + 1] = place.share;
  return weights;
}

ChannelWeights luminance_weights(const MeasuredReflectance& measured) {
  const std::size_t count = measured.channels.size();
  if (count == 1) return {1.0};
  if (has_wavelengths(measured)) {
    ChannelWeights weights(count);
    double sum = 0.0;
    for (std::size_t c = 0; c < count; ++c) {
      // Each wavelength stands for what lies nearest to it.
      const auto nm = [&](std::size_t i) { return 1e3 * measured.channels[i].wavelength->um(); };
      const double width = nm(std::min(c + 1, count - 1)) - nm(c > 0 ? c - 1 : 0);
      weights[c] = width * luminosity(nm(c));
      sum += weights[c];
    }
    require(sum > 0.0, "luminance needs wavelengths that the eye sees; choose one by wavelength_nm");
    for (double& weight : weights) weight /= sum;
    return weights;
  }
  if (count == 3 && measured.channels[0].name == "R") return {0.2126, 0.7152, 0.0722};
  if (count == 3 && measured.channels[1].name == "TristimulusY") return {0.0, 1.0, 0.0};
  throw InvalidInput(
      fmt::format("luminance is not defined for the channels {}; choose one by its name", names_of(measured)));
}

std::string words(const MeasuredReflectance& measured, const DirectionAngles& angles) {
  return measured.isotropic ? fmt::format("{:.6g}°", angles.theta.degrees())
                            : fmt::format("({:.6g}°, {:.6g}°)", angles.theta.degrees(), angles.phi.degrees());
}

std::string listed(const MeasuredReflectance& measured) {
  constexpr std::size_t most_listed = 24;
  std::string text;
  for (std::size_t i = 0; i < std::min(measured.incidences.size(), most_listed); ++i)
    text += (text.empty() ? "" : ", ") + words(measured, measured.incidences[i]);
  return measured.incidences.size() > most_listed ? text + ", …" : text;
}

// Whether a light at (θ, φ) finds samples of its own, or between those of its neighbours.
bool is_known(const MeasuredReflectance& measured, const DirectionAngles& light) {
  if (measured.incidences.empty()) return true;
  const double slack = incidence_tolerance.radians();
  if (measured.between_incidences) {
    const auto [low, high] = std::ranges::minmax(measured.incidences, {}, &DirectionAngles::theta);
    return light.theta.radians() >= low.theta.radians() - slack &&
           light.theta.radians() <= high.theta.radians() + slack;
  }
  return std::ranges::any_of(measured.incidences, [&](const DirectionAngles& own) {
    const bool same_phi = measured.isotropic || light.theta.radians() < slack ||
                          std::abs(wrapped(own.phi.radians() - light.phi.radians())) <= slack;
    return std::abs(own.theta.radians() - light.theta.radians()) <= slack && same_phi;
  });
}

}  // namespace

ChannelWeights channel_weights(const MeasuredReflectance& measured, const ChannelChoice& choice) {
  require(choice.name.empty() || !choice.wavelength, "a channel is chosen by its name or by a wavelength, not by both");
  if (!choice.name.empty()) return weights_of_name(measured, choice.name);
  return choice.wavelength ? weights_of_wavelength(measured, *choice.wavelength) : luminance_weights(measured);
}

double evaluate(const MeasuredReflectance& measured, const Direction& to_light, const Direction& to_viewer,
                const ChannelWeights& weights) {
  if (!(to_light.z() > 0.0 && to_viewer.z() > 0.0)) return not_measured;
  return std::visit([&](const auto& data) { return evaluate(data, to_light, to_viewer, weights); }, measured.data);
}

std::string refusal_of_incidence(const MeasuredReflectance& measured, const DirectionAngles& to_light) {
  if (!(to_light.theta.degrees() < 90.0)) return "the light must be above the horizon";
  if (is_known(measured, to_light)) return "";
  return fmt::format("light from {} was not measured; {}: {}", words(measured, to_light),
                     measured.between_incidences ? "between these it is known" : "it was from", listed(measured));
}

}  // namespace mezzotint
