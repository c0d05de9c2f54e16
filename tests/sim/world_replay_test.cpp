// The worlds that ship, played from the first robot's camera: the same bytes of images and truth, however many threads draw.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/sim/cache.h"
#include "hal/sim/truth.h"
#include "hal/sim/worlds/world.h"
#include "platform/config/reader.h"
#include "tests/sim/small_scenes.h"

namespace cgsr::sim {
namespace {

namespace fs = std::filesystem;

constexpr double kRate_hz = 30.0;
const int kImages = std::getenv("CGSR_WHOLE_SCRIPTS") != nullptr ? 1200 : 60;

std::vector<std::string> world_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(fs::path(CGSR_SOURCE_DIR) / "config/worlds")) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Result<World> load(const std::string& name) {
  const fs::path file = fs::path(CGSR_SOURCE_DIR) / "config/worlds" / (name + ".toml");
  const auto spec = config::read_file<WorldSpec>(file);
  if (!spec) return tl::unexpected(spec.error());
  return build_world(*spec, file);
}

// One tick: what the camera delivers, and the truth as a row.
struct Tick {
  std::vector<std::uint8_t> bytes;
  std::string truth;
  bool operator==(const Tick&) const = default;
};

class Player {
 public:
  Player(const World& world, const CameraModel& camera, int threads, CacheOptions cache)
      : world_(world), camera_(camera) {
    auto made = CachedPhotographer::make(world.scene, camera, {threads, 4}, std::move(cache));
    EXPECT_TRUE(made) << made.error().message;
    photographer_ = std::move(*made);
    for (const Lamp& lamp : world.scene.lamps) switches_[lamp.switch_name] = true;
  }

  Tick play(int number) {
    const double at_s = number / kRate_hz;
    const Pose X_WR = scripted_robots(world_, at_s)[0];
    const Moment moment{state_at(world_.scene, at_s, switches_, {X_WR}), X_WR * mount_of(world_.scene.robots[0])};
    Tick tick;
    tick.bytes.resize(static_cast<std::size_t>(camera_.width_px * camera_.height_px * 2));
    photographer_->take({moment}, world_.sensor, {7, static_cast<std::uint64_t>(number)},
                        {tick.bytes.data(), camera_.width_px, camera_.height_px, camera_.width_px * 2});
    const Truth truth = truth_at(photographer_->renderer(), moment.state, moment.X_WC, {0, 0, number == 0, {0.05, 4}});
    tick.truth = truth_csv_row(number, truth);
    if (truth.masks) {
      tick.truth.append(truth.masks->possibly_shaded.begin(), truth.masks->possibly_shaded.end());
      tick.truth.append(truth.masks->surface_shaded.begin(), truth.masks->surface_shaded.end());
    }
    return tick;
  }

  [[nodiscard]] const ImageCache::Counts& counts() const { return photographer_->counts(); }

 private:
  const World& world_;
  CameraModel camera_;
  SwitchStates switches_;
  std::unique_ptr<CachedPhotographer> photographer_;
};

class WorldReplay : public testing::TestWithParam<std::string> {};

TEST_P(WorldReplay, OneThreadAndTwoMakeTheSameBytes) {
  const auto world = load(GetParam());
  ASSERT_TRUE(world) << world.error().message;
  const CameraModel small = CameraModel().scaled_to(160, 120);
  Player one(*world, small, 1, {});
  Player two(*world, small, 2, {});
  for (int i = 0; i < kImages; ++i) {
    const Tick a = one.play(i);
    const Tick b = two.play(i);
    ASSERT_TRUE(a.bytes == b.bytes) << "image " << i;
    ASSERT_EQ(a.truth, b.truth) << "tick " << i;
  }
  Player full_one(*world, CameraModel(), 1, {});
  Player full_two(*world, CameraModel(), 2, {});
  for (int i = 0; i < 2; ++i)
    ASSERT_TRUE(full_one.play(30 * i) == full_two.play(30 * i)) << "640x480, image " << 30 * i;
}

TEST_P(WorldReplay, ACachedImageEqualsAFreshOne) {
  const fs::path folder = fs::path(testing::TempDir()) / ("cgsr-world-cache-" + GetParam());
  fs::remove_all(folder);
  const auto world = load(GetParam());
  ASSERT_TRUE(world) << world.error().message;
  const CameraModel small = CameraModel().scaled_to(80, 60);
  std::vector<Tick> fresh;
  {
    Player first(*world, small, 1, {folder, 100'000'000U});
    for (int i = 0; i < 5; ++i) fresh.push_back(first.play(6 * i));
    EXPECT_EQ(first.counts().misses, 5);
  }
  const auto again = load(GetParam());  // built anew, so that nothing but the cache is shared
  Player second(*again, small, 2, {folder, 100'000'000U});
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(second.play(6 * i) == fresh[static_cast<std::size_t>(i)]) << i;
  EXPECT_EQ(second.counts().hits, 5);
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Worlds, WorldReplay, testing::ValuesIn(world_names()), [](const auto& world) {
  std::string name = world.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace cgsr::sim
