#include "src/output/map_overlay.h"

#include <opencv2/imgproc.hpp>

#include "src/output/map_view.h"
#include "src/output/overlay.h"

namespace cgsr::app {
namespace {

constexpr int kPanelHeight_px = 24;
constexpr std::size_t kMostPieces = 20000;
const cv::Scalar kUnsure(90, 90, 250);
const cv::Scalar kPanel(32, 28, 26);
const cv::Scalar kText(225, 225, 225);

}  // namespace

MapOverlay::MapOverlay(const world::Map& map, render::Expectation& expectation, const geometry::Camera& camera)
    : map_(map), expectation_(expectation), camera_(camera) {
  pieces_.reserve(kMostPieces);
  picture_.create(picture_size(), CV_8UC3);
}

cv::Size MapOverlay::picture_size() const {
  return {camera_.width_px & ~1, (camera_.height_px & ~1) + kPanelHeight_px};  // video codecs want even sides
}

const cv::Mat& MapOverlay::draw(const ImageView& image, const std::optional<geometry::Pose>& X_WC, bool sure,
                                const std::string& words) {
  const cv::Rect shown(0, 0, picture_.cols, picture_.rows - kPanelHeight_px);
  cv::Mat image_part = picture_(shown);
  to_bgr(image)(shown).copyTo(image_part);
  picture_.rowRange(shown.height, picture_.rows).setTo(kPanel);
  if (X_WC) {
    expectation_.look(*X_WC, camera_, pieces_);
    draw_pieces(map_, pieces_, camera_, image_part);
  }
  cv::putText(picture_, words, {6, shown.height + 17}, cv::FONT_HERSHEY_SIMPLEX, 0.43, sure ? kText : kUnsure, 1,
              cv::LINE_AA);
  return picture_;
}

}  // namespace cgsr::app
