#include "tools/lab/tracking/painted_over.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/photo.hpp>
#include <opencv2/video/tracking.hpp>

namespace cgsr::lab {
namespace {

constexpr int kImagesBefore = 10;
constexpr double kMargin = 0.15;  // of the box's sides, at each side
constexpr int kMargin_px = 4;
constexpr int kRing_px = 12;            // of the surroundings that have to agree
constexpr double kMaxRingError = 14.0;  // mean absolute difference of 8-bit values
constexpr std::array kDistances{3, 6, 10, 15, 20, 30, 45, 60, 90, 130, 180, 250};

cv::Rect grown(const cv::Rect& rect, int by, const cv::Size& size) {
  return cv::Rect(rect.x - by, rect.y - by, rect.width + 2 * by, rect.height + 2 * by) & cv::Rect(cv::Point(), size);
}

/// A picture whose background may be seen in another one.
struct View {
  cv::Mat bgr, gray;
  cv::Mat object;  ///< 255 where the object is, or may be
};

Result<View> view_of(const Film& film, int number) {
  const auto image = film.image(number);
  if (!image) return tl::unexpected(image.error());
  View view{image->bgr, {}, cv::Mat::zeros(image->bgr.size(), CV_8U)};
  cv::cvtColor(view.bgr, view.gray, cv::COLOR_BGR2GRAY);
  const auto& box = film.truth[static_cast<std::size_t>(number)];
  if (box) view.object(painted_region(*box, view.bgr.size())).setTo(255);
  return view;
}

/// \return the homography from pixels of `from` to pixels of `to`, by their backgrounds; nothing where too few corners agree.
std::optional<cv::Mat> homography(const View& from, const View& to) {
  constexpr int kCorners = 300, kLeastCorners = 16;
  cv::Mat background;
  cv::bitwise_not(from.object, background);
  std::vector<cv::Point2f> corners, moved;
  cv::goodFeaturesToTrack(from.gray, corners, kCorners, 0.005, 6, background);
  if (corners.size() < kLeastCorners) return std::nullopt;
  std::vector<std::uint8_t> followed;
  std::vector<float> errors;
  cv::calcOpticalFlowPyrLK(from.gray, to.gray, corners, moved, followed, errors);
  std::vector<cv::Point2f> a, b;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (followed[i] == 0) continue;
    a.push_back(corners[i]);
    b.push_back(moved[i]);
  }
  if (a.size() < kLeastCorners) return std::nullopt;
  cv::Mat inliers;
  const cv::Mat H = cv::findHomography(a, b, cv::RANSAC, 2.0, inliers, 500, 0.995);
  if (H.empty() || cv::countNonZero(inliers) < std::max<int>(kLeastCorners / 2, static_cast<int>(a.size()) * 2 / 5))
    return std::nullopt;
  return H;
}

/// One region of one image while it is filled.
class Filling {
 public:
  Filling(const View& view, const cv::Rect& region)
      : view_(view), around_(grown(region, kRing_px, view.bgr.size())), region_(region - around_.tl()) {
    view.bgr(around_).copyTo(picture_);
    missing_ = cv::Mat::zeros(around_.size(), CV_8U);
    missing_(region_).setTo(255);
  }

  /// Takes what another image shows of the background. \param H  from this image to the other one.
  void take(const View& other, const cv::Mat& H) {
    const cv::Mat shift = (cv::Mat_<double>(3, 3) << 1, 0, around_.x, 0, 1, around_.y, 0, 0, 1);
    const cv::Mat from_here = H * shift;
    cv::Mat seen, usable;
    cv::Mat background;
    cv::bitwise_not(other.object, background);
    const int flags = cv::WARP_INVERSE_MAP;
    cv::warpPerspective(other.bgr, seen, from_here, around_.size(), cv::INTER_LINEAR | flags);
    cv::warpPerspective(background, usable, from_here, around_.size(), cv::INTER_NEAREST | flags);
    if (!agrees_around(seen, usable)) return;
    cv::Mat taken;
    cv::bitwise_and(usable, missing_, taken);
    seen.copyTo(picture_, taken);
    missing_.setTo(0, taken);
  }

  [[nodiscard]] double missing_share() const {
    return static_cast<double>(cv::countNonZero(missing_)) / std::max(region_.area(), 1);
  }

