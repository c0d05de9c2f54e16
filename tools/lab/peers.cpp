#include "tools/lab/peers.h"

#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>
#include <opencv2/tracking.hpp>
#include <opencv2/video/tracking.hpp>

#include "platform/count_marks.h"

namespace cgsr::lab {
namespace {

/// The pixels that a box covers, cut at the image.
cv::Rect pixels_of(const Box& box, const cv::Mat& image) {
  const auto round = [](double value) { return static_cast<int>(std::lround(value)); };
  return cv::Rect(round(box.x), round(box.y), round(box.width), round(box.height)) &
         cv::Rect(0, 0, image.cols, image.rows);
}

Box box_of(const cv::Rect& rect) {
  return {static_cast<double>(rect.x), static_cast<double>(rect.y), static_cast<double>(rect.width),
          static_cast<double>(rect.height)};
}

/// Marks its life as the stage that tools/count sees.
struct MarkedStage {
  MarkedStage() { count_stage_begin(); }
  ~MarkedStage() { count_stage_end("track"); }
};

class CamShift final : public BoxTracker {
 public:
  Result<LearnedObject> learn(const Image& image, const Box& box) override {
    window_ = pixels_of(box, image.bgr);
    if (window_.empty()) return fail("the box lies outside the image");
    cv::Mat hsv, has_hue, histogram;
    cv::cvtColor(image.bgr(window_), hsv, cv::COLOR_BGR2HSV);
    cv::inRange(hsv, cv::Scalar(0, kLeastSaturation, kLeastValue), cv::Scalar(180, 256, 256), has_hue);
    cv::calcHist(&hsv, 1, kChannels.data(), has_hue, histogram, 1, kBins.data(), ranges_.data());
    cv::normalize(histogram, histogram_, 0, 255, cv::NORM_MINMAX);
    return LearnedObject{};
  }

  Sighting track(const Image& image) override {
    const MarkedStage stage;
    cv::Mat hsv, projection;
    cv::cvtColor(image.bgr, hsv, cv::COLOR_BGR2HSV);
    cv::calcBackProject(&hsv, 1, kChannels.data(), histogram_, projection, ranges_.data());
    const auto until = cv::TermCriteria(cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 10, 1);
    cv::CamShift(projection, window_, until);
    if (window_.area() > 1) return {.box = box_of(window_), .light = {}, .exact_light = {}, .confidence = 1.0};
    restart_around_the_loss(projection.size());
    return {};
  }

 private:
  /// A window that has shrunk to nothing grows again where it was, as in OpenCV's demonstration.
  void restart_around_the_loss(const cv::Size& size) {
    const int reach = (std::min(size.width, size.height) + 5) / 6;
    window_ = cv::Rect(window_.x - reach, window_.y - reach, 2 * reach, 2 * reach) & cv::Rect(cv::Point(), size);
  }

  // OpenCV's tutorial: every hue its own bin, learned where saturation and value say that a hue means something.
  static constexpr int kLeastSaturation = 60;
  static constexpr int kLeastValue = 32;
  static constexpr std::array<int, 1> kChannels{0};
  static constexpr std::array<int, 1> kBins{180};
  static constexpr std::array<float, 2> kHueRange{0.0F, 180.0F};

  std::array<const float*, 1> ranges_{kHueRange.data()};  // calcHist() wants it writable
  cv::Rect window_;
  cv::Mat histogram_;
};

/// The two correlation-filter trackers share OpenCV's interface.
class FilterTracker final : public BoxTracker {
 public:
  FilterTracker(cv::Ptr<cv::Tracker> tracker, bool first_update_trains)
      : tracker_(std::move(tracker)), first_update_trains_(first_update_trains) {}

  Result<LearnedObject> learn(const Image& image, const Box& box) override {
    cv::Rect rect = pixels_of(box, image.bgr);
    if (rect.empty()) return fail("the box lies outside the image");
    tracker_->init(image.bgr, rect);
    if (first_update_trains_) tracker_->update(image.bgr, rect);
    return LearnedObject{};
  }

  Sighting track(const Image& image) override {
    const MarkedStage stage;
    cv::Rect rect;
    if (!tracker_->update(image.bgr, rect) || rect.empty()) return {};
    return {.box = box_of(rect), .light = {}, .exact_light = {}, .confidence = 1.0};
  }

 private:
  cv::Ptr<cv::Tracker> tracker_;
  bool first_update_trains_;
};

}  // namespace

std::unique_ptr<BoxTracker> make_cam_shift() {
  return std::make_unique<CamShift>();
}

std::unique_ptr<BoxTracker> make_kcf() {
  cv::TrackerKCF::Params parameters;
  parameters.detect_thresh = 0.0F;
  return std::make_unique<FilterTracker>(cv::TrackerKCF::create(parameters), true);
}

std::unique_ptr<BoxTracker> make_csrt() {
  cv::TrackerCSRT::Params parameters;
  parameters.psr_threshold = 0.0F;
  return std::make_unique<FilterTracker>(cv::TrackerCSRT::create(parameters), false);
}

}  // namespace cgsr::lab
