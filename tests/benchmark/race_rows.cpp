#include "race_rows.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measure.h"

namespace mezzotint::benchmark {

namespace {

constexpr const char* names =
    "family,target,method,evaluations,cpu_s,wall_s,cube_root,cube_root_se,l2,l2_se,covariance_error";

using Rows = std::vector<RaceRow>;

double median_of(const Rows& rows, double RaceRow::*member) {
  std::vector<double> values;
  for (const RaceRow& row : rows) values.push_back(row.*member);
  return median(values);
}

double worst_of(const Rows& rows, double RaceRow::*member) {
  double worst = 0.0;
  for (const RaceRow& row : rows) worst = std::max(worst, row.*member);
  return worst;
}

Rows of_targets(const Rows& rows, const std::set<int>& targets) {
  Rows list;
  for (const RaceRow& row : rows)
    if (targets.contains(row.target)) list.push_back(row);
  return list;
}

std::set<int> targets_of(const Rows& rows) {
  std::set<int> targets;
  for (const RaceRow& row : rows) targets.insert(row.target);
  return targets;
}

std::set<int> common(const std::set<int>& a, const std::set<int>& b) {
  std::set<int> both;
  std::ranges::set_intersection(a, b, std::inserter(both, both.begin()));
  return both;
}

using ByMethod = std::map<std::string, Rows>;

// The ladder beside one plain loop, on the targets that both have run on.
std::string ratio(const std::string& name, const Rows& plain, const Rows& ladder) {
  const std::set<int> both = common(targets_of(plain), targets_of(ladder));
  const Rows a = of_targets(plain, both), b = of_targets(ladder, both);
  return fmt::format(
      "  {:<60} {:2} targets: {:6.1f} times less time; cube root {:.4f} (plain) {:.4f} (ladder), L2 {:.4f} {:.4f}\n",
      name, both.size(), median_of(a, &RaceRow::cpu_seconds) / median_of(b, &RaceRow::cpu_seconds),
      median_of(a, &RaceRow::cube_root), median_of(b, &RaceRow::cube_root), median_of(a, &RaceRow::l2),
      median_of(b, &RaceRow::l2));
}

// The plain loop that ends nearest, and the fastest within a quarter of it; of those with so many rays.
std::string ratios(const ByMethod& methods, const std::string& rays, double RaceRow::*error, const char* by) {
  if (!methods.contains("ladder")) return "";
  const ByMethod::value_type *nearest = nullptr, *fastest = nullptr;
  for (const auto& entry : methods) {
    if (!entry.first.starts_with("plain") || entry.first.find("rays=" + rays) == std::string::npos) continue;
    if (nearest == nullptr || median_of(entry.second, error) < median_of(nearest->second, error)) nearest = &entry;
  }
  if (nearest == nullptr) return "";
  for (const auto& entry : methods) {
    if (!entry.first.starts_with("plain") || entry.first.find("rays=" + rays) == std::string::npos) continue;
    if (median_of(entry.second, error) > 1.25 * median_of(nearest->second, error)) continue;
    if (fastest == nullptr ||
        median_of(entry.second, &RaceRow::cpu_seconds) < median_of(fastest->second, &RaceRow::cpu_seconds))
      fastest = &entry;
  }
  const Rows& ladder = methods.at("ladder");
  return fmt::format(" {} rays, by {}: nearest, and fastest within 1.25 of it\n", rays, by) +
         ratio(nearest->first, nearest->second, ladder) + ratio(fastest->first, fastest->second, ladder);
}

std::string table_of(const std::string& family, const ByMethod& methods) {
  std::string text = fmt::format(
      "\n{}: medians (worst)\n {:<72} targets evaluations    CPU s   wall s  cube root (worst)"
      "       L2 (worst)    covariance % (worst)\n",
      family, "method");
  for (const auto& [name, rows] : methods)
    text += fmt::format(
        " {:<72} {:7} {:11.0f} {:8.2f} {:8.2f}  {:.4f} ({:.4f})  {:.4f} ({:.4f})  {:6.2f} ({:.2f})\n", name,
        rows.size(), median_of(rows, &RaceRow::evaluations), median_of(rows, &RaceRow::cpu_seconds),
        median_of(rows, &RaceRow::wall_seconds), median_of(rows, &RaceRow::cube_root),
        worst_of(rows, &RaceRow::cube_root), median_of(rows, &RaceRow::l2), worst_of(rows, &RaceRow::l2),
        100.0 * median_of(rows, &RaceRow::covariance_error), 100.0 * worst_of(rows, &RaceRow::covariance_error));
  for (const char* rays : {"1e5", "1e6"})
    text += ratios(methods, rays, &RaceRow::cube_root, "cube root") + ratios(methods, rays, &RaceRow::l2, "L2");
  return text;
}

}  // namespace

void append_row(const std::filesystem::path& path, const RaceRow& row) {
  const bool is_new = !std::filesystem::exists(path);
  std::ofstream file(path, std::ios::app);
  if (is_new) file << names << '\n';
  file << fmt::format("{},{},{},{},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n", row.family, row.target,
                      row.method, row.evaluations, row.cpu_seconds, row.wall_seconds, row.cube_root,
                      row.cube_root_error, row.l2, row.l2_error, row.covariance_error);
  if (!file.flush()) throw DeviceError("cannot write " + path.string());
}

std::vector<RaceRow> read_rows(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line) || line != names) throw FileError(path, "line 1", "these are no rows of design_race");
  std::vector<RaceRow> rows;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::vector<std::string> cell;
    for (std::string text; std::getline(cells, text, ',');) cell.push_back(text);
    if (cell.size() != 11) throw FileError(path, "", "a row has 11 cells, not: " + line);
    const auto number = [&](std::size_t i) { return std::stod(cell[i]); };
    rows.push_back({cell[0], std::stoi(cell[1]), cell[2], number(3), number(4), number(5), number(6), number(7),
                    number(8), number(9), number(10)});
  }
  return rows;
}

std::string race_table(const std::vector<RaceRow>& rows) {
  std::map<std::string, ByMethod> families;
  for (const RaceRow& row : rows) families[row.family][row.method].push_back(row);
  std::string text;
  for (const auto& [family, methods] : families) text += table_of(family, methods);
  return text;
}

}  // namespace mezzotint::benchmark
