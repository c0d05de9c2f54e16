#include "tools/lab/tracking/folds.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "tools/lab/scenes/random.h"
#include "tools/lab/source_path.h"

namespace cgsr::lab {
namespace {

std::string lower(std::string_view name) {
  std::string text(name);
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

int hashed_fold(std::string_view scene) {
  std::uint64_t sum = 0;
  for (const char c : scene) sum = Random::mix(sum ^ static_cast<unsigned char>(c));
  return 1 + static_cast<int>(sum % kFolds);
}

}  // namespace

Result<Folds> Folds::read(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return fail(fmt::format("cannot read the folds {}", path.string()));
  Folds folds;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    std::istringstream words(line.substr(0, line.find('#')));
    int fold = 0;
    std::string scene, sequence;
    if (words.str().find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto wrong = [&](const std::string& what) {
      return fail(fmt::format("{}:{}: {}", path.string(), number, what));
    };
    if (!(words >> fold >> scene) || fold < 1 || fold > kFolds) {
      return wrong(fmt::format("expected a fold from 1 to {}, a scene and its sequences", kFolds));
    }
    if (!folds.fold_of_scene_.emplace(scene, fold).second) return wrong(fmt::format("a second line of {}", scene));
    while (words >> sequence) {
      if (!folds.scene_of_sequence_.emplace(lower(sequence), scene).second) {
        return wrong(fmt::format("{} is already in another scene", sequence));
      }
    }
  }
  return folds;
}

Result<Folds> Folds::shipped() {
  return read(source_path("tools/lab/tracking/folds.txt"));
}

std::string Folds::scene_of(std::string_view sequence) const {
  std::string scene = lower(sequence);
  if (const auto listed = scene_of_sequence_.find(scene); listed != scene_of_sequence_.end()) return listed->second;
  while (!scene.empty() &&
         (std::isdigit(static_cast<unsigned char>(scene.back())) != 0 || scene.back() == '-' || scene.back() == '_')) {
    scene.pop_back();
  }
  if (const auto listed = scene_of_sequence_.find(scene); listed != scene_of_sequence_.end()) return listed->second;
  return scene;
}

int Folds::of(std::string_view sequence) const {
  const std::string scene = scene_of(sequence);
  const auto listed = fold_of_scene_.find(scene);
  return listed != fold_of_scene_.end() ? listed->second : hashed_fold(scene);
}

}  // namespace cgsr::lab
