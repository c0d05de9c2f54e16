#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/localization/expected.h"
#include "pipeline/localization/segment_table.h"

namespace cgsr::localization {

/// What makes an expected and a perceived edge one (4.1, Fig. 4.3), each with its own confidence.
struct MatchingRules {
  float radius_px = 24.0F;     ///< largest effective distance.
  float angle_rad = 0.21F;     ///< largest difference of direction.
  float overlap_px = 5.0F;     ///< shortest overlap ...
  float overlap_share = 0.3F;  ///< ... and its least share of the shorter of the two.
  float unknown_side =
      0.8F;  ///< confidence of the appearance where nothing is expected of it; where it contradicts the match is discarded.
};

/// An expected edge that found a perceived one, along their overlap.
struct Match {
  std::uint32_t projected = 0;  ///< index of the ProjectedPiece.
  std::uint32_t perceived = 0;  ///< index of the PerceivedEdge.
  float from_px = 0.0F;         ///< the overlap along the expected edge, from its middle.
  float to_px = 0.0F;
  float from_on_perceived_px = 0.0F;  ///< the same along the perceived edge, from its middle.
  float to_on_perceived_px = 0.0F;
  float d1_px =
      0.0F;  ///< from the perceived line to the expected edge at both ends of the overlap; positive along the line's normal.
  float d2_px = 0.0F;
  float confidence = 0.0F;
  float rival_px = kNoRival;  ///< to the nearest other line that one of the two could have been matched with instead.

  static constexpr float kNoRival = 1e6F;

  [[nodiscard]] float overlap_px() const { return to_px - from_px; }
  [[nodiscard]] float effective_distance_px() const;
};

/// Matches expected edges with perceived ones: the most confident pair first, each stretch of an edge at most once. An edge that was
/// perceived in several pieces is matched with each of them, a perceived one that runs along several expected ones likewise.
class Matcher {
 public:
  Matcher(std::size_t most_expected, std::size_t most_perceived);

  /// \return in no order that matters; valid until the next call. No allocation.
  std::span<const Match> match(std::span<const ProjectedPiece> expected, const SegmentTable& perceived,
                               const MatchingRules& rules);

 private:
  void find_candidates(std::uint32_t index, const ProjectedPiece& piece, const SegmentTable& perceived,
                       const MatchingRules& rules);
  void try_pair(std::uint32_t index, const ProjectedPiece& piece, std::uint32_t other, const PerceivedEdge& edge,
                const MatchingRules& rules);

  static constexpr std::size_t kPieces = 6;
  struct Taken {
    float from[kPieces];
    float to[kPieces];
    std::uint32_t count = 0;
  };
  /// A pair that was left out because a more confident one holds its edges says that this one may be the wrong one of two.
  void note_rival(const Match& left_out, std::span<const ProjectedPiece> expected, const SegmentTable& perceived);
  static float taken_of(const Taken& taken, float from, float to);
  static void take(Taken& taken, float from, float to);

  std::vector<Match> candidates_;
  std::vector<std::uint32_t> order_;
  std::vector<Match> matches_;
  std::vector<Taken> of_expected_;
  std::vector<Taken> of_perceived_;
  std::vector<float> line_of_expected_;
};

}  // namespace cgsr::localization
