#include "experiments/study/study_methods.h"

#include <algorithm>
#include <map>

namespace mezzotint {

namespace {

using Options = PathTracingOptions;

constexpr const char* beam = "paths, beam";
constexpr const char* corrected = "paths, splat corrected";

void from_beam(Options& options) { options.control_variate = ControlVariate::Off; }
void from_splat(Options& options) { options.control_variate = ControlVariate::On; }

const std::vector<int> slow = {12, 14, 16, 18}, fast = {12, 14, 16, 18, 20};

PathMethod capped(const char* name, std::uint32_t bounces) {
  return {name, fast, [bounces](Options& o) { o.max_bounces = bounces; }};
}

PathMethod varied(const char* name, const std::vector<int>& log2_samples, const std::function<void(Options&)>& vary) {
  return {name, log2_samples, [vary](Options& o) {
            from_beam(o);
            vary(o);
          }};
}

}  // namespace

const std::vector<StudyQuestion>& study_questions() {
  static const std::vector<StudyQuestion> all = {StudyQuestion::Rungs,  StudyQuestion::Placement,
                                                 StudyQuestion::Tracer, StudyQuestion::Normals,
                                                 StudyQuestion::Mesh,   StudyQuestion::Bounces};
  return all;
}

std::string_view in_words(StudyQuestion question) {
  switch (question) {
    case StudyQuestion::Rungs:
      return "rung of the ladder";
    case StudyQuestion::Placement:
      return "sample placement";
    case StudyQuestion::Tracer:
      return "tracer";
    case StudyQuestion::Normals:
      return "normals";
    case StudyQuestion::Mesh:
      return "mesh resolution";
    case StudyQuestion::Bounces:
      return "bounce cap";
  }
  return "";
}

const std::vector<PathMethod>& path_methods() {
  static const std::vector<PathMethod> all = {
      varied(plain_method, slow,
             [](Options& o) {
               o.tracer = TracerKind::Embree;
               o.placement = Placement::Random;
               o.roulette_first = true;
             }),
      {beam, fast, from_beam},
      {corrected, fast, from_splat, 1, true},
      varied("random positions", fast, [](Options& o) { o.placement = Placement::Random; }),
      varied("shifted lattice", fast, [](Options& o) { o.placement = Placement::Lattice; }),
      varied("Embree", slow, [](Options& o) { o.tracer = TracerKind::Embree; }),
      varied("interpolated normals", slow, [](Options& o) { o.normals = NormalKind::Interpolated; }),
      {"mesh halved", fast, [](Options&) {}, 2},
      {"mesh quartered", fast, [](Options&) {}, 4},
      capped("1 bounce (single)", 1),
      capped("2 bounces", 2),
      capped("4 bounces", 4)};
  return all;
}

const std::vector<std::string>& methods_for(StudyQuestion question) {
  static const std::map<StudyQuestion, std::vector<std::string>> all = {
      {StudyQuestion::Rungs, {moments_method, slopes_method, "1 bounce (single)", beam, corrected}},
      {StudyQuestion::Placement, {beam, "random positions", "shifted lattice"}},
      {StudyQuestion::Tracer, {beam, "Embree"}},
      {StudyQuestion::Normals, {beam, "interpolated normals"}},
      {StudyQuestion::Mesh, {beam, corrected, "mesh halved", "mesh quartered"}},
      {StudyQuestion::Bounces, {beam, corrected, "1 bounce (single)", "2 bounces", "4 bounces"}}};
  return all.at(question);
}

const StudyStyle& style_of(const std::string& method) {
  static const std::map<std::string, StudyStyle> all = {{plain_method, {"#000000", "square"}},
                                                        {moments_method, {"#cc79a7", "square"}},
                                                        {slopes_method, {"#009e73", "square"}},
                                                        {beam, {"#0072b2", "circle"}},
                                                        {corrected, {"#d55e00", "circle"}},
                                                        {"1 bounce (single)", {"#009e73", "diamond"}},
                                                        {"2 bounces", {"#56b4e9", "diamond"}},
                                                        {"4 bounces", {"#cc79a7", "diamond"}},
                                                        {"random positions", {"#e69f00", "triangle"}},
                                                        {"shifted lattice", {"#56b4e9", "diamond"}},
                                                        {"Embree", {"#7f7f7f", "triangle"}},
                                                        {"interpolated normals", {"#cc79a7", "triangle"}},
                                                        {"mesh halved", {"#cc79a7", "triangle"}},
                                                        {"mesh quartered", {"#56b4e9", "triangle"}},
                                                        {"plane", {"#7f7f7f", "square"}},
                                                        {"relaxation", {"#0072b2", "circle"}},
                                                        {"Laplace, solved", {"#d55e00", "diamond"}},
                                                        {"ends wrapped", {"#7f7f7f", "square"}},
                                                        {"plain sums, ends renormalised", {"#0072b2", "circle"}},
                                                        {"ends by regression", {"#d55e00", "diamond"}},
                                                        {"block of rows", {"#cc79a7", "triangle"}},
                                                        {"random samples", {"#0072b2", "circle"}},
                                                        {"every n-th sample", {"#d55e00", "diamond"}},
                                                        {"all samples", {"#000000", "square"}},
                                                        {"ladder by levels", {"#d55e00", "circle"}},
                                                        {"SBPLX", {"#0072b2", "triangle"}},
                                                        {"COBYLA", {"#56b4e9", "triangle"}},
                                                        {"L-BFGS", {"#009e73", "triangle"}},
                                                        {"cube root", {"#d55e00", "diamond"}},
                                                        {"L2", {"#e69f00", "diamond"}},
                                                        {"log", {"#56b4e9", "diamond"}},
                                                        {"Wasserstein", {"#009e73", "diamond"}},
                                                        {"lobe's moments", {"#cc79a7", "diamond"}},
                                                        {"plain, cube root", {"#000000", "square"}},
                                                        {"plain, L2", {"#7f7f7f", "square"}},
                                                        {"plain, our start, cube root", {"#000000", "circle"}},
                                                        {"plain, our start, L2", {"#7f7f7f", "circle"}},
                                                        {"plain, our tracer", {"#0072b2", "square"}},
                                                        {auto_method, {"#000000", "star"}}};
  return all.at(method);
}

}  // namespace mezzotint
