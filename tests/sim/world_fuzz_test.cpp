// World files are written by people: whatever they say, they are refused with the reason or built and drawn, and nothing crashes.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/sim/worlds/world.h"
#include "platform/config/reader.h"
#include "tests/sim/small_scenes.h"

namespace cgsr::sim {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// What people get wrong: a number, a line that is gone or there twice, a word, a bracket.
class Damage {
 public:
  explicit Damage(std::uint64_t seed) : random_(seed) {}

  void line(std::vector<std::string>& lines) {
    const std::size_t at = below(lines.size());
    switch (below(6)) {
      case 0:
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 1:
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), lines[below(lines.size())]);
        break;
      case 2:
        std::swap(lines[at], lines[below(lines.size())]);
        break;
      case 3:
        letter(lines[at]);
        break;
      default:
        number(lines[at]);
        break;
    }
  }

 private:
  std::size_t below(std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(random_.uniform(0, static_cast<double>(count))));
  }

  void letter(std::string& text) {
    if (!text.empty()) text[below(text.size())] = static_cast<char>(random_.uniform(32, 127));
  }

  void number(std::string& text) {
    static const std::array<std::string, 12> kWrong{"nan", "-inf",   "0",     "-1", "1e300", "1e-300",
                                                    "999", "0.0005", "\"3\"", "[]", "true",  "1e5"};
    const std::size_t digit = text.find_first_of("0123456789", below(text.size() + 1));
    if (digit == std::string::npos) return;
    const std::size_t end = text.find_first_not_of("0123456789.-e", digit);
    text.replace(digit, (end == std::string::npos ? text.size() : end) - digit, kWrong[below(kWrong.size())]);
  }

  Seeded random_;
};

struct Outcomes {
  int unread = 0;
  int refused = 0;
  int drawn = 0;
};

// \return what came of it; the reason of a refusal must name the file.
void try_world(const std::string& toml, const fs::path& name, Outcomes& outcomes) {
  const auto document = config::Document::parse(toml, name.string());
  if (!document) {
    EXPECT_THAT(document.error().message, HasSubstr(name.string()));
    ++outcomes.unread;
    return;
  }
  auto spec = config::read<WorldSpec>(*document);
  if (!spec) {
    EXPECT_THAT(spec.error().message, HasSubstr(name.string()));
    ++outcomes.refused;
    return;
  }
  spec->ambient.corner_reach_m = 0.0;                   // takes long and knows no limits to test
  if (spec->person.size() > 1) spec->person.resize(1);  // so do faces
  const auto world = build_world(*spec, name);
  if (!world) {
    EXPECT_THAT(world.error().message, HasSubstr(name.string()));
    ++outcomes.refused;
    return;
  }
  auto renderer = Renderer::make(world->scene, CameraModel().scaled_to(16, 12), {1, 4});
  if (!renderer) {
    ++outcomes.refused;
    return;
  }
  RadianceImage image;
  const double at_s = 1.5;
  const std::vector<Pose> X_WR = scripted_robots(*world, at_s);
  (*renderer)->draw(state_at(world->scene, at_s, {}, X_WR), X_WR[0] * mount_of(world->scene.robots[0]), image);
  EXPECT_TRUE(std::all_of(image.rgb.begin(), image.rgb.end(),
                          [](float value) { return std::isfinite(value) && value >= 0.0F; }));
  ++outcomes.drawn;
}

TEST(WorldFuzzProperty, WorldsThatShipSurviveDamage) {
  Outcomes outcomes;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(CGSR_SOURCE_DIR) / "config/worlds"))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::vector<std::string> good = lines_of(files[i]);
    for (std::uint64_t trial = 0; trial < 30; ++trial) {
      Damage damage(1000 * i + trial);
      std::vector<std::string> lines = good;
      for (std::uint64_t k = 0; k <= trial % 4; ++k) damage.line(lines);
      std::string toml;
      for (const std::string& line : lines) toml += line + '\n';
      SCOPED_TRACE(files[i].filename().string() + ", trial " + std::to_string(trial));
      try_world(toml, files[i], outcomes);
    }
  }
  std::printf("%d not TOML, %d refused, %d drawn\n", outcomes.unread, outcomes.refused, outcomes.drawn);
  EXPECT_GT(outcomes.unread, 5);
  EXPECT_GT(outcomes.refused, 25);
  EXPECT_GT(outcomes.drawn, 25);
}

// A count that is meant for something else must not fill the memory.
TEST(WorldFault, AbsurdlyManyThingsAreRefused) {
  const std::string toml =
      "[[material]]\nname = \"grey\"\n[[shape]]\nname = \"balls\"\nkind = \"sphere\"\nmaterial = \"grey\"\nsize_m = "
      "[1, 1, 1]\ncount = 10000\n"
      "step_m = [0.01, 0, 0]\n[[robot]]\n";
  const auto document = config::Document::parse(toml, "many.toml");
  ASSERT_TRUE(document);
  const auto spec = config::read<WorldSpec>(*document);
  ASSERT_TRUE(spec) << spec.error().message;
  const auto world = build_world(*spec, "many.toml");
  ASSERT_FALSE(world);
  EXPECT_THAT(world.error().message, HasSubstr("many.toml:3: 'balls': the world has more than"));
}

}  // namespace
}  // namespace cgsr::sim
