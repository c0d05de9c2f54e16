#include "pipeline/shade/shadow_volumes.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/render/box_map.h"
#include "tests/shade/table_map.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/counted_budget.h"

namespace cgsr::shade {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using geometry::Camera;
using geometry::Pose;
using render::add_box;
using render::add_rectangle;
using render::looking_from;
using world::Map;

std::size_t count(const std::vector<std::uint8_t>& mask) {
  return mask.size() - static_cast<std::size_t>(std::count(mask.begin(), mask.end(), 0));
}

Eigen::Vector3d on_floor(const Pose& X_WC, const Camera& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d ideal = camera.ideal_of(pixel);
  const Vector3d ray = X_WC.linear() * Vector3d(ideal.x(), ideal.y(), 1.0);
  return X_WC.translation() - ray * (X_WC.translation().z() / ray.z());
}

// Lamp above the table: its shadow on the floor is the table's rectangle, stretched from the lamp's foot by h / (h - z).
TEST(ShadowVolumes, TheShadowOfATableIsWhereGeometrySaysThroughALens) {
  const Map map = table_over_floor();
  Camera camera;
  camera.k1 = -0.075;
  camera.k2 = 0.045;
  const Pose X_WC = looking_from({-2.5, 0.0, 1.8}, {0.0, 0.3, 0.2});
  const Vector3d p_WL(0.3, 0.2, 2.75);
  ShadowVolumes volumes(map, {});
  const ShadeMasks& masks = volumes.look(X_WC, camera, p_WL);
  int wrong = 0;
  int shaded = 0;
  for (int y = 0; y < masks.height; ++y) {
    for (int x = 0; x < masks.width; ++x) {
      const Vector3d p = on_floor(X_WC, camera, {(x + 0.5) * 4 - 0.5, (y + 0.5) * 4 - 0.5});
      const Vector3d at =
          p_WL + (p - p_WL) * ((p_WL.z() - 0.72) / p_WL.z());  // on the way to the lamp, at the table's lower face
      const Vector3d above = p_WL + (p - p_WL) * ((p_WL.z() - 0.75) / p_WL.z());
      const bool expected = (std::abs(at.x()) < 0.6 && std::abs(at.y()) < 0.4) ||
                            (std::abs(above.x()) < 0.6 && std::abs(above.y()) < 0.4);
      const bool found = masks.surface_shaded[static_cast<std::size_t>(y * masks.width + x)] != 0;
      shaded += expected ? 1 : 0;
      wrong += expected != found ? 1 : 0;
    }
  }
  EXPECT_GT(shaded, 300);
  EXPECT_LE(wrong, shaded / 50);
}

TEST(ShadowVolumes, RaysThatCrossTheVolumeArePossiblyShaded) {
  const Map map = table_over_floor();
  const Pose X_WC = looking_from({-4.0, 0.0, 1.2}, {0.0, 0.0, 0.3});
  ShadowVolumes volumes(map, {});
  const ShadeMasks& masks = volumes.look(X_WC, Camera(), {0.0, 0.0, 2.75});
  EXPECT_GT(count(masks.possibly_shaded), count(masks.surface_shaded));
  for (std::size_t i = 0; i < masks.surface_shaded.size(); ++i) {
    ASSERT_LE(masks.surface_shaded[i], masks.possibly_shaded[i]);
  }
  // Under the table, before the lit floor behind it: through the volume. To the side of it: not.
  const auto at = [&](const Vector3d& p_W) {
    const auto pixel = Camera().pixel_of(X_WC.inverse() * p_W);
    const auto x = static_cast<int>((pixel->x() + 0.5) / 4);
    const auto y = static_cast<int>((pixel->y() + 0.5) / 4);
    return masks.possibly_shaded[static_cast<std::size_t>(y * masks.width + x)] != 0;
  };
  EXPECT_TRUE(at({0.0, 0.0, 0.4}));
  EXPECT_TRUE(at({0.0, 0.3, 0.6}));
  EXPECT_FALSE(at({0.0, 1.2, 0.4}));
  EXPECT_FALSE(at({0.0, 0.0, 1.0})) << "above the table";
}

TEST(ShadowVolumes, ACameraInsideOfAVolumeSeesShadeEverywhere) {
  const Map map = table_over_floor();
  ShadowVolumes volumes(map, {});
  const ShadeMasks& masks = volumes.look(looking_from({0.0, 0.0, 0.4}, {3.0, 0.0, 0.0}), Camera(), {0.0, 0.0, 2.75});
  std::size_t floor = 0;
  for (int y = 70; y < masks.height; ++y) {
    for (int x = 0; x < masks.width; ++x) {
      floor += masks.possibly_shaded[static_cast<std::size_t>(y * masks.width + x)] != 0 ? 1 : 0;
    }
  }
  EXPECT_EQ(floor, static_cast<std::size_t>(50 * masks.width));
  EXPECT_LT(count(masks.surface_shaded), floor / 2);
}

TEST(ShadowVolumes, WhatDidNotMoveIsKeptAndWhatDidIsDrawnAnew) {
  const Map map = table_over_floor();
  ShadowVolumes volumes(map, {});
  const Pose X_WC = looking_from({-4.0, 0.0, 1.2}, {0.0, 0.0, 0.3});
  const auto first = volumes.look(X_WC, Camera(), {0.0, 0.0, 2.75}).surface_shaded;
  EXPECT_EQ(volumes.look(X_WC, Camera(), {0.0, 0.0, 2.75}).surface_shaded, first);
  const auto moved = volumes.look(X_WC, Camera(), {1.0, 0.0, 2.75}).surface_shaded;
  EXPECT_NE(moved, first);
  EXPECT_EQ(volumes.look(X_WC, Camera(), {0.0, 0.0, 2.75}).surface_shaded, first);
  EXPECT_GT(count(volumes.look(X_WC, Camera(), {0.0, 0.0, 2.75}, 2).surface_shaded), count(first));
  EXPECT_EQ(volumes.look(X_WC, Camera(), {0.0, 0.0, 2.75}).surface_shaded, first);
}

TEST(ShadowVolumes, APlaceThatIsPreparedInStepsGivesTheSameMasks) {
  const Map map = table_over_floor();
  const Pose X_WC = looking_from({-4.0, 0.0, 1.2}, {0.0, 0.0, 0.3});
  const Vector3d before(0.0, 0.0, 2.75);
  const Vector3d after(1.0, 0.4, 2.2);
  ShadowVolumes whole(map, {});
  const ShadeMasks old = whole.look(X_WC, Camera(), before);
  const ShadeMasks wanted = whole.look(X_WC, Camera(), after);
  const std::size_t wanted_silhouettes = whole.silhouettes();

  for (const int units : {1, 3, 20}) {
    ShadowVolumes volumes(map, {});
    volumes.look(X_WC, Camera(), before);
    int images = 1;
    for (; images < 1000; ++images) {
      CountedBudget budget(units);
      if (volumes.prepare(after, budget)) break;
      EXPECT_EQ(volumes.look(X_WC, Camera(), before).possibly_shaded, old.possibly_shaded) << "the old place serves";
    }
    EXPECT_GT(images, 2);
    EXPECT_LT(images, 1000);
    EXPECT_EQ(volumes.silhouettes(), wanted_silhouettes);
    EXPECT_EQ(volumes.look(X_WC, Camera(), after).surface_shaded, wanted.surface_shaded);
    EXPECT_EQ(volumes.look(X_WC, Camera(), after).possibly_shaded, wanted.possibly_shaded);
  }
}

TEST(ShadowVolumes, AnotherPlaceBeginsAnewAndTheSameOneGoesOn) {
  const Map map = table_over_floor();
  ShadowVolumes volumes(map, {});
  CountedBudget some(5);
  EXPECT_FALSE(volumes.prepare({1.0, 0.4, 2.2}, some));
  UnlimitedBudget rest;
  EXPECT_TRUE(volumes.prepare({0.0, 0.0, 2.75}, rest));
  ShadowVolumes fresh(map, {});
  EXPECT_TRUE(fresh.prepare({0.0, 0.0, 2.75}, rest));
  EXPECT_EQ(volumes.silhouettes(), fresh.silhouettes());
  CountedBudget none(0);
  EXPECT_TRUE(volumes.prepare({0.0, 0.0, 2.75}, none)) << "nothing is left to do";
}

ShadeErrors errors_of(double lamp_m, double place_m, double turn_rad) {
  ShadeErrors errors;
  errors.lamp = lamp_m * lamp_m * Eigen::Matrix3d::Identity();
  errors.pose.topLeftCorner<3, 3>() = place_m * place_m * Eigen::Matrix3d::Identity();
  errors.pose.bottomRightCorner<3, 3>() = turn_rad * turn_rad * Eigen::Matrix3d::Identity();
  return errors;
}

TEST(ShadowVolumes, WhatIsUncertainMayBeShadedAndWhatIsCertainIsKept) {
  const Map map = table_over_floor();
  const Pose X_WC = looking_from({-4.0, 0.0, 1.2}, {0.0, 0.0, 0.3});
  const Vector3d p_WL(0.3, 0.2, 2.75);
  ShadeParameters parameters;
  parameters.map_sigma_m = 0.0;
  ShadowVolumes volumes(map, parameters);
  const ShadeMasks certain = volumes.look(X_WC, Camera(), p_WL);
  EXPECT_EQ(volumes.look(X_WC, Camera(), p_WL, ShadeErrors{}).possibly_shaded, certain.possibly_shaded);
  std::size_t before = count(certain.possibly_shaded);
  for (const ShadeErrors& errors : {errors_of(0.1, 0.0, 0.0), errors_of(0.1, 0.03, 0.0), errors_of(0.1, 0.03, 0.01)}) {
    const ShadeMasks& masks = volumes.look(X_WC, Camera(), p_WL, errors);
    EXPECT_EQ(masks.surface_shaded, certain.surface_shaded);
    for (std::size_t i = 0; i < masks.possibly_shaded.size(); ++i) {
      ASSERT_GE(masks.possibly_shaded[i], certain.possibly_shaded[i]);
    }
    EXPECT_GT(count(masks.possibly_shaded), before);
    before = count(masks.possibly_shaded);
  }
}

TEST(ShadowVolumesProperty, TheWidenedMaskHoldsWhatLampAndPoseDoNotKnow) {
  std::mt19937 random(7);
  const auto normal = [&] {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += random() / 4294967296.0;
    return sum;
  };
  const Map map = table_over_floor();
  const Pose X_WC = looking_from({-3.5, 0.5, 1.2}, {0.0, 0.0, 0.3});
  const Vector3d p_WL(0.3, 0.2, 2.75);
  ShadowVolumes volumes(map, {});
  const auto truth = volumes.look(X_WC, Camera(), p_WL).possibly_shaded;
  const ShadeErrors errors = errors_of(0.04, 0.015, 0.003);
  double missed = 0.0;
  double missed_unwidened = 0.0;
  double area = 0.0;
  constexpr int kTrials = 60;
  for (int trial = 0; trial < kTrials; ++trial) {
    geometry::Vector6d step;
    for (Eigen::Index i = 0; i < 6; ++i) step[i] = normal() * std::sqrt(errors.pose(i, i));
    const Vector3d off = Vector3d(normal(), normal(), normal()) * 0.04;
    const Pose believed = geometry::moved(X_WC, step);
    const auto misses = [&](const std::vector<std::uint8_t>& mask) {
      double sum = 0.0;
      for (std::size_t i = 0; i < mask.size(); ++i) sum += truth[i] > mask[i] ? 1.0 : 0.0;
      return sum / static_cast<double>(count(truth)) / kTrials;
    };
    missed_unwidened += misses(volumes.look(believed, Camera(), p_WL + off).possibly_shaded);
    const auto& mask = volumes.look(believed, Camera(), p_WL + off, errors).possibly_shaded;
    missed += misses(mask);
    area += static_cast<double>(count(mask)) / static_cast<double>(count(truth)) / kTrials;
  }
  EXPECT_GT(missed_unwidened, 0.02);
  EXPECT_LT(missed, 0.002);
  EXPECT_LT(area, 1.6);
}

// The lamp stands behind a panel: all of its face is shaded, and what it grows by is the camera's error at the panel's own depth.
TEST(ShadowVolumes, AShadedFaceGrowsByWhatItsDepthSays) {
  const ShadeErrors errors = errors_of(0.0, 0.012, 0.0);
  ShadeParameters parameters;
  parameters.sigmas = 2.0;
  parameters.map_sigma_m = 0.0;
  const auto width_cells = [&](float away_m, bool widened) {
    Map map;
    add_rectangle(map, {away_m, -0.25F * away_m, 1.0F - 0.15F * away_m}, {0.0F, 0.5F * away_m, 0.0F},
                  {0.0F, 0.0F, 0.3F * away_m});
    ShadowVolumes volumes(map, parameters);
    const Pose X_WC = looking_from({0.0, 0.0, 1.0}, {1.0, 0.0, 1.0});
    const Vector3d p_WL(away_m + 1.0, 0.0, 1.0);
    const auto& masks = widened ? volumes.look(X_WC, Camera(), p_WL, errors) : volumes.look(X_WC, Camera(), p_WL);
    const auto row = masks.possibly_shaded.begin() + 60 * masks.width;
    return static_cast<int>(masks.width - std::count(row, row + masks.width, 0));
  };
  EXPECT_EQ(width_cells(1.0F, false), width_cells(4.0F, false)) << "the same angle";
  EXPECT_GE(width_cells(1.0F, true) - width_cells(1.0F, false), 2 * 4) << "2 sigmas at 1 m: 4 cells a side";
  EXPECT_EQ(width_cells(4.0F, true) - width_cells(4.0F, false), 2 * 1);
}

// By the definition, at random: a ray from where each cell looks to the lamp, past every triangle.
TEST(ShadowVolumesProperty, SurfacesAreShadedWhereARayToTheLampIsStopped) {
  std::mt19937 random(5);
  const auto uniform = [&](double least, double most) { return least + (most - least) * random() / 4294967296.0; };
  int wrong = 0;
  int cells = 0;
  for (int trial = 0; trial < 6; ++trial) {
    Map map;
    add_rectangle(map, {-6.0F, -6.0F, 0.0F}, {12.0F, 0.0F, 0.0F}, {0.0F, 12.0F, 0.0F});
    for (int i = 0; i < 12; ++i) {
      const Vector3f a(static_cast<float>(uniform(-3, 3)), static_cast<float>(uniform(-3, 3)),
                       static_cast<float>(uniform(0, 0.8)));
      add_box(map, a, a + Vector3f(static_cast<float>(uniform(0.1, 0.8)), 0.3F, 0.2F));
    }
    const Pose X_WC = looking_from({-5.0, uniform(-2, 2), 1.3}, {0.0, 0.0, 0.2});
    const Vector3d p_WL(uniform(-2, 2), uniform(-2, 2), 2.75);
    ShadowVolumes volumes(map, {});
    const ShadeMasks& masks = volumes.look(X_WC, Camera(), p_WL);
    const auto first_hit = [&](const Vector3d& from, const Vector3d& way, std::uint32_t without) {
      double nearest = 1e9;
      std::uint32_t found = world::kNone;
      for (std::uint32_t s = 0; s < map.surfaces.size(); ++s) {
        if (s == without) continue;
        for (std::uint32_t k = 0; k < 2; ++k) {
          const auto& t = map.triangles[map.surfaces[s].first_triangle + k];
          const Vector3d a = map.vertices[t[0]].cast<double>();
          const Vector3d e1 = map.vertices[t[1]].cast<double>() - a;
          const Vector3d e2 = map.vertices[t[2]].cast<double>() - a;
          const Vector3d h = way.cross(e2);
          const double det = e1.dot(h);
          if (std::abs(det) < 1e-12) continue;
          const Vector3d o = from - a;
          const double u = o.dot(h) / det;
          const double v = way.dot(o.cross(e1)) / det;
          const double at = e2.dot(o.cross(e1)) / det;
          if (u < 0 || v < 0 || u + v > 1 || at <= 0 || at >= nearest) continue;
          nearest = at;
          found = s;
        }
      }
      return std::pair(nearest, found);
    };
    for (int y = 1; y < masks.height; y += 3) {
      for (int x = 1; x < masks.width; x += 3) {
        const Eigen::Vector2d ideal = Camera().ideal_of({(x + 0.5) * 4 - 0.5, (y + 0.5) * 4 - 0.5});
        const Vector3d way = X_WC.linear() * Vector3d(ideal.x(), ideal.y(), 1.0);
        const auto [depth, surface] = first_hit(X_WC.translation(), way, world::kNone);
        if (surface == world::kNone) continue;
        const Vector3d p = X_WC.translation() + depth * way;
        const bool expected = first_hit(p_WL, p - p_WL, surface).first < 1.0 - 1e-5;
        ++cells;
        wrong += expected != (masks.surface_shaded[static_cast<std::size_t>(y * masks.width + x)] != 0) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(cells, 5000);
  EXPECT_LE(wrong, cells / 200) << "of " << cells;
}

TEST(ShadowVolumesFault, NoMapNoShadeAndALampInTheFloorHarmsNothing) {
  const Map nothing;
  ShadowVolumes none(nothing, {});
  EXPECT_EQ(count(none.look(Pose::Identity(), Camera(), {0.0, 0.0, 2.0}).possibly_shaded), 0U);
  const Map map = table_over_floor();
  ShadowVolumes volumes(map, {});
  const Pose X_WC = looking_from({-4.0, 0.0, 1.2}, {0.0, 0.0, 0.3});
  volumes.look(X_WC, Camera(), {0.0, 0.0, 0.0});
  volumes.look(X_WC, Camera(), {std::nan(""), 0.0, 2.0});
  volumes.look(X_WC, Camera(), X_WC.translation());
  EXPECT_GT(count(volumes.look(X_WC, Camera(), {0.0, 0.0, 2.75}).surface_shaded), 100U);
}

TEST(ShadowVolumesAlloc, LookingTakesNoMemory) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "SKIPPED: a sanitizer brings its own malloc";
  const Map map = table_over_floor();
  ShadowVolumes volumes(map, {});
  const test::AllocationGuard guard;
  for (int i = 0; i < 5; ++i) {
    volumes.look(looking_from({-4.0, 0.1 * i, 1.2}, {0.0, 0.0, 0.3}), Camera(), {0.1 * (i / 2), 0.0, 2.75}, i);
  }
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::shade
