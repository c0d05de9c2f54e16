#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace cgsr::app::testing {

/// What a finished program left behind.
struct Outcome {
  int exit_code = -1;  ///< 128 + signal when it was killed.
  std::string output;  ///< standard output.
  std::string errors;  ///< standard error.
};

/// Where the cgsr that was built lies.
std::string built_cgsr();

/// Runs cgsr with `arguments` and waits for it. Neither of its streams is a terminal.
/// \param program  the one that was built, unless a copy is meant.
Outcome run_cgsr(const std::vector<std::string>& arguments, const std::string& program = built_cgsr());

/// Starts cgsr and returns at once.
class RunningCgsr {
 public:
  explicit RunningCgsr(const std::vector<std::string>& arguments, const std::string& program = built_cgsr());
  ~RunningCgsr();
  RunningCgsr(const RunningCgsr&) = delete;
  RunningCgsr& operator=(const RunningCgsr&) = delete;

  void send(int signal) const;
  Outcome wait();
  [[nodiscard]] bool ended();
  [[nodiscard]] pid_t process() const { return process_; }

 private:
  std::filesystem::path folder_;
  pid_t process_ = -1;
  int status_ = 0;
  bool reaped_ = false;
};

/// A folder that is gone when the test ends.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A short made video folder of 320x240 px: a two-coloured patch of 60x80 px that moves over cluttered ground.
/// \param scale  enlarges the images.
/// \return the region of the patch in image 0 of scale 1 as --region takes it.
std::string make_images(const std::filesystem::path& folder, int count, int scale = 1);

std::string read_text(const std::string& path);
void write_text(const std::string& path, const std::string& text);

/// Values of configuration keys, as TOML, by the path of the key.
using Keys = std::map<std::string, std::string>;

/// \return the keys of a simulated robot whose images have half the size, 320x240, and are kept nowhere, with some more.
Keys half_size(Keys more);

/// \return `text` as a TOML value.
std::string quoted(const std::string& text);

/// \return a robot's file that extends `base`, which is an absolute path, and sets some keys.
std::string extended(const std::string& base, const Keys& keys);

/// Writes `to` for the first `from`; without one the test has failed.
void replace(std::string& text, const std::string& from, const std::string& to);

}  // namespace cgsr::app::testing
