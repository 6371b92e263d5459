#include "experiments/run/report_page.h"
#include "experiments/run/stages.h"

namespace mezzotint {

std::vector<std::string> run_report(const StageContext& context) {
  const RunResults results = load_results(context.experiment, context.folder);
  write_json(summarize(context.experiment, results), context.folder / "summary.json");
  write_report(make_page(context.experiment, results), context.folder / "report.html");
  return {"summary.json", "report.html"};
}

}  // namespace mezzotint
