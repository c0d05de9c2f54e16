#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/geometry/camera.h"
#include "pipeline/render/depth_raster.h"
#include "pipeline/runtime/stage_budget.h"
#include "pipeline/stages/localize_stage.h"
#include "pipeline/world/load.h"
#include "pipeline/world/map.h"
#include "platform/error.h"
#include "src/commands/first_pose.h"
#include "src/config/localization.h"
#include "src/input/image_input.h"
#include "src/input/pose_file.h"
#include "src/output/map_overlay.h"
#include "src/output/text_file.h"
#include "src/output/video_writer.h"

namespace cgsr::app {

/// The command line of `cgsr localize`; empty texts were not given.
struct LocalizeOptions {
  std::string map;
  std::string camera;
  std::string input;
  std::string pose;
  std::string priors;
  std::string odometry;
  std::string mount;
  std::string method;
  world::LoadOptions load;          ///< of the map.
  std::optional<double> sigma_m;    ///< of the given poses, instead of the configuration's.
  std::optional<double> sigma_deg;  ///< likewise.
  std::string config;
  std::string csv;
  std::string video;
  std::string json;
  std::string plan;
  bool anywhere = false;  ///< no pose is given: the images show a turn on the spot, and a search finds the first one.
  bool force = false;
  int units = 60;  ///< of work at each image after the first that is followed on odometry; 0: all that it asks for.
};

/// Corrects the poses of a camera's images, one after the other: either follows from one pose, given or found, carried by odometry where there is
/// some, or takes a prior for each image by itself.
class LocalizeRun {
 public:
  /// Opens everything before the first image is looked at, so that what cannot be read or written is said at once.
  static Result<LocalizeRun> open(const LocalizeOptions& options);

  /// Looks at the next image. \return false at the end; an error is a file that could not be written, or an image that has no prior.
  Result<bool> step();

  /// What the video still holds is written, and the plan of where the robot may have been.
  Result<void> finish();

  [[nodiscard]] const config::Localization& config() const { return state_->config; }
  [[nodiscard]] int images() const { return images_; }
  [[nodiscard]] int corrected() const { return corrected_; }
  /// Units of work that the image which took most of them was granted, the first one of a followed camera aside.
  [[nodiscard]] std::uint32_t max_units() const { return units_most_; }
  /// The image in which --anywhere found the pose.
  [[nodiscard]] std::optional<std::int64_t> found_in() const { return found_in_; }
  /// How far --anywhere came at last.
  [[nodiscard]] global_localization::Phase first_pose_phase() const { return state_->first_pose->phase(); }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  [[nodiscard]] const world::Map& map() const { return *state_->map; }

 private:
  /// What must stay where it is while others point to it.
  struct State {
    config::Localization config;
    std::shared_ptr<const world::Map> map;
    geometry::Camera camera;
    std::unique_ptr<FirstPose> first_pose;  ///< with --anywhere.
    std::optional<stages::LocalizeStage> stage;
    std::unique_ptr<render::DepthRaster> expectation;  ///< of the video.
    std::optional<MapOverlay> overlay;
  };

  LocalizeRun() : state_(std::make_unique<State>()) {}

  [[nodiscard]] Result<void> open_images(const LocalizeOptions& options);
  [[nodiscard]] Result<void> open_stage();
  [[nodiscard]] Result<void> open_poses(const LocalizeOptions& options);
  [[nodiscard]] Result<void> open_outputs(const LocalizeOptions& options);
  [[nodiscard]] Result<localization::Correction> look(const ImageView& image);
  [[nodiscard]] Result<localization::Correction> search(const ImageView& image, const geometry::Pose& X_OR);
  [[nodiscard]] Result<void> draw_plan() const;
  [[nodiscard]] Result<localization::Correction> look_at_prior(const ImageView& image);
  [[nodiscard]] localization::Correction follow(const ImageView& image, std::uint32_t units);
  [[nodiscard]] Result<void> write(const ImageView& image, const localization::Correction& answer);
  [[nodiscard]] Result<const PoseRow*> row_for(const std::vector<PoseRow>& rows, const std::string& file) const;

  std::unique_ptr<State> state_;
  std::optional<ImageInput> input_;
  std::vector<PoseRow> priors_;  ///< empty: it follows from start_.
  std::string priors_file_;
  std::vector<PoseRow> odometry_;
  std::string odometry_file_;
  std::string plan_file_;
  std::optional<std::int64_t> found_in_;
  std::optional<geometry::Pose> X_OR_before_;
  geometry::Pose X_RC_ = geometry::Pose::Identity();
  localization::Prior start_;
  localization::TrackedPose tracked_;  ///< of the last image.
  geometry::Pose X_RR_last_ =
      geometry::Pose::Identity();  ///< how the robot moved over the last image, where nothing says it.
  std::optional<TextFile> csv_;
  std::optional<VideoWriter> video_;
  std::vector<std::string> notes_;
  std::int64_t frame_ = 0;
  int images_ = 0;
  int corrected_ = 0;
  std::uint32_t units_ = runtime::StageBudget::kAll;
  std::uint32_t units_most_ = 0;
};

}  // namespace cgsr::app
