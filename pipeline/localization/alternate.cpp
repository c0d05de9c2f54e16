#include "pipeline/localization/alternate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

#include "pipeline/localization/work.h"

namespace cgsr::localization {
namespace {

constexpr float kShrink = 0.6F;            // of the matching radius with each round
constexpr float kWholeOverlap_px = 20.0F;  // a shorter overlap weighs less
constexpr float kLeastShare = 0.3F;
constexpr float kNear_px = 2.0F;  // a match this far off explains half of its length
constexpr float kWorstShare = 0.15F;
constexpr std::size_t kMetricPieces = 48;
constexpr double kUnseenDepth_m = 3.0;
constexpr double kLeastDepth_m = 0.1;
constexpr double kLeastNoise = 0.3;  // of the stated noise

// Where edges meet, their slopes mix: a perceived one stops this far from its corner, give or take. Farther off it was broken, or another
// one goes on where it ends.
constexpr float kShortOfCorner_px = 1.5F;
constexpr double kCornerSigma_px = 3.0;
constexpr float kCornerReach_px = 6.0F;
constexpr int kMostCorners = 64;  // of the most confident matches: more of them hardly hold it better

constexpr double kCloseBy = 0.2;    // of a map's size: no further off it is the camera's surroundings
constexpr float kBeside_px = 2.0F;  // of a line, what lies on either side of it

// How much of a match's length counts as explained, 0..1.
float nearness(const Match& match) {
  const float scaled = match.effective_distance_px() / kNear_px;
  return 1.0F / (1.0F + scaled * scaled);
}

}  // namespace

Belief::Belief(const Prior& given) : prior(given), information(geometry::Matrix6d::Zero()) {
  if (!given.X_WC.matrix().allFinite() || !given.covariance.allFinite()) return;
  const Eigen::LLT<geometry::Matrix6d> factor(given.covariance);
  if (factor.info() != Eigen::Success) return;
  information = factor.solve(geometry::Matrix6d::Identity());
  valid = information.allFinite();
}

Alternation::Alternation(const world::Map& map, const LocalizerParameters& parameters, render::Expectation& expectation,
                         const geometry::Camera& camera, std::size_t most_perceived)
    : parameters_(parameters),
      expectation_(&expectation),
      camera_(camera),
      view_(map, static_cast<std::size_t>(parameters.max_pieces)),
      matcher_(static_cast<std::size_t>(parameters.max_pieces), most_perceived),
      by_part_(camera.width_px, camera.height_px) {
  visible_.reserve(static_cast<std::size_t>(parameters.max_pieces));
  lines_.reserve(static_cast<std::size_t>(parameters.max_pieces) * 4);
  for (const Eigen::Vector3f& vertex : map.vertices) bounds_.extend(vertex.cast<double>());
  // A low field is stood on, not in.
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kCloseBy * bounds_.diagonal().norm());
  bounds_.min() -= margin;
  bounds_.max() += margin;
}

void Alternation::look(const geometry::Pose& X_WC) {
  expectation_->look(X_WC, camera_, visible_);
  view_.take(visible_, X_WC);
  X_WC_looked_ = X_WC;
  ++looks_;
}

bool Alternation::is_far(const geometry::Pose& X_WC, const geometry::Matrix6d& metric) const {
  if (!X_WC_looked_) return true;
  const geometry::Vector6d since = geometry::step_between(*X_WC_looked_, X_WC);
  return std::sqrt(since.dot(metric * since)) > parameters_.max_view_shift_px;
}

bool Alternation::must_look(const geometry::Pose& X_WC) {
  if (parameters_.method != Method::kGlCorrect) return true;
  view_.project(X_WC, camera_);
  return is_far(X_WC, motion_metric(X_WC));
}

bool Alternation::look_if_far(const geometry::Pose& X_WC, WorkBudget& budget) {
  if (!must_look(X_WC)) return true;
  if (!granted(budget, kLookUnits)) return false;
  look(X_WC);
  view_.project(X_WC, camera_);
  return true;
}

