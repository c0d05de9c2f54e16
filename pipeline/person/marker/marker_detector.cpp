#include "pipeline/person/marker/marker_detector.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/person/face/grey_region.h"

namespace cgsr::person {
namespace {

constexpr int kBits = 4, kCells = kBits + 2;  // along a side of the black square
constexpr double kMinAgreement = 0.75;        // a quarter of the pixels may be blurred, covered or noise
constexpr double kWorkingSide_px = 40.0;      // a nearer marker is shrunk to about this
constexpr double kMaxPerMin = 2.4;            // of the sides that are sought at one size; the next size is halved
constexpr double kWithMargin =
    (kCells + 2.0) / kCells;        // the side with a white cell on each side of it, by the black square's
constexpr double kTile_px = 160.0;  // by which tiles of one size are apart, in its pixels

using Corners = std::vector<cv::Point2f>;

// Corners are the middles of the outermost black pixels.
Box box_around(const Corners& corners) {
  const auto [left, right] = std::ranges::minmax(corners, {}, &cv::Point2f::x);
  const auto [top, bottom] = std::ranges::minmax(corners, {}, &cv::Point2f::y);
  return {left.x, top.y, double(right.x) - left.x + 1.0, double(bottom.y) - top.y + 1.0};
}

cv::Point2d middle_of(const Box& box) {
  return {box.x + box.width / 2, box.y + box.height / 2};
}

/// One slice of a search: a tile of the image at a size.
struct Slice {
  Box region;
  double shrink = 1.0;
};

/// Positions at which tiles of a length begin, together with how long they are.
struct Tiles {
  int count = 1;
  double length_px = 0.0;
  double step_px = 0.0;
};

Tiles tiles_over(double whole_px, double step_px, double overlap_px) {
  const int count = std::max(1, static_cast<int>(std::ceil((whole_px - overlap_px) / step_px)));
  const double step = (whole_px - overlap_px) / count;
  return {count, count == 1 ? whole_px : step + overlap_px, step};
}

/// \param slice  out: the one of that number; a number past the last one leaves it as it is.
/// \return the number of slices of a round.
std::size_t slice_of(std::size_t number, int width_px, int height_px, double min_side_px, Slice& slice) {
  std::size_t count = 0;
  // The longest marker is as high as the image.
  for (double shrink = 1.0; min_side_px * shrink < height_px; shrink *= 2.0) {
    const double overlap = kWithMargin * kMaxPerMin * min_side_px * shrink;
    const Tiles across = tiles_over(width_px, kTile_px * shrink, overlap);
    const Tiles down = tiles_over(height_px, kTile_px * shrink, overlap);
    for (int row = 0; row < down.count; ++row) {
      for (int column = 0; column < across.count; ++column, ++count) {
        if (count != number) continue;
        slice = {{column * across.step_px, row * down.step_px, across.length_px, down.length_px}, shrink};
      }
    }
  }
  return count;
}

/// The share of the marker's pixels that are as its code says, by 3 x 3 samples of each cell.
double agreement(const cv::Mat& grey, const Corners& corners, const cv::Mat& code) {
  constexpr int kSide = 3 * kCells;
  const std::array<cv::Point2f, 4> square{
      {{-0.5F, -0.5F}, {kSide - 0.5F, -0.5F}, {kSide - 0.5F, kSide - 0.5F}, {-0.5F, kSide - 0.5F}}};
  cv::Mat flat;
  cv::warpPerspective(grey, flat, cv::getPerspectiveTransform(square.data(), corners.data()), {kSide, kSide},
                      cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
  const auto is_white = [&](int row, int column) {
    const int i = row / 3 - 1, j = column / 3 - 1;
    return i >= 0 && j >= 0 && i < kBits && j < kBits && code.at<std::uint8_t>(i, j) != 0;
  };
  const auto for_each_pixel = [&](const auto& visit) {
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column)
        visit(is_white(row, column), int{flat.at<std::uint8_t>(row, column)});
    }
  };
  std::array<int, 2> sum{}, count{};  // of black ones, of white ones
  for_each_pixel([&](bool white, int level) {
    sum[white ? 1 : 0] += level;
    ++count[white ? 1 : 0];
  });
  if (count[0] == 0 || count[1] == 0) return 0.0;
  const double threshold = 0.5 * (double(sum[0]) / count[0] + double(sum[1]) / count[1]);
  int right = 0;
  for_each_pixel([&](bool white, int level) { right += (level > threshold) == white ? 1 : 0; });
  return static_cast<double>(right) / (kSide * kSide);
}

}  // namespace

