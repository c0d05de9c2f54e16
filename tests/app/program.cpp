#include "tests/app/program.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

extern char** environ;

namespace cgsr::app::testing {

RunningCgsr::RunningCgsr(const std::vector<std::string>& arguments, const std::string& program) {
  std::string name = (std::filesystem::temp_directory_path() / "cgsr-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  folder_ = name;

  std::vector<std::string> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  const auto open_as = [&](int descriptor, const char* file) {
    posix_spawn_file_actions_addopen(&files, descriptor, (folder_ / file).c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
  };
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  open_as(STDOUT_FILENO, "output");
  open_as(STDERR_FILENO, "errors");
  const int failed = posix_spawn(&process_, program.c_str(), &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (failed != 0) throw std::runtime_error("cgsr could not be started");
}

RunningCgsr::~RunningCgsr() {
  if (!reaped_) {
    kill(process_, SIGKILL);
    waitpid(process_, &status_, 0);
  }
  std::filesystem::remove_all(folder_);
}

void RunningCgsr::send(int signal) const {
  kill(process_, signal);
}

bool RunningCgsr::ended() {
  if (!reaped_) reaped_ = waitpid(process_, &status_, WNOHANG) == process_;
  return reaped_;
}

Outcome RunningCgsr::wait() {
  if (!reaped_) waitpid(process_, &status_, 0);
  reaped_ = true;
  const int code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
  return {code, read_text(folder_ / "output"), read_text(folder_ / "errors")};
}

std::string built_cgsr() {
  return CGSR_PROGRAM;
}

Outcome run_cgsr(const std::vector<std::string>& arguments, const std::string& program) {
  return RunningCgsr(arguments, program).wait();
}

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "cgsr-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::filesystem::remove_all(path_);
}

std::string make_images(const std::filesystem::path& folder, int count, int scale) {
  std::filesystem::create_directories(folder);
  cv::Mat ground(240, 320, CV_8UC3);
  cv::RNG random(7);
  random.fill(ground, cv::RNG::UNIFORM, 90, 150);
  cv::blur(ground, ground, {9, 9});
  for (int i = 0; i < count; ++i) {
    cv::Mat image = ground.clone();
    const cv::Rect patch(40 + 2 * i % 200, 80, 60, 80);
    image(patch).setTo(cv::Scalar(40, 40, 220));
    image(cv::Rect(patch.x, patch.y + 40, 60, 40)).setTo(cv::Scalar(200, 90, 30));
    if (scale != 1) cv::resize(image, image, {}, scale, scale);
    cv::imwrite((folder / fmt::format("{:04}.png", i)).string(), image);
  }
  return "40,80,60,80";
}

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

Keys half_size(Keys more) {
  more.insert({{"camera.pinhole.fx_px", "300.9"},
               {"camera.pinhole.fy_px", "289.7"},
               {"camera.pinhole.cx_px", "159.5"},
               {"camera.pinhole.cy_px", "119.5"},
               {"sim.width_px", "320"},
               {"sim.height_px", "240"},
               {"sim.cache", "false"}});
  return more;
}

std::string quoted(const std::string& text) {
  return '"' + text + '"';
}

std::string extended(const std::string& base, const Keys& keys) {
  std::string text = "extends = " + quoted(base) + "\n";
  for (const auto& [key, value] : keys) text += key + " = " + value + "\n";
  return text;
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
}

}  // namespace cgsr::app::testing
