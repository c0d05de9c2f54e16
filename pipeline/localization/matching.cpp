#include "pipeline/localization/matching.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cgsr::localization {
namespace {

constexpr float kMostTaken = 0.3F;          // share of an overlap that a more confident match may hold already
constexpr float kSameLine_px = 3.0F;        // pieces of one broken edge lie along one line
constexpr std::size_t kCandidatesEach = 6;  // per expected edge, on average
constexpr float kRivalOverlap = 0.3F;       // of a match, along which a rival lies
constexpr float kLeastRival_px = 0.4F;      // nearer it is the same line

// From the perceived line to the expected edge, positive along the line's normal.
float from_line(const Match& match) {
  return 0.5F * (match.d1_px + match.d2_px);
}

// The same, positive along the expected edge's own normal.
float line_of(const Match& match, std::span<const ProjectedPiece> expected, const SegmentTable& perceived) {
  const bool along = expected[match.projected].direction.dot(perceived.edges()[match.perceived].direction) > 0.0F;
  return along ? from_line(match) : -from_line(match);
}

}  // namespace

float Match::effective_distance_px() const {
  return 0.5F * (std::abs(d1_px) + std::abs(d2_px));
}

Matcher::Matcher(std::size_t most_expected, std::size_t most_perceived) {
  candidates_.reserve(most_expected * kCandidatesEach);
  order_.reserve(most_expected * kCandidatesEach);
  matches_.reserve(most_expected * 2);
  of_expected_.reserve(most_expected);
  of_perceived_.reserve(most_perceived);
  line_of_expected_.reserve(most_expected);
}

float Matcher::taken_of(const Taken& taken, float from, float to) {
  float sum = 0.0F;
  for (std::uint32_t i = 0; i < taken.count; ++i)
    sum += std::max(0.0F, std::min(to, taken.to[i]) - std::max(from, taken.from[i]));
  return sum;
}

void Matcher::take(Taken& taken, float from, float to) {
  if (taken.count == kPieces) return;
  taken.from[taken.count] = from;
  taken.to[taken.count] = to;
  ++taken.count;
}

void Matcher::try_pair(std::uint32_t index, const ProjectedPiece& piece, std::uint32_t other, const PerceivedEdge& edge,
                       const MatchingRules& rules) {
  const Eigen::Vector2f& d = piece.direction;
  const Eigen::Vector2f normal = edge.normal();
  const float cosine = d.dot(edge.direction);
  const float sine = d.dot(normal);
  if (std::abs(sine) > rules.angle_rad) return;  // asin(x) >= x: the bins have kept the rest out
  // The overlap is measured along the expected edge.
  const Eigen::Vector2f offset = edge.middle - piece.middle;
  const float along = offset.dot(d);
  const float reach = edge.half_length * std::abs(cosine);
  const float from = std::max(-piece.half_length, along - reach);
  const float to = std::min(piece.half_length, along + reach);
  const float overlap = to - from;
  const float shorter = 2.0F * std::min(piece.half_length, edge.half_length);
  if (overlap < std::max(std::min(rules.overlap_px, 0.9F * shorter), rules.overlap_share * shorter)) return;
  const float at_middle = -offset.dot(normal);
  const float d1 = at_middle + from * sine;
  const float d2 = at_middle + to * sine;
  const float distance = 0.5F * (std::abs(d1) + std::abs(d2));
  if (distance > rules.radius_px) return;

  const float scaled_distance = distance / (0.5F * rules.radius_px);
  const float scaled_angle = sine / (0.5F * rules.angle_rad);
  // 1 / (1 + x^2/2)-like confidences: cheap, and monotone as the exponentials that they stand for.
  const float confidence = overlap / (overlap + 10.0F) / (1.0F + scaled_distance * scaled_distance) /
                           (1.0F + 0.5F * scaled_angle * scaled_angle) *
                           (piece.bright_side == 0 ? rules.unknown_side : 1.0F);
  if (candidates_.size() == candidates_.capacity()) return;
  const float turn = cosine > 0.0F ? 1.0F : -1.0F;
  const float a = turn * (from - along) / std::max(0.1F, std::abs(cosine));
  const float b = turn * (to - along) / std::max(0.1F, std::abs(cosine));
  candidates_.push_back({.projected = index,
                         .perceived = other,
                         .from_px = from,
                         .to_px = to,
                         .from_on_perceived_px = std::min(a, b),
                         .to_on_perceived_px = std::max(a, b),
                         .d1_px = d1,
                         .d2_px = d2,
                         .confidence = confidence});
}

