#include "pipeline/imaging/segments.h"

#include <algorithm>
#include <cmath>

namespace cgsr::imaging {
namespace {

constexpr int kCell_px = 16;
constexpr std::size_t kFewestPoints = 6;
/// Points within so much of an end lie where two edges' slopes mix.
constexpr std::size_t kMixedEnd = 2;
/// An end point that lies farther off the line than this belongs to something else.
constexpr double kFarOffLine_px = 0.5;
/// cos^2 of the greatest turn from one edge pixel to the next, 45 degrees.
constexpr float kLeastAgreement = 0.5F;
/// cos^2 between the slopes of edges that count as parallel, 15 degrees.
constexpr double kLeastParallel = 0.93;
/// Pieces on one line: directions within 6 degrees, ends within so many pixels of each other's line.
constexpr double kLeastCosine = 0.9945;
constexpr double kGreatestStep_px = 0.9;
/// Neighbouring points share noise, because the blur is wider than a pixel: so many count as one.
constexpr double kPointsPerMeasurement = 2.5;
/// What is left of the position's bias from the pixel raster and a neighbour's slope.
constexpr double kLeastSigma_px = 0.02;

/// Two opposite edges of equal strength push each other apart, because each one's slope lies on the other's. By how much each, over the distance
/// that they seem to have from 2.6 px in steps of 0.2; for edges as sharp as a half-size image shows them (deviation 0.5 px), measured on
/// drawn tapes of 1.6 to 4.5 px.
constexpr double kNearest_px = 2.6;
constexpr double kApart_px = 4.4;
constexpr double kTableStep_px = 0.2;
constexpr std::array<double, 11> kPush_px = {0.585, 0.324, 0.185, 0.105, 0.059, 0.032, 0.016, 0.0075, 0.004, 0.0, 0.0};

double push_at(double distance) {
  if (distance >= kApart_px) return 0.0;
  const double at = std::max(0.0, (distance - kNearest_px) / kTableStep_px);
  const auto i = static_cast<std::size_t>(at);
  const double part = at - static_cast<double>(i);
  return (1.0 - part) * kPush_px[i] + part * kPush_px[i + 1];
}

}  // namespace

SegmentFinder::SegmentFinder(const SegmentParameters& parameters, int max_width_px, int max_height_px)
    : parameters_(parameters),
      edges_(parameters.edges, max_width_px, max_height_px),
      cells_x_(max_width_px / kCell_px + 1),
      cells_y_(max_height_px / kCell_px + 1) {
  linked_.resize(edges_.capacity());
  chain_.reserve(kLongestChain);
  x_.resize(kLongestChain);
  y_.resize(kLongestChain);
  running_.resize(kLongestChain + 1);
  bends_.reserve(kLongestChain);
  pieces_.reserve(edges_.capacity() / kFewestPoints + 1);
  cells_.resize(static_cast<std::size_t>(cells_x_) * static_cast<std::size_t>(cells_y_));
  segments_.reserve(pieces_.capacity());
}

std::span<const Segment> SegmentFinder::find(const std::uint8_t* grey, int width_px, int height_px,
                                             std::ptrdiff_t stride, const std::uint8_t* mask) {
  pieces_.clear();
  segments_.clear();
  grey_ = grey;
  stride_ = stride;
  const std::span<const EdgePixel> edges = edges_.find(grey, width_px, height_px, stride, mask);
  const std::ptrdiff_t row = edges_.map_width();
  around_ = {1, row + 1, row, row - 1, -1, -row - 1, -row, -row + 1};

  std::fill_n(linked_.begin(), edges.size(), std::uint8_t{0});
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    if (linked_[i] != 0) continue;
    link(i);
    if (chain_.size() < kFewestPoints) continue;
    sum_up_chain();
    split_chain();
  }
  join_pieces();
  keep_longest();
  return segments_;
}

/// The chain through `start`, from its one end to the other.
void SegmentFinder::link(std::uint32_t start) {
  chain_.clear();
  linked_[start] = 1;
  chain_.push_back(start);
  for (const int sense : {-1, 1}) {
    std::uint32_t at = start;
    while (chain_.size() < kLongestChain) {
      const std::uint32_t entry = follow(at, sense);
      if (entry == 0) break;
      at = entry - 1;
      linked_[at] = 1;
      chain_.push_back(at);
    }
    if (sense < 0) std::reverse(chain_.begin(), chain_.end());
  }
}

