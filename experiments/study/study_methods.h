#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "forward/scattering/path_tracing.h"

namespace mezzotint {

/// What a reader may want to compare with one another.
enum class StudyQuestion { Rungs, Placement, Tracer, Normals, Mesh, Bounces };

/// All questions, in the order in which they are drawn.
[[nodiscard]] const std::vector<StudyQuestion>& study_questions();
/// "rungs of the ladder", "sample placement", …
[[nodiscard]] std::string_view in_words(StudyQuestion question);

/// How a method is drawn: in Okabe and Ito's colours, which readers with any colour vision can tell apart, and with a
/// mark of its own, for print without colour.
struct StudyStyle {
  const char* colour;
  const char* mark;  ///< "circle", "square", "diamond", "triangle", "star"
};

/// A way to trace paths, with the budgets that it is measured at.
struct PathMethod {
  std::string name;
  std::vector<int> log2_samples;
  std::function<void(PathTracingOptions&)> set;
  std::size_t coarsening = 1;  ///< on every so many-th sample of the relief
  bool needs_splat = false;    ///< left out where the splat is not possible
};

/// The names of the methods that are measured apart from paths, and that of the zero line.
inline constexpr const char* moments_method = "moments";
inline constexpr const char* slopes_method = "slopes";
inline constexpr const char* auto_method = "auto";
inline constexpr const char* plain_method = "slides' plain method";

/// All ways to trace paths. The first is the slides' plain method (one ray at a time through Embree, random positions,
/// roulette at every interface), with the weight that conserves energy: with its own it converges to a wrong map.
[[nodiscard]] const std::vector<PathMethod>& path_methods();

/// The methods, in the order of the legend, that answer a question: the variants, and the method that they vary. The
/// plain method and `auto` belong to each.
[[nodiscard]] const std::vector<std::string>& methods_for(StudyQuestion question);

/// How any method is drawn.
[[nodiscard]] const StudyStyle& style_of(const std::string& method);

}  // namespace mezzotint
