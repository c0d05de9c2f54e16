#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/global_localization/panorama.h"
#include "pipeline/global_localization/parameters.h"
#include "pipeline/global_localization/place_index.h"
#include "pipeline/localization/direction_field.h"
#include "pipeline/localization/expected.h"
#include "pipeline/localization/perceive.h"
#include "pipeline/localization/segment_table.h"
#include "platform/image_view.h"

namespace cgsr::global_localization {

/// The robot's motion at an image's exposure, as its base tells it.
struct Motion {
  geometry::Pose X_OR = geometry::Pose::Identity();
  double pitch_rad = 0.0;  ///< positive nose down, about an axle that high; X_OR contains it.
  double axle_height_m = 0.0;
};

/// An image of the turn.
struct Keyframe {
  ImageView image;  ///< of `pixels`.
  Motion motion;
  double turned_rad = 0.0;  ///< since the first image, to the left.
  float edges_px = 0.0F;    ///< how much of edges it shows, each by how much it tells.
  localization::SegmentTable edges{localization::Perception::kMostSegments};
  std::vector<std::uint8_t> pixels;
};

/// What a robot sees that turns on the spot once: an image every 30 degrees, and a last one that looks again where one of the first saw most. What those
/// two are apart says how far the odometry is off over the turn; its error is taken to be the same share of every part of it.
///
/// Allocates nothing after construction.
class Turn {
 public:
  /// \param camera  with its lens, in the size of whole images.  \param X_RC  the mount.
  /// \param max_drift_m  farther from where it began the turn begins anew.
  Turn(const geometry::Camera& camera, const geometry::Pose& X_RC, double max_drift_m);

  void restart();
  /// Whether the robot has turned three times, and no turn became whole: its base slips or drives away.
  [[nodiscard]] bool leads_nowhere() const { return turned_in_all_rad_ > kMostTurned; }

  /// Whether see() will look at the image that comes with this motion.
  [[nodiscard]] bool looks_at(const Motion& motion) const;

  /// \return whether the turn is whole: from then on nothing more is to be seen, and close() and gather() come next, each in an image of its own for its cost.
  bool see(const ImageView& image, const Motion& motion, const std::uint8_t* mask);

  /// Compares the last image with the one of the beginning that looks the same way, and corrects the headings.
  void close();

  /// All that was seen; azimuth 0 is the robot's heading in the first image. Once the turn is closed.
  void gather(Panorama& panorama) const;

  [[nodiscard]] std::span<const Keyframe> keyframes() const { return keyframes_; }
  /// The image of the beginning that the last one looks like.
  [[nodiscard]] std::size_t closing_view() const { return closed_; }
  /// The robot in the level frame below it at the first image, now and at an image of the turn: how it moved since and leans, with its heading as the
  /// closed turn has it.
  [[nodiscard]] geometry::Pose X_FR(const Keyframe& keyframe) const {
    return X_FR(keyframe.motion, keyframe.turned_rad);
  }
  /// Goes on to say where the robot is, once the turn is whole.
  void follow(const Motion& motion);
  /// How far the robot has turned since the first image, to the left; its odometry corrected as that of the turn was.
  [[nodiscard]] double turned_rad() const { return share_ * turned_rad_; }
  [[nodiscard]] geometry::Pose X_FR() const { return X_FR(now_, turned_rad()); }

 private:
  static constexpr double kMostTurned = 6.0 * std::numbers::pi;

  void begin_anew();
  [[nodiscard]] geometry::Pose X_FR(const Motion& motion, double turned_rad) const;
  [[nodiscard]] double next_turn() const;
  [[nodiscard]] bool has_reversed() const;
  [[nodiscard]] bool has_left(const Motion& motion) const;
  void take(const ImageView& image, const Motion& motion, const std::uint8_t* mask);
  [[nodiscard]] float likeness_turned(const Keyframe& first, double turn_rad);

  geometry::Pose X_RC_;
  double max_drift_m_;
  localization::Perception perception_;
  Sector sector_;
  localization::DirectionField field_;                ///< of the last image.
  std::vector<localization::ProjectedPiece> turned_;  ///< edges of another one in it.
  std::array<Keyframe, kKeyframes + 1> keyframes_;
  int taken_ = 0;
  std::size_t closed_ = 0;          ///< the image that the last one closes the turn with.
  double turned_rad_ = 0.0;         ///< as the odometry says.
  double turned_in_all_rad_ = 0.0;  ///< either way round, with turns that began anew.
  Motion now_;
  double share_ = 1.0;  ///< of what the odometry says it turned.
  geometry::Pose X_OR_before_ = geometry::Pose::Identity();
};

}  // namespace cgsr::global_localization
