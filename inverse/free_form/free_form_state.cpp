#include "inverse/free_form/free_form_state.h"

#include <cstring>

#include <nlohmann/json.hpp>

#include "forward/base/digest.h"
#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "forward/base/file_output.h"

namespace mezzotint {

namespace {

using nlohmann::json;

// Also the version of the method: with another one a state would not end in the bits of a search from the start.
constexpr std::string_view magic = "Mezzotint free form 1\n";
constexpr std::size_t digest_size = 64;

std::string digest_of(std::string_view text) {
  return sha256_hex({reinterpret_cast<const std::byte*>(text.data()), text.size()});
}

json to_json(const Growth& growth) {
  return {{"start", growth.start}, {"wanted_um", growth.wanted_um},     {"history", growth.history},
          {"after", growth.after}, {"evaluations", growth.evaluations}, {"beyond", growth.beyond}};
}

Growth growth_of(const json& from) {
  Growth growth;
  from.at("start").get_to(growth.start);
  from.at("wanted_um").get_to(growth.wanted_um);
  from.at("history").get_to(growth.history);
  from.at("after").get_to(growth.after);
  from.at("evaluations").get_to(growth.evaluations);
  from.at("beyond").get_to(growth.beyond);
  return growth;
}

json printer_json(const PrinterProfile& printer) {
  json ground = json::array();
  for (const GroundOctave& octave : printer.ground) ground.push_back({octave.weight, octave.scale.um()});
  return {{"pitch", printer.pixel_pitch.um()},
          {"layer", printer.layer.um()},
          {"levels", printer.gray_levels},
          {"cure", {printer.cure.alpha.um(), printer.cure.beta.um(), printer.cure.gamma}},
          {"spread", {kernel_name(printer.spread.kernel), printer.spread.width.um()}},
          {"ground", {printer.ground_amplitude.um(), ground}}};
}

json weights_json(const std::vector<WeightedDistance>& objective) {
  json weights = json::array();
  for (const WeightedDistance& part : objective) weights.push_back({name_of(part.distance), part.weight});
  return weights;
}

json options_json(const FreeFormOptions& options) {
  return {{"pixels", options.pixels},
          {"budget", {options.start_evaluations, options.evaluations, options.evaluations_per_epoch}},
          {"objective", weights_json(options.objective)},
          {"start_objective", weights_json(options.start_objective)},
          {"corrections", options.traced_corrections},
          {"traced", {options.fresh_draws, options.traced_samples}},
          {"algorithm", options.algorithm},
          {"wavelength", options.wavelength.um()},
          {"seed", options.seed}};
}

}  // namespace

std::string problem_digest(const LobeTarget& goal, const PrinterProfile& printer, const FreeFormOptions& options) {
  json lights = json::array();
  for (const DirectionAngles& light : goal.incidences) lights.push_back({light.theta.radians(), light.phi.radians()});
  const json problem = {{"grid", {goal.grid.grid().width, goal.grid.grid().height}},
                        {"material", to_string(goal.material)},
                        {"lights", lights},
                        {"maps", goal.maps},
                        {"printer", printer_json(printer)},
                        {"options", options_json(options)}};
  return digest_of(problem.dump());
}

void write_state(const std::filesystem::path& path, const std::string& problem, const FreeFormState& state) {
  json growths = json::array();
  for (const Growth& growth : state.growths) growths.push_back(to_json(growth));
  const json whole = {{"growths", growths}, {"best", to_json(state.best)}, {"pixels", state.pixels}};
  std::string body;
  json::to_cbor(whole, body);
  write_file(path, std::string(magic) + problem + digest_of(body) + body);
}

FreeFormState read_state(const std::filesystem::path& path, const std::string& problem) {
  const std::vector<std::byte> bytes = read_file(path);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!text.starts_with(magic))
    throw FileError(path, "byte 0", "is no state of a free-form search; give another file, or delete this one");
  const std::size_t head = magic.size() + 2 * digest_size;
  if (text.size() < head || text.substr(head - digest_size, digest_size) != digest_of(text.substr(head)))
    throw FileError(path, "end", "is cut short or damaged; delete it to start anew");
  if (!problem.empty() && text.substr(magic.size(), digest_size) != problem) {
    throw FileError(path, "byte " + std::to_string(magic.size()),
                    "is the state of another search (another goal, printer or options); give another file, or delete "
                    "this one to start anew");
  }
  try {
    const json whole = json::from_cbor(text.substr(head));
    FreeFormState state{{}, growth_of(whole.at("best")), whole.at("pixels").get<std::size_t>()};
    for (const json& growth : whole.at("growths")) state.growths.push_back(growth_of(growth));
    return state;
  } catch (const json::exception&) {
    throw FileError(path, "byte " + std::to_string(head),
                    "holds something else than a search; delete it to start anew");
  }
}

}  // namespace mezzotint
