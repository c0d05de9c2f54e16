#include "pipeline/illumination/switch_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "platform/image_view.h"

namespace cgsr::illumination {
namespace {

constexpr double kMinDifference = 4.0;  // grey levels, mean over the board
constexpr double kMaxMotion_m = 0.004;
constexpr double kMaxRotation_rad = 0.006;
constexpr double kMinAboveTip_m = 0.05;
constexpr double kBound = 13.8;  // chi-square, 2 degrees of freedom: one in a thousand is further off
constexpr int kAlong = 6;        // places of the board that are compared
constexpr int kAcross = 12;

}  // namespace

std::string_view to_string(SwitchVerdict verdict) {
  switch (verdict) {
    case SwitchVerdict::kAgrees:
      return "agrees";
    case SwitchVerdict::kDisagrees:
      return "shadows fall elsewhere";
    case SwitchVerdict::kNoShadow:
      return "no shadow";
    case SwitchVerdict::kNoDifference:
      return "the lamp did not switch";
    case SwitchVerdict::kMoved:
      return "the camera moved";
    case SwitchVerdict::kNoImage:
      return "no image";
    case SwitchVerdict::kNotRegistered:
      return "board and probes not found";
    case SwitchVerdict::kNoAnswer:
      return "the switch does not answer";
  }
  return "unknown";
}

SwitchChecker::SwitchChecker(const Board& board, const ProbesParameters& parameters, double lamp_height_m)
    : board_(board),
      parameters_(parameters),
      difference_(static_cast<std::size_t>(board.camera.width_px) * static_cast<std::size_t>(board.camera.height_px)) {
  finders_.reserve(static_cast<std::size_t>(board.probes));
  for (int i = 0; i < board.probes; ++i) finders_.emplace_back(board, i, parameters.shadow, lamp_height_m);
}

bool SwitchChecker::can_compare(const ImageView& on, const ImageView& off) const {
  for (const ImageView* image : {&on, &off}) {
    if (image->empty() || image->format == PixelFormat::kBgr24 || image->width_px != board_.camera.width_px ||
        image->height_px != board_.camera.height_px || image->format != on.format)
      return false;
  }
  return true;
}

// In the dark image there may be too little light to see the board; where it is seen, it is in the same place.
bool SwitchChecker::has_moved(const Registration& registration, const ImageView& off) const {
  const Registration before = register_board(board_, parameters_.registration, LumaView(off), registration.X_BC, true);
  if (!before.good || before.cones != registration.cones) return false;
  const auto step = geometry::step_between(registration.X_BC, before.X_BC);
  return step.head<3>().norm() > kMaxMotion_m || step.tail<3>().norm() > kMaxRotation_rad;
}

// What is left of the light in the difference's shadows has the level 0 there.
LumaView SwitchChecker::subtract(const ImageView& on, const ImageView& off, const geometry::Pose& X_BC) {
  const LumaView without(off);
  const LightLevels levels{.zero = without.levels().zero - mean_on_board(without, X_BC),
                           .saturated = std::numeric_limits<double>::infinity()};
  const int pixel_bytes = bytes_per_pixel(on.format);
  const int width = on.width_px;
  for (int y = 0; y < on.height_px; ++y) {
    const std::uint8_t* a = on.row(y);
    const std::uint8_t* b = off.row(y);
    std::uint8_t* out = difference_.data() + static_cast<std::ptrdiff_t>(y) * width;
    for (int x = 0; x < width; ++x)
      out[x] = static_cast<std::uint8_t>(std::max(0, int{a[pixel_bytes * x]} - int{b[pixel_bytes * x]}));
  }
  return {ImageView{difference_.data(), width, on.height_px, width, PixelFormat::kGrey8}, levels};
}

// Grey levels.
double SwitchChecker::mean_on_board(const LumaView& image, const geometry::Pose& X_BC) const {
  const BoardView view(board_.camera, X_BC);
  double sum = 0.0;
  int places = 0;
  for (int i = 0; i < kAlong; ++i) {
    for (int k = 0; k < kAcross; ++k) {
      const Eigen::Vector3d p_B(((i + 0.5) / kAlong - 0.5) * board_.depth_m,
                                ((k + 0.5) / kAcross - 0.5) * board_.width_m, 0.0);
      const auto pixel = view.pixel(p_B);
      if (!pixel.in_front || !image.holds(pixel.at.x(), pixel.at.y())) continue;
      sum += static_cast<double>(image.at(pixel.at.x(), pixel.at.y()));
      ++places;
    }
  }
  return places > 0 ? sum / places : 0.0;
}

// The shadow that is nearest, in standard deviations, to where the lamp throws this probe's.
void SwitchChecker::compare_shadow(std::size_t probe, const ShadowFinder::Found& found, const Lamp& lamp,
                                   const geometry::Matrix6d& registration, SwitchCheck& check) const {
  const Eigen::Vector3d& p_BL = lamp.p_BL;
  const auto model = shadow_of(p_BL, board_.probe[probe].p_BA);
  // The turn of the board moves the lamp in its frame.
  Eigen::Matrix3d cross;
  cross << 0, -p_BL.z(), p_BL.y(), p_BL.z(), 0, -p_BL.x(), -p_BL.y(), p_BL.x(), 0;
  const Eigen::Matrix<double, 2, 3> J_turn = model.J_lamp * cross;
  for (int k = 0; k < found.count; ++k) {
    const ProbeShadow& shadow = found.shadow[static_cast<std::size_t>(k)];
    const Eigen::Matrix2d V = shadow.covariance + shadow.J_pose * registration * shadow.J_pose.transpose() +
                              board_.place_sigma_m * board_.place_sigma_m * model.J_tip * model.J_tip.transpose() +
                              board_.turn_sigma_rad * board_.turn_sigma_rad * J_turn * J_turn.transpose() +
                              lamp.sigma_m * lamp.sigma_m * model.J_lamp * model.J_lamp.transpose();
    const Eigen::Vector2d off_m = shadow.p_BS - model.p_BS;
    const double chi2 = off_m.dot(V.inverse() * off_m);
    if (check.seen[probe] && chi2 >= check.chi2[probe]) continue;
    check.off_m[probe] = off_m;
    check.chi2[probe] = chi2;
    check.seen[probe] = true;
  }
}

SwitchCheck SwitchChecker::check(const ImageView& on, const ImageView& off, const Eigen::Vector3d& p_RL,
                                 double lamp_sigma_m) {
  SwitchCheck check;
  if (!can_compare(on, off)) return check;
  const Registration registration = register_board(board_, parameters_.registration, LumaView(on), board_.X_BC, false);
  if (!registration.good) {
    check.verdict = SwitchVerdict::kNotRegistered;
    return check;
  }
  if (has_moved(registration, off)) {
    check.verdict = SwitchVerdict::kMoved;
    return check;
  }
  const LumaView difference = subtract(on, off, registration.X_BC);
  check.difference = mean_on_board(difference, registration.X_BC);
  if (check.difference < kMinDifference) {
    check.verdict = SwitchVerdict::kNoDifference;
    return check;
  }
  const Lamp lamp{.p_BL = board_.X_RB.inverse() * p_RL, .sigma_m = lamp_sigma_m};
  bool any = false;
  bool all_agree = true;
  for (std::size_t i = 0; i < finders_.size(); ++i) {
    if ((registration.cones & (1 << i)) == 0 || lamp.p_BL.z() < board_.probe[i].p_BA.z() + kMinAboveTip_m) continue;
    const auto found = finders_[i].find(difference, registration.X_BC);
    compare_shadow(i, found, lamp, registration.covariance, check);
    if (!check.seen[i]) continue;
    any = true;
    all_agree = all_agree && check.chi2[i] < kBound;
  }
  check.verdict = !any ? SwitchVerdict::kNoShadow : all_agree ? SwitchVerdict::kAgrees : SwitchVerdict::kDisagrees;
  return check;
}

}  // namespace cgsr::illumination
