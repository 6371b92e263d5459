#include "experiments/gamut/gamut_svg.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/gamut/gamut_axes.h"

namespace mezzotint {

namespace {

constexpr double panel_side = 250.0, gap_x = 70.0, gap_y = 66.0, left = 58.0, top = 96.0, large_scale = 2.0;

struct Box {
  double x = 0.0, y = 0.0, width = panel_side, height = panel_side;
};

/// The coordinates of one panel.
class Panel {
public:
  Panel(const Box& box, const AlphaAxes& axes) : box_(box), axes_(axes) {}

  [[nodiscard]] double across(double alpha) const {
    return box_.x + std::log(alpha / axes_.low_x) / std::log(axes_.high_x / axes_.low_x) * box_.width;
  }
  [[nodiscard]] double up(double alpha) const {
    return box_.y + box_.height - std::log(alpha / axes_.low_y) / std::log(axes_.high_y / axes_.low_y) * box_.height;
  }
  [[nodiscard]] std::string place(const AlphaPair& alpha) const {
    return fmt::format("{:.1f} {:.1f}", across(alpha.x), up(alpha.y));
  }

  // Frame, numbers, and what no print of any printer shows: α_y above α_x, and below the ground.
  [[nodiscard]] std::string frame(const std::string& title, double floor) const {
    std::string svg = fmt::format("<text x='{:.1f}' y='{:.1f}' font-size='12.5' font-weight='bold'>{}</text>\n", box_.x,
                                  box_.y - 9, title);
    svg += fmt::format("<path d='M{} L{} L{}z' fill='#f3f3f3'/>\n", place({axes_.low_y, axes_.low_y}),
                       place({axes_.low_y, axes_.high_y}), place({axes_.high_y, axes_.high_y}));
    svg += fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='#f3f3f3'/>\n", box_.x,
                       up(floor), box_.width, up(axes_.low_y) - up(floor));
    svg += numbers();
    svg += fmt::format("<path d='M{:.1f} {:.1f}h{:.1f}' stroke='#222' stroke-dasharray='2 3'/>", box_.x, up(floor),
                       box_.width);
    svg += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='end' fill='#555' font-size='10'>floor {:.3g}</text>\n",
                       box_.x + box_.width - 4, up(floor) + 12, floor);
    return svg + fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='none' stroke='#888'/>\n",
                             box_.x, box_.y, box_.width, box_.height);
  }

  // Lines of equal ratio, named where they leave the panel.
  [[nodiscard]] std::string ratios() const {
    std::string svg;
    for (const double ratio : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0}) {
      const double end = std::min(axes_.high_x, axes_.high_y * ratio),
                   begin = std::max(axes_.low_x, axes_.low_y * ratio);
      if (begin >= 0.8 * end) continue;
      svg += fmt::format("<path d='M{}L{}' stroke='#bbb' stroke-width='.7'/>", place({begin, begin / ratio}),
                         place({end, end / ratio}));
      const bool right = end == axes_.high_x;
      svg += fmt::format("<text x='{:.1f}' y='{:.1f}' fill='#777' font-size='9'>{}:1</text>\n",
                         across(end) + (right ? 3 : -8), up(end / ratio) + (right ? 3 : -3), ratio);
    }
    return svg;
  }

  [[nodiscard]] std::string outline(const GamutRegion& region, const std::string& style) const {
    std::string path;
    for (const AlphaPair& alpha : region.outline()) path += (path.empty() ? "M" : "L") + place(alpha);
    return fmt::format("<path d='{}' stroke='{}' stroke-linejoin='round' {}/>\n", path, colour_of(region.kind), style);
  }

private:
  [[nodiscard]] std::string numbers() const {
    std::string svg;
    for (const double alpha : ticks(axes_.low_x, axes_.high_x)) {
      svg += fmt::format(
          "<path d='M{0:.1f} {1:.1f}v{2:.1f}' stroke='#e4e4e4'/><text x='{0:.1f}' y='{3:.1f}' "
          "text-anchor='middle' font-size='10'>{4:g}</text>\n",
          across(alpha), box_.y, box_.height, box_.y + box_.height + 13, alpha);
    }
    for (const double alpha : ticks(axes_.low_y, axes_.high_y)) {
      svg += fmt::format(
          "<path d='M{0:.1f} {1:.1f}h{2:.1f}' stroke='#e4e4e4'/><text x='{3:.1f}' y='{4:.1f}' "
          "text-anchor='end' font-size='10'>{5:g}</text>\n",
          box_.x, up(alpha), box_.width, box_.x - 5, up(alpha) + 3.5, alpha);
    }
    return svg + fmt::format(
                     "<text x='{:.1f}' y='{:.1f}' text-anchor='middle'>α_x</text><text x='{:.1f}' y='{:.1f}' "
                     "text-anchor='middle'>α_y</text>\n",
                     box_.x + 0.5 * box_.width, box_.y + box_.height + 27, box_.x - 30, box_.y - 9);
  }

  Box box_;
  AlphaAxes axes_;
};

