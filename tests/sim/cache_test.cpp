#include "hal/sim/cache.h"

#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/sim/fingerprint.h"
#include "hal/sim/truth.h"
#include "tests/sim/small_scenes.h"

namespace cgsr::sim {
namespace {

namespace fs = std::filesystem;

Scene small_room() {
  Scene scene = dark_scene();
  scene.add_static("floor", make_rectangle(6, 6), matt(scene, Rgb(0.7F, 0.5F, 0.3F)));
  Figure ball;
  ball.name = "ball";
  ball.path = *Path::make({{{1, -1, 0.2}}, {{2, 1, 0.2}, 1.0}}, 0.0, 2.0, true);
  scene.figures.push_back(ball);
  Part part;
  part.mesh = make_sphere(0.2);
  part.figure = 0;
  scene.parts.push_back(part);
  add_lamp(scene, {0.5, 0.5, 2.5}, 900);
  return scene;
}

const CameraModel kCamera = CameraModel().scaled_to(64, 48);
const Pose kEye = look_at({-1, 0, 1}, {1.5, 0, 0.2});

struct Taken {
  std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(64 * 48 * 2);
  double luma = 0.0;
  bool operator==(const Taken&) const = default;
};

class SimCache : public testing::Test {
 protected:
  void SetUp() override {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = fs::path(testing::TempDir()) / ("cgsr-cache-test-" + name) / "cache";
    fs::remove_all(folder_.parent_path());
    fs::create_directories(folder_.parent_path());
  }
  void TearDown() override { fs::remove_all(folder_.parent_path()); }

