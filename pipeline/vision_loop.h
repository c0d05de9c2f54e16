#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "pipeline/behavior/follow.h"
#include "pipeline/behavior/route.h"
#include "pipeline/behavior/seek_lamp.h"
#include "pipeline/color/integrated_tracker.h"
#include "pipeline/color/tracker.h"
#include "pipeline/imaging/reduce.h"
#include "pipeline/runtime/stage.h"
#include "pipeline/switchboard.h"
#include "pipeline/what_is_shaded.h"
#include "pipeline/where_am_i.h"
#include "pipeline/where_is_the_lamp.h"
#include "platform/image_lease.h"
#include "platform/parameters.h"

namespace cgsr {

/// Where the robot believes to be.
struct Whereabouts {
  bool has_map = false;  ///< else nothing below means anything.
  localization::TrackedPose camera;
  behavior::FloorBelief robot;

  [[nodiscard]] bool known() const { return has_map && robot.known; }
};

/// Where the object is, by whichever tracker looks for it.
struct Found {
  color::TrackedObject object;
  color::BallSighting ball;  ///< what the integrated tracker says beside that; else nothing.
};

/// What one image led to.
struct Decision {
  behavior::Velocity goal;
  bool halt = false;  ///< forward motion ends at once.
  behavior::FollowDecision follow;
  behavior::RouteDecision route;
  behavior::SeekDecision seek;
  Whereabouts where;
  LampSight lamp;
  Duration lamp_age{};  ///< since the image whose probes `lamp` comes from.
  ShadeSight shade;     ///< its masks may be gone by the time that somebody else looks; the picture stays.
  color::TrackedObject object;
  color::BallSighting ball;
  Duration
      object_age{};  ///< since the image in which `object` was looked for; more than zero when its stage was skipped.
};

/// The pinhole of the camera that the images come from (frames: docs/frames.md).
struct Pinhole {
  double fx_px = 601.8;
  double fy_px = 579.4;
  double cx_px = 319.5;
  double cy_px = 239.5;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("fx_px", self.fx_px, {10.0, 20000.0}, "px", "focal length along x");
    visit.number("fy_px", self.fy_px, {10.0, 20000.0}, "px", "focal length along y");
    visit.number("cx_px", self.cx_px, {-10000.0, 20000.0}, "px", "column of the optical axis");
    visit.number("cy_px", self.cy_px, {-10000.0, 20000.0}, "px", "row of the optical axis");
  }
};

/// What a vision loop is made of. Each may be missing; what would do its work then has nothing to say.
struct VisionParts {
  std::optional<color::Tracker> tracker = std::nullopt;         ///< chapter 3,
  std::optional<color::IntegratedTracker> ball = std::nullopt;  ///< or 5.3, which is told what may lie in shadow.
  std::unique_ptr<WhereAmI> where = nullptr;                    ///< chapter 4.
  std::unique_ptr<WhereIsTheLamp> lamp = nullptr;               ///< chapter 5: the probes on the robot.
  std::unique_ptr<WhatIsShaded> shade = nullptr;                ///< chapter 5: the masks; not without `where`.
  Switchboard switchboard{};                                    ///< lamps that may be switched; by default none.
  std::optional<behavior::Route> route = std::nullopt;          ///< the task is to drive it,
  std::optional<behavior::SeekLamp> seek = std::nullopt;        ///< or Alg. 5.2; without either, to follow the object.
};

/// One image through Figure 5.1: every line of on_image is a stage with a row in the schedule.
///
/// Threads: one, the vision thread. After construction nothing here allocates.
class VisionLoop {
 public:
  /// \param runner  outlives the loop. \param max_width_px, max_height_px  the largest image that will come.
  VisionLoop(runtime::StageRunner& runner, VisionParts parts, behavior::Follow follow, const Pinhole& camera,
             int max_width_px, int max_height_px);
  VisionLoop(const VisionLoop&) = delete;
  VisionLoop& operator=(const VisionLoop&) = delete;

  /// Gives every stage its row in the runner's schedule; to be called once, before the first image.
  Result<void> bind() { return runner_.bind(decode_, localize_, probes_, shade_, search_, track_, decide_); }

  /// What the base reported; to be told before the image that is exposed about then.
  void heard(const hal::Odometry& odometry);
  /// What became of a switching; to be told before the next image.
  void heard(const SwitchAnswer& answer) { parts_.switchboard.heard(answer); }
  /// \return the next switching that the last image led to; to be asked until there is none.
  std::optional<SwitchRequest> next_switching() { return parts_.switchboard.next(last_image_); }

  /// Image in, decision out. Valid between the runner's begin_frame and end_frame.
  Decision on_image(const ImageLease& image);

 private:
  /// What the stages after decode read: the image as it came, and reduced to grey and labels. No image: decode failed.
  struct View {
    const imaging::ReducedImage* reduced = nullptr;
  };

  View decode(const ImageLease& image);
  Whereabouts localize(WorkBudget& budget, const ImageLease& image, const View& view);
  LampSight probes(const ImageLease& image, const runtime::Aged<Whereabouts>& where);
  ShadeSight shade(const runtime::Aged<Whereabouts>& where, const LampSight& lamp);
  color::SearchResult search(WorkBudget& budget, const View& view);
  Found track(WorkBudget& budget, const ImageLease& image, const View& view, const color::SearchResult& matches,
              const ShadeSight& shade);
  Decision decide(const ImageLease& image, const runtime::Aged<Found>& object, const runtime::Aged<Whereabouts>& where,
                  const runtime::Aged<LampSight>& lamp, const ShadeSight& shade);

  template <class Output, class... Inputs>
  using StageOf = runtime::Stage<std::function<Output(Inputs...)>>;

  runtime::StageRunner& runner_;
  VisionParts parts_;
  behavior::Follow follow_;
  imaging::LabelTable no_labels_;  // where no tracker says which colours matter
  Pinhole camera_;
  imaging::ReducedImage reduced_;
  MonoTime last_image_{};

  StageOf<View, const ImageLease&> decode_;
  StageOf<Whereabouts, WorkBudget&, const ImageLease&, const View&> localize_;
  StageOf<LampSight, const ImageLease&, const runtime::Aged<Whereabouts>&> probes_;
  StageOf<ShadeSight, const runtime::Aged<Whereabouts>&, const LampSight&> shade_;
  StageOf<color::SearchResult, WorkBudget&, const View&> search_;
  StageOf<Found, WorkBudget&, const ImageLease&, const View&, const color::SearchResult&, const ShadeSight&> track_;
  StageOf<Decision, const ImageLease&, const runtime::Aged<Found>&, const runtime::Aged<Whereabouts>&,
          const runtime::Aged<LampSight>&, const ShadeSight&>
      decide_;
};

}  // namespace cgsr
