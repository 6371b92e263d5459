#include "experiments/run/design_page.h"
#include "experiments/run/stages.h"

namespace mezzotint {

std::vector<std::string> run_page(const StageContext& context) {
  const DesignResults results = load_design(context.experiment, context.folder);
  write_report(design_page(context.experiment, results), context.folder / "report.html");
  return {"report.html"};
}

}  // namespace mezzotint