/// \param sense  1: the brighter side stays on the right hand. \return map entry of the next edge pixel, or 0.
std::uint32_t SegmentFinder::follow(std::uint32_t number, int sense) const {
  const EdgePixel& edge = edges_.edges()[number];
  const int dx = sense * edge.gy;
  const int dy = -sense * edge.gx;
  const int across = std::abs(dx);
  const int down = std::abs(dy);
  unsigned octant = 0;
  if (5 * down <= 2 * across) {
    octant = dx > 0 ? 0 : 4;
  } else if (5 * across <= 2 * down) {
    octant = dy > 0 ? 2 : 6;
  } else if (dx > 0) {
    octant = dy > 0 ? 1 : 7;
  } else {
    octant = dy > 0 ? 3 : 5;
  }
  const std::uint32_t* here = edges_.map() + static_cast<std::ptrdiff_t>(edge.y) * edges_.map_width() + edge.x;
  const auto size = static_cast<float>(across * across + down * down);
  const auto agreement = [&](std::uint32_t entry) {
    if (entry == 0 || linked_[entry - 1] != 0) return 0.0F;
    const EdgePixel& other = edges_.edges()[entry - 1];
    const int dot = edge.gx * other.gx + edge.gy * other.gy;
    if (dot <= 0) return 0.0F;
    const auto shared = static_cast<float>(dot);
    const auto other_size = static_cast<float>(other.gx * other.gx + other.gy * other.gy);
    return shared * shared >= kLeastAgreement * size * other_size ? shared : 0.0F;
  };
  const std::uint32_t ahead = here[around_[octant]];
  if (agreement(ahead) > 0.0F) return ahead;
  const std::uint32_t left = here[around_[(octant + 7) % 8]];
  const std::uint32_t right = here[around_[(octant + 1) % 8]];
  const float left_agrees = agreement(left);
  const float right_agrees = agreement(right);
  if (left_agrees <= 0.0F && right_agrees <= 0.0F) return 0;
  return left_agrees >= right_agrees ? left : right;
}

void SegmentFinder::sum_up_chain() {
  for (std::size_t i = 0; i < chain_.size(); ++i) {
    const EdgePixel& edge = edges_.edges()[chain_[i]];
    x_[i] = edge.exact_x();
    y_[i] = edge.exact_y();
  }
  const double origin_x = static_cast<double>(x_[0]);
  const double origin_y = static_cast<double>(y_[0]);
  LineMoments sums;
  running_[0] = sums;
  for (std::size_t i = 0; i < chain_.size(); ++i) {
    sums.add(static_cast<double>(x_[i]) - origin_x, static_cast<double>(y_[i]) - origin_y);
    running_[i + 1] = sums;
  }
}

/// Of the points first to last, both counted; from the image's corner.
LineMoments SegmentFinder::sums_of(std::size_t first, std::size_t last) const {
  const LineMoments stretch = running_[last + 1] - running_[first];
  return stretch.moved(static_cast<double>(x_[0]), static_cast<double>(y_[0]));
}

/// \return the point between that lies farthest off the line from first to last, if that is more than may be; else `last`.
std::size_t SegmentFinder::farthest_from_chord(std::size_t first, std::size_t last) const {
  const float dx = x_[last] - x_[first];
  const float dy = y_[last] - y_[first];
  const float offset = dx * y_[first] - dy * x_[first];
  float greatest = static_cast<float>(parameters_.max_deviation_px) * std::sqrt(dx * dx + dy * dy);
  std::size_t farthest = last;
  for (std::size_t i = first + 1; i < last; ++i) {
    const float distance = std::abs(dx * y_[i] - dy * x_[i] - offset);
    if (distance > greatest) {
      greatest = distance;
      farthest = i;
    }
  }
  return farthest;
}

/// Ramer's splitting from the left; then what a bad end point split needlessly is one again.
void SegmentFinder::split_chain() {
  bends_.clear();
  std::size_t first = 0;
  std::size_t done = 0;  // pieces up to here are made
  bool pending = false;
  std::size_t pending_first = 0;
  bends_.push_back(static_cast<std::uint32_t>(chain_.size() - 1));
  while (!bends_.empty()) {
    const std::size_t last = bends_.back();
    const std::size_t bend = last - first < kFewestPoints ? last : farthest_from_chord(first, last);
    if (bend != last) {
      bends_.push_back(static_cast<std::uint32_t>(bend));
      continue;
    }
    bends_.pop_back();
    if (pending && is_straight(pending_first, last)) {
      done = last;
    } else {
      if (pending) add_piece(pending_first, done);
      pending = true;
      pending_first = first;
      done = last;
    }
    first = last;
  }
  if (pending) add_piece(pending_first, done);
}

bool SegmentFinder::is_straight(std::size_t first, std::size_t last) const {
  if (last - first < kFewestPoints) return false;
  const FittedLine line = fit_line(sums_of(first, last), point(last) - point(first));
  return line.rms < 0.3 * parameters_.max_deviation_px;
}

