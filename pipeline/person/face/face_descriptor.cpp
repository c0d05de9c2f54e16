#include "pipeline/person/face/face_descriptor.h"

#include <emmintrin.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>

#include "pipeline/person/face/grey_region.h"

namespace cgsr::person {
namespace {

constexpr int kFace_px = 128;   // to which a face is scaled
constexpr int kMargin_px = 26;  // around it
constexpr int kCrop_px = kFaceCrop_px;
static_assert(kCrop_px == kFace_px + 2 * kMargin_px);
constexpr int kStep_px = 4;    // of the dense grid
constexpr int kFirst_px = 28;  // its first point
constexpr int kCell_px = 5;    // of a descriptor
constexpr int kDirections = 8;
constexpr int kReach = 3;      // steps by which a point may lie off
constexpr int kSpacing = 3;    // steps between a view's points
constexpr int kAround_px = 9;  // within which the contrast is made equal: a box, twice
constexpr float kMinContrast = 0.003F;
constexpr float kMinNorm = 0.1F;  // of a descriptor whose cells hold hundreds; less is what rounding leaves of nothing
// Of a component, before the second normalisation. Lowe (2004) has .2; less than a component's mean share is better here, for how strong an edge
// of a face is changes with where the light comes from, its direction hardly.
constexpr float kMaxShare = 0.08F;

static_assert(kDenseSide == (kViewSide - 1) * kSpacing + 2 * kReach + 1);
static_assert(kFirst_px + (kDenseSide - 1) * kStep_px + 2 * kCell_px < kCrop_px);

// Two boxes one after the other make a triangle, which costs the same however wide it is.
void blur_twice(cv::Mat& image, int width_px) {
  for (int pass = 0; pass < 2; ++pass) cv::blur(image, image, {width_px, width_px});
}

/// The sums over a box of 2 * reach + 1 values along a line, nothing beyond its ends.
/// \param from, to  from a place in the line to its value, and to where its sum goes.
template <class Value, class From, class To>
void sum_boxes(int length, int reach, Value sum, const From& from, const To& to) {
  for (int i = -reach; i < length; ++i) {
    if (i + reach < length) sum += from(i + reach);
    if (i > reach) sum -= from(i - reach - 1);
    if (i >= 0) to(i) = sum;
  }
}

using Directions = Eigen::Array<float, kDirections, 1>;

// As cv::blur() with a border of zeros and not divided by the area, at a ninth of its cost: it adds the directions up one by one.
void sum_cells(cv::Mat& planes) {
  constexpr int kReach_px = kCell_px / 2;
  cv::Mat sums(planes.size(), planes.type());
  for (int y = 0; y < planes.rows; ++y) {
    const auto from = [row = planes.ptr<float>(y)](int x) { return Eigen::Map<Directions>(row + x * kDirections); };
    const auto to = [row = sums.ptr<float>(y)](int x) { return Eigen::Map<Directions>(row + x * kDirections); };
    sum_boxes(planes.cols, kReach_px, Directions(Directions::Zero()), from, to);
  }
  const Eigen::Index width = Eigen::Index{planes.cols} * kDirections;
  const auto row_of = [width](cv::Mat& image) {
    return [&image, width](int y) { return Eigen::Map<Eigen::ArrayXf>(image.ptr<float>(y), width); };
  };
  sum_boxes(planes.rows, kReach_px, Eigen::ArrayXf(Eigen::ArrayXf::Zero(width)), row_of(sums), row_of(planes));
}

// Local mean out, local deviation to one: what is left does not depend on how bright the light is.
cv::Mat equal_contrast(const GreyPatch& patch) {
  cv::Mat crop(kCrop_px, kCrop_px, CV_8UC1, const_cast<std::uint8_t*>(patch.pixels.data()));
  cv::Mat face, mean, deviation;
  crop.convertTo(face, CV_32F, 1.0 / 255.0);
  mean = face.clone();
  blur_twice(mean, kAround_px);
  face -= mean;
  deviation = face.mul(face);
  blur_twice(deviation, kAround_px);
  deviation = cv::max(deviation, 0.0);  // running sums leave a little less than nothing where all is alike
  cv::sqrt(deviation, deviation);
  face /= deviation + kMinContrast;
  cv::GaussianBlur(face, face, {}, 1.6);
  return face;
}

// Gradients shared out over directions, the channels of each pixel, then over cells.
cv::Mat direction_planes(const cv::Mat& face) {
  const cv::Rect inner(1, 1, kCrop_px - 2, kCrop_px - 2);
  const auto moved = [&](int x, int y) { return face(inner + cv::Point(x, y)); };
  cv::Mat size, turn;
  cv::cartToPolar(moved(1, 0) - moved(-1, 0), moved(0, 1) - moved(0, -1), size, turn);
  turn *= kDirections / (2 * std::numbers::pi);
  cv::Mat planes = cv::Mat::zeros(kCrop_px, kCrop_px, CV_32FC(kDirections));
  for (int y = 0; y < inner.height; ++y) {
    const float *sizes = size.ptr<float>(y), *turns = turn.ptr<float>(y);
    float* shares = planes.ptr<float>(y + 1) + kDirections;
    for (int x = 0; x < inner.width; ++x, shares += kDirections) {
      const int first = static_cast<int>(turns[x]);
      const float rest = sizes[x] * (turns[x] - static_cast<float>(first));
      shares[first % kDirections] += sizes[x] - rest;
      shares[(first + 1) % kDirections] += rest;
    }
  }
  for (int pass = 0; pass < 2; ++pass) sum_cells(planes);
  return planes;
}

/// A cell of a descriptor: where it lies from the descriptor's place, in floats of the planes, and how much it counts.
struct Cell {
  std::ptrdiff_t at = 0;
  float weight = 0.0F;
};

std::array<Cell, 16> descriptor_cells() {
  std::array<Cell, 16> cells{};
  for (int i = 0; i < 16; ++i) {
    const int across = i % 4, down = i / 4;
    const float column = static_cast<float>(across) - 1.5F, row = static_cast<float>(down) - 1.5F;
    const std::ptrdiff_t x_px = std::lround(column * kCell_px), y_px = std::lround(row * kCell_px);
    cells[static_cast<std::size_t>(i)] = {(y_px * kCrop_px + x_px) * kDirections,
                                          std::exp(-(column * column + row * row) / 8)};
  }
  return cells;
}

float sum_of(__m128 four) {
  std::array<float, 4> values{};
  _mm_storeu_ps(values.data(), four);
  return (values[0] + values[1]) + (values[2] + values[3]);
}

// One descriptor out of the planes, normalised, limited, normalised, square root taken.
void describe_point(const cv::Mat& planes, int x_px, int y_px, std::uint8_t* out) {
  static const std::array<Cell, 16> kCells = descriptor_cells();
  const float* const here = planes.ptr<float>(y_px) + std::ptrdiff_t{x_px} * kDirections;
  std::array<float, kSiftSize> values{};
  __m128 squares = _mm_setzero_ps();
  for (std::size_t cell = 0; cell < 16; ++cell) {
    const float* const directions = here + kCells[cell].at;
    const __m128 weight = _mm_set1_ps(kCells[cell].weight);
    for (std::size_t half = 0; half < 2; ++half) {
      const __m128 four = _mm_mul_ps(_mm_loadu_ps(directions + 4 * half), weight);
      _mm_storeu_ps(values.data() + cell * kDirections + 4 * half, four);
      squares = _mm_add_ps(squares, _mm_mul_ps(four, four));
    }
  }
  const float norm = std::sqrt(sum_of(squares));
  if (norm < kMinNorm) {
    std::fill_n(out, kSiftSize, std::uint8_t{0});
    return;
  }
  const __m128 per_norm = _mm_set1_ps(1.0F / norm), zero = _mm_setzero_ps();
  __m128 sum = zero;
  for (std::size_t i = 0; i < values.size(); i += 4) {
    const __m128 share = _mm_max_ps(zero, _mm_mul_ps(_mm_loadu_ps(values.data() + i), per_norm));
    const __m128 four = _mm_min_ps(_mm_set1_ps(kMaxShare), share);
    _mm_storeu_ps(values.data() + i, four);
    sum = _mm_add_ps(sum, four);
  }
  const __m128 per_sum = _mm_set1_ps(255.0F * 255.0F / (sum_of(sum) + 1e-9F));
  const auto whole = [&](std::size_t first) {
    return _mm_cvtps_epi32(_mm_sqrt_ps(_mm_mul_ps(_mm_loadu_ps(values.data() + first), per_sum)));
  };
  for (std::size_t i = 0; i < values.size(); i += 16) {
    const __m128i low = _mm_packs_epi32(whole(i), whole(i + 4)), high = _mm_packs_epi32(whole(i + 8), whole(i + 12));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out + i), _mm_packus_epi16(low, high));
  }
}

