#include "src/commands/light_run.h"

#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "platform/count_marks.h"
#include "src/commands/files.h"
#include "src/output/text_file.h"

namespace cgsr::app {
namespace {

using illumination::LampStatus;
using illumination::ObservationStatus;

constexpr const char* kColumns = "frame,found,reason,x,y,z,probes,sigma_m";

/// The robot where a row says; its covariance is zero where the row states no sigmas: the filter knows no pose better than [lamp].min_pose_sigma_*.
stages::PlacedRobot placed(const PoseRow& pose) {
  stages::PlacedRobot robot{pose.X, geometry::Matrix6d::Zero()};
  const double place = pose.sigma_m.value_or(0.0);
  const double turn = pose.sigma_rad.value_or(0.0);
  robot.covariance.diagonal().head<3>().setConstant(place * place);
  robot.covariance.diagonal().tail<3>().setConstant(turn * turn);
  return robot;
}

Result<void> claim_outputs(const LightOptions& options) {
  OutputClaims files(options.force);
  reads_configuration(files, options.config, "--config");
  files.reads(options.camera, "--camera");
  files.reads(options.mount, "--mount");
  files.reads(options.input, "--input");
  files.reads(options.pose, "--pose");
  files.writes(options.csv, "--csv", csv_file(kColumns));
  return files.claim();
}

std::string unanswered_row(int frame, std::string_view reason) {
  return fmt::format("{},0,{},,,,,\n", frame, reason);
}

}  // namespace

LightRun::LightRun(const LightOptions& options, LightSetup setup, std::vector<PoseRow> poses)
    : options_(options),
      config_(setup.config),
      input_(std::move(setup.input)),
      poses_(std::move(poses)),
      stage_(setup.board, config_.probes, config_.lamp, setup.board.X_RB * setup.board.X_BC),
      causes_(static_cast<std::size_t>(ObservationStatus::kSaturated) + 1) {}

Result<LightRun> LightRun::open(const LightOptions& options) {
  if (auto claimed = claim_outputs(options); !claimed) return tl::unexpected(claimed.error());
  auto setup = open_light_setup(options.config, options.camera, options.mount, options.input);
  if (!setup) return tl::unexpected(setup.error());
  if (const auto checked = illumination::check_lamp(setup->board, setup->config.lamp); !checked) {
    return fail(fmt::format("{}: {}", options.config, checked.error().message));
  }
  std::vector<PoseRow> poses;
  if (!options.pose.empty()) {
    auto read = read_poses(options.pose);
    if (!read) return tl::unexpected(read.error());
    poses = std::move(*read);
  }
  return LightRun(options, std::move(*setup), std::move(poses));
}

Result<bool> LightRun::step() {
  auto next = input_.next();
  if (next.end) return false;
  const int frame = images_++;
  if (!next.image) {
    problems_.push_back(fmt::format("image {}: {}", frame, next.problem));
    rows_ += unanswered_row(frame, "unreadable");
    return true;
  }
  const PoseRow* const pose = pose_of(frame);
  const auto robot = pose != nullptr ? std::optional(placed(*pose)) : std::nullopt;
  count_stage_begin();
  report_ = stage_.update(next.image.view(), robot ? &*robot : nullptr);
  count_stage_end(stages::ProbesStage::kName.data());
  count_image_end();
  ++causes_[static_cast<std::size_t>(report_.observation)];
  without_a_cone_ += report_.cone_missing ? 1 : 0;
  if (add_rows(frame, robot ? &robot->X_WR : nullptr)) {
    ++answered_;
  } else {
    last_cause_ = reason_of(report_);
    rows_ += unanswered_row(frame, last_cause_);
  }
  return true;
}

bool LightRun::add_rows(int frame, const geometry::Pose* X_WR) {
  bool found = false;
  for (int i = 0; i < report_.single_image.count; ++i) {
    const auto& lamp = report_.single_image.lamp[static_cast<std::size_t>(i)];
    if (lamp.status != LampStatus::kFound) continue;
    found = true;
    const Eigen::Vector3d p = X_WR != nullptr ? Eigen::Vector3d(*X_WR * lamp.p_RL) : lamp.p_RL;
    rows_ += fmt::format("{},1,,{:.4f},{:.4f},{:.4f},{},{:.4f}\n", frame, p.x(), p.y(), p.z(),
                         std::popcount(static_cast<unsigned>(lamp.probes)), std::sqrt(lamp.covariance.trace()));
  }
  return found;
}

const PoseRow* LightRun::pose_of(int frame) const {
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const PoseRow& row = poses_[i];
    if (row.frame ? *row.frame == frame : static_cast<int>(i) == frame) return &row;
  }
  return nullptr;
}

Result<void> LightRun::finish() {
  if (options_.csv.empty()) return {};
  return write_file(options_.csv, fmt::format("{}\n{}", kColumns, rows_));
}

std::vector<std::string> LightRun::summary() const {
  std::vector<std::string> lines;
  for (std::size_t cause = 0; cause < causes_.size(); ++cause) {
    if (causes_[cause] == 0) continue;
    lines.push_back(
        fmt::format("{:6} images: {}", causes_[cause], illumination::to_string(static_cast<ObservationStatus>(cause))));
  }
  if (without_a_cone_ > 0) lines.push_back(fmt::format("{:6} images: a cone is missing", without_a_cone_));
  for (int i = 0; i < report_.lamps.count; ++i) {
    const auto& lamp = report_.lamps.lamp[static_cast<std::size_t>(i)];
    const Eigen::Vector3d sigma = lamp.covariance.diagonal().cwiseSqrt();
    lines.push_back(fmt::format(
        "lamp {} at ({:.3f}, {:.3f}, {:.3f}) m in the world, sigma ({:.3f}, {:.3f}, {:.3f}), seen in {} images", i,
        lamp.p_WL.x(), lamp.p_WL.y(), lamp.p_WL.z(), sigma.x(), sigma.y(), sigma.z(), lamp.seen));
  }
  lines.insert(lines.end(), problems_.begin(), problems_.end());
  return lines;
}

}  // namespace cgsr::app
