#include "experiments/report/page_template.h"

// Defined in page_template.S, which the build fills with the file's bytes.
extern "C" {
extern const char mezzotint_page_template_begin[];
extern const char mezzotint_page_template_end[];
}

namespace mezzotint {

std::string_view page_template() {
  return {mezzotint_page_template_begin,
          static_cast<std::size_t>(mezzotint_page_template_end - mezzotint_page_template_begin)};
}

}  // namespace mezzotint