geometry::Matrix6d Alternation::motion_metric(const geometry::Pose& X_WC) const {
  geometry::Matrix6d M = geometry::Matrix6d::Zero();
  double weight = 0.0;
  const auto add = [&](const Eigen::Vector3d& p_W, double w) {
    for (const Eigen::Vector2d& normal : {Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.0, 1.0)}) {
      double distance = 0.0;
      Eigen::Matrix<double, 1, 6> J;
      if (!distance_of({.p_W = p_W, .normal = normal}, X_WC, camera_, distance, J)) continue;
      M.noalias() += w * J.transpose() * J;
    }
    weight += w;
  };
  const auto pieces = view_.projected();
  const std::size_t stride = std::max<std::size_t>(1, pieces.size() / kMetricPieces);
  for (std::size_t i = 0; i < pieces.size(); i += stride) {
    const ProjectedPiece& piece = pieces[i];
    if (std::min(piece.depth0_m, piece.depth1_m) < kLeastDepth_m) continue;
    add(view_.point_at(piece, -0.5F * piece.half_length), piece.half_length);
    add(view_.point_at(piece, 0.5F * piece.half_length), piece.half_length);
  }
  if (!(weight > 0.0)) {
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 3; ++x) {
        const Eigen::Vector3d p_C((camera_.width_px * (x + 0.5) / 3.0 - camera_.cx_px) / camera_.fx_px,
                                  (camera_.height_px * (y + 0.5) / 3.0 - camera_.cy_px) / camera_.fy_px, 1.0);
        add(X_WC * (kUnseenDepth_m * p_C), 1.0);
      }
    }
  }
  return M / weight;
}

void Alternation::gather(std::span<const Match> matches, const SegmentTable& perceived) {
  lines_.clear();
  corners_ = 0;
  const bool paper = parameters_.method == Method::kPaper;
  const double system = parameters_.system_sigma_px * parameters_.system_sigma_px;
  for (const Match& match : matches) {
    if (lines_.size() + 4 > lines_.capacity()) break;
    const PerceivedEdge& edge = perceived.edges()[match.perceived];
    const ProjectedPiece& piece = view_.projected()[match.projected];
    LineDistance line;
    line.normal = edge.normal().cast<double>();
    line.offset_px = line.normal.dot(edge.middle.cast<double>());
    if (!paper) {
      // A weak edge is rather a shadow's or a pattern's than the map's, and lies beside it without being far off.
      line.weight = static_cast<double>(edge.weight) *
                    static_cast<double>(std::clamp(match.overlap_px() / kWholeOverlap_px, kLeastShare, 1.0F));
      // The map's error is the same for each image and another for each thing in it: from near, it is what is seen.
      const double depth_m = std::max(kLeastDepth_m, 0.5 * static_cast<double>(piece.depth0_m + piece.depth1_m));
      const double map_px = camera_.fx_px * parameters_.map_sigma_m / depth_m;
      // Of two lines that lie close beside each other the match may have taken the wrong one.
      const double rival_px =
          match.rival_px < Match::kNoRival ? parameters_.rival_share * static_cast<double>(match.rival_px) : 0.0;
      line.sigma_px = std::sqrt(system + rival_px * rival_px + map_px * map_px +
                                static_cast<double>(edge.sigma_px) * edge.sigma_px);
    }
    line.p_W = view_.point_at(piece, match.from_px);
    lines_.push_back(line);
    line.p_W = view_.point_at(piece, match.to_px);
    lines_.push_back(line);
    if (parameters_.method == Method::kGlCorrect) gather_ends(piece, edge, line);
  }
}