  [[nodiscard]] CacheOptions options() const { return {folder_, 1'000'000'000U}; }

  static Taken take(CachedPhotographer& photographer, const Scene& scene, int number, std::uint32_t seed = 3,
                    const SensorSettings& settings = {}) {
    Taken taken;
    const Moment moment{state_at(scene, 0.1 * number), kEye};
    taken.luma = photographer.take({moment}, settings, {seed, static_cast<std::uint64_t>(number)},
                                   {taken.bytes.data(), 64, 48, 128});
    return taken;
  }

  std::unique_ptr<CachedPhotographer> photographer(const CacheOptions& with) {
    auto made = CachedPhotographer::make(scene_, kCamera, {1, 4}, with);
    EXPECT_TRUE(made) << made.error().message;
    return std::move(*made);
  }

  // The images of a first round, then a second one after `harm` was done to the folder.
  void expect_missed_but_right(const std::function<void()>& harm) {
    const auto fresh = photographer({});
    const auto first = photographer(options());
    for (int i = 0; i < 3; ++i) take(*first, scene_, i);
    ASSERT_EQ(first->counts().kept, 3);
    harm();
    const auto second = photographer(options());
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(take(*second, scene_, i) == take(*fresh, scene_, i)) << i;
    EXPECT_EQ(second->counts().hits, 0);
    EXPECT_EQ(second->counts().misses, 3);
  }

  void for_each_entry(const std::function<void(const fs::path&)>& work) {
    int entries = 0;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      work(entry.path());
      ++entries;
    }
    EXPECT_EQ(entries, 3);
  }

  Scene scene_ = small_room();
  fs::path folder_;
};

using SimCacheReplay = SimCache;
using SimCacheFault = SimCache;

TEST_F(SimCacheReplay, ACachedImageEqualsAFreshOne) {
  const auto fresh = photographer({});
  const auto first = photographer(options());
  std::vector<Taken> images;
  for (int i = 0; i < 4; ++i) images.push_back(take(*first, scene_, i));
  const auto second = photographer(options());
  for (int i = 0; i < 4; ++i) {
    const Taken cached = take(*second, scene_, i);
    EXPECT_TRUE(cached == images[static_cast<std::size_t>(i)]);
    EXPECT_TRUE(cached == take(*fresh, scene_, i));
  }
  EXPECT_EQ(second->counts().hits, 4);
  EXPECT_EQ(second->counts().misses, 0);
  EXPECT_FALSE(images[0] == images[1]);
}

// Whatever an image is made from, a change of it is another image.
TEST_F(SimCache, NothingThatMakesAnImageIsLeftOutOfItsKey) {
  const auto first = photographer(options());
  take(*first, scene_, 0);
  const auto missed = [&](const std::function<void(Scene&)>& change) {
    Scene other = scene_;
    change(other);
    auto made = CachedPhotographer::make(other, kCamera, {1, 4}, options());
    take(**made, other, 0);
    return (*made)->counts().hits == 0;
  };
  EXPECT_FALSE(missed([](Scene&) {})) << "a copy of the scene is the same scene";
  EXPECT_FALSE(missed([](Scene& s) { s.name = "called differently"; }));
  EXPECT_TRUE(missed([](Scene& s) { s.materials[0].albedo[1] += 0.01F; }));
  EXPECT_TRUE(missed([](Scene& s) { s.materials[0].specular = 0.04F; }));
  EXPECT_TRUE(missed([](Scene& s) { s.parts[0].mesh.position_m[0].x() += 0.01F; }));
  EXPECT_TRUE(missed([](Scene& s) { s.parts[1].casts_shadow = false; }));
  EXPECT_TRUE(missed([](Scene& s) { s.lamps[0].radius_m = 0.1; }));
  EXPECT_TRUE(missed([](Scene& s) { s.lamps[0].lumens = 901; }));
  EXPECT_TRUE(missed([](Scene& s) { s.lamps[0].p_WL.x() += 0.1; }));
  EXPECT_TRUE(missed([](Scene& s) { s.ambient.from_below = 0.1; }));
  EXPECT_TRUE(missed([](Scene& s) { s.ambient.illuminance_lux = Rgb::Ones(); }));
  EXPECT_TRUE(missed([](Scene& s) { s.figures[0].path = Path::standing({1, 0, 0.2}, 0.0); }));

  const auto again = photographer(options());
  take(*again, scene_, 1);
  take(*again, scene_, 0, 4);
  SensorSettings brighter;
  brighter.gain = 1.5;
  take(*again, scene_, 0, 3, brighter);
  EXPECT_EQ(again->counts().hits, 0);
  auto coarse = CachedPhotographer::make(scene_, kCamera, {1, 1}, options());
  take(**coarse, scene_, 0);
  EXPECT_EQ((*coarse)->counts().hits, 0) << "without anti-aliasing";
  auto threads = CachedPhotographer::make(scene_, kCamera, {2, 4}, options());
  take(**threads, scene_, 0);
  EXPECT_EQ((*threads)->counts().hits, 1) << "the number of threads changes nothing";
}

TEST_F(SimCacheFault, ADamagedEntryIsAMiss) {
  expect_missed_but_right([&] {
    int kind = 0;
    for_each_entry([&](const fs::path& path) {
      std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
      file.seekp(std::vector<int>{3, 1000, 6200}[static_cast<std::size_t>(kind++)]);  // head, pixels, sum
      file.put('~');
    });
  });
}

TEST_F(SimCacheFault, AnEntryOfTheWrongLengthIsAMiss) {
  expect_missed_but_right([&] {
    int kind = 0;
    for_each_entry([&](const fs::path& path) {
      fs::resize_file(path, std::vector<std::uintmax_t>{0, 700, 7000}[static_cast<std::size_t>(kind++)]);
    });
  });
}

TEST_F(SimCacheFault, AnEntryUnderAnotherOnesNameIsAMiss) {
  expect_missed_but_right([&] {
    std::vector<fs::path> paths;
    for_each_entry([&](const fs::path& path) { paths.push_back(path); });
    fs::rename(paths[0], folder_ / "aside");
    fs::rename(paths[1], paths[0]);
    fs::rename(paths[2], paths[1]);
    fs::rename(folder_ / "aside", paths[2]);
  });
}

TEST_F(SimCacheFault, AFolderThatCannotBeIsNoError) {
  std::ofstream(folder_.parent_path() / "a-file") << "in the way";
  const auto fresh = photographer({});
  const auto cached = photographer({folder_.parent_path() / "a-file/images", 1'000'000U});
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(take(*cached, scene_, i) == take(*fresh, scene_, i));
  EXPECT_FALSE(cached->counts().keeps);
  EXPECT_EQ(cached->counts().misses, 2);
}

// A file that may not grow stands for a disk without room: write() fails half-way either way.
TEST_F(SimCacheFault, AFullDiskIsNoErrorAndLeavesNothingHalfWritten) {
  const auto fresh = photographer({});
  const auto cached = photographer(options());
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{1000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const Taken taken = take(*cached, scene_, 0);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_TRUE(taken == take(*fresh, scene_, 0));
  EXPECT_FALSE(cached->counts().keeps);
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(SimCache, StaysWithinItsSizeAndForgetsWhatWasUsedLongestAgo) {
  constexpr std::uintmax_t kEntry = 24 + 64 * 48 * 2 + 64;
  const CacheOptions four{folder_, 4 * kEntry + 10};
  const auto cached = photographer(four);
  for (int i = 0; i < 3; ++i) take(*cached, scene_, i);
  // Clocks of file systems are coarse: what was used long ago has to look like it.
  for (const auto& entry : fs::directory_iterator(folder_))
    fs::last_write_time(entry, fs::file_time_type::clock::now() - std::chrono::hours(1));
  take(*cached, scene_, 1);
  for (int i = 3; i < 6; ++i) take(*cached, scene_, i);
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::directory_iterator(folder_)) bytes += entry.file_size();
  EXPECT_LE(bytes, four.most_bytes);
  EXPECT_GE(cached->counts().removed, 2);
  const int hits = cached->counts().hits;
  take(*cached, scene_, 1);
  EXPECT_EQ(cached->counts().hits, hits + 1) << "it was used meanwhile";
}

TEST_F(SimCache, AnImageThatIsNotKeptIsAnErrorWhereNothingMayBeDrawn) {
  const auto drawing = photographer(options());
  const Taken drawn = take(*drawing, scene_, 0);
  CacheOptions reading = options();
  reading.draws = false;
  const auto recorded = photographer(reading);
  EXPECT_TRUE(take(*recorded, scene_, 0) == drawn);
  EXPECT_THROW(take(*recorded, scene_, 1), std::runtime_error);
}

TEST(SimImageSource, IsNamedByTheEnvironment) {
  unsetenv("CGSR_SIM_IMAGES");
  EXPECT_EQ(image_source(), ImageSource::kRobotFile);
  setenv("CGSR_SIM_IMAGES", "record", 1);
  EXPECT_EQ(image_source(), ImageSource::kRecord);
  setenv("CGSR_SIM_IMAGES", "recorded", 1);
  EXPECT_EQ(image_source(), ImageSource::kRecorded);
  setenv("CGSR_SIM_IMAGES", "drawn", 1);
  ASSERT_FALSE(image_source());
  EXPECT_NE(image_source().error().message.find("expected 'record' or 'recorded'"), std::string::npos);
  unsetenv("CGSR_SIM_IMAGES");
}

TEST(SimCacheFolder, IsWhereXdgSays) {
  const char* before = std::getenv("XDG_CACHE_HOME");
  const std::string kept = before == nullptr ? "" : before;
  setenv("XDG_CACHE_HOME", "/somewhere", 1);
  EXPECT_EQ(image_cache_folder(), "/somewhere/cgsr/images");
  setenv("XDG_CACHE_HOME", "not/absolute", 1);
  EXPECT_NE(image_cache_folder(), "not/absolute/cgsr/images");
  if (kept.empty()) {
    unsetenv("XDG_CACHE_HOME");
  } else {
    setenv("XDG_CACHE_HOME", kept.c_str(), 1);
  }
}

TEST(ProgramFingerprint, IsTheSameTwiceInOneProgram) {
  EXPECT_EQ(program_fingerprint(), program_fingerprint());
  EXPECT_EQ(program_fingerprint().size(), 64U);
}

}  // namespace
}  // namespace cgsr::sim