  cv::Mat finish() {
    if (cv::countNonZero(missing_) > 0) {
      cv::Mat filled;
      cv::inpaint(picture_, missing_, filled, 3.0, cv::INPAINT_TELEA);
      picture_ = filled;
    }
    cv::Mat whole = view_.bgr.clone();
    picture_(region_).copyTo(whole(region_ + around_.tl()));
    return whole;
  }

 private:
  [[nodiscard]] bool agrees_around(const cv::Mat& seen, const cv::Mat& usable) const {
    cv::Mat ring = usable.clone();
    ring(region_).setTo(0);
    if (cv::countNonZero(ring) < (around_.area() - region_.area()) / 4) return false;
    cv::Mat difference;
    cv::absdiff(seen, view_.bgr(around_), difference);
    const cv::Scalar mean = cv::mean(difference, ring);
    return (mean[0] + mean[1] + mean[2]) / 3 <= kMaxRingError;
  }

  const View& view_;
  cv::Rect around_, region_;
  cv::Mat picture_, missing_;
};

std::filesystem::path file_of(const std::filesystem::path& folder, int number) {
  return folder / fmt::format("{:04}.png", number);
}

Result<cv::Mat> kept_or_painted(const Film& film, int number, const std::filesystem::path& folder) {
  if (!folder.empty() && std::filesystem::exists(file_of(folder, number))) {
    cv::Mat kept = cv::imread(file_of(folder, number).string());
    if (!kept.empty()) return kept;
  }
  auto painted = painted_over(film, number);
  if (painted && !folder.empty() && !cv::imwrite(file_of(folder, number).string(), *painted)) {
    return fail(fmt::format("cannot write {}", file_of(folder, number).string()));
  }
  return painted;
}

}  // namespace

AbsentRange absent_range(const Boxes& truth) {
  const auto images = static_cast<int>(truth.size());
  const int count = std::min(kAbsentImages, images - kImagesBefore - kAgainWithinImages);
  if (count <= 0) return {};
  int first = std::max(kImagesBefore, (images - count - kAgainWithinImages) / 2);
  while (first + count + kAgainWithinImages < images && !truth[static_cast<std::size_t>(first + count)]) ++first;
  if (!truth[static_cast<std::size_t>(first + count)]) return {};
  return {first, count};
}

cv::Rect painted_region(const Box& box, const cv::Size& size) {
  const double dx = kMargin * box.width + kMargin_px, dy = kMargin * box.height + kMargin_px;
  const cv::Point low(static_cast<int>(std::floor(box.x - dx)), static_cast<int>(std::floor(box.y - dy)));
  const cv::Point high(static_cast<int>(std::ceil(box.x + box.width + dx)),
                       static_cast<int>(std::ceil(box.y + box.height + dy)));
  return cv::Rect(low, high) & cv::Rect(cv::Point(), size);
}

Result<cv::Mat> painted_over(const Film& film, int number, PaintShares* shares) {
  const auto view = view_of(film, number);
  if (!view) return tl::unexpected(view.error());
  const cv::Rect region = painted_region(*film.truth[static_cast<std::size_t>(number)], view->bgr.size());
  if (region.empty()) return view->bgr.clone();
  Filling filling(*view, region);
  for (const int distance : kDistances) {
    for (const int other : {number - distance, number + distance}) {
      if (other < 0 || other >= film.size() || filling.missing_share() == 0.0) continue;
      const auto shown = view_of(film, other);
      if (!shown) return tl::unexpected(shown.error());
      if (const auto H = homography(*view, *shown)) filling.take(*shown, *H);
    }
  }
  if (shares != nullptr) *shares = {1.0 - filling.missing_share(), filling.missing_share()};
  return filling.finish();
}

Result<Film> film_without_object(const Film& film, const AbsentRange& range, const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!folder.empty()) std::filesystem::create_directories(folder, ignored);
  auto painted = std::make_shared<std::map<int, Image>>();
  Film absent{film.name, {}, film.truth};
  for (int i = range.first; i < range.end(); ++i) {
    auto& box = absent.truth[static_cast<std::size_t>(i)];
    if (!box) continue;
    const auto picture = kept_or_painted(film, i, folder);
    if (!picture) return tl::unexpected(picture.error());
    painted->emplace(i, image_of_bgr(*picture));
    box.reset();
  }
  absent.image = [original = film.image, painted](int i) -> Result<Image> {
    const auto changed = painted->find(i);
    return changed == painted->end() ? original(i) : Result<Image>(changed->second);
  };
  return absent;
}

}  // namespace cgsr::lab
