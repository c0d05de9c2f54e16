#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <openssl/evp.h>

#include "tools/lab/report.h"
#include "tools/lab/report_table.h"

namespace cgsr::lab {
namespace {

constexpr std::array<std::string_view, 6> kColors{"#1f6fb4", "#d1662a", "#3a8f3f", "#a03b8c", "#7a6a1a", "#555555"};
constexpr double kWidth = 640, kHeight = 340, kLeft = 60, kRight = 170, kTop = 24, kBottom = 46;

constexpr std::string_view kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>CGSR-Vision: reproduced</title><style>
body{font:15px/1.5 system-ui,sans-serif;max-width:1100px;margin:2em auto;padding:0 1em;color:#222}
table{border-collapse:collapse;margin:1em 0}th,td{padding:.2em .8em;border-bottom:1px solid #ddd;text-align:left;vertical-align:top}
td small{color:#777;display:block}h2{margin-top:2em}code{font-size:85%;color:#555}svg text{font:12px system-ui,sans-serif}
</style></head><body><h1>The dissertation's tables and figures, reproduced</h1>
)";

std::string escaped(std::string_view text) {
  std::string safe;
  for (char c : text) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else
      safe += c;
  }
  return safe;
}

/// A straight scale from values to pixels, with about five round ticks.
struct Axis {
  double low, high, from_px, to_px;

  [[nodiscard]] double px(double value) const { return from_px + (value - low) / (high - low) * (to_px - from_px); }

  [[nodiscard]] std::vector<double> ticks() const {
    const double power = std::pow(10.0, std::floor(std::log10((high - low) / 5)));
    const double rough = (high - low) / 5 / power;
    const double step = power * (rough < 1.5 ? 1 : rough < 3.5 ? 2 : rough < 7.5 ? 5 : 10);
    std::vector<double> values;
    const auto first = static_cast<int>(std::ceil(low / step - 1e-9));
    for (int i = first; i * step <= high + 1e-9 * step; ++i) values.push_back(i * step);
    return values;
  }
};

/// The horizontal axis spans the values; the vertical one starts at 0.
std::array<Axis, 2> axes_of(const Plot& plot) {
  double x_low = 1e300, x_high = -1e300, y_high = 0.0;
  for (const Curve& curve : plot.curves) {
    for (const auto& point : curve.points) {
      x_low = std::min(x_low, point.x);
      x_high = std::max(x_high, point.x);
      y_high = std::max(y_high, point.interval ? point.interval->high : point.y);
    }
  }
  if (!(x_high > x_low)) {
    x_low -= 0.5;
    x_high = x_low + 1.0;
  }
  const double top = y_high > 0.0 && y_high <= 1.0 && y_high > 0.5 ? 1.0 : y_high > 0.0 ? 1.05 * y_high : 1.0;
  return {Axis{x_low, x_high, kLeft, kWidth - kRight}, Axis{0.0, top, kHeight - kBottom, kTop}};
}

std::string frame(const Plot& plot, const Axis& x, const Axis& y) {
  std::string svg;
  for (double value : x.ticks()) {
    svg += fmt::format(
        R"(<line x1="{0:.1f}" y1="{1}" x2="{0:.1f}" y2="{2}" stroke="#eee"/><text x="{0:.1f}" y="{3}" text-anchor="middle">{4:g}</text>)",
        x.px(value), kTop, kHeight - kBottom, kHeight - kBottom + 16, value);
  }
  for (double value : y.ticks()) {
    svg += fmt::format(
        R"(<line x1="{1}" y1="{0:.1f}" x2="{2}" y2="{0:.1f}" stroke="#eee"/><text x="{3}" y="{4:.1f}" text-anchor="end">{5:g}</text>)",
        y.px(value), kLeft, kWidth - kRight, kLeft - 6, y.px(value) + 4, value);
  }
  svg += fmt::format(R"(<path d="M{0},{1}V{2}H{3}" fill="none" stroke="#444"/>)", kLeft, kTop, kHeight - kBottom,
                     kWidth - kRight);
  svg += fmt::format(R"(<text x="{}" y="{}" text-anchor="middle">{}</text>)", (kLeft + kWidth - kRight) / 2,
                     kHeight - 10, escaped(plot.x_label));
  svg += fmt::format(R"svg(<text transform="translate(16,{}) rotate(-90)" text-anchor="middle">{}</text>)svg",
                     (kTop + kHeight - kBottom) / 2, escaped(plot.y_label));
  return svg;
}

/// The line, its band of 95 % and its name beside the frame.
std::string drawn(const Curve& curve, std::size_t number, const Axis& x, const Axis& y) {
  const std::string_view color = kColors[number % kColors.size()];
  std::string line, band_up, band_back;
  for (const auto& point : curve.points) {
    const Interval band = point.interval.value_or(Interval{point.y, point.y});
    line += fmt::format("{:.1f},{:.1f} ", x.px(point.x), y.px(point.y));
    band_up += fmt::format("{:.1f},{:.1f} ", x.px(point.x), y.px(band.high));
    band_back.insert(0, fmt::format("{:.1f},{:.1f} ", x.px(point.x), y.px(band.low)));
  }
  std::string svg = fmt::format(R"(<polygon points="{}{}" fill="{}" opacity=".15"/>)", band_up, band_back, color);
  svg += fmt::format(R"(<polyline points="{}" fill="none" stroke="{}" stroke-width="2"/>)", line, color);
  for (const auto& point : curve.points) {
    svg += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="2.5" fill="{}"/>)", x.px(point.x), y.px(point.y), color);
  }
  const double legend_y = kTop + 8 + 18.0 * static_cast<double>(number);
  svg += fmt::format(
      R"(<line x1="{0}" y1="{2}" x2="{1}" y2="{2}" stroke="{3}" stroke-width="2"/><text x="{4}" y="{5}">{6}</text>)",
      kWidth - kRight + 10, kWidth - kRight + 28, legend_y, color, kWidth - kRight + 34, legend_y + 4,
      escaped(curve.name));
  return svg;
}

std::string to_svg(const Plot& plot) {
  const auto [x, y] = axes_of(plot);
  std::string svg =
      fmt::format(R"(<figure><figcaption><b>{}</b></figcaption><svg width="{}" height="{}" viewBox="0 0 {} {}">)",
                  escaped(plot.title), kWidth, kHeight, kWidth, kHeight);
  svg += frame(plot, x, y);
  for (std::size_t i = 0; i < plot.curves.size(); ++i) svg += drawn(plot.curves[i], i, x, y);
  return svg + "</svg></figure>\n";
}

/// As wide as the plots' frame, so that it lies under its seconds.
std::string to_svg(const Stripe& stripe) {
  constexpr double kBand = 22, kGap = 4;
  const double height = static_cast<double>(stripe.bands.size()) * (kBand + kGap);
  std::string svg =
      fmt::format(R"(<figure><figcaption><b>{}</b></figcaption><svg width="{}" height="{}" viewBox="0 0 {} {}">)",
                  escaped(stripe.title), kWidth, height, kWidth, height);
  for (std::size_t i = 0; i < stripe.bands.size(); ++i) {
    const auto& [name, colors] = stripe.bands[i];
    const double y = static_cast<double>(i) * (kBand + kGap);
    const double step = (kWidth - kRight - kLeft) / static_cast<double>(colors.size());
    for (std::size_t k = 0; k < colors.size(); ++k) {
      if (!colors[k]) continue;
      svg += fmt::format(
          R"svg(<rect x="{:.1f}" y="{}" width="{:.1f}" height="{}" fill="rgb({:.1f}%,{:.1f}%,{:.1f}%)"/>)svg",
          kLeft + static_cast<double>(k) * step, y, step + 0.2, kBand, 100.0 * colors[k]->r, 100.0 * colors[k]->g,
          100.0 * colors[k]->b);
    }
    svg += fmt::format(R"(<text x="{}" y="{}">{}</text>)", kWidth - kRight + 10, y + 15, escaped(name));
  }
  return svg + "</svg></figure>\n";
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  std::vector<unsigned char> text(4 * (bytes.size() / 3 + 1) + 1);  // with the zero that OpenSSL puts at the end
  const int length = EVP_EncodeBlock(text.data(), bytes.data(), static_cast<int>(bytes.size()));
  return {text.begin(), text.begin() + length};
}

std::string to_figure(const Picture& picture) {
  return fmt::format(
      R"(<figure style="display:inline-block;margin:.5em"><img width="440" alt="" src="data:image/jpeg;base64,{}"><figcaption>{}</figcaption></figure>)",
      base64(picture.jpeg), escaped(picture.caption));
}

std::string cell(const Row* row) {
  if (row == nullptr) return "<td></td>";
  std::string small =
      row->interval ? fmt::format("{} … {}", in_figures(row->interval->low), in_figures(row->interval->high)) : "";
  if (row->dissertation) small += fmt::format(" dissertation: {}", in_figures(*row->dissertation));
  return fmt::format("<td title=\"{} trials\">{}<small>{}</small></td>", row->trials,
                     row->ours ? in_figures(*row->ours) : "not there", small);
}

std::string section(const Report& report) {
  const Table table = pivot(report);
  std::string html =
      fmt::format("<h2>{}</h2>\n<p>{}<br><code>seed {}, configuration {}</code></p>\n<table><tr><th></th>",
                  escaped(report.name), escaped(report.title), report.seed, report.config_sha256);
  for (const auto& heading : table.headings) html += fmt::format("<th>{}</th>", escaped(heading));
  html += "</tr>\n";
  for (const auto& line : table.lines) {
    html += fmt::format("<tr><td>{}</td>", escaped(line.name));
    for (const Row* row : line.cells) html += cell(row);
    html += "</tr>\n";
  }
  html += "</table>\n";
  for (const Plot& plot : report.plots) html += to_svg(plot);
  for (const Stripe& stripe : report.stripes) html += to_svg(stripe);
  for (const Picture& picture : report.pictures) html += to_figure(picture) + "\n";
  if (!report.notes.empty()) {
    html += "<ul>";
    for (const std::string& note : report.notes) html += fmt::format("<li>{}</li>", escaped(note));
    html += "</ul>\n";
  }
  return html;
}

}  // namespace

std::string to_html(const std::vector<Report>& reports) {
  std::string html(kHead);
  for (const Report& report : reports) html += section(report);
  return html + "</body></html>\n";
}

}  // namespace cgsr::lab
