#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hal/simulation.h"
#include "pipeline/color/light_history.h"
#include "pipeline/runtime/stage_table.h"
#include "platform/config/sha256.h"
#include "src/config/whereabouts.h"
#include "src/output/overlay.h"
#include "src/output/plan_view.h"
#include "src/output/text_file.h"
#include "src/output/video_writer.h"
#include "src/robot/decision_digest.h"
#include "src/robot/light_tally.h"
#include "src/robot/links.h"
#include "src/robot/pose_tally.h"
#include "src/robot/truth_tally.h"

namespace cgsr::robot {

/// Looks on at every image with what the robot made of it and what was really there. In lock-step what a decision points to is still there.
using Witness = std::function<void(const ImageView& image, const VisionReport& report,
                                   const std::optional<hal::ImageTruth>& truth)>;

/// The files a run leaves behind; each may be missing.
struct RunOutputs {
  std::optional<app::TextFile> csv;
  std::optional<app::VideoWriter> video;
  std::optional<app::Overlay> overlay;                ///< there whenever `video` is.
  std::optional<app::PlanView> plan;                  ///< beside it; only of a simulated home.
  const hal::Simulation* simulation = nullptr;        ///< where truth comes from; null: there is none.
  config::TaskKind task = config::TaskKind::kFollow;  ///< whose state is told.
  Witness witness = nullptr;
  double set_distance_m = 0.0;  ///< that the robot shall keep, for truth and plan; 0: it follows nothing.
};

/// A change of state of Algorithm 5.2.
struct SeekStep {
  behavior::SeekState state = behavior::SeekState::kWaiting;
  behavior::SeekReason reason = behavior::SeekReason::kBegun;
  std::uint64_t image = 0;
  double at_s = 0.0;
};

/// A check by switching that ended.
struct CheckEnd {
  illumination::CheckedLamp lamp = illumination::CheckedLamp::kProbeLamp;
  illumination::CheckReport report;
  std::uint64_t image = 0;
  double at_s = 0.0;
};

/// What a run came to.
struct RunTally {
  std::uint64_t frames = 0;
  std::uint64_t without_image = 0;
  std::uint64_t found = 0;
  std::uint64_t beats = 0;            ///< of the motion loop.
  std::uint64_t beats_in_motion = 0;  ///< a command other than zero went to the base.
  std::uint64_t pictures = 0;         ///< images that reached housekeeping and are in inputs_sha256.
  double fastest_mps = 0.0;
  double fastest_radps = 0.0;
  MotionStatus last_motion;
  Whereabouts last_where;
  std::vector<SeekStep> seek;            ///< in order; empty where that is not the task.
  std::vector<SwitchRecord> switchings;  ///< of lamps, in order.
  std::vector<CheckEnd> checks;          ///< by switching, in order.
  std::string output_problem;            ///< the first file that could not be written; empty: none.
};

/// Everything that may be slow: files, video, log, sums. Never real-time; what it cannot keep up with is lost and counted.
class HousekeepingTask {
 public:
  HousekeepingTask(Links& links, const runtime::Schedule& schedule, RunOutputs outputs)
      : links_(links), table_(schedule), outputs_(std::move(outputs)), truths_(outputs_.set_distance_m) {}

  /// Deals with all that lies in the rings.
  void step();

  /// After the last step: what the video still holds is written; what fails is the tally's problem.
  void finish();

  [[nodiscard]] const RunTally& tally() const { return tally_; }
  [[nodiscard]] const runtime::StageTable& table() const { return table_; }
  /// \return what the run came to by what was really there; null without a simulation.
  [[nodiscard]] const TruthFigures* truth() const {
    return outputs_.simulation == nullptr || outputs_.set_distance_m <= 0.0 ? nullptr : &truths_.figures();
  }

  /// \return how well it knew where it was; null without a simulation or a map.
  [[nodiscard]] const PoseFigures* pose_truth() const {
    return poses_.figures().images == 0 ? nullptr : &poses_.figures();
  }

  /// \return what became of the lamp; null for a robot without probes.
  [[nodiscard]] const LightFigures* light() const {
    return lights_seen_.figures().looks == 0 ? nullptr : &lights_seen_.figures();
  }

  /// SHA-256 over the rows of the CSV and over the pixels of the images. End the sums.
  std::string outputs_sha256() { return outputs_sum_.hex(); }
  std::string inputs_sha256() { return inputs_sum_.hex(); }
  /// SHA-256 over what was decided, independent of columns and messages. Ends the sum.
  std::string decisions_sha256() { return decisions_.hex(); }

 private:
  void take(const MotionStatus& status);
  void take(const VisionReport& report);
  void watch_pose(const VisionReport& report);
  void watch_light(const VisionReport& report);
  void watch_seek(const VisionReport& report);
  void watch_check(illumination::CheckedLamp lamp, const illumination::CheckReport& check,
                   const runtime::FrameRecord& record);
  void take(const SwitchRecord& record);
  std::optional<ImageLease> picture_of(std::uint64_t sequence);
  void write_row(const VisionReport& report, const std::optional<PoseError>& off);
  void draw(const VisionReport& report, const ImageLease& picture, const std::optional<color::Light>& light,
            const std::optional<hal::ImageTruth>& truth);
  void note(const Result<void>& outcome);

  Links& links_;
  runtime::StageTable table_;
  RunOutputs outputs_;
  RunTally tally_;
  TruthTally truths_;
  PoseTally poses_;
  LightTally lights_seen_;
  cv::Mat side_by_side_;
  color::LightHistory lights_;
  std::optional<ImageLease> next_picture_;
  behavior::FollowState state_ = behavior::FollowState::kWaiting;
  behavior::RouteState route_ = behavior::RouteState::kNowhere;
  localization::TrackState pose_ = localization::TrackState::kUnsure;
  bool lamp_known_ = false;
  ShadeStatus shade_ = ShadeStatus::kNoMap;
  bool probes_fit_ = true;
  std::array<illumination::CheckState, 2> checks_{};  // by CheckedLamp
  config::Sha256 outputs_sum_;
  config::Sha256 inputs_sum_;
  DecisionDigest decisions_;
};

/// The head of the CSV that a run writes.
std::string run_csv_head();

}  // namespace cgsr::robot
