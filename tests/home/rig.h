#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "hal/sim/home/simulated_home.h"

namespace cgsr::sim::test {

/// A scenario file in a folder of its own, in the shipped home unless `text` names another world.
class ScenarioFile {
 public:
  explicit ScenarioFile(const std::string& text) {
    std::string pattern = (std::filesystem::temp_directory_path() / "cgsr-home-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
    std::ofstream(path()) << "world = \"" CGSR_SOURCE_DIR "/config/worlds/home.toml\"\n" << text;
  }
  ~ScenarioFile() { std::filesystem::remove_all(folder_); }
  ScenarioFile(const ScenarioFile&) = delete;
  ScenarioFile& operator=(const ScenarioFile&) = delete;

  [[nodiscard]] std::string path() const { return (folder_ / "scenario.toml").string(); }

 private:
  std::filesystem::path folder_;
};

inline hal::SimulationParameters small(const ScenarioFile& file, int threads = 2) {
  hal::SimulationParameters parameters;
  parameters.scenario = file.path();
  parameters.threads = threads;
  parameters.width_px = 64;
  parameters.height_px = 48;
  return parameters;
}

inline std::unique_ptr<SimulatedHome> make_home(const ScenarioFile& file, int threads = 2) {
  auto home = SimulatedHome::make(small(file, threads));
  EXPECT_TRUE(home) << home.error().message;
  return home ? std::move(*home) : nullptr;
}

inline MonoTime at(double time_s) {
  return MonoTime{seconds(time_s)};
}

}  // namespace cgsr::sim::test
