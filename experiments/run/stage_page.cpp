#include "experiments/run/stages.h"

namespace mezzotint {

std::vector<std::string> run_page(const StageContext&) { return {}; }

}  // namespace mezzotint
