#include "pipeline/global_localization/turn.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>

namespace cgsr::global_localization {
namespace {

using geometry::Pose;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kKeyframeTurn = 2.0 * std::numbers::pi / kKeyframes;
constexpr double kTurnTolerance = 0.5 * kDegree;  // of an image that comes just before it has turned so far
constexpr std::size_t kClosing = 3;               // images of the beginning, of which one closes the turn
constexpr int kClosingSteps = 12;                 // by these the odometry of one turn may be off: 36 degrees
constexpr double kClosingStep = 3.0 * kDegree;
constexpr int kFiner = 4;
constexpr float kShort_px = 5.0F;  // half of an edge that says too little for its cost
constexpr double kLeastDepth = 0.1;
constexpr float kSurelyTheSame = 0.5F;  // agreement of two images

double turn_between(const Pose& a, const Pose& b) {
  return std::remainder(geometry::heading_of(b) - geometry::heading_of(a), 2.0 * std::numbers::pi);
}

// How the base leans, about its axle.
Pose leaning(const Motion& motion) {
  const Eigen::Vector3d axle(0.0, 0.0, motion.axle_height_m);
  Pose tilt = Pose::Identity();
  tilt.linear() = Eigen::AngleAxisd(motion.pitch_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  tilt.translation() = axle - tilt.linear() * axle;
  return tilt;
}

// The odometry without it.
Pose level(const Motion& motion) {
  return motion.X_OR * leaning(motion).inverse();
}

}  // namespace

Turn::Turn(const geometry::Camera& camera, const Pose& X_RC, double max_drift_m)
    : X_RC_(X_RC),
      max_drift_m_(max_drift_m),
      perception_(camera),
      sector_(seen_by(perception_.camera(), X_RC, 0.5 * kKeyframeTurn)),
      field_(perception_.camera().width_px, perception_.camera().height_px) {
  constexpr std::size_t kBytes = 2;  // of a YUYV pixel
  const auto pixels = static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  for (Keyframe& keyframe : keyframes_) {
    keyframe.pixels.reserve(pixels * kBytes);
  }
  turned_.reserve(localization::Perception::kMostSegments);
}

void Turn::restart() {
  begin_anew();
  turned_in_all_rad_ = 0.0;
}

void Turn::begin_anew() {
  taken_ = 0;
  turned_rad_ = 0.0;
  share_ = 1.0;
}

bool Turn::looks_at(const Motion& motion) const {
  if (taken_ == 0 || has_left(motion)) return true;
  return std::abs(turned_rad_ + turn_between(X_OR_before_, motion.X_OR)) >= next_turn();
}

// How far it has turned when the next image is taken. The last one looks again where one of the first saw most.
double Turn::next_turn() const {
  const int cells = taken_ < kKeyframes ? taken_ : kKeyframes + static_cast<int>(closed_);
  return cells * kKeyframeTurn - kTurnTolerance;
}

bool Turn::has_left(const Motion& motion) const {
  const Pose& X_OR_first = keyframes_.front().motion.X_OR;
  return (motion.X_OR.translation() - X_OR_first.translation()).norm() > max_drift_m_;
}

// It turned back beyond where it began: what was seen there would be seen twice, and the rest never.
bool Turn::has_reversed() const {
  return taken_ > 1 && turned_rad_ * keyframes_[1].turned_rad < 0.0 && std::abs(turned_rad_) > 0.5 * kKeyframeTurn;
}

bool Turn::see(const ImageView& image, const Motion& motion, const std::uint8_t* mask) {
  if (!motion.X_OR.matrix().allFinite() || !std::isfinite(motion.pitch_rad)) return false;
  if (taken_ > 0) {
    const double step_rad = turn_between(X_OR_before_, motion.X_OR);
    turned_rad_ += step_rad;
    turned_in_all_rad_ += std::abs(step_rad);
    if (has_left(motion) || has_reversed()) begin_anew();
  }
  X_OR_before_ = motion.X_OR;
  if (std::abs(turned_rad_) < next_turn()) return false;
  take(image, motion, mask);
  return taken_ > kKeyframes;
}

void Turn::take(const ImageView& image, const Motion& motion, const std::uint8_t* mask) {
  Keyframe& keyframe = keyframes_[static_cast<std::size_t>(taken_)];
  ++taken_;
  const auto bytes = static_cast<std::size_t>(image.width_px) * (image.format == PixelFormat::kYuyv ? 2U : 1U);
  keyframe.pixels.resize(bytes * static_cast<std::size_t>(image.height_px));
  for (int y = 0; y < image.height_px; ++y)
    std::memcpy(keyframe.pixels.data() + bytes * static_cast<std::size_t>(y), image.row(y), bytes);
  keyframe.image = image;
  keyframe.image.data = keyframe.pixels.data();
  keyframe.image.stride_bytes = static_cast<std::ptrdiff_t>(bytes);
  keyframe.motion = motion;
  keyframe.turned_rad = turned_rad_;
  keyframe.edges.clear();
  keyframe.edges_px = 0.0F;
  if (taken_ == 1) closed_ = 0;
  if (perception_.perceive(image, mask) != localization::Reason::kNone) return;
  keyframe.edges = perception_.edges();  // of one capacity: allocates nothing
  keyframe.edges_px = perception_.edges().weighted_length();
  const auto index = static_cast<std::size_t>(taken_) - 1;
  if (index < kClosing && keyframe.edges_px > keyframes_[closed_].edges_px) closed_ = index;
}

// How alike two images are if the camera had turned by so much between them, about its own centre: 0..1.
float Turn::likeness_turned(const Keyframe& first, double turn_rad) {
  const geometry::Camera& camera = perception_.camera();
  const Eigen::Matrix3d R = X_RC_.linear().transpose() *
                            Eigen::AngleAxisd(-turn_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() * X_RC_.linear();
  const auto there = [&](const Eigen::Vector2f& pixel) -> std::optional<Eigen::Vector2f> {
    const Eigen::Vector3d ray =
        R * Eigen::Vector3d((static_cast<double>(pixel.x()) - camera.cx_px) / camera.fx_px,
                            (static_cast<double>(pixel.y()) - camera.cy_px) / camera.fy_px, 1.0);
    if (ray.z() < kLeastDepth) return std::nullopt;
    return Eigen::Vector2d(camera.fx_px * ray.x() / ray.z() + camera.cx_px,
                           camera.fy_px * ray.y() / ray.z() + camera.cy_px)
        .cast<float>();
  };
  const Eigen::AlignedBox2f image(Eigen::Vector2f::Zero(), Eigen::Vector2f(static_cast<float>(camera.width_px - 1),
                                                                           static_cast<float>(camera.height_px - 1)));
  turned_.clear();
  for (const localization::PerceivedEdge& edge : first.edges.edges()) {
    if (edge.half_length < kShort_px) continue;
    const auto from = there(edge.middle - edge.half_length * edge.direction);
    const auto to = there(edge.middle + edge.half_length * edge.direction);
    if (!from || !to) continue;
    localization::ProjectedPiece piece;
    piece.middle = 0.5F * (*from + *to);
    if (!image.contains(piece.middle)) continue;
    piece.half_length = 0.5F * (*to - *from).norm();
    piece.direction = (*to - *from) / std::max(2.0F * piece.half_length, 1e-3F);
    piece.bright_side = 1;
    piece.weight = edge.information_weight;
    turned_.push_back(piece);
  }
  return field_.score(turned_);
}

// The last image looks where one of the first did: the turn at which they agree says how far the odometry is off, which is the same share of every part
// of it.
void Turn::close() {
  const Keyframe& first = keyframes_[closed_];
  const Keyframe& last = keyframes_.back();
  field_.build(perception_.edges());  // of the last image, which was taken just now
  double best_rad = 0.0;
  float best = -1.0F;
  const auto look_about = [&](double middle_rad, int steps, double step_rad) {
    for (int i = -steps; i <= steps; ++i) {
      const double turn_rad = middle_rad + i * step_rad;
      const float likeness = likeness_turned(first, turn_rad);
      if (likeness > best) best = likeness, best_rad = turn_rad;
    }
  };
  look_about(0.0, kClosingSteps, kClosingStep);
  look_about(best_rad, kFiner, kClosingStep / kFiner);
  double share = 1.0;
  if (best >= kSurelyTheSame) {
    const double told_rad = last.turned_rad - first.turned_rad;
    share = 1.0 - std::remainder(told_rad - best_rad, 2.0 * std::numbers::pi) / told_rad;
  }
  share_ = share;
  for (Keyframe& keyframe : keyframes_) keyframe.turned_rad *= share;
}

void Turn::gather(Panorama& panorama) const {
  const geometry::Camera& camera = perception_.camera();
  panorama.clear();
  for (const Keyframe& keyframe : std::span(keyframes_).first<kKeyframes>()) {
    Sector sector = sector_;
    sector.middle += keyframe.turned_rad;
    const Eigen::Matrix3d R = (Eigen::AngleAxisd(keyframe.turned_rad, Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(keyframe.motion.pitch_rad, Eigen::Vector3d::UnitY()))
                                  .toRotationMatrix() *
                              X_RC_.linear();
    const auto ray = [&](const Eigen::Vector2f& pixel) -> Eigen::Vector3d {
      return R * Eigen::Vector3d((static_cast<double>(pixel.x()) - camera.cx_px) / camera.fx_px,
                                 (static_cast<double>(pixel.y()) - camera.cy_px) / camera.fy_px, 1.0);
    };
    for (const localization::PerceivedEdge& edge : keyframe.edges.edges()) {
      const Eigen::Vector2f half = edge.half_length * edge.direction;
      panorama.add(ray(edge.middle - half), ray(edge.middle + half), static_cast<double>(edge.information_weight),
                   sector);
    }
  }
  panorama.finish();
}

Pose Turn::X_FR(const Motion& motion, double turned_rad) const {
  const Motion& first = keyframes_.front().motion;
  const Pose X_FO = level(first).inverse();
  Pose X_FR = X_FO * level(motion);
  X_FR.linear() = Eigen::AngleAxisd(turned_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return X_FR * leaning(motion);
}

void Turn::follow(const Motion& motion) {
  if (!motion.X_OR.matrix().allFinite() || !std::isfinite(motion.pitch_rad)) return;
  turned_rad_ += turn_between(X_OR_before_, motion.X_OR);
  X_OR_before_ = motion.X_OR;
  now_ = motion;
}

}  // namespace cgsr::global_localization
