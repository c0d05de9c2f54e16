#include "src/commands/light_run.h"

#include <bit>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "platform/count_marks.h"
#include "src/output/text_file.h"

namespace cgsr::app {
namespace {

using illumination::LampStatus;
using illumination::ObservationStatus;

constexpr const char* kColumns = "frame,found,reason,x,y,z,probes,sigma_m";

constexpr std::string_view kConeMissing = "a cone is missing";

/// Of geometry::moved(X_WR, step), where a row states sigmas; else zero: the filter knows no pose better than [lamp].pose_sigma_* says.
geometry::Matrix6d covariance_of(const PoseRow& pose) {
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
  const double place = pose.sigma_m.value_or(0.0);
  const double turn = pose.sigma_rad.value_or(0.0);
  covariance.diagonal().head<3>().setConstant(place * place);
  covariance.diagonal().tail<3>().setConstant(turn * turn);
  return covariance;
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
      observer_(setup.board, config_.probes, config_.lamp.height_m - setup.board.X_RB.translation().z()),
      filter_(setup.board, config_.lamp),
      causes_(static_cast<std::size_t>(ObservationStatus::kSaturated) + 1) {}

Result<LightRun> LightRun::open(const LightOptions& options) {
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
  count_stage_begin();
  const auto observation = observer_.observe(next.image.view());
  count_stage_end("probes");
  ++causes_[static_cast<std::size_t>(observation.status)];
  const PoseRow* pose = pose_of(frame);
  const geometry::Pose* X_WR = pose != nullptr ? &pose->X : nullptr;
  without_a_cone_ += observation.missing != 0 ? 1 : 0;
  count_stage_begin();
  const auto lamps = illumination::locate_lamps(observer_.board(), config_.lamp, observation);
  if (X_WR != nullptr) filter_.update(observation, *X_WR, covariance_of(*pose));
  count_stage_end("lamp");
  count_image_end();
  bool found = false;
  for (int i = 0; i < lamps.count; ++i) {
    const auto& lamp = lamps.lamp[static_cast<std::size_t>(i)];
    if (lamp.status != LampStatus::kFound) continue;
    found = true;
    const Eigen::Vector3d p = X_WR != nullptr ? Eigen::Vector3d(*X_WR * lamp.p_RL) : lamp.p_RL;
    rows_ += fmt::format("{},1,{},{:.4f},{:.4f},{:.4f},{},{:.4f}\n", frame,
                         observation.missing != 0 ? kConeMissing : "", p.x(), p.y(), p.z(),
                         std::popcount(static_cast<unsigned>(lamp.probes)), std::sqrt(lamp.covariance.trace()));
  }
  if (!found) {
    const bool seen = observation.status == ObservationStatus::kSeen;
    last_cause_ = observation.missing != 0 && observation.status != ObservationStatus::kSaturated ? kConeMissing
                  : seen ? illumination::to_string(lamps.status)
                         : illumination::to_string(observation.status);
    rows_ += unanswered_row(frame, last_cause_);
  }
  answered_ += found ? 1 : 0;
  return true;
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
  if (without_a_cone_ > 0) lines.push_back(fmt::format("{:6} images: {}", without_a_cone_, kConeMissing));
  for (int i = 0; i < filter_.count(); ++i) {
    const auto& lamp = filter_.lamp(i);
    if (!lamp.steady) continue;
    const Eigen::Vector3d sigma = lamp.covariance.diagonal().cwiseSqrt();
    lines.push_back(fmt::format(
        "lamp {} at ({:.3f}, {:.3f}, {:.3f}) m in the world, sigma ({:.3f}, {:.3f}, {:.3f}), seen in {} images", i,
        lamp.p_WL.x(), lamp.p_WL.y(), lamp.p_WL.z(), sigma.x(), sigma.y(), sigma.z(), lamp.seen));
  }
  lines.insert(lines.end(), problems_.begin(), problems_.end());
  return lines;
}

}  // namespace cgsr::app
