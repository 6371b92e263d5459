#include "experiments/study/svg_panel.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/study/label_places.h"

namespace mezzotint {

namespace {

std::string power_of_ten(int power) {
  return fmt::format("10<tspan dy='-4' font-size='8'>{}{}</tspan>", power < 0 ? "−" : "", std::abs(power));
}

std::string star(const StudyStyle& style, double x, double y) {
  std::string path;
  for (int k = 0; k < 10; ++k) {
    const double radius = k % 2 == 0 ? 8.0 : 3.6, angle = 0.62831853 * k;
    path +=
        fmt::format("{}{:.1f} {:.1f}", k == 0 ? 'M' : 'L', x + radius * std::sin(angle), y - radius * std::cos(angle));
  }
  return fmt::format("<path d='{}z' fill='#ffd54a' stroke='{}' stroke-width='1.1'/>", path, style.colour);
}

/// The coordinates of one panel.
class Panel {
public:
  Panel(const PanelPlace& place, const PanelAxes& axes) : place_(place), axes_(axes) {}

  [[nodiscard]] double across(double seconds) const {
    const double t = std::clamp(seconds, axes_.fastest, axes_.slowest) / axes_.fastest;
    return place_.x + std::log(t) / std::log(axes_.slowest / axes_.fastest) * place_.width;
  }
  [[nodiscard]] double down(double error) const {
    const double t = std::clamp(error, axes_.smallest, axes_.largest) / axes_.smallest;
    return bottom() - std::log(t) / std::log(axes_.largest / axes_.smallest) * place_.height;
  }
  /// A point that cannot be told from no error stands at the least that can be.
  [[nodiscard]] double down(const ChartPoint& point) const { return down(point.told()); }
  [[nodiscard]] double bottom() const { return place_.y + place_.height; }
  [[nodiscard]] double right() const { return place_.x + place_.width; }

  [[nodiscard]] std::string grid() const {
    std::string svg;
    for (int power = decade(axes_.fastest); power <= decade(axes_.slowest); ++power) {
      const double at = across(std::pow(10.0, power));
      svg += line("grid", at, place_.y, at, bottom());
      // The next panel's first number stands where this one's last would.
      if (place_.numbers_below && (power < decade(axes_.slowest) || place_.last_column))
        svg += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>{}</text>", at, bottom() + 15,
                           power_of_ten(power));
    }
    for (int power = decade(axes_.smallest); power <= 0; ++power) {
      const double at = down(std::pow(10.0, power));
      svg += line("grid", place_.x, at, right(), at);
      if (place_.numbers_left)
        svg += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='end'>{}</text>", place_.x - 6, at + 4,
                           power_of_ten(power));
    }
    return svg;
  }

  [[nodiscard]] std::string floor(double error) const {
    const double at = down(error);
    return fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' class='floor'/>", place_.x, at,
                       place_.width, bottom() - at);
  }

  [[nodiscard]] std::string frame(const std::string& title) const {
    return fmt::format(
        "<rect x='{:.1f}' y='{:.1f}' width='{}' height='{}' class='frame'/><text x='{:.1f}' y='{:.1f}' "
        "font-weight='bold'>{}</text>",
        place_.x, place_.y, place_.width, place_.height, place_.x, place_.y - 6, escaped(title));
  }

  static std::string line(const char* kind, double x1, double y1, double x2, double y2) {
    return fmt::format("<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' class='{}'/>", x1, y1, x2, y2, kind);
  }

private:
  static int decade(double value) { return static_cast<int>(std::lround(std::ceil(std::log10(value) - 1e-9))); }
  PanelPlace place_;
  PanelAxes axes_;
};

using Points = std::vector<ChartPoint>;

Points points_of(const Points& points, const std::string& method) {
  Points list;
  std::copy_if(points.begin(), points.end(), std::back_inserter(list),
               [&](const ChartPoint& point) { return point.method == method; });
  std::sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.samples < b.samples; });
  return list;
}

std::string path_through(const Panel& panel, const Points& points) {
  std::string path;
  for (const ChartPoint& point : points)
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', panel.across(point.seconds), panel.down(point));
  return path;
}

// ± 1 standard error of error and time, where the mark does not hide it.
std::string error_bars(const Panel& panel, const ChartPoint& point, const char* colour) {
  const double x = panel.across(point.seconds), y = panel.down(point);
  const double left = panel.across(std::max(1e-9, point.seconds - point.seconds_error)),
               right = panel.across(point.seconds + point.seconds_error);
  const double up = panel.down(point.error + point.error_spread),
               down = panel.down(std::max(point.floor, point.error - point.error_spread));
  std::string svg;
  if (right - left > 7.0) svg += fmt::format("<path d='M{:.1f} {:.1f}H{:.1f}' stroke='{}'/>", left, y, right, colour);
  if (down - up > 7.0) svg += fmt::format("<path d='M{:.1f} {:.1f}V{:.1f}' stroke='{}'/>", x, up, down, colour);
  return svg;
}