// A line's distances leave its own direction open. Where a perceived edge ends at the expected one's corner, that holds it too, if not as
// well: of views that show edges of next to one direction it is all there is.
void Alternation::gather_ends(const ProjectedPiece& piece, const PerceivedEdge& edge, LineDistance end) {
  end.end = true;
  end.sigma_px = std::hypot(end.sigma_px, kCornerSigma_px);
  const float along = piece.direction.dot(edge.direction) > 0.0F ? 1.0F : -1.0F;
  for (const float side : {-1.0F, 1.0F}) {
    if (side < 0.0F ? !view_.ends_at_first(piece) : !view_.ends_at_last(piece)) continue;
    const Eigen::Vector2f outward = side * along * edge.direction;
    const Eigen::Vector2f seen = edge.middle + (edge.half_length + kShortOfCorner_px) * outward;
    const Eigen::Vector2f expected = piece.middle + side * piece.half_length * piece.direction;
    if (std::abs((seen - expected).dot(outward)) > kCornerReach_px || corners_ == kMostCorners) continue;
    ++corners_;
    end.p_W = view_.point_at(piece, side * piece.half_length);
    end.normal = outward.cast<double>();
    end.offset_px = end.normal.dot(seen.cast<double>());
    lines_.push_back(end);
  }
}

// It lies on the map as that was looked at last, or borders on it.
bool Alternation::on_map(const PerceivedEdge& edge) const {
  const Eigen::Vector2f aside = kBeside_px * edge.normal();
  return expectation_->covers(edge.middle + aside) || expectation_->covers(edge.middle - aside);
}

// Of all that was perceived, each by how much it tells; from outside of the map what lies on it.
float Alternation::length_on_map(const SegmentTable& perceived, const geometry::Pose& X_WC) const {
  if (bounds_.contains(X_WC.translation())) return perceived.weighted_length();
  float length = 0.0F;
  for (const PerceivedEdge& edge : perceived.edges()) {
    if (on_map(edge)) length += 2.0F * edge.half_length * edge.information_weight;
  }
  return length;
}

void Alternation::judge(std::span<const Match> matches, const SegmentTable& perceived, const geometry::Pose& X_WC,
                        Estimate& estimate) const {
  float expected = 0.0F;
  for (const ProjectedPiece& piece : view_.projected()) expected += 2.0F * piece.half_length * piece.weight;
  float found = 0.0F;
  float foreseen = 0.0F;
  float foretold = 0.0F;
  for (const Match& match : matches) {
    const float length = nearness(match) * match.overlap_px();
    found += length * view_.projected()[match.projected].weight;
    const PerceivedEdge& edge = perceived.edges()[match.perceived];
    foreseen += length * edge.weight;
    foretold += length * edge.information_weight;
  }
  const float both = expected + perceived.whole_length();
  estimate.explained = expected > 0.0F ? std::min(1.0F, found / expected) : 0.0F;
  estimate.agreement = both > 0.0F ? std::min(1.0F, (found + foreseen) / both) : 0.0F;
  const float on_map = expected + length_on_map(perceived, X_WC);
  estimate.agreement_on_map = on_map > 0.0F ? std::min(1.0F, (found + foretold) / on_map) : 0.0F;
}

void Alternation::judge_by_part(std::span<const Match> matches, const SegmentTable& perceived,
                                const geometry::Pose& X_WC, Estimate& estimate) {
  by_part_.clear();
  for (const ProjectedPiece& piece : view_.projected()) {
    const Eigen::Vector2f half = piece.half_length * piece.direction;
    by_part_.add(piece.middle - half, piece.middle + half, piece.weight);
  }
  const bool surrounded = bounds_.contains(X_WC.translation());
  for (const PerceivedEdge& edge : perceived.edges()) {
    if (!surrounded && !on_map(edge)) continue;
    const Eigen::Vector2f half = edge.half_length * edge.direction;
    by_part_.add(edge.middle - half, edge.middle + half, edge.information_weight);
  }
  for (const Match& match : matches) {
    const ProjectedPiece& piece = view_.projected()[match.projected];
    const float weight = nearness(match) * (piece.weight + perceived.edges()[match.perceived].information_weight);
    by_part_.agree(piece.middle + match.from_px * piece.direction, piece.middle + match.to_px * piece.direction,
                   weight);
  }
  estimate.agreement_in_the_worst = by_part_.in_the_worst(kWorstShare);
}

