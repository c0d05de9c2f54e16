#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

#include "pipeline/geometry/pose.h"
#include "pipeline/illumination/active_check.h"
#include "pipeline/illumination/lamp.h"
#include "pipeline/illumination/lamp_filter.h"
#include "pipeline/illumination/probe_observation.h"
#include "pipeline/stages/events.h"
#include "pipeline/stages/localize_stage.h"
#include "pipeline/stages/requests.h"
#include "platform/description.h"
#include "platform/image_view.h"

namespace cgsr::stages {

/// The lamps that many images agree on.
struct KnownLamps {
  std::array<illumination::KnownLamp, illumination::LampFilter::kMostLamps> lamp;
  int count = 0;

  void add(const illumination::KnownLamp& known) { lamp[static_cast<std::size_t>(count++)] = known; }
};

/// What one image said about lamps, and what all images together say.
struct LampReport {
  bool has_board = false;  ///< else nothing below means anything.
  illumination::ObservationStatus observation = illumination::ObservationStatus::kNoImage;
  bool cone_missing = false;  ///< a probe of the board was not found: nothing here is trusted in this image.
  illumination::LampEstimates single_image;  ///< the lamps of this image alone, robot frame; none: why.
  bool pose_known = false;                   ///< the robot's pose was known: this image counts in what follows.
  illumination::LampChange change;
  bool known = false;                      ///< there is a lamp that many images agree on.
  illumination::KnownLamp lamp;            ///< the best known one, world frame; read only when known.
  KnownLamps lamps;                        ///< every one that is known so, the best known first.
  illumination::CheckReport probes_check;  ///< the probe lamp switched: what that says of board and probes.
  illumination::CheckReport lamp_proof;    ///< the room lamp switched: what that says of the shadows.
  bool requests_probe_lamp = false;        ///< the level that a check requires of the probe lamp's line,
  bool requests_room_lamp = false;         ///< and of the room lamp's.
  Events events{};                         ///< the lamp found or lost, the probes in view or not, checks that ended.

  /// A lamp is being switched: what is said of shadows is the last image's before that.
  [[nodiscard]] bool switching() const {
    return probes_check.state == illumination::CheckState::kRunning ||
           lamp_proof.state == illumination::CheckState::kRunning;
  }
  /// No check speaks against what the probes say.
  [[nodiscard]] bool trusted() const;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    const auto& p = self.lamp.p_WL;
    const bool known = self.has_board && self.known;
    visit.text("probes", when(self.has_board, self.outcome()), "what the probes showed, or why not");
    visit.number("lamp_x_m", when(known, p.x()), {4}, "m", "place of the lamp in the world");
    visit.number("lamp_y_m", when(known, p.y()), {4}, "m", "likewise");
    visit.number("lamp_z_m", when(known, p.z()), {4}, "m", "its height above the floor");
    visit.number("lamp_sigma_m", when(known, std::sqrt(self.lamp.covariance.trace())), {4}, "m",
                 "standard deviation of its place");
  }

 private:
  /// \return "seen", or why this image says nothing of a lamp.
  [[nodiscard]] std::string_view outcome() const;
};

/// \return why this image says nothing of a lamp; empty when it says something.
std::string_view reason_of(const LampReport& report);

/// The robot in the world and how sure that is.
struct PlacedRobot {
  geometry::Pose X_WR = geometry::Pose::Identity();
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();  ///< of geometry::moved(X_WR, step).
};

/// \return X_WR and its covariance, from the camera's.
PlacedRobot robot_of(const geometry::Pose& X_WC, const geometry::Matrix6d& camera_covariance,
                     const geometry::Pose& X_CR);

/// What is needed to check by switching.
struct CheckParameters {
  bool has_probe_lamp = false;
  bool has_room_lamp = false;
  illumination::ProbeLampParameters probe_lamp;
};

/// Chapter 5's first half: the probes' shadows, one image's lamp (Alg. 5.1, Eq. 5.1 and 5.2), and the lamps of the world. On request it checks by
/// switching a lamp; when a check fails, the lamp counts as unknown.
///
/// Threads: one. After construction nothing here allocates.
class ProbesStage {
 public:
  using Output = LampReport;
  static constexpr std::string_view kName = "probes";
  static constexpr std::string_view kMeaning =
      "Where the lamp is: the probes' shadows, one image's lamp, the lamps of the world (Alg. 5.1).";
  static constexpr runtime::StageParameters kRow{2, 0, 3000, 1, runtime::OnOverrun::kSkip};

  /// \param X_RC  the camera's mount.
  ProbesStage(const illumination::Board& board, const illumination::ProbesParameters& probes,
              const illumination::LampParameters& lamp, const geometry::Pose& X_RC, const CheckParameters& check = {});

  /// \param image  YUYV or grey, of the camera's size.
  /// \param pose  of this image: an older one is not used, and the image then moves no lamp of the world.
  Output update(const ImageView& image, const runtime::Aged<PoseEstimate>& pose, const LampLines& lines,
                const Requests& requests);

  /// The same with the robot's pose as its owner knows it. \param robot  null: not known.
  Output update(const ImageView& image, const PlacedRobot* robot, const LampLines& lines = {},
                const Requests& requests = {});

 private:
  void begin_check(illumination::CheckedLamp lamp, const PlacedRobot* robot);
  void observe(const ImageView& image, const PlacedRobot* robot, LampReport& report);
  [[nodiscard]] Events changes() const;

  illumination::LampParameters lamp_;
  illumination::ProbeLampParameters probe_lamp_;
  geometry::Pose X_CR_;
  illumination::ProbeObserver observer_;
  illumination::LampFilter filter_;
  illumination::ActiveCheck probe_lamp_check_;
  illumination::ActiveCheck room_lamp_check_;
  LampReport last_;

  /// What events tell the changes of.
  struct State {
    bool visible = true;
    bool known = false;
    illumination::CheckState probes_check{};
    illumination::CheckState lamp_proof{};
  };
  [[nodiscard]] State state() const;
  State reported_;
};

}  // namespace cgsr::stages
