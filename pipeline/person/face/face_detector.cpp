#include "pipeline/person/face/face_detector.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/objdetect.hpp>

#include "pipeline/person/face/grey_region.h"

namespace cgsr::person {

struct FaceDetector::Cascade {
  cv::CascadeClassifier classifier;
};

namespace {

// Faces are sought at twice the size of the cascade's own window of 20 px: from there on OpenCV tries every position, below only every other one.
constexpr double kWindow_px = 40.0;
constexpr double kExpectedFace_px = 48.0;  // to which find_near() scales an expected face: room for nearer and farther
constexpr double kNearStep = 1.15, kNearMost = 1.3;  // scales that find_near() tries
constexpr double kScaleStep = 1.2;  // between the two sizes that a slice looks for, and kScaleStep^2 between slices
constexpr double kTileWidth_px = 130.0, kTileHeight_px = 100.0;
constexpr double kOverlap_px = kWindow_px * kScaleStep + 4.0;

struct Slice {
  Box region;
  double face_px;
};

int tiles_along(double length_px, double tile_px) {
  if (length_px <= tile_px) return 1;
  return 1 + static_cast<int>(std::ceil((length_px - tile_px) / (tile_px - kOverlap_px)));
}

// Large faces first: they are near, and cheap to look for.
std::vector<Slice> slices_of(int width_px, int height_px, double min_face_px) {
  std::vector<double> sizes;
  for (double face = min_face_px; face <= std::min(width_px, height_px); face *= kScaleStep * kScaleStep)
    sizes.push_back(face);
  std::vector<Slice> slices;
  for (auto face = sizes.rbegin(); face != sizes.rend(); ++face) {
    const double scale = kWindow_px / *face;
    const double w = width_px * scale, h = height_px * scale;
    const int across = tiles_along(w, kTileWidth_px), down = tiles_along(h, kTileHeight_px);
    const double tile_w = std::min(w, kTileWidth_px), tile_h = std::min(h, kTileHeight_px);
    for (int j = 0; j < down; ++j) {
      for (int i = 0; i < across; ++i) {
        const double x = across > 1 ? (w - tile_w) * i / (across - 1) : 0.0;
        const double y = down > 1 ? (h - tile_h) * j / (down - 1) : 0.0;
        slices.push_back({{x / scale, y / scale, tile_w / scale, tile_h / scale}, *face});
      }
    }
  }
  return slices;
}

std::vector<cv::Rect> detect(cv::CascadeClassifier& cascade, const GreyPatch& patch, double step, int neighbors,
                             double max_px) {
  std::vector<cv::Rect> found;
  const cv::Mat pixels(patch.height_px, patch.width_px, CV_8UC1, const_cast<std::uint8_t*>(patch.pixels.data()));
  const int least = static_cast<int>(kWindow_px);
  const int most = static_cast<int>(std::ceil(max_px));
  cascade.detectMultiScale(pixels, found, step, neighbors, 0, {least, least}, {most, most});
  return found;
}

double distance(const Box& a, const Box& b) {
  return std::hypot(a.x + a.width / 2 - b.x - b.width / 2, a.y + a.height / 2 - b.y - b.height / 2);
}

bool same_face(const Box& a, const Box& b) {
  return distance(a, b) < 0.4 * std::max(a.width, b.width);
}

}  // namespace

FaceDetector::FaceDetector(std::unique_ptr<Cascade> cascade, const FaceDetectorParameters& parameters)
    : cascade_(std::move(cascade)), parameters_(parameters) {}
FaceDetector::FaceDetector(FaceDetector&&) noexcept = default;
FaceDetector& FaceDetector::operator=(FaceDetector&&) noexcept = default;
FaceDetector::~FaceDetector() = default;

Result<FaceDetector> FaceDetector::from_cascade(const std::string& cascade_xml,
                                                const FaceDetectorParameters& parameters) {
  auto cascade = std::make_unique<Cascade>();
  try {
    const cv::FileStorage file(cascade_xml, cv::FileStorage::READ | cv::FileStorage::MEMORY);
    if (!file.isOpened() || !cascade->classifier.read(file.getFirstTopLevelNode()) || cascade->classifier.empty()) {
      return fail("not a cascade of OpenCV's: haarcascade_frontalface_alt2.xml of Debian's opencv-data is one");
    }
  } catch (const cv::Exception& error) {
    return fail(fmt::format("not a cascade of OpenCV's: {}", error.err));
  }
  return FaceDetector(std::move(cascade), parameters);
}

std::optional<Box> FaceDetector::find_near(const ImageView& image, const Box& expected) {
  if (image.empty() || expected.empty()) return std::nullopt;
  const double side = parameters_.region * expected.width;
  const double scale = kExpectedFace_px / expected.width;
  const Box region{expected.x + (expected.width - side) / 2, expected.y + (expected.height - side) / 2, side, side};
  const int size = static_cast<int>(std::lround(side * scale));
  const GreyPatch patch = grey_region(image, region, size, size);
  if (patch.pixels.empty()) return std::nullopt;
  std::optional<Box> nearest;
  for (const cv::Rect& r :
       detect(cascade_->classifier, patch, kNearStep, parameters_.min_neighbors, kExpectedFace_px * kNearMost)) {
    const double back = side / size;
    const Box face{std::round(region.x) + r.x * back, std::round(region.y) + r.y * back, r.width * back,
                   r.height * back};
    if (!nearest || distance(face, expected) < distance(*nearest, expected)) nearest = face;
  }
  return nearest;
}

void FaceDetector::find_in_slice(const ImageView& image, const Box& region, double face_px, std::vector<Box>& found) {
  const double scale = kWindow_px / face_px;
  const int width = static_cast<int>(std::lround(region.width * scale));
  const int height = static_cast<int>(std::lround(region.height * scale));
  const GreyPatch patch = grey_region(image, region, width, height);
  if (patch.pixels.empty()) return;
  const int neighbors = std::min(1, parameters_.min_neighbors);
  for (const cv::Rect& r : detect(cascade_->classifier, patch, kScaleStep, neighbors, kWindow_px * kScaleStep + 1)) {
    const Box rough{region.x + r.x / scale, region.y + r.y / scale, r.width / scale, r.height / scale};
    const auto known = [&](const Box& face) { return same_face(face, rough); };
    if (std::any_of(found.begin(), found.end(), known)) continue;
    const auto face = find_near(image, rough);
    if (!face) continue;
    const auto same = [&](const Box& other) { return same_face(other, *face); };
    if (std::none_of(found.begin(), found.end(), same)) found.push_back(*face);
  }
}

void FaceDetector::search(const ImageView& image, WorkBudget& budget, std::vector<Box>& found) {
  if (image.empty()) return;
  const auto slices = slices_of(image.width_px, image.height_px, parameters_.min_face_px);
  for (std::size_t done = 0; done < slices.size() && budget.grant(); ++done) {
    next_slice_ %= slices.size();
    const Slice& slice = slices[next_slice_++];
    find_in_slice(image, slice.region, slice.face_px, found);
  }
}

std::vector<Box> FaceDetector::find_all(const ImageView& image) {
  UnlimitedBudget budget;
  std::vector<Box> found;
  next_slice_ = 0;
  search(image, budget, found);
  return found;
}

std::size_t FaceDetector::slices(int width_px, int height_px) const {
  return slices_of(width_px, height_px, parameters_.min_face_px).size();
}

}  // namespace cgsr::person
