#include "tools/lab/mapping/drive.h"

#include <array>
#include <cmath>
#include <numbers>

#include "pipeline/localization/perceive.h"
#include "tools/lab/scenes/random.h"

namespace cgsr::lab {
namespace {

constexpr double kRad = std::numbers::pi / 180.0;
constexpr std::array<double, 4> kLook_deg{0.0, 75.0, 0.0, -75.0};  // beside the way, image after image

struct Stop {
  double x_m, y_m, heading_rad;
};

// Places along the round, `step_m` apart.
std::vector<Stop> stops_of(const sim::GeneratedHome& home, int images) {
  const double step = home.route.length_m / images;
  std::vector<Stop> stops;
  sim::FloorPoint at = home.route.start;
  double left = 0.0;
  for (const sim::FloorPoint& next : home.route.places) {
    const double dx = next.x - at.x;
    const double dy = next.y - at.y;
    const double length = std::hypot(dx, dy);
    for (; left < length; left += step) {
      const double look = kLook_deg.at(stops.size() % kLook_deg.size()) * kRad;
      stops.push_back({at.x + dx * left / length, at.y + dy * left / length, std::atan2(dy, dx) + look});
    }
    left -= length;
    at = next;
  }
  return stops;
}

// An error that lasts for a while and forgets itself: a stationary Gauss-Markov sequence.
class LastingError {
 public:
  LastingError(const PoseErrors& errors, Random random) : random_(random), keep_(std::exp(-1.0 / errors.images)) {
    sigma_ << errors.place_m, errors.place_m, errors.height_m, errors.tilt_rad, errors.tilt_rad, errors.heading_rad;
    error_ = drawn();
  }

  geometry::Vector6d next() {
    const geometry::Vector6d now = error_;
    error_ = keep_ * error_ + std::sqrt(1.0 - keep_ * keep_) * drawn();
    return now;
  }

 private:
  geometry::Vector6d drawn() {
    geometry::Vector6d drawn;
    for (double& value : drawn) value = random_.normal();
    return drawn.cwiseProduct(sigma_);
  }

  Random random_;
  double keep_;
  geometry::Vector6d sigma_;
  geometry::Vector6d error_;
};

geometry::Pose odometry_between(const geometry::Pose& X_WA, const geometry::Pose& X_WB, const PoseErrors& errors,
                                Random& random) {
  geometry::Pose X_AB = X_WA.inverse() * X_WB;
  const Eigen::Vector3d turn = geometry::vector_of(X_AB.linear());
  X_AB.translation() *= 1.0 + errors.odometry_share * random.normal();
  X_AB.linear() = geometry::rotation_of(turn * (1.0 + errors.odometry_turn_share * random.normal()));
  return X_AB;
}

}  // namespace

PoseErrors PoseErrors::times(double factor) const {
  PoseErrors scaled = *this;
  for (double* value : {&scaled.place_m, &scaled.height_m, &scaled.heading_rad, &scaled.tilt_rad,
                        &scaled.odometry_share, &scaled.odometry_turn_share}) {
    *value *= factor;
  }
  return scaled;
}

Drive drive_through(const sim::GeneratedHome& home, Place& place, const geometry::Camera& told,
                    const PoseErrors& errors, int images, std::uint32_t seed,
                    const std::function<void(int)>& progress) {
  Drive drive;
  localization::Perception perception(told);
  drive.camera = perception.camera();
  LastingError lasting(errors, Random(seed).fork(0x51));
  Random odometry = Random(seed).fork(0x52);
  const localization::PriorSigmas stated{.x_m = std::max(errors.place_m, 0.01),
                                         .y_m = std::max(errors.place_m, 0.01),
                                         .z_m = std::max(errors.height_m, 0.005),
                                         .heading_rad = std::max(errors.heading_rad, 0.005),
                                         .tilt_rad = std::max(errors.tilt_rad, 0.005)};
  for (const Stop& stop : stops_of(home, images)) {
    const auto number = static_cast<std::int64_t>(drive.views.size());
    const geometry::Pose X_WC = geometry::pose_on_floor(stop.x_m, stop.y_m, stop.heading_rad) * place.X_RC();
    const Photograph photo = place.photograph(X_WC, seed, static_cast<std::uint64_t>(number));
    mapping::View view;
    view.number = number;
    view.given = localization::prior_at(geometry::moved(X_WC, lasting.next()), stated);
    view.X_WC = view.given.X_WC;
    if (number > 0) view.X_CB = odometry_between(drive.true_poses.back(), X_WC, errors, odometry);
    const bool perceived = perception.perceive(photo.view(), nullptr) == localization::Reason::kNone;
    if (perceived) view.edges = perception.edges();
    drive.views.push_back(std::move(view));
    drive.true_poses.push_back(X_WC);
    progress(static_cast<int>(number));
  }
  return drive;
}

}  // namespace cgsr::lab
