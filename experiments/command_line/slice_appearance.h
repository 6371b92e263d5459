#pragma once

#include <string>

#include "fabrication/appearance/appearance.h"

namespace mezzotint {

/// What `slice` clothes a part with: an appearance file, or the folder of a design, whose pattern then lies in the
/// part's surface with its x axis along the part's.
struct AppearanceArguments {
  std::string file, design;
  [[nodiscard]] bool given() const { return !file.empty() || !design.empty(); }
};
/// @throws ConfigurationError, FileError, or InvalidInput for a design without a pattern (a free form).
[[nodiscard]] Appearance read_slice_appearance(const AppearanceArguments& arguments);

/// The function above in the program with all commands, which can read pictures. The small one has none, and never
/// needs it: it becomes the other where these options are given.
using ReadAppearance = Appearance (*)(const AppearanceArguments&);
[[nodiscard]] ReadAppearance appearance_reader();
inline constexpr const char* appearance_options[] = {"--appearance", "--design"};

}  // namespace mezzotint
