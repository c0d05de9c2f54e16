#include "hal/sim/render/sensor.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "hal/sim/scene/portable_math.h"
#include "tests/sim/small_scenes.h"

namespace cgsr::sim {
namespace {

RadianceImage uniform(int width, int height, const Rgb& light) {
  RadianceImage image{width, height, {}};
  for (int i = 0; i < width * height; ++i) image.rgb.insert(image.rgb.end(), {light[0], light[1], light[2]});
  return image;
}

std::vector<std::uint8_t> measure(const RadianceImage& image, const SensorSettings& settings, std::uint64_t number = 0,
                                  std::uint32_t seed = 1) {
  static const Sensor sensor;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(image.width_px * image.height_px * 2));
  Workers workers(1);
  sensor.measure(image, settings, seed, number, {bytes.data(), image.width_px, image.height_px, image.width_px * 2},
                 workers);
  return bytes;
}

SensorSettings quiet(double scale = 1.0) {
  SensorSettings settings;
  settings.exposure_s = scale;
  settings.noise = false;
  return settings;
}

TEST(Sensor, EncodesAsSrgbAndBt601Say) {
  Seeded random(3);
  for (int trial = 0; trial < 3000; ++trial) {
    const Rgb light(static_cast<float>(random.uniform(0, 1)), static_cast<float>(random.uniform(0, 1)),
                    static_cast<float>(random.uniform(0, 1)));
    const auto bytes = measure(uniform(2, 1, light), quiet());
    const Eigen::Vector3d e(srgb_encode(static_cast<double>(light[0])), srgb_encode(static_cast<double>(light[1])),
                            srgb_encode(static_cast<double>(light[2])));
    ASSERT_NEAR(bytes[0], 16 + 65.481 * e[0] + 128.553 * e[1] + 24.966 * e[2], 0.56);
    ASSERT_NEAR(bytes[1], 128 - 37.797 * e[0] - 74.203 * e[1] + 112.0 * e[2], 0.56);
    ASSERT_NEAR(bytes[3], 128 + 112.0 * e[0] - 93.786 * e[1] - 18.214 * e[2], 0.56);
    ASSERT_EQ(bytes[2], bytes[0]);
  }
}

TEST(Sensor, StaysInTheLimitedRange) {
  EXPECT_EQ(measure(uniform(2, 1, Rgb::Zero()), quiet())[0], 16);
  EXPECT_EQ(measure(uniform(2, 1, Rgb::Constant(50)), quiet())[0], 235) << "what overflows the well is white";
  EXPECT_EQ(measure(uniform(2, 1, Rgb(1, 0, 0)), quiet())[3], 240);
}

TEST(Sensor, ExposureGainAndWhiteBalanceMultiply) {
  SensorSettings settings = quiet(0.5);
  settings.gain = 2.0;
  settings.white_balance = Rgb(0.5F, 1.0F, 0.25F);
  EXPECT_EQ(measure(uniform(2, 1, Rgb(0.8F, 0.4F, 0.8F)), settings),
            measure(uniform(2, 1, Rgb(0.4F, 0.4F, 0.2F)), quiet()));
}

// The variance of srgb(value + sigma z), z standard normal, by the trapezoid rule: the curve bends within a few sigma of the dark end.
double variance_encoded(double value, double sigma) {
  double weight = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (double z = -5.0; z <= 5.0; z += 0.01) {
    const double w = std::exp(-0.5 * z * z);
    const double e = srgb_encode(value + sigma * z);
    weight += w;
    sum += w * e;
    squares += w * e * e;
  }
  return squares / weight - (sum / weight) * (sum / weight);
}

// The variance of luma is that of the three channels' shot and read noise through the sRGB curve, plus that of rounding.
TEST(SensorNoise, HasTheStatedVariance) {
  for (const double value : {0.02, 0.1, 0.3, 0.6}) {
    for (const double gain : {1.0, 4.0}) {
      SensorSettings settings;
      settings.exposure_s = 1.0;
      settings.gain = gain;
      const int width = 200;
      const auto bytes = measure(uniform(width, 200, Rgb::Constant(static_cast<float>(value / gain))), settings);
      double sum = 0.0;
      double squares = 0.0;
      const int count = width * 200;
      for (int i = 0; i < count; ++i) {
        const double luma = bytes[static_cast<std::size_t>(2 * i)];
        sum += luma;
        squares += luma * luma;
      }
      const double variance = squares / count - (sum / count) * (sum / count);
      const double read = settings.read_noise_e * gain / settings.full_well_e;
      const double sigma = std::sqrt(value * gain / settings.full_well_e + read * read);
      const double expected =
          variance_encoded(value, sigma) * (65.481 * 65.481 + 128.553 * 128.553 + 24.966 * 24.966) + 1.0 / 12.0;
      EXPECT_NEAR(variance, expected, 0.06 * expected) << value << " at gain " << gain;
    }
  }
}

TEST(SensorNoise, DependsOnSeedAndImageNumberAndRepeats) {
  const RadianceImage image = uniform(64, 48, Rgb::Constant(0.3F));
  SensorSettings settings;
  settings.exposure_s = 1.0;
  EXPECT_EQ(measure(image, settings, 5, 1), measure(image, settings, 5, 1));
  EXPECT_NE(measure(image, settings, 5, 1), measure(image, settings, 6, 1));
  EXPECT_NE(measure(image, settings, 5, 1), measure(image, settings, 5, 2));
}

TEST(AutoExposure, SettlesOnItsGoalFromFarAway) {
  const Sensor sensor;
  Workers workers(1);
  for (const float light : {2.0F, 40.0F, 800.0F}) {
    const RadianceImage image = uniform(16, 16, Rgb::Constant(light));
    std::vector<std::uint8_t> bytes(512);
    const AutoExposure automatic;
    SensorSettings settings;
    double luma = 0.0;
    for (int i = 0; i < 60; ++i) {
      luma = sensor.measure(image, settings, 1, static_cast<std::uint64_t>(i), {bytes.data(), 16, 16, 32}, workers);
      settings = automatic.next(settings, luma);
    }
    EXPECT_NEAR(luma, automatic.goal_luma, 0.02) << light << " cd/m^2";
  }
}

// Under another light the encoded colours of matt surfaces are multiplied channel by channel, but for what the sRGB curve's linear foot
// and its offset add; gloss sends the lamp's own colour along and breaks the model.
TEST(DiagonalModel, HoldsOnMattSurfacesAndIsBrokenByGloss) {
  const auto encoded = [](const Material& material, const Rgb& color) {
    Scene scene = dark_scene();
    scene.add_static("patch", make_rectangle(2, 2), scene.add_material(material));
    add_lamp(scene, {0.6, 0, 1}, 1, 0.0, color);
    scene.lamps[0].lumens = 25.0;
    const RadianceImage image =
        draw(scene, plain_camera(4, 4, 40), pose_at({0, 0, 0}) * look_at({-0.6, 0, 1}, {0, 0, 0}));
    const Rgb light = image.at(2, 2);
    return Eigen::Vector3d(srgb_encode(static_cast<double>(light[0])), srgb_encode(static_cast<double>(light[1])),
                           srgb_encode(static_cast<double>(light[2])));
  };
  Seeded random(11);
  const Rgb white = Rgb::Ones();
  const Rgb warm(1.0F, 0.72F, 0.45F);
  double matt_residual = 0.0;
  double gloss_residual = 0.0;
  Material reference;
  reference.albedo = Rgb::Constant(0.5F);
  const Eigen::Vector3d diagonal = encoded(reference, warm).cwiseQuotient(encoded(reference, white));
  for (int trial = 0; trial < 24; ++trial) {
    Material material;
    material.albedo = Rgb(static_cast<float>(random.uniform(0.03, 0.9)), static_cast<float>(random.uniform(0.03, 0.9)),
                          static_cast<float>(random.uniform(0.03, 0.9)));
    const auto residual = [&] {
      return (encoded(material, warm) - diagonal.cwiseProduct(encoded(material, white))).cwiseAbs().maxCoeff();
    };
    matt_residual = std::max(matt_residual, residual());
    material.specular = 0.3F;
    material.roughness = 0.3F;
    const Eigen::Vector3d glossy = encoded(material, warm);  // the true colour is the matt one's
    material.specular = 0.0F;
    gloss_residual =
        std::max(gloss_residual, (glossy - diagonal.cwiseProduct(encoded(material, white))).cwiseAbs().maxCoeff());
  }
  std::printf("diagonal model on encoded values: residual %.4f on matt surfaces, %.4f with gloss\n", matt_residual,
              gloss_residual);
  EXPECT_LT(matt_residual, 0.03);
  EXPECT_GT(matt_residual, 1e-4) << "the curve is not a power law";
  EXPECT_GT(gloss_residual, 4 * matt_residual);
}

}  // namespace
}  // namespace cgsr::sim