int dot(const std::uint8_t* a, const std::uint8_t* b) {
  const __m128i zero = _mm_setzero_si128();
  __m128i sum = zero;
  for (int i = 0; i < kSiftSize; i += 16) {
    const __m128i x = _mm_loadu_si128(reinterpret_cast<const __m128i*>(a + i));
    const __m128i y = _mm_loadu_si128(reinterpret_cast<const __m128i*>(b + i));
    sum = _mm_add_epi32(sum, _mm_madd_epi16(_mm_unpacklo_epi8(x, zero), _mm_unpacklo_epi8(y, zero)));
    sum = _mm_add_epi32(sum, _mm_madd_epi16(_mm_unpackhi_epi8(x, zero), _mm_unpackhi_epi8(y, zero)));
  }
  sum = _mm_add_epi32(sum, _mm_srli_si128(sum, 8));
  return _mm_cvtsi128_si32(_mm_add_epi32(sum, _mm_srli_si128(sum, 4)));
}

constexpr std::size_t kSteps = 2 * kReach + 1;
/// How alike a view's point is to each dense point around its place, row by row: scalar products.
using Likenesses = std::array<int, kSteps * kSteps>;

/// From a point's place in the view to where it lies in the face, in steps of the dense grid.
struct Offset {
  double x = 0.0, y = 0.0;
};

