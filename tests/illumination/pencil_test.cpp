// Photographs of an upright pencil and its shadow: the only real ones of chapter 5.
#include <filesystem>
#include <fstream>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/illumination/lamp.h"
#include "tests/illumination/rod_shadow.h"
#include "tests/support/real_data.h"

namespace cgsr::illumination {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using nlohmann::json;

class Pencil : public ::testing::Test {
 protected:
  void SetUp() override {
    CGSR_NEEDS_REAL_DATA("shadow/pencil/GROUND_TRUTH.json");
    folder_ = test::real_data("shadow/pencil");
    std::ifstream file(folder_ / "GROUND_TRUTH.json");
    truth_ = json::parse(file);
    const json& K = truth_["K"];
    camera_.width_px = 1920;
    camera_.height_px = 1080;
    camera_.fx_px = K[0][0];
    camera_.fy_px = K[1][1];
    camera_.cx_px = K[0][2];
    camera_.cy_px = K[1][2];
    const json& lens = truth_["dist"];
    camera_.k1 = lens[0];
    camera_.k2 = lens[1];
    camera_.p1 = lens[2];
    camera_.p2 = lens[3];
    camera_.k3 = lens[4];
    X_CD_.linear() = geometry::rotation_of(vector(truth_["rvec_desk"]));
    X_CD_.translation() = vector(truth_["tvec_desk"]);
    up_ = Vector3d(0.0, 0.0, truth_["z_up_sign"].get<double>() * truth_["pencil_height_mm"].get<double>());
  }

  static Vector3d vector(const json& v) { return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()}; }
  static Vector2d pixel(const json& v) { return {v[0].get<double>(), v[1].get<double>()}; }

  // Where a pixel's ray meets the desk, millimetres.
  [[nodiscard]] Vector3d on_desk(const Vector2d& pixel) const {
    const Vector2d ideal = camera_.ideal_of(pixel);
    const geometry::Pose X_DC = X_CD_.inverse();
    const Vector3d way = X_DC.linear() * Vector3d(ideal.x(), ideal.y(), 1.0);
    const Vector3d from = X_DC.translation();
    return from - way * (from.z() / way.z());
  }

  [[nodiscard]] TipShadow shadow(const Vector2d& base_px, const Vector2d& tip_px) const {
    TipShadow shadow;
    shadow.p_A = on_desk(base_px) + up_;
    shadow.p_S = on_desk(tip_px).head<2>();
    return shadow;
  }

  std::filesystem::path folder_;
  json truth_;
  geometry::Camera camera_;
  geometry::Pose X_CD_ = geometry::Pose::Identity();
  Vector3d up_ = Vector3d::Zero();
};

TEST_F(Pencil, RaysOfTheStatedPixelsMeetAtTheLamp) {
  std::vector<TipShadow> shadows;
  for (std::size_t i = 0; i < truth_["images"].size(); ++i)
    shadows.push_back(shadow(pixel(truth_["base_px"][i]), pixel(truth_["shadow_tip_px"][i])));
  const auto lamp = nearest_to_rays(shadows);
  ASSERT_TRUE(lamp);
  EXPECT_LT((*lamp - vector(truth_["light_mm"])).norm(), 8.0);
}

TEST_F(Pencil, TheShadowsTipIsFoundInThePicture) {
  std::vector<TipShadow> shadows;
  for (std::size_t i = 0; i < truth_["images"].size(); ++i) {
    const auto name = "light_" + std::to_string(truth_["images"][i].get<int>()) + ".jpg";
    const cv::Mat grey = cv::imread((folder_ / name).string(), cv::IMREAD_GRAYSCALE);
    ASSERT_FALSE(grey.empty()) << name;
    const Vector2d base = pixel(truth_["base_px"][i]);
    const auto top = camera_.pixel_of(X_CD_ * Vector3d(on_desk(base) + up_));
    ASSERT_TRUE(top);
    const ImageView view{grey.data, grey.cols, grey.rows, static_cast<std::ptrdiff_t>(grey.step), PixelFormat::kGrey8};
    const auto tip = find_rod_shadow(LumaView(view), base, *top);
    ASSERT_TRUE(tip) << name;
    EXPECT_LT((*tip - pixel(truth_["shadow_tip_px"][i])).norm(), 25.0) << name;
    shadows.push_back(shadow(base, *tip));
  }
  const auto lamp = nearest_to_rays(shadows);
  ASSERT_TRUE(lamp);
  EXPECT_LT((*lamp - vector(truth_["light_mm"])).norm(), 40.0);
}

TEST(Rays, ParallelOnesMeetNowhere) {
  TipShadow a;
  a.p_A = Vector3d(0.1, 0.0, 0.1);
  TipShadow b = a;
  b.p_A.y() += 0.2;
  b.p_S.y() += 0.2;
  EXPECT_FALSE(nearest_to_rays(std::vector{a, b}));
  EXPECT_FALSE(nearest_to_rays(std::vector{a}));
  const Vector3d lamp(1.0, 0.5, 2.0);
  a.p_S = shadow_of(lamp, a.p_A).p_BS;
  b.p_S = shadow_of(lamp, b.p_A).p_BS;
  const auto met = nearest_to_rays(std::vector{a, b});
  ASSERT_TRUE(met);
  EXPECT_LT((*met - lamp).norm(), 1e-6);
}

}  // namespace
}  // namespace cgsr::illumination