MatchingRules Alternation::rules_within(float radius_px) const {
  MatchingRules rules;
  rules.radius_px = radius_px;
  rules.angle_rad = static_cast<float>(parameters_.max_match_angle_deg * std::numbers::pi / 180.0);
  return rules;
}

std::span<const LineDistance> Alternation::distances_from(const geometry::Pose& X_WC, const SegmentTable& perceived,
                                                          float radius_px) {
  look(X_WC);
  view_.project(X_WC, camera_);
  ++rounds_;
  gather(matcher_.match(view_.projected(), perceived, rules_within(radius_px)), perceived);
  return lines_;
}

void Alternation::take_measured_noise(const geometry::Pose& start, const Belief& belief, const SolverOptions& solver,
                                      Solution& solution) {
  const double noise = std::clamp(solution.rms_px / parameters_.system_sigma_px, kLeastNoise, 1.0);
  const auto scale = [this](double factor) {
    for (LineDistance& line : lines_) {
      if (!line.end) line.sigma_px *= factor;
    }
  };
  scale(noise);
  const Solution measured = solve(lines_, start, belief.prior, belief.information, camera_, solver);
  scale(1.0 / noise);
  if (!measured.solved) return;
  solution.X_WC = measured.X_WC;
  solution.cost = cost_of(lines_, solution.X_WC, belief.prior, belief.information, camera_, solver.robust).sum;
}

Estimate Alternation::refine(const geometry::Pose& start, const Belief& belief, const SegmentTable& perceived,
                             const AlternateOptions& options, WorkBudget& budget) {
  Estimate estimate;
  estimate.solution.X_WC = start;
  const auto near = static_cast<float>(parameters_.min_match_radius_px);
  const float least = options.settle ? std::min(near, static_cast<float>(parameters_.settle_radius_px)) : near;
  MatchingRules rules = rules_within(std::max(options.radius_px, least));
  SolverOptions solver;
  solver.paper = parameters_.method == Method::kPaper;
  solver.steps = 2;
  solver.robust = options.robust;
  geometry::Pose X_WC = start;
  bool look_now = options.look_first;
  geometry::Matrix6d metric = geometry::Matrix6d::Zero();
  for (int round = 0; round < options.rounds_done; ++round)
    rules.radius_px = std::max(least, rules.radius_px * kShrink);
  for (int round = options.rounds_done; round < options.rounds; ++round) {
    if (!granted(budget, kRoundUnits + (look_now ? kLookUnits : 0))) {
      estimate.cut_off = true;
      break;
    }
    if (look_now) look(X_WC);
    view_.project(X_WC, camera_);
    if (round == options.rounds_done) metric = motion_metric(X_WC);
    if (options.settle && rules.radius_px <= near) solver.robust = kFollowedRobust;
    const auto matches = matcher_.match(view_.projected(), perceived, rules);
    gather(matches, perceived);
    Solution solution = solve(lines_, X_WC, belief.prior, belief.information, camera_, solver);
    if (options.measured_noise && solution.solved) take_measured_noise(X_WC, belief, solver, solution);
    ++estimate.rounds;
    ++rounds_;
    estimate.expected = static_cast<int>(view_.projected().size());
    estimate.matches = static_cast<int>(matches.size());
    judge(matches, perceived, X_WC, estimate);
    if (options.by_part) judge_by_part(matches, perceived, X_WC, estimate);
    if (!solution.solved) break;
    estimate.solved = true;
    estimate.solution = solution;
    const geometry::Vector6d step = geometry::step_between(X_WC, solution.X_WC);
    const double moved = std::sqrt(step.dot(metric * step));
    X_WC = solution.X_WC;
    if (moved < parameters_.min_step_px && rules.radius_px <= least) break;
    look_now = options.look_again && is_far(X_WC, metric);
    rules.radius_px = std::max(least, rules.radius_px * kShrink);
  }
  const geometry::Vector6d off = geometry::step_between(belief.prior.X_WC, estimate.solution.X_WC);
  estimate.prior_chi2 = static_cast<float>(off.dot(belief.information * off));
  return estimate;
}

}  // namespace cgsr::localization