/// Place of a view's point from the middle of the face, in steps.
Offset place_of(int point) {
  constexpr int kMiddle = kViewSide / 2;
  const int x = kSpacing * (point % kViewSide - kMiddle), y = kSpacing * (point / kViewSide - kMiddle);
  return {static_cast<double>(x), static_cast<double>(y)};
}

/// How a face was moved, turned and scaled against a view: offset = (a x - b y + dx, b x + a y + dy).
struct Similarity {
  double a = 0.0, b = 0.0, dx = 0.0, dy = 0.0;
  [[nodiscard]] Offset at(int point) const {
    const auto [x, y] = place_of(point);
    return {a * x - b * y + dx, b * x + a * y + dy};
  }
};

/// Fills in how alike a view's point is to the dense points around it. \return where it is most alike.
Offset likenesses(const FaceDescriptor& face, const FaceView& view, int point, Likenesses& alike) {
  const std::uint8_t* enrolled = view.data() + std::ptrdiff_t{point} * kSiftSize;
  for (std::size_t y = 0; y < kSteps; ++y) {
    const int row = (point / kViewSide * kSpacing + static_cast<int>(y)) * kDenseSide + point % kViewSide * kSpacing;
    const std::uint8_t* seen = face.dense.data() + std::ptrdiff_t{row} * kSiftSize;
    for (std::size_t x = 0; x < kSteps; ++x, seen += kSiftSize) alike[y * kSteps + x] = dot(enrolled, seen);
  }
  const auto most = static_cast<int>(std::max_element(alike.begin(), alike.end()) - alike.begin());
  constexpr int kAcross = static_cast<int>(kSteps);
  const int x = most % kAcross - kReach, y = most / kAcross - kReach;
  return {static_cast<double>(x), static_cast<double>(y)};
}

