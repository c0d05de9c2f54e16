#include "src/output/overlay.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <opencv2/imgproc.hpp>

namespace cgsr::app {
namespace {

constexpr int kStripeHeight_px = 22;
constexpr int kLineHeight_px = 20;
constexpr int kMaxLines = 5;
constexpr int kPanelHeight_px = kStripeHeight_px + (kMaxLines + 1) * kLineHeight_px + 10;
constexpr int kColumn_px = 3;  // width of one image's light in the stripe
const cv::Scalar kPanel(32, 28, 26);
const cv::Scalar kText(225, 225, 225);
const cv::Scalar kFound(80, 230, 80);
const cv::Scalar kTruth(230, 150, 60);
const cv::Scalar kShade(220, 90, 40);
const cv::Scalar kNothing(60, 60, 60);
const cv::Scalar kPerson(80, 220, 240);
const cv::Scalar kFace(200, 200, 200);

/// A light brighter than white keeps its hue.
cv::Scalar bgr_of(const color::Light& light) {
  const double brightest = std::max({1.0, light.r, light.g, light.b});
  const auto channel = [brightest](double value) { return 255.0 * std::clamp(value / brightest, 0.0, 1.0); };
  return {channel(light.b), channel(light.g), channel(light.r)};
}

}  // namespace

cv::Mat to_bgr(const ImageView& image) {
  // The view is read only; cv::Mat has no such notion.
  const cv::Mat raw(image.height_px, image.width_px, image.format == PixelFormat::kYuyv ? CV_8UC2 : CV_8UC1,
                    const_cast<std::uint8_t*>(image.data), static_cast<std::size_t>(image.stride_bytes));
  cv::Mat bgr;
  cv::cvtColor(raw, bgr, image.format == PixelFormat::kYuyv ? cv::COLOR_YUV2BGR_YUY2 : cv::COLOR_GRAY2BGR);
  return bgr;
}

Overlay::Overlay(int image_width_px, int image_height_px)
    : width_px_(image_width_px),
      height_px_(image_height_px),
      zoom_(std::max(1.0, std::ceil(480.0 / std::max(1, image_width_px)))) {
  const cv::Size size = picture_size();
  picture_.create(size, CV_8UC3);
}

cv::Size Overlay::picture_size() const {
  const int width = static_cast<int>(width_px_ * zoom_);
  const int height = static_cast<int>(height_px_ * zoom_) + kPanelHeight_px;
  return {width & ~1, height & ~1};  // video codecs want even sides
}

const cv::Mat& Overlay::draw(const ImageView& image, const OverlayFacts& facts) {
  const cv::Size scaled(picture_.cols, static_cast<int>(height_px_ * zoom_));
  cv::Mat top = picture_(cv::Rect({0, 0}, scaled));
  cv::resize(to_bgr(image), top, scaled, 0, 0, cv::INTER_NEAREST);
  if (facts.shade != nullptr) draw_shade(*facts.shade, top);
  if (facts.truth) draw_box(*facts.truth, kTruth, 1);
  if (facts.box) draw_box(*facts.box, kFound, 2);
  for (const OverlayPerson& person : facts.people) draw_person(person);
  stripe_.push_back({facts.box ? facts.light : std::nullopt, facts.plurality});
  while (static_cast<int>(stripe_.size()) * kColumn_px > picture_.cols) stripe_.pop_front();
  draw_panel(facts);
  return picture_;
}

void Overlay::draw_shade(const shade::ShadeMasks& shade, cv::Mat& top) {
  const auto mask = [&shade](const std::vector<std::uint8_t>& cells) {
    return cv::Mat(shade.height, shade.width, CV_8UC1, const_cast<std::uint8_t*>(cells.data()));  // read only
  };
  const cv::Mat possibly = mask(shade.possibly_shaded);
  const cv::Mat surface = mask(shade.surface_shaded);
  cv::Mat large;
  cv::resize(possibly, large, top.size(), 0, 0, cv::INTER_NEAREST);
  cv::Mat tinted;
  cv::addWeighted(top, 0.72, cv::Mat(top.size(), CV_8UC3, kShade), 0.28, 0.0, tinted);
  tinted.copyTo(top, large);
  cv::resize(surface, large, top.size(), 0, 0, cv::INTER_NEAREST);
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(large, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_SIMPLE);
  cv::drawContours(top, outlines, -1, kShade, 1);
}

void Overlay::draw_box(const Box& box, const cv::Scalar& color, int thickness) {
  const cv::Point corner(cvRound(box.x * zoom_), cvRound(box.y * zoom_));
  const cv::Point opposite(cvRound((box.x + box.width) * zoom_) - 1, cvRound((box.y + box.height) * zoom_) - 1);
  cv::rectangle(picture_, corner, opposite, {0, 0, 0}, thickness + 2);
  cv::rectangle(picture_, corner, opposite, color, thickness);
}

void Overlay::draw_person(const OverlayPerson& person) {
  draw_box(person.box, person.identified ? kPerson : kFace, person.identified ? 2 : 1);
  const cv::Point corner(cvRound(person.box.x * zoom_) + 2, cvRound(person.box.y * zoom_) - 4);
  cv::putText(picture_, person.text, corner, cv::FONT_HERSHEY_SIMPLEX, 0.5, {0, 0, 0}, 3, cv::LINE_AA);
  cv::putText(picture_, person.text, corner, cv::FONT_HERSHEY_SIMPLEX, 0.5, kPerson, 1, cv::LINE_AA);
}

void Overlay::draw_panel(const OverlayFacts& facts) {
  const int top = static_cast<int>(height_px_ * zoom_);
  cv::rectangle(picture_, cv::Rect(0, top, picture_.cols, picture_.rows - top), kPanel, cv::FILLED);
  int column = 0;
  const auto fill = [&](int row_px, const std::optional<color::Light>& light) {
    const cv::Rect bar(column, top + row_px, kColumn_px, kStripeHeight_px / 2 - 2);
    cv::rectangle(picture_, bar & cv::Rect({0, 0}, picture_.size()), light ? bgr_of(*light) : kNothing, cv::FILLED);
  };
  for (const Column& seen : stripe_) {
    fill(2, seen.light);
    fill(kStripeHeight_px / 2, seen.plurality);
    column += kColumn_px;
  }

  std::string first = fmt::format("image {}   ", facts.image_number);
  if (facts.box && facts.light) {
    first += fmt::format("divergence {:.3f}   light {:.2f} {:.2f} {:.2f}", facts.divergence, facts.light->r,
                         facts.light->g, facts.light->b);
  } else {
    first += facts.box ? "found" : "not found";
  }
  std::vector<std::string> lines{first};
  for (const std::string& line : facts.lines) {
    if (static_cast<int>(lines.size()) <= kMaxLines) lines.push_back(line);
  }
  int baseline = top + kStripeHeight_px + kLineHeight_px - 5;
  for (const std::string& line : lines) {
    cv::putText(picture_, line, {6, baseline}, cv::FONT_HERSHEY_SIMPLEX, 0.43, kText, 1, cv::LINE_AA);
    baseline += kLineHeight_px;
  }
}

}  // namespace cgsr::app
