#include "pipeline/localization/solve.h"

#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "tests/localization/random_numbers.h"

namespace cgsr::localization {
namespace {

using geometry::Matrix6d;
using geometry::Pose;
using geometry::Vector6d;
using testing::RandomNumbers;

geometry::Camera small_camera() {
  return geometry::Camera{}.scaled_to(320, 240).without_distortion();
}

Pose some_pose(RandomNumbers& random) {
  return geometry::moved(Pose::Identity(), (Vector6d() << random.normal3(1.0), random.normal3(0.7)).finished());
}

// Lines through the images of random points in front of the camera.
std::vector<LineDistance> lines_at(const Pose& X_WC, int count, double noise_px, RandomNumbers& random) {
  const geometry::Camera camera = small_camera();
  std::vector<LineDistance> lines;
  for (int i = 0; i < count; ++i) {
    LineDistance line;
    const double depth = random.uniform(0.8, 6.0);
    const Eigen::Vector3d p_C(random.uniform(-0.5, 0.5) * depth, random.uniform(-0.4, 0.4) * depth, depth);
    line.p_W = X_WC * p_C;
    const double angle = random.uniform(0.0, 6.28);
    line.normal = {std::cos(angle), std::sin(angle)};
    line.offset_px = line.normal.dot(*camera.pixel_of(p_C)) + noise_px * random.normal();
    line.sigma_px = std::max(noise_px, 0.1);
    lines.push_back(line);
  }
  return lines;
}

TEST(SolveProperty, JacobianIsTheNumericOne) {
  RandomNumbers random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Pose X_WC = some_pose(random);
    const LineDistance line = lines_at(X_WC, 1, 5.0, random)[0];
    double distance = 0.0;
    Eigen::Matrix<double, 1, 6> J;
    ASSERT_TRUE(distance_of(line, X_WC, small_camera(), distance, J));
    for (int j = 0; j < 6; ++j) {
      constexpr double kStep = 1e-6;
      Vector6d step = Vector6d::Zero();
      step[j] = kStep;
      double ahead = 0.0;
      double behind = 0.0;
      Eigen::Matrix<double, 1, 6> unused;
      ASSERT_TRUE(distance_of(line, geometry::moved(X_WC, step), small_camera(), ahead, unused));
      ASSERT_TRUE(distance_of(line, geometry::moved(X_WC, -step), small_camera(), behind, unused));
      EXPECT_NEAR(J[j], (ahead - behind) / (2.0 * kStep), 1e-3 * std::max(1.0, std::abs(J[j]))) << j;
    }
  }
}

TEST(SolveProperty, FindsThePoseThatTheLinesWereMadeFrom) {
  RandomNumbers random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const Pose truth = some_pose(random);
    const auto lines = lines_at(truth, 30, 0.0, random);
    Prior prior = prior_at(truth, PriorSigmas::free().times(10.0));
    prior.X_WC = geometry::moved(truth, (Vector6d() << random.normal3(0.1), random.normal3(0.05)).finished());
    const Matrix6d information = prior.covariance.inverse();
    const Solution found = solve(lines, prior.X_WC, prior, information, small_camera(), {.steps = 15, .robust = 0.0});
    ASSERT_TRUE(found.solved);
    const Vector6d error = geometry::step_between(truth, found.X_WC);
    EXPECT_LT(error.head<3>().norm(), 2e-3);
    EXPECT_LT(error.tail<3>().norm(), 1e-3);
  }
}

// lambda = 1 in units of a sigma is a Gaussian prior: the pose and its covariance are those of the linear problem, and the covariance is honest.
TEST(SolveProperty, ErrorsAreAsLargeAsTheCovarianceSays) {
  RandomNumbers random(3);
  double chi2 = 0.0;
  constexpr int kTrials = 300;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Pose truth = some_pose(random);
    const auto lines = lines_at(truth, 12, 1.0, random);
    const PriorSigmas sigmas{.x_m = 0.05, .y_m = 0.05, .z_m = 0.01, .heading_rad = 0.03, .tilt_rad = 0.005};
    Prior prior = prior_at(truth, sigmas);
    Vector6d off;
    for (int i = 0; i < 6; ++i) off[i] = std::sqrt(prior.covariance(i, i)) * random.normal();
    prior.X_WC = geometry::moved(truth, off);
    const Matrix6d information = prior.covariance.inverse();
    const Solution found = solve(lines, prior.X_WC, prior, information, small_camera(), {.steps = 10, .robust = 0.0});
    ASSERT_TRUE(found.solved);
    const Vector6d error = geometry::step_between(truth, found.X_WC);
    chi2 += error.dot(found.information * error);
  }
  EXPECT_NEAR(chi2 / kTrials, 6.0, 0.8);  // 300 draws of a chi-square of six: standard error 0.2
}