void Matcher::find_candidates(std::uint32_t index, const ProjectedPiece& piece, const SegmentTable& perceived,
                              const MatchingRules& rules) {
  constexpr int kBins = SegmentTable::kBins;
  constexpr float kBinWidth = 2.0F * std::numbers::pi_v<float> / kBins;
  const int reach = static_cast<int>(std::ceil(rules.angle_rad / kBinWidth));
  const int middle = SegmentTable::bin_of(piece.direction);
  const float dx = piece.direction.x();
  const float dy = piece.direction.y();
  const float max_across = rules.radius_px;
  for (int side = -1; side <= 1; side += 2) {
    if (piece.bright_side == -side) continue;
    const int first = middle - reach + (side < 0 ? kBins / 2 : 0) + kBins;
    for (int bin = first; bin <= first + 2 * reach;) {
      // Bins that follow each other are one run, up to the end of the turn.
      const int begin = bin % kBins;
      const int end = std::min(begin + (first + 2 * reach - bin) + 1, kBins);
      const std::size_t i0 = perceived.first_of(begin);
      const std::size_t i1 = perceived.first_of(end);
      const float* x = perceived.x();
      const float* y = perceived.y();
      const float* half = perceived.half_length();
      for (std::size_t i = i0; i < i1; ++i) {
        const float ex = x[i] - piece.middle.x();
        const float ey = y[i] - piece.middle.y();
        const float along = std::abs(ex * dx + ey * dy);
        const float across = std::abs(ey * dx - ex * dy);
        // A perceived edge's middle may lie beyond the overlap, where the two lines are further apart.
        if (across > max_across + rules.angle_rad * (half[i] + along) || along > piece.half_length + half[i]) continue;
        try_pair(index, piece, static_cast<std::uint32_t>(i), perceived.edges()[i], rules);
      }
      bin += end - begin;
    }
  }
}

void Matcher::note_rival(const Match& left_out, std::span<const ProjectedPiece> expected,
                         const SegmentTable& perceived) {
  for (Match& match : matches_) {
    const bool one_expected = match.projected == left_out.projected;
    if (one_expected == (match.perceived == left_out.perceived)) continue;  // neither edge, or the pair itself
    const float common = one_expected
                             ? std::min(match.to_px, left_out.to_px) - std::max(match.from_px, left_out.from_px)
                             : std::min(match.to_on_perceived_px, left_out.to_on_perceived_px) -
                                   std::max(match.from_on_perceived_px, left_out.from_on_perceived_px);
    if (common < kRivalOverlap * match.overlap_px()) continue;
    // Each along the normal of the edge that the two pairs share.
    const float gap = one_expected ? line_of(left_out, expected, perceived) - line_of(match, expected, perceived)
                                   : from_line(left_out) - from_line(match);
    if (std::abs(gap) > kLeastRival_px) match.rival_px = std::min(match.rival_px, std::abs(gap));
  }
}

std::span<const Match> Matcher::match(std::span<const ProjectedPiece> expected, const SegmentTable& perceived,
                                      const MatchingRules& rules) {
  candidates_.clear();
  matches_.clear();
  const std::size_t count = std::min(expected.size(), of_expected_.capacity());
  for (std::size_t i = 0; i < count; ++i) find_candidates(static_cast<std::uint32_t>(i), expected[i], perceived, rules);

  of_expected_.resize(count);
  for (Taken& taken : of_expected_) taken.count = 0;
  of_perceived_.resize(std::min(perceived.size(), of_perceived_.capacity()));
  for (Taken& taken : of_perceived_) taken.count = 0;
  line_of_expected_.resize(count);
  order_.resize(candidates_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::uint32_t>(i);
  std::sort(order_.begin(), order_.end(), [this](std::uint32_t a, std::uint32_t b) {
    const float ca = candidates_[a].confidence;
    const float cb = candidates_[b].confidence;
    return ca != cb ? ca > cb : a < b;
  });
  for (const std::uint32_t index : order_) {
    const Match& match = candidates_[index];
    if (match.perceived >= of_perceived_.size() || matches_.size() == matches_.capacity()) continue;
    Taken& mine = of_expected_[match.projected];
    Taken& its = of_perceived_[match.perceived];
    if (mine.count == kPieces || its.count == kPieces) continue;
    const float line = line_of(match, expected, perceived);
    const float overlap = match.overlap_px();
    if ((mine.count > 0 && std::abs(line - line_of_expected_[match.projected]) > kSameLine_px) ||
        taken_of(mine, match.from_px, match.to_px) > kMostTaken * overlap ||
        taken_of(its, match.from_on_perceived_px, match.to_on_perceived_px) > kMostTaken * overlap) {
      note_rival(match, expected, perceived);
      continue;
    }
    if (mine.count == 0) line_of_expected_[match.projected] = line;
    take(mine, match.from_px, match.to_px);
    take(its, match.from_on_perceived_px, match.to_on_perceived_px);
    matches_.push_back(match);
  }
  return matches_;
}

}  // namespace cgsr::localization
