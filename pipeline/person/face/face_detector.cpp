#include "pipeline/person/face/face_detector.h"

#include <algorithm>
#include <cmath>

#include "pipeline/person/face/cascade.h"
#include "pipeline/person/face/grey_region.h"

namespace cgsr::person {
namespace {

// find_near() and find_all() scale faces to twice the size of the cascade's own window: from there on OpenCV tries every position, below only every
// other one in each direction, which is a quarter of the work. That is enough to notice a face, and what was noticed is then looked at closely.
constexpr double kWindow_px = 20.0;
constexpr double kClose_px = 2.0 * kWindow_px;
constexpr double kExpectedFace_px = 48.0;  // to which find_near() scales an expected face: room for nearer and farther
constexpr double kNearStep = 1.2, kNearMost = 1.25;  // scales that find_near() tries
constexpr double kScaleStep = 1.2;                   // between the sizes that a slice looks for

constexpr int kMinSizes = 2;  // that a slice looks for

/// How an image is cut: the size to which the smallest faces of a slice are scaled, and how large a slice then is at most.
struct Cut {
  double face_px;
  double width_px, height_px;
};
constexpr Cut kRoughCut{kWindow_px, 104.0, 90.0};
constexpr Cut kCloseCut{kClose_px, 130.0, 100.0};

GreyPatch patch_for_cascade(const ImageView& image, const Box& region, int width_px, int height_px) {
  GreyPatch patch = quick_grey_region(image, region, width_px, height_px);
  if (!patch.pixels.empty()) stretch_contrast(patch);
  return patch;
}

int tiles_along(double length_px, double tile_px, double overlap_px) {
  if (length_px <= tile_px) return 1;
  return 1 + static_cast<int>(std::ceil((length_px - tile_px) / (tile_px - overlap_px)));
}

// As long as so many that overlap by no more than they have to: what they overlap by is looked at twice.
double tile_length(double length_px, int tiles, double overlap_px) {
  return (length_px + (tiles - 1) * overlap_px) / tiles;
}

// As many as cost no more than the fewest do in the largest slice: pixels shrink with the square of the size sought.
int sizes_in(double width_px, double height_px, const Cut& cut) {
  constexpr double kShrink = 1.0 / (kScaleStep * kScaleStep);
  constexpr double kFull = 0.85;  // of the largest slice: what the tiles of a 640x480 image reach
  const double affordable = kFull * cut.width_px * cut.height_px * (1.0 + kShrink);
  double pixels = width_px * height_px * (1.0 + kShrink), next = width_px * height_px * kShrink * kShrink;
  int sizes = kMinSizes;
  for (; sizes < 10 && pixels + next <= affordable; ++sizes, next *= kShrink) pixels += next;
  return sizes;
}

// Large faces first: they are near, and cheap to look for.
std::vector<SearchStep> slices_of(int width_px, int height_px, double min_face_px, const Cut& cut) {
  const double largest = std::min(width_px, height_px);
  const double overlap = cut.face_px * kScaleStep + 4.0;
  std::vector<SearchStep> slices;
  for (double face = min_face_px; face <= largest;) {
    const double scale = cut.face_px / face;
    const double w = width_px * scale, h = height_px * scale;
    const int across = tiles_along(w, cut.width_px, overlap), down = tiles_along(h, cut.height_px, overlap);
    const double tile_w = tile_length(w, across, overlap), tile_h = tile_length(h, down, overlap);
    const int sizes = across * down > 1 ? kMinSizes : sizes_in(w, h, cut);
    const double next_face = face * std::pow(kScaleStep, sizes);
    for (int i = across * down; i-- > 0;) {
      const int row = i / across;
      const double x = across > 1 ? (w - tile_w) * (i % across) / (across - 1) : 0.0;
      const double y = down > 1 ? (h - tile_h) * row / (down - 1) : 0.0;
      slices.push_back({{x / scale, y / scale, tile_w / scale, tile_h / scale}, face, next_face / kScaleStep});
    }
    face = next_face;
  }
  std::ranges::reverse(slices);
  return slices;
}

double distance(const Box& a, const Box& b) {
  return std::hypot(a.x + a.width / 2 - b.x - b.width / 2, a.y + a.height / 2 - b.y - b.height / 2);
}

bool is_among(const std::vector<Box>& faces, const Box& face) {
  return std::ranges::any_of(faces, [&](const Box& other) { return same_face(other, face); });
}

// A face between two of the sizes that are looked for may be like neither: every other round looks for those between. Rounds 4 to 7
// swap the two, so that each size meets each of the four positions.
double smallest_face(double min_face_px, std::size_t round) {
  const bool between = (round + round / 4) % 2 == 1;
  return between ? min_face_px * std::sqrt(kScaleStep) : min_face_px;
}

// Every round looks at positions that the one before it left out.
SearchStep shifted(SearchStep slice, std::size_t round) {
  const double position = slice.min_face_px / kRoughCut.face_px;
  slice.region.x += position * static_cast<double>(round % 2);
  slice.region.y += position * static_cast<double>(round / 2 % 2);
  return slice;
}

// Appends the rough places of faces in a slice, scaled so that the smallest are of face_px.
void look_at(const ImageView& image, const SearchStep& slice, double face_px, int neighbors, Cascade& cascade,
             std::vector<Box>& rough) {
  const double scale = face_px / slice.min_face_px;
  const Box& region = slice.region;
  const int width = static_cast<int>(std::lround(region.width * scale));
  const int height = static_cast<int>(std::lround(region.height * scale));
  const GreyPatch patch = patch_for_cascade(image, region, width, height);
  if (patch.pixels.empty()) return;
  const CascadeSearch sizes{kScaleStep, neighbors, static_cast<int>(face_px),
                            static_cast<int>(std::ceil(slice.max_face_px * scale + 1))};
  for (const cv::Rect& r : cascade.find(patch, sizes)) {
    const Box face{region.x + r.x / scale, region.y + r.y / scale, r.width / scale, r.height / scale};
    if (!is_among(rough, face)) rough.push_back(face);
  }
}

}  // namespace

bool same_face(const Box& a, const Box& b) {
  return distance(a, b) < 0.4 * std::max(a.width, b.width);
}

FaceDetector::FaceDetector(std::unique_ptr<Cascade> cascade, const FaceDetectorParameters& parameters)
    : cascade_(std::move(cascade)), parameters_(parameters) {}
FaceDetector::FaceDetector(FaceDetector&&) noexcept = default;
FaceDetector& FaceDetector::operator=(FaceDetector&&) noexcept = default;
FaceDetector::~FaceDetector() = default;

Result<FaceDetector> FaceDetector::from_cascade(const std::string& cascade_xml,
                                                const FaceDetectorParameters& parameters) {
  auto cascade = Cascade::from_xml(cascade_xml, "haarcascade_frontalface_alt2.xml");
  if (!cascade) return tl::unexpected(cascade.error());
  return FaceDetector(std::make_unique<Cascade>(std::move(*cascade)), parameters);
}

std::optional<Box> FaceDetector::find_near(const ImageView& image, const Box& expected) {
  if (image.empty() || expected.empty()) return std::nullopt;
  const double side = parameters_.region * expected.width;
  const double scale = kExpectedFace_px / expected.width;
  const Box region{expected.x + (expected.width - side) / 2, expected.y + (expected.height - side) / 2, side, side};
  const int size = static_cast<int>(std::lround(side * scale));
  const GreyPatch patch = patch_for_cascade(image, region, size, size);
  if (patch.pixels.empty()) return std::nullopt;
  std::optional<Box> nearest;
  const CascadeSearch sizes{kNearStep, parameters_.min_neighbors, static_cast<int>(kClose_px),
                            static_cast<int>(std::ceil(kExpectedFace_px * kNearMost))};
  for (const cv::Rect& r : cascade_->find(patch, sizes)) {
    const double back = side / size;
    const Box face{std::round(region.x) + r.x * back, std::round(region.y) + r.y * back, r.width * back,
                   r.height * back};
    if (!nearest || distance(face, expected) < distance(*nearest, expected)) nearest = face;
  }
  return nearest;
}

// A new face is looked at closely in a step of its own: no step costs more than one look.
void FaceDetector::search(const ImageView& image, std::vector<Box>& faces) {
  if (image.empty()) return;
  if (noticed_.empty()) {
    const auto slices = round_of(image.width_px, image.height_px, round_);
    if (slices.empty()) {
      ++round_;  // the next one begins with smaller faces
      return;
    }
    const auto slice = slices[std::min(next_slice_, slices.size() - 1)];
    if (++next_slice_ >= slices.size()) {
      next_slice_ = 0;
      ++round_;
    }
    look_at(image, slice, kRoughCut.face_px, 0, *cascade_, noticed_);
    std::erase_if(noticed_, [&](const Box& rough) { return is_among(faces, rough); });
    return;
  }
  const Box rough = noticed_.back();
  noticed_.pop_back();
  const auto face = find_near(image, rough);
  if (face && !is_among(faces, *face)) faces.push_back(*face);
}

std::vector<Box> FaceDetector::find_all(const ImageView& image) {
  std::vector<Box> faces;
  if (image.empty()) return faces;
  const int neighbors = std::min(1, parameters_.min_neighbors);
  for (const SearchStep& slice : slices_of(image.width_px, image.height_px, parameters_.min_face_px, kCloseCut)) {
    std::vector<Box> noticed;
    look_at(image, slice, kCloseCut.face_px, neighbors, *cascade_, noticed);
    SearchStep between = slice;  // the sizes between its own
    between.min_face_px *= std::sqrt(kScaleStep);
    between.max_face_px *= std::sqrt(kScaleStep);
    look_at(image, between, kCloseCut.face_px, neighbors, *cascade_, noticed);
    for (const Box& rough : noticed) {
      if (is_among(faces, rough)) continue;
      const auto face = find_near(image, rough);
      if (face && !is_among(faces, *face)) faces.push_back(*face);
    }
  }
  return faces;
}

std::vector<Box> FaceDetector::find_all_dark(const ImageView& image) {
  if (image.empty()) return {};
  const GreyPatch grey = equalized_locally(image);
  return find_all({grey.pixels.data(), grey.width_px, grey.height_px, grey.width_px, PixelFormat::kGrey8});
}

std::vector<SearchStep> FaceDetector::round_of(int width_px, int height_px, std::size_t round) const {
  auto slices = slices_of(width_px, height_px, smallest_face(parameters_.min_face_px, round), kRoughCut);
  for (SearchStep& slice : slices) slice = shifted(slice, round);
  return slices;
}

}  // namespace cgsr::person