/// The similarity that most points agree with: least squares, again with weights that fall with the distance (Geman and McClure, 1987).
Similarity fit(const std::array<Offset, kViewSide * kViewSide>& offsets) {
  constexpr int kRounds = 5;
  std::array<double, kViewSide * kViewSide> weights{};
  weights.fill(1.0);
  Similarity moved;
  for (int round = 0; round < kRounds; ++round) {
    double sum = 0.0, x = 0.0, y = 0.0, u = 0.0, v = 0.0, square = 0.0, along = 0.0, across = 0.0;
    for (int i = 0; i < kViewSide * kViewSide; ++i) {
      const double w = weights[static_cast<std::size_t>(i)];
      const Offset place = place_of(i), off = offsets[static_cast<std::size_t>(i)];
      sum += w;
      x += w * place.x;
      y += w * place.y;
      u += w * off.x;
      v += w * off.y;
      square += w * (place.x * place.x + place.y * place.y);
      along += w * (place.x * off.x + place.y * off.y);
      across += w * (place.x * off.y - place.y * off.x);
    }
    const double spread = square - (x * x + y * y) / sum;
    moved.a = (along - (x * u + y * v) / sum) / spread;
    moved.b = (across - (x * v - y * u) / sum) / spread;
    moved.dx = (u - moved.a * x + moved.b * y) / sum;
    moved.dy = (v - moved.b * x - moved.a * y) / sum;
    for (int i = 0; i < kViewSide * kViewSide; ++i) {
      const Offset expected = moved.at(i), off = offsets[static_cast<std::size_t>(i)];
      const double away2 = (expected.x - off.x) * (expected.x - off.x) + (expected.y - off.y) * (expected.y - off.y);
      weights[static_cast<std::size_t>(i)] = 1.0 / ((1.0 + away2) * (1.0 + away2));
    }
  }
  return moved;
}

std::array<double, kSteps> squares_from(double place) {
  std::array<double, kSteps> squares{};
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double off = static_cast<double>(i) - kReach - place;
    squares[i] = off * off;
  }
  return squares;
}

}  // namespace

bool FaceAlignment::is_small() const {
  constexpr double kHalfFace_px = kFace_px / 2.0;
  return std::hypot(dx_px, dy_px) + std::hypot(a, b) * kHalfFace_px <= kStep_px;
}

void FaceAlignment::move_towards(const FaceAlignment& other, double share) {
  a += share * (other.a - a);
  b += share * (other.b - b);
  dx_px += share * (other.dx_px - dx_px);
  dy_px += share * (other.dy_px - dy_px);
}

