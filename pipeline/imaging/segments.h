#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/imaging/edge_pixels.h"
#include "pipeline/imaging/line_moments.h"

namespace cgsr::imaging {

/// A straight edge in an image, in its pixels: the centre of the top-left one is (0, 0), x right, y down.
/// With d = p1 - p0 the normal (-d.y, d.x) points to the brighter side.
struct Segment {
  Eigen::Vector2f p0 = Eigen::Vector2f::Zero();
  Eigen::Vector2f p1 = Eigen::Vector2f::Zero();
  float contrast = 0.0F;  ///< mean difference of both sides, grey levels.
  float sigma_px = 0.0F;  ///< standard error of the line across its direction, in its middle.
};

struct SegmentParameters {
  EdgeParameters edges;
  double min_length_px = 8.0;
  double max_deviation_px = 0.8;
  double max_gap_px = 8.0;
  int max_segments = 1000;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("edges", self.edges, "what counts as an edge pixel");
    visit.number("min_length_px", self.min_length_px, {6.0, 100.0}, "px", "shorter ones are left out");
    visit.number("max_deviation_px", self.max_deviation_px, {0.3, 5.0}, "px",
                 "an edge is split where it leaves the straight line between its ends by more");
    visit.number("max_gap_px", self.max_gap_px, {0.0, 50.0}, "px",
                 "pieces on one line are one segment when no more than this lies between them");
    visit.number("max_segments", self.max_segments, {1, 20000}, "", "of more the longest are kept");
  }
};

/// Straight edges of an image: edge pixels are linked to chains, these split where they bend, lines fitted by total least squares to where
/// the slope is steepest (between pixels), ends trimmed off, pieces on one line joined over small gaps (perception, section 4.1). The borders
/// of a narrow tape come out where they are: what their slopes do to each other is taken back.
/// Nothing is allocated after construction.
class SegmentFinder {
 public:
  /// \param max_width_px, max_height_px  of the largest image.
  SegmentFinder(const SegmentParameters& parameters, int max_width_px, int max_height_px);

  /// \param grey, width_px, height_px, stride, mask  as EdgeDetector::find() takes them.
  /// \return good until the next call, in no order that means anything.
  std::span<const Segment> find(const std::uint8_t* grey, int width_px, int height_px, std::ptrdiff_t stride,
                                const std::uint8_t* mask = nullptr);

  /// Of the last image.
  [[nodiscard]] std::span<const Segment> segments() const { return segments_; }

  /// The last image's edge pixels.
  [[nodiscard]] const EdgeDetector& edges() const { return edges_; }

 private:
  /// A straight stretch of a chain.
  struct Piece {
    LineMoments sums;  ///< of its points without the ends, from the image's corner.
    FittedLine line;
    Eigen::Vector2d first;
    Eigen::Vector2d last;
    double contrast_sum;
    double contrast_count;
    std::int32_t next;  ///< the piece that goes on behind `last`, or kNone.
    std::int32_t next_in_cell;
    bool continues;  ///< it goes on another one.

    [[nodiscard]] double length() const { return (last - first).norm(); }
  };
  static constexpr std::int32_t kNone = -1;
  static constexpr std::size_t kLongestChain = 4096;

  void link(std::uint32_t start);
  [[nodiscard]] std::uint32_t follow(std::uint32_t number, int sense) const;
  void sum_up_chain();
  void split_chain();
  [[nodiscard]] std::size_t farthest_from_chord(std::size_t first, std::size_t last) const;
  [[nodiscard]] LineMoments sums_of(std::size_t first, std::size_t last) const;
  [[nodiscard]] Eigen::Vector2d point(std::size_t i) const {
    return {static_cast<double>(x_[i]), static_cast<double>(y_[i])};
  }
  [[nodiscard]] bool is_straight(std::size_t first, std::size_t last) const;
  void add_piece(std::size_t first, std::size_t last);
  void join_pieces();
  [[nodiscard]] std::int32_t continuation_of(const Piece& piece, std::int32_t itself) const;
  [[nodiscard]] std::size_t cell_of(const Eigen::Vector2d& at) const;
  [[nodiscard]] double correction_for_neighbours(const Piece& piece) const;
  void add_segment(const Piece& piece);
  void keep_longest();

  SegmentParameters parameters_;
  EdgeDetector edges_;
  const std::uint8_t* grey_ = nullptr;
  std::ptrdiff_t stride_ = 0;
  std::array<std::ptrdiff_t, 8> around_{};  // map entries from one pixel to its neighbours, clockwise from the right

  std::vector<std::uint8_t> linked_;  // per edge pixel
  std::vector<std::uint32_t> chain_;  // edge pixels in order, the brighter side on the right hand
  std::vector<float> x_;              // their places
  std::vector<float> y_;
  std::vector<LineMoments> running_;  // of the chain, from its first point; one more than points
  std::vector<std::uint32_t> bends_;  // places in the chain between which it is straight
  std::vector<Piece> pieces_;
  int cells_x_;
  int cells_y_;
  std::vector<std::int32_t> cells_;  // first piece that begins there
  std::vector<Segment> segments_;
};

}  // namespace cgsr::imaging
