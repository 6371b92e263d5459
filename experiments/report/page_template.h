#pragma once

#include <string_view>

namespace mezzotint {

/// Where the data go in the page.
inline constexpr std::string_view page_data_marker = "<!--MEZZOTINT_REPORT_DATA-->";

/// The page with its scripts and styles, and without data: dist/template.html of the npm project in this
/// folder, as it was when the program was built.
[[nodiscard]] std::string_view page_template();

}  // namespace mezzotint