GreyPatch aligned_crop(const GreyPatch& crop, const FaceAlignment& alignment) {
  if (crop.width_px != kCrop_px || crop.height_px != kCrop_px || crop.pixels.empty()) return crop;
  constexpr int kMiddle_px = kFirst_px + kStep_px * (kDenseSide / 2);
  const double along = 1 + alignment.a, across = alignment.b;
  const cv::Matx23d to_crop(along, -across, kMiddle_px + alignment.dx_px - (along - across) * kMiddle_px, across, along,
                            kMiddle_px + alignment.dy_px - (along + across) * kMiddle_px);
  GreyPatch aligned{kCrop_px, kCrop_px, std::vector<std::uint8_t>(std::size_t{kCrop_px} * kCrop_px)};
  const cv::Mat from(kCrop_px, kCrop_px, CV_8UC1, const_cast<std::uint8_t*>(crop.pixels.data()));
  cv::Mat to(kCrop_px, kCrop_px, CV_8UC1, aligned.pixels.data());
  cv::warpAffine(from, to, to_crop, to.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
  return aligned;
}

GreyPatch face_crop(const ImageView& image, const Box& face) {
  if (face.empty()) return {};
  const double margin = face.width * kMargin_px / kFace_px;
  const Box region{face.x - margin, face.y - margin, face.width + 2 * margin, face.height + 2 * margin};
  return grey_region(image, region, kCrop_px, kCrop_px);
}

std::optional<FaceDescriptor> describe_face(const ImageView& image, const Box& face) {
  return describe_crop(face_crop(image, face));
}

std::optional<FaceDescriptor> describe_crop(const GreyPatch& crop) {
  if (crop.width_px != kCrop_px || crop.height_px != kCrop_px || crop.pixels.empty()) return std::nullopt;
  const auto planes = direction_planes(equal_contrast(crop));
  FaceDescriptor descriptor{std::vector<std::uint8_t>(std::size_t{kDenseSide} * kDenseSide * kSiftSize)};
  std::uint8_t* out = descriptor.dense.data();
  for (int y = 0; y < kDenseSide; ++y) {
    for (int x = 0; x < kDenseSide; ++x, out += kSiftSize)
      describe_point(planes, kFirst_px + x * kStep_px, kFirst_px + y * kStep_px, out);
  }
  return descriptor;
}

FaceView view_of(const FaceDescriptor& face) {
  FaceView view{};
  std::uint8_t* out = view.data();
  for (int y = 0; y < kViewSide; ++y) {
    for (int x = 0; x < kViewSide; ++x, out += kSiftSize) {
      const int at = (kReach + y * kSpacing) * kDenseSide + kReach + x * kSpacing;
      std::copy_n(face.dense.begin() + std::ptrdiff_t{at} * kSiftSize, kSiftSize, out);
    }
  }
  return view;
}

std::int64_t rough_likeness(const FaceDescriptor& face, const FaceView& view) {
  std::int64_t sum = 0;
  for (std::size_t point = 0; point < std::size_t{kViewSide} * kViewSide; ++point) {
    const std::size_t row = kReach + kSpacing * (point / kViewSide), column = kReach + kSpacing * (point % kViewSide);
    const std::uint8_t* const seen = face.dense.data() + (row * kDenseSide + column) * kSiftSize;
    const std::uint8_t* const known = view.data() + point * kSiftSize;
    int product = 0;
    for (int i = 0; i < kSiftSize; ++i) product += int{seen[i]} * int{known[i]};
    sum += product;
  }
  return sum;
}

FaceAlignment view_distances(const FaceDescriptor& face, const FaceView& view,
                             std::array<double, kViewSide * kViewSide>& distances) {
  constexpr double kUnit = 255.0 * 255.0;
  constexpr double kPerStep2 = 0.04;  // by which a point counts as farther for each squared step off its place
  std::array<Likenesses, kViewSide * kViewSide> alike;
  std::array<Offset, kViewSide * kViewSide> nearest{};
  for (int i = 0; i < kViewSide * kViewSide; ++i)
    nearest[static_cast<std::size_t>(i)] = likenesses(face, view, i, alike[static_cast<std::size_t>(i)]);
  const Similarity moved = fit(nearest);
  for (int i = 0; i < kViewSide * kViewSide; ++i) {
    const Offset place = moved.at(i);
    const std::array<double, kSteps> off_x2 = squares_from(place.x), off_y2 = squares_from(place.y);
    const Likenesses& point = alike[static_cast<std::size_t>(i)];
    double most = -1.0;
    for (std::size_t y = 0; y < kSteps; ++y) {
      for (std::size_t x = 0; x < kSteps; ++x)
        most = std::max(most, point[y * kSteps + x] / kUnit - kPerStep2 * (off_x2[x] + off_y2[y]));
    }
    distances[static_cast<std::size_t>(i)] = 1.0 - most;
  }
  return {moved.a, moved.b, moved.dx * kStep_px, moved.dy * kStep_px};
}

}  // namespace cgsr::person