// A circle where it can be printed; else a cross, and an arrow to what is nearest.
std::string target_mark(const Panel& panel, const AskedTarget& target) {
  const double x = panel.across(target.alpha.x), y = panel.up(target.alpha.y);
  if (target.is_reached())
    return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='5' fill='#fff' stroke='#222' stroke-width='2'/>\n", x, y);
  const AlphaPair& nearest = target.best().nearest;
  return fmt::format(
      "<path d='M{0:.1f} {1:.1f}L{2:.1f} {3:.1f}' stroke='#222' stroke-width='1.2' marker-end='url(#tip)'/>"
      "<path d='M{0:.1f} {1:.1f}m-4 -4l8 8m0 -8l-8 8' stroke='#c00' stroke-width='2.2' fill='none'/>\n",
      x, y, panel.across(nearest.x), panel.up(nearest.y));
}

std::string legend(const GamutFindings& findings) {
  double x = left;
  std::string svg;
  const auto add = [&](const std::string& sign, const std::string& name) {
    svg += fmt::format("<g transform='translate({:.1f} 60)'>{}</g><text x='{:.1f}' y='64'>{}</text>\n", x, sign, x + 24,
                       name);
    x += 38.0 + 6.0 * static_cast<double>(name.size());
  };
  for (const std::string& kind : findings.map.options.kinds)
    add(fmt::format("<path d='M0 0h18' stroke='{}' stroke-width='2.5'/>", colour_of(kind)), kind);
  if (findings.targets.empty()) return svg;
  add("<circle cx='9' cy='0' r='5' fill='#fff' stroke='#222' stroke-width='2'/>", "asked, can be printed");
  add("<path d='M5 -4l8 8m0 -8l-8 8' stroke='#c00' stroke-width='2.2'/>", "cannot; arrow: nearest print");
  return svg;
}

std::string style_of(double factor) {
  if (factor == 1.0) return "stroke-width='2.2' fill='none'";
  return factor < 1.0 ? "stroke-width='1.3' stroke-dasharray='6 3' fill='none'"
                      : "stroke-width='1.3' stroke-dasharray='2 2.5' fill='none'";
}

std::string overview(const GamutFindings& findings, const AlphaAxes& axes) {
  const double side = large_scale * panel_side + (large_scale - 1.0) * gap_y;
  const Panel panel({left, top, side, side}, axes);
  std::string svg = panel.frame("all kinds", findings.map.formula.floor_alpha) + panel.ratios();
  for (const GamutRegion& region : findings.map.regions)
    if (region.blur_factor == 1.0) svg += panel.outline(region, style_of(1.0));
  for (const AskedTarget& target : findings.targets) svg += target_mark(panel, target);
  return svg;
}

std::string small_panel(const GamutFindings& findings, const AlphaAxes& axes, std::size_t index) {
  const double large_side = large_scale * panel_side + (large_scale - 1.0) * gap_y;
  const auto column = static_cast<double>(index / 2), row = static_cast<double>(index % 2);
  const Panel panel({left + large_side + gap_x + column * (panel_side + gap_x), top + row * (panel_side + gap_y)},
                    axes);
  const std::string& kind = findings.map.options.kinds[index];
  std::string svg = panel.frame(kind, findings.map.formula.floor_alpha);
  for (const GamutRegion& region : findings.map.regions) {
    if (region.kind != kind) continue;
    const std::string fill = fmt::format(" fill='{}' fill-opacity='.12' stroke-width='2.2'", colour_of(kind));
    svg += panel.outline(region, region.blur_factor == 1.0 ? fill : style_of(region.blur_factor));
  }
  return svg;
}

}  // namespace

std::string gamut_svg(const GamutFindings& findings) {
  const AlphaAxes axes = axes_of(findings);
  const std::size_t kinds = findings.map.options.kinds.size();
  const double large_side = large_scale * panel_side + (large_scale - 1.0) * gap_y;
  const double width =
      std::max(1200.0, left + large_side + static_cast<double>((kinds + 1) / 2) * (panel_side + gap_x) + 30.0);
  const double height = top + large_side + 52.0;
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:.0f} {1:.0f}' width='{0:.0f}' height='{1:.0f}' "
      "font-family='Helvetica, Arial, sans-serif' font-size='11' fill='#222'>\n<defs><marker id='tip' "
      "viewBox='0 0 8 8' refX='7' refY='4' markerWidth='7' markerHeight='7' orient='auto'><path d='M0 0L8 4L0 "
      "8z'/></marker></defs>\n<rect width='100%' height='100%' fill='#fff'/>\n",
      width, height);
  const PixelSpread& blur = findings.printer.spread;
  svg += fmt::format(
      "<text x='{:.0f}' y='24' font-size='15' font-weight='bold'>What {} can print: α = √2 · RMS slope along the "
      "steeper "
      "axis x and across it</text>\n<text x='{:.0f}' y='42'>Blur {:.3g} µm{}. Small panels: at this blur (filled), at "
      "less (dashed) and at more (dotted).</text>\n",
      left, findings.printer.name, left, blur.width.um(), blur.calibrated ? "" : ", assumed");
  svg += legend(findings) + overview(findings, axes);
  for (std::size_t i = 0; i < kinds; ++i) svg += small_panel(findings, axes, i);
  return svg + "</svg>\n";
}

}  // namespace mezzotint