std::string series(const Panel& panel, const Points& points, const StudyStyle& style) {
  std::string svg = fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='1.3'/>",
                                path_through(panel, points), style.colour);
  for (const ChartPoint& point : points) {
    svg += error_bars(panel, point, style.colour);
    svg += svg_mark(style, panel.across(point.seconds), panel.down(point), point.error < point.floor);
  }
  return svg;
}

std::string front(const Panel& panel, Points points) {
  points.erase(std::remove_if(points.begin(), points.end(), [](const ChartPoint& p) { return !p.on_front; }),
               points.end());
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
  return "<path d='" + path_through(panel, points) + "' class='front'/>";
}

std::string stars(const Panel& panel, const Points& points) {
  std::string svg;
  for (const ChartPoint& point : points_of(points, auto_method)) {
    const double x = panel.across(point.seconds), y = panel.down(point);
    const bool at_the_edge = x > panel.right() - 34.0;
    svg += star(style_of(auto_method), x, y);
    svg += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}' class='halo' font-size='9.5'>{:.3g} %</text>",
                       at_the_edge ? x - 9 : x + 9, y - 5, at_the_edge ? "end" : "start",
                       100.0 * point.tolerance.value_or(0.0));
  }
  return svg;
}

std::string key_of(const Panel& panel, double left, const std::vector<std::string>& methods) {
  std::string svg;
  double y = panel.bottom() - 9.0;
  for (auto method = methods.rbegin(); method != methods.rend(); ++method, y -= 14.0) {
    const StudyStyle& style = style_of(*method);
    svg +=
        svg_mark(style, left + 12, y - 4) + fmt::format("<text x='{:.1f}' y='{:.1f}' class='halo' fill='{}'>{}</text>",
                                                        left + 21, y, style.colour, escaped(*method));
  }
  return svg;
}

/// The name of a line, and its right end.
struct Name {
  std::string text;
  const char* colour;
  double x, y;
};

// Names beside the panel, none over another, with a thin line from each to its own.
std::string names(const Panel& panel, const std::vector<Name>& list) {
  std::vector<double> wanted;
  wanted.reserve(list.size());
  for (const Name& name : list) wanted.push_back(name.y);
  const std::vector<double> places = label_places(wanted, 12.5, panel.bottom() - 2.0);
  std::string svg;
  for (std::size_t k = 0; k < list.size(); ++k) {
    svg += fmt::format(
        "<path d='M{:.1f} {:.1f}L{:.1f} {:.1f}' stroke='{}' stroke-width='0.6' opacity='0.6' "
        "fill='none'/><text x='{:.1f}' y='{:.1f}' fill='{}'>{}</text>",
        list[k].x + 4, list[k].y, panel.right() + 7, places[k], list[k].colour, panel.right() + 10, places[k] + 4,
        list[k].colour, escaped(list[k].text));
  }
  return svg;
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}

std::string svg_mark(const StudyStyle& style, double x, double y, bool hollow) {
  const std::string kind = style.mark;
  if (kind == "star") return star(style, x, y);
  const std::string paint = fmt::format("fill='{}' stroke='{}'", hollow ? "#fff" : style.colour, style.colour);
  if (kind == "circle") return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='2.7' {}/>", x, y, paint);
  if (kind == "square")
    return fmt::format("<rect x='{:.1f}' y='{:.1f}' width='5' height='5' {}/>", x - 2.5, y - 2.5, paint);
  if (kind == "diamond")
    return fmt::format("<path d='M{:.1f} {:.1f}l3.5 3.5l-3.5 3.5l-3.5 -3.5z' {}/>", x, y - 3.5, paint);
  return fmt::format("<path d='M{:.1f} {:.1f}l3.4 5.6h-6.8z' {}/>", x, y - 3.4, paint);
}

PanelAxes axes_of(const std::vector<ChartPoint>& points) {
  PanelAxes axes;
  double low = INFINITY, high = 0.0;
  for (const ChartPoint& point : points) {
    low = std::min(low, point.seconds);
    high = std::max(high, point.seconds);
  }
  if (!points.empty()) {
    axes.fastest = std::pow(10.0, std::floor(std::log10(low)));
    axes.slowest = std::pow(10.0, std::ceil(std::log10(high)));
  }
  return axes;
}

std::string svg_panel(const PanelPlace& place, const PanelAxes& axes, const std::string& title,
                      const std::vector<ChartPoint>& points, const std::vector<std::string>& methods) {
  const Panel panel(place, axes);
  if (points.empty()) return panel.grid() + panel.frame(title);
  std::string svg = panel.floor(points.front().floor) + panel.grid() + front(panel, points);
  std::vector<Name> ends;
  std::vector<std::string> drawn = {plain_method};
  drawn.insert(drawn.end(), methods.begin(), methods.end());
  for (const std::string& method : drawn) {
    const Points here = points_of(points, method);
    if (here.empty()) continue;
    const StudyStyle& style = style_of(method);
    svg += series(panel, here, style);
    if (here.size() > 1)
      ends.push_back({method, style.colour, panel.across(here.back().seconds), panel.down(here.back())});
  }
  svg += stars(panel, points) + panel.frame(title);
  if (place.names_right) svg += names(panel, ends);
  if (place.key) svg += key_of(panel, place.x, methods);
  return svg + "\n";
}

}  // namespace mezzotint