void SegmentFinder::add_piece(std::size_t first, std::size_t last) {
  FittedLine line;
  std::size_t from = 0;
  std::size_t to = 0;
  const auto refit = [&] {
    const std::size_t trimmed = last - first >= 3 * kMixedEnd + kFewestPoints ? kMixedEnd : 1;
    from = first + trimmed;
    to = last - trimmed;
    line = fit_line(sums_of(from, to), point(last) - point(first));
  };
  const auto off_line = [&](std::size_t i) { return std::abs(line.across(point(i))) > kFarOffLine_px; };
  for (int pass = 0; pass < 2; ++pass) {
    if (last - first < kFewestPoints) return;
    refit();
    const std::size_t first_before = first;
    const std::size_t last_before = last;
    while (last - first >= kFewestPoints && off_line(first)) ++first;
    while (last - first >= kFewestPoints && off_line(last)) --last;
    if (first == first_before && last == last_before) break;
  }
  if (last - first < kFewestPoints || pieces_.size() == pieces_.capacity()) return;
  refit();

  Piece piece;
  piece.sums = sums_of(from, to);
  piece.line = line;
  piece.first = line.middle + line.along(point(first)) * line.direction;
  piece.last = line.middle + line.along(point(last)) * line.direction;
  int difference = 0;
  for (std::size_t i = from; i <= to; ++i) {
    const EdgePixel& edge = edges_.edges()[chain_[i]];
    const std::uint8_t* pixel = grey_ + edge.y * stride_ + edge.x;
    const std::ptrdiff_t step = edge.across_row() ? (edge.gx > 0 ? 2 : -2) : (edge.gy > 0 ? 2 * stride_ : -2 * stride_);
    difference += pixel[step] - pixel[-step];
  }
  piece.contrast_sum = static_cast<double>(difference);
  piece.contrast_count = static_cast<double>(to - from + 1);
  piece.next = kNone;
  piece.next_in_cell = kNone;
  piece.continues = false;
  pieces_.push_back(piece);
}

std::size_t SegmentFinder::cell_of(const Eigen::Vector2d& at) const {
  const int x = std::clamp(static_cast<int>(at.x()) / kCell_px, 0, cells_x_ - 1);
  const int y = std::clamp(static_cast<int>(at.y()) / kCell_px, 0, cells_y_ - 1);
  return static_cast<std::size_t>(y * cells_x_ + x);
}

/// \return the nearest piece that begins where this one ends and lies on the same line.
std::int32_t SegmentFinder::continuation_of(const Piece& piece, std::int32_t itself) const {
  const double gap = parameters_.max_gap_px;
  const std::size_t low = cell_of(piece.last - Eigen::Vector2d::Constant(gap));
  const std::size_t high = cell_of(piece.last + Eigen::Vector2d::Constant(gap));
  const auto columns = static_cast<std::size_t>(cells_x_);
  double nearest = gap;
  std::int32_t best = kNone;
  for (std::size_t y = low / columns; y <= high / columns; ++y) {
    for (std::size_t x = low % columns; x <= high % columns; ++x) {
      for (std::int32_t i = cells_[y * columns + x]; i != kNone;
           i = pieces_[static_cast<std::size_t>(i)].next_in_cell) {
        const Piece& other = pieces_[static_cast<std::size_t>(i)];
        if (i == itself || other.continues) continue;
        const double along = piece.line.along(other.first) - piece.line.along(piece.last);
        if (along < -2.0 || along > nearest) continue;
        if (piece.line.direction.dot(other.line.direction) < kLeastCosine) continue;
        // The shorter one's line is the less certain: what counts is how far its points are from the longer one's.
        const bool longer = piece.length() >= other.length();
        const FittedLine& line = longer ? piece.line : other.line;
        const Eigen::Vector2d& near_end = longer ? other.first : piece.last;
        const Eigen::Vector2d& far_end = longer ? other.last : piece.first;
        if (std::abs(line.across(near_end)) > kGreatestStep_px || std::abs(line.across(far_end)) > kGreatestStep_px) {
          continue;
        }
        nearest = along;
        best = i;
      }
    }
  }
  return best;
}