TEST(Solve, AnEdgesEndPullsThePoseAndIsNoPartOfTheResidual) {
  RandomNumbers random(6);
  const Pose truth = some_pose(random);
  auto lines = lines_at(truth, 20, 0.3, random);
  const Prior prior = prior_at(truth, PriorSigmas::free());
  const Matrix6d information = prior.covariance.inverse();
  const auto found = [&] {
    return solve(lines, truth, prior, information, small_camera(), {.steps = 20, .robust = 0.0});
  };
  const Solution without = found();
  LineDistance end = lines.front();
  end.offset_px += 10.0;
  end.sigma_px = 3.0;
  end.end = true;
  lines.push_back(end);
  const Solution with_end = found();
  EXPECT_GT(geometry::step_between(without.X_WC, with_end.X_WC).norm(), 1e-4);
  EXPECT_LT(with_end.rms_px, without.rms_px + 0.2) << "ten pixels off";
  lines.back().end = false;
  EXPECT_GT(found().rms_px, without.rms_px + 1.0);
}

TEST(Solve, AFewWrongLinesDoNotPullARobustPose) {
  RandomNumbers random(4);
  const Pose truth = some_pose(random);
  auto lines = lines_at(truth, 40, 0.3, random);
  for (int i = 0; i < 8; ++i) lines[static_cast<std::size_t>(i)].offset_px += 15.0;
  const Prior prior = prior_at(geometry::moved(truth, Vector6d::Constant(0.01)), PriorSigmas::free());
  const Matrix6d information = prior.covariance.inverse();
  const auto error_of = [&](double robust) {
    const Solution found =
        solve(lines, prior.X_WC, prior, information, small_camera(), {.steps = 20, .robust = robust});
    return geometry::step_between(truth, found.X_WC).head<3>().norm();
  };
  EXPECT_LT(error_of(2.0), 0.01);
  EXPECT_GT(error_of(0.0), 2.0 * error_of(2.0));
}

// One step of Eq. 4.5 by hand: lambda = 1, units the prior's variances.
TEST(SolveGolden, ThePapersStepIsEquation45) {
  RandomNumbers random(5);
  const Pose truth = some_pose(random);
  const auto lines = lines_at(truth, 10, 0.0, random);
  const Prior prior = prior_at(geometry::moved(truth, Vector6d::Constant(0.02)), PriorSigmas::free());
  Eigen::MatrixXd J(10, 6);
  Eigen::VectorXd F(10);
  const Vector6d unit = prior.covariance.diagonal();
  for (int i = 0; i < 10; ++i) {
    Eigen::Matrix<double, 1, 6> row;
    ASSERT_TRUE(distance_of(lines[static_cast<std::size_t>(i)], prior.X_WC, small_camera(), F[i], row));
    J.row(i) = row.cwiseProduct(unit.transpose());
  }
  const Vector6d p = -(J.transpose() * J + Matrix6d::Identity()).ldlt().solve(J.transpose() * F);
  const Pose expected = geometry::moved(prior.X_WC, p.cwiseProduct(unit));
  const Solution found = solve(lines, prior.X_WC, prior, prior.covariance.inverse(), small_camera(), {.paper = true});
  ASSERT_TRUE(found.solved);
  EXPECT_LT(geometry::step_between(expected, found.X_WC).norm(), 1e-5);
}

TEST(SolveFault, TooFewLinesOrNumbersThatAreNoneAreNotSolved) {
  RandomNumbers random(6);
  const Pose truth = some_pose(random);
  const Prior prior = prior_at(truth, PriorSigmas::free());
  auto lines = lines_at(truth, 2, 0.0, random);
  EXPECT_FALSE(solve(lines, truth, prior, prior.covariance.inverse(), small_camera(), {}).solved);
  lines = lines_at(truth, 20, 0.0, random);
  lines[3].offset_px = std::nan("");
  EXPECT_FALSE(solve(lines, truth, prior, prior.covariance.inverse(), small_camera(), {}).solved);
  for (LineDistance& line : lines) line.p_W = truth * Eigen::Vector3d(0.0, 0.0, -2.0);
  EXPECT_FALSE(solve(lines, truth, prior, prior.covariance.inverse(), small_camera(), {}).solved) << "behind";
}

}  // namespace
}  // namespace cgsr::localization
