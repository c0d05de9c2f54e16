#include "pipeline/render/sphere_groups.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/render/box_map.h"

namespace cgsr::render {
namespace {

using Sphere = SphereGroups::Sphere;

std::vector<Sphere> random_spheres(std::mt19937& random, std::size_t count) {
  std::uniform_real_distribution<float> place(-30.0F, 30.0F);
  std::uniform_real_distribution<float> radius(0.05F, 1.0F);
  std::uniform_int_distribution<std::uint32_t> weight(1, 9);
  std::vector<Sphere> spheres;
  spheres.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    spheres.push_back({{place(random), place(random), 0.1F * place(random)}, radius(random), weight(random)});
  return spheres;
}

Frustum random_frustum(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-20.0, 20.0);
  return frustum_of(looking_from({place(random), place(random), 1.0}, {place(random), place(random), 0.0}), View(),
                    0.05);
}

float near_m(const Sphere& sphere, const Frustum& frustum) {
  return (sphere.centre - frustum.p_WC).norm() - sphere.radius;
}

float looks_large(const Sphere& sphere, const Frustum& frustum) {
  return sphere.radius / (sphere.centre - frustum.p_WC).norm();
}

bool in_view(const Sphere& sphere, const Frustum& frustum) {
  for (std::size_t k = 0; k < frustum.normal.size(); ++k) {
    if (frustum.normal[k].dot(sphere.centre) + frustum.offset[k] < -sphere.radius) return false;
  }
  return true;
}

// By looking at every sphere.
std::vector<std::uint32_t> all_in_view(const std::vector<Sphere>& spheres, const Frustum& frustum) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < spheres.size(); ++i) {
    if (in_view(spheres[i], frustum)) found.push_back(i);
  }
  return found;
}

TEST(SphereGroupsProperty, NothingNearerThanItsReachIsMissing) {
  std::mt19937 random(3);
  for (const std::size_t count : {500U, 20000U}) {
    const auto spheres = random_spheres(random, count);
    const SelectionLimits limits{.max_visited = 4096, .max_chosen = 300, .max_weight = 900};
    SphereGroups groups(spheres, limits, Preference::kNearest);
    for (int trial = 0; trial < 100; ++trial) {
      const Frustum frustum = random_frustum(random);
      const auto answer = groups.select(frustum);
      std::vector<std::uint32_t> chosen(answer.begin(), answer.end());
      std::sort(chosen.begin(), chosen.end());
      std::uint32_t weight = 0;
      for (const std::uint32_t i : chosen) weight += spheres[i].weight;
      EXPECT_LE(chosen.size(), 300U);
      EXPECT_LE(weight, 900U);
      const auto wanted = all_in_view(spheres, frustum);
      if (groups.reach_m() == SphereGroups::kEverything) {
        EXPECT_EQ(chosen, wanted);
      }
      for (const std::uint32_t i : wanted) {
        if (near_m(spheres[i], frustum) >= groups.reach_m() - 1e-4F) continue;
        EXPECT_TRUE(std::binary_search(chosen.begin(), chosen.end(), i));
      }
    }
  }
}

TEST(SphereGroupsProperty, TheLargestWithinADistanceAreKept) {
  std::mt19937 random(4);
  const auto spheres = random_spheres(random, 5000);
  SphereGroups groups(spheres, {.max_visited = 8192, .max_chosen = 100}, Preference::kLargest);
  constexpr float kWithin_m = 20.0F;
  for (int trial = 0; trial < 100; ++trial) {
    const Frustum frustum = random_frustum(random);
    auto wanted = all_in_view(spheres, frustum);
    std::erase_if(wanted, [&](std::uint32_t i) { return near_m(spheres[i], frustum) > kWithin_m; });
    std::sort(wanted.begin(), wanted.end(), [&](std::uint32_t a, std::uint32_t b) {
      return looks_large(spheres[a], frustum) > looks_large(spheres[b], frustum);
    });
    if (wanted.size() > 100) wanted.resize(100);
    std::sort(wanted.begin(), wanted.end());
    const auto chosen = groups.select(frustum, 0.0, kWithin_m);
    EXPECT_EQ(std::vector<std::uint32_t>(chosen.begin(), chosen.end()), wanted);
  }
}

}  // namespace
}  // namespace cgsr::render