void SegmentFinder::join_pieces() {
  std::fill(cells_.begin(), cells_.end(), kNone);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    std::int32_t& head = cells_[cell_of(pieces_[i].first)];
    pieces_[i].next_in_cell = head;
    head = static_cast<std::int32_t>(i);
  }
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const std::int32_t next = continuation_of(pieces_[i], static_cast<std::int32_t>(i));
    if (next == kNone) continue;
    pieces_[i].next = next;
    pieces_[static_cast<std::size_t>(next)].continues = true;
  }
  for (const Piece& start : pieces_) {
    if (start.continues) continue;
    Piece joined = start;
    for (std::int32_t i = start.next; i != kNone; i = pieces_[static_cast<std::size_t>(i)].next) {
      const Piece& other = pieces_[static_cast<std::size_t>(i)];
      const LineMoments sums = joined.sums + other.sums;
      const FittedLine line = fit_line(sums, joined.line.direction);
      if (line.rms > 0.3 * parameters_.max_deviation_px) {  // a slow bend
        add_segment(joined);
        joined = other;
        continue;
      }
      joined.sums = sums;
      joined.line = line;
      joined.first = line.middle + line.along(joined.first) * line.direction;
      joined.last = line.middle + line.along(other.last) * line.direction;
      joined.contrast_sum += other.contrast_sum;
      joined.contrast_count += other.contrast_count;
    }
    add_segment(joined);
  }
}

/// \return how far the line was pushed off along its normal by an opposite edge close to it, with a minus sign: what to add.
double SegmentFinder::correction_for_neighbours(const Piece& piece) const {
  const FittedLine& line = piece.line;
  const bool along_row = std::abs(line.direction.y()) > std::abs(line.direction.x());  // the way across
  const double slant = along_row ? std::abs(line.direction.y()) : std::abs(line.direction.x());
  const int steps = static_cast<int>(kApart_px / slant) + 1;
  const std::ptrdiff_t width = edges_.map_width();
  const std::ptrdiff_t step = along_row ? 1 : width;
  double sum[2] = {0.0, 0.0};
  int seen[2] = {0, 0};
  for (const double part : {0.2, 0.5, 0.8}) {
    const Eigen::Vector2d at = piece.first + part * (piece.last - piece.first);
    const auto x = static_cast<int>(std::lround(at.x()));
    const auto y = static_cast<int>(std::lround(at.y()));
    const std::uint32_t* here = edges_.map() + y * width + x;
    const std::uint32_t own = here[0] != 0 ? here[0] : here[step] != 0 ? here[step] : here[-step];
    if (own == 0) continue;
    const EdgePixel& edge = edges_.edges()[own - 1];
    const auto size = static_cast<double>(edge.gx * edge.gx + edge.gy * edge.gy);
    for (const int sense : {-1, 1}) {
      const int room =
          along_row ? (sense < 0 ? x : edges_.width_px() - 1 - x) : (sense < 0 ? y : edges_.height_px() - 1 - y);
      for (int k = 2; k <= std::min(steps, room); ++k) {
        const std::uint32_t entry = here[sense * k * step];
        if (entry == 0) continue;
        const EdgePixel& other = edges_.edges()[entry - 1];
        const auto dot = static_cast<double>(edge.gx * other.gx + edge.gy * other.gy);
        const auto other_size = static_cast<double>(other.gx * other.gx + other.gy * other.gy);
        if (dot >= 0.0 || dot * dot < kLeastParallel * size * other_size) continue;
        const double distance =
            line.across({static_cast<double>(other.exact_x()), static_cast<double>(other.exact_y())});
        const std::size_t side = distance > 0.0 ? 1 : 0;
        sum[side] += push_at(std::abs(distance)) * std::min(std::sqrt(other_size / size), 1.5);
        ++seen[side];
        break;
      }
    }
  }
  const double brighter = seen[1] >= 2 ? sum[1] / seen[1] : 0.0;
  const double darker = seen[0] >= 2 ? sum[0] / seen[0] : 0.0;
  return brighter - darker;
}

void SegmentFinder::add_segment(const Piece& piece) {
  if (piece.length() < parameters_.min_length_px) return;
  const double measurements = std::max(piece.sums.n / kPointsPerMeasurement, 1.0);
  Segment segment;
  const Eigen::Vector2d normal(-piece.line.direction.y(), piece.line.direction.x());
  const Eigen::Vector2d correction = correction_for_neighbours(piece) * normal;
  segment.p0 = (piece.first + correction).cast<float>();
  segment.p1 = (piece.last + correction).cast<float>();
  segment.contrast = static_cast<float>(piece.contrast_sum / piece.contrast_count);
  segment.sigma_px =
      static_cast<float>(std::sqrt(piece.line.rms * piece.line.rms / measurements + kLeastSigma_px * kLeastSigma_px));
  segments_.push_back(segment);
}

void SegmentFinder::keep_longest() {
  const auto most = static_cast<std::size_t>(parameters_.max_segments);
  if (segments_.size() <= most) return;
  const auto longer = [](const Segment& a, const Segment& b) {
    return (a.p1 - a.p0).squaredNorm() > (b.p1 - b.p0).squaredNorm();
  };
  std::nth_element(segments_.begin(), segments_.begin() + static_cast<std::ptrdiff_t>(most), segments_.end(), longer);
  segments_.resize(most);
}

}  // namespace cgsr::imaging
