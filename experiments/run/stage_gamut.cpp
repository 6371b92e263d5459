#include "experiments/run/design_file.h"
#include "experiments/run/gamut_of_target.h"
#include "experiments/run/run_files.h"
#include "experiments/run/stages.h"

namespace mezzotint {

std::vector<std::string> run_gamut(const StageContext& context) {
  const Target target = target_from_json(read_json(context.folder / "target.json"));
  const TargetGamut gamut = gamut_of_target(context.experiment, target);
  context.say(in_words(gamut));
  write_json(to_json(gamut), context.folder / "gamut.json");
  return {"gamut.json"};
}

}  // namespace mezzotint