std::string_view to_string(MarkerSearch search) {
  switch (search) {
    case MarkerSearch::kWholeImage:
      return "whole image";
    case MarkerSearch::kPrediction:
      return "prediction";
  }
  return "";
}

struct MarkerDetector::Reader {
  cv::Ptr<cv::aruco::Dictionary> dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50);
  cv::Ptr<cv::aruco::DetectorParameters> parameters = cv::aruco::DetectorParameters::create();

  Reader() {
    // One threshold: sides differ by little within one size. A wrong bit is a wrong marker: 50 codes of 16 bits are near to each other.
    parameters->adaptiveThreshWinSizeMin = parameters->adaptiveThreshWinSizeMax = 15;
    parameters->errorCorrectionRate = 0.0;
    parameters->maxErroneousBitsInBorderRate = 0.1;
    parameters->minDistanceToBorder = 1;
    parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_NONE;
  }
};

MarkerDetector::MarkerDetector(double min_side_px, double region)
    : reader_(std::make_unique<Reader>()), min_side_px_(min_side_px), region_(region) {}
MarkerDetector::MarkerDetector(MarkerDetector&&) noexcept = default;
MarkerDetector& MarkerDetector::operator=(MarkerDetector&&) noexcept = default;
MarkerDetector::~MarkerDetector() = default;

std::vector<SeenMarker> MarkerDetector::read(const ImageView& image, const Box& region, double shrink,
                                             MarkerSearch search) {
  const int width_px = static_cast<int>(std::lround(region.width / shrink));
  const int height_px = static_cast<int>(std::lround(region.height / shrink));
  const GreyPatch patch = quick_grey_region(image, region, width_px, height_px);
  if (patch.pixels.empty()) return {};
  // OpenCV's header takes no pointer to constant pixels; nothing here writes through it.
  const cv::Mat grey(height_px, width_px, CV_8UC1, const_cast<std::uint8_t*>(patch.pixels.data()));
  reader_->parameters->minMarkerPerimeterRate = 0.7 * 4.0 * min_side_px_ / std::max(width_px, height_px);
  std::vector<Corners> corners;
  std::vector<int> ids;
  cv::aruco::detectMarkers(grey, reader_->dictionary, corners, ids, reader_->parameters);
  std::vector<SeenMarker> seen;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto code = cv::aruco::Dictionary::getBitsFromByteList(reader_->dictionary->bytesList.row(ids[i]), kBits);
    const double share = agreement(grey, corners[i], code);
    if (share < kMinAgreement) continue;
    const double x_scale = region.width / width_px, y_scale = region.height / height_px;
    const Box box = box_around(corners[i]);
    seen.push_back({ids[i],
                    {region.x + box.x * x_scale, region.y + box.y * y_scale, box.width * x_scale, box.height * y_scale},
                    share,
                    search});
  }
  return seen;
}

std::optional<SeenMarker> MarkerDetector::find_near(const ImageView& image, const Box& expected, int id) {
  if (image.empty() || expected.empty()) return std::nullopt;
  const double side = std::max({expected.width, expected.height, min_side_px_});
  const cv::Point2d middle = middle_of(expected);
  const double half = std::round(region_ * side / 2.0);
  const Box region{std::round(middle.x) - half, std::round(middle.y) - half, 2.0 * half, 2.0 * half};
  std::optional<SeenMarker> nearest;
  double distance = 0.0;
  for (const SeenMarker& seen : read(image, region, std::max(1.0, side / kWorkingSide_px), MarkerSearch::kPrediction)) {
    if (seen.id != id) continue;
    const double away = cv::norm(middle_of(seen.box) - middle);
    if (nearest && away >= distance) continue;
    nearest = seen;
    distance = away;
  }
  return nearest;
}

void MarkerDetector::search(const ImageView& image, std::vector<SeenMarker>& found) {
  found.clear();
  const std::size_t slices = steps(image.width_px, image.height_px);
  if (image.empty() || slices == 0) return;
  Slice slice;
  slice_of(next_slice_ % slices, image.width_px, image.height_px, min_side_px_, slice);
  next_slice_ = (next_slice_ + 1) % slices;
  found = read(image, slice.region, slice.shrink, MarkerSearch::kWholeImage);
}

std::size_t MarkerDetector::steps(int width_px, int height_px) const {
  Slice ignored;
  return width_px <= 0 || height_px <= 0 ? 0 : slice_of(SIZE_MAX, width_px, height_px, min_side_px_, ignored);
}

}  // namespace cgsr::person
