#include "pipeline/calibration/probes.h"

#include <random>

#include "pipeline/illumination/lamp.h"
#include "tests/illumination/drawn_board.h"

namespace cgsr::calibration {
namespace {

using Eigen::Vector3d;
using illumination::shipped_board;

const Vector3d kLamp(4.0, 3.0, 2.75);

// What a robot whose tips stand a little elsewhere, and whose board leans, sees of the lamp from all around.
std::vector<ProbeView> views_of(const illumination::Board& real, int count) {
  std::vector<ProbeView> views;
  for (int i = 0; i < count; ++i) {
    ProbeView view;
    view.image = i;
    const double angle = 2.0 * M_PI * i / count;
    view.X_WR =
        geometry::pose_on_floor(kLamp.x() + 1.1 * std::cos(angle), kLamp.y() + 1.1 * std::sin(angle), 2.7 * angle);
    view.observation.status = illumination::ObservationStatus::kSeen;
    view.observation.registration.good = true;
    view.observation.registration.X_BC = real.X_BC;
    for (std::size_t k = 0; k < 2; ++k) {
      illumination::ProbeShadow shadow;
      shadow.p_BS = illumination::cast(real.X_RB.inverse() * (view.X_WR.inverse() * kLamp), real.probe[k].p_BA);
      shadow.covariance = 4e-8 * Eigen::Matrix2d::Identity();
      shadow.lines = 2;
      view.observation.probe[k].shadow[0] = shadow;
      view.observation.probe[k].count = 1;
    }
    views.push_back(view);
  }
  return views;
}

TEST(CalibrateProbes, FindsTipsTurnAndMount) {
  const illumination::Board board = shipped_board();
  illumination::Board real = board;
  real.probe[0].p_BA += Vector3d(0.0009, -0.0006, 0.0005);
  real.probe[1].p_BA += Vector3d(-0.0007, 0.0008, -0.0004);
  real.X_RB.linear() = board.X_RB.linear() * geometry::rotation_of(Vector3d(0.003, -0.002, 0.001));
  geometry::Vector6d step;
  step << 0.002, -0.001, 0.001, 0.004, -0.003, 0.002;
  real.X_BC = geometry::moved(board.X_BC, step);
  const auto found = calibrate_probes(board, illumination::shipped_probes().board, views_of(real, 12), kLamp);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_LT(found->rms_m, 0.0004);
  EXPECT_GT(found->rms_before_m, 2.0 * found->rms_m);
  const Vector3d apex(found->board.left.apex_m[0], found->board.left.apex_m[1], found->board.left.apex_m[2]);
  EXPECT_LT((apex - real.X_RB * real.probe[0].p_BA).norm(), 0.0005);
  const geometry::Pose X_RC = real.X_RB * real.X_BC;
  EXPECT_LT((found->X_RC.translation() - X_RC.translation()).norm(), 0.001);
  // Of the turn the tips take a part: they explain the same shadows.
  EXPECT_LT(geometry::step_between(found->X_RC, X_RC).tail<3>().norm(), 0.0025);
  // With what was found, shadows fall where they were seen.
  illumination::BoardParameters better = found->board;
  const auto again = illumination::make_board(better, found->X_RC, board.camera);
  ASSERT_TRUE(again) << again.error().message;
  const Vector3d lamp_R(1.0, 0.4, 2.75);
  const auto expected = illumination::cast(real.X_RB.inverse() * lamp_R, real.probe[1].p_BA);
  const auto by_found = illumination::cast(again->X_RB.inverse() * lamp_R, again->probe[1].p_BA);
  EXPECT_LT((expected - by_found).norm(), 0.0006);
}

TEST(CalibrateProbesFault, SaysWhatIsWrong) {
  const illumination::Board board = shipped_board();
  const auto parameters = illumination::shipped_probes().board;
  const auto message = [&](const std::vector<ProbeView>& views, const Vector3d& lamp) {
    const auto found = calibrate_probes(board, parameters, views, lamp);
    return found ? std::string() : found.error().message;
  };
  EXPECT_NE(message({}, kLamp).find("0 shadows of probes"), std::string::npos);
  EXPECT_NE(message(views_of(board, 8), kLamp + Vector3d(1.2, 0.0, 0.0)).find("another lamp"), std::string::npos);
  EXPECT_NE(message(views_of(board, 8), Vector3d(4.0, 3.0, 0.8)).find("not above the probes' tips"), std::string::npos);
  auto unseen = views_of(board, 8);
  for (auto& view : unseen) view.observation.registration.good = false;
  EXPECT_NE(message(unseen, kLamp).find("not in view"), std::string::npos);
}

}  // namespace
}  // namespace cgsr::calibration
