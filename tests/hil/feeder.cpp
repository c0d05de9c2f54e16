// What surrounds the robot computer, played to the real drivers: images into a video output, the simulated Segway on a CAN interface, the arming
// switch on a line of gpio-sim. Runs in the guest beside the service (docs/hil.md).
//
// The first image stands until the file `play` appears in the control folder; then the images follow at their rate and the switch is pressed when
// it is due. Files of the names `silent`, `estop`, `poweroff` and `flagged` in that folder are faults as long as they exist; while `still` exists, no
// image is written. SIGTERM ends it: only then it writes what it did and what it cost.
#include <pthread.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "platform/clock.h"
#include "tests/hil/base_feeder.h"
#include "tests/hil/flag_button.h"
#include "tests/hil/image_feeder.h"
#include "tests/hil/image_order.h"

namespace cgsr::hil {
namespace {

constexpr Duration kBasePeriod =
    seconds(0.01);  // a set of status messages, and the pace of everything here but the images

struct Options {
  ImageFeed images;
  double rate_hz = 30.0;
  std::string can;
  std::string controls = "/run/hil";
  std::string arming_pull;  ///< gpio-sim's file of the line; empty: nobody presses.
  double arm_after_s = 1.5;
  std::string camera;  ///< vivid's, whose images are flagged; empty: none.
  std::string motion;  ///< what the base says of its motion while the images play; empty: what it does.
  double end_of_frame_offset_s = 0.025;
  std::string json;
  std::string truth;
  double keep_s = 3600.0;
};

struct Controls {
  std::atomic<bool> play{false};
  std::atomic<bool> still{false};
  std::atomic<bool> silent{false};
  std::atomic<bool> emergency_stop{false};
  std::atomic<bool> powered_off{false};
  std::atomic<MonoTime> first_played{MonoTime{}};  ///< when the first image went out; the clock's zero: not yet.
};

/// What one thread did and what it cost.
struct Cost {
  std::uint64_t cycles = 0;
  Duration worst_lateness{};
  Duration cpu{};
};

std::atomic<bool> stop_requested{false};

Duration thread_cpu_time() {
  timespec spent{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
  return std::chrono::seconds(spent.tv_sec) + Duration{spent.tv_nsec};
}

/// Above every thread of the robot: a camera and a base take no turns with it.
void run_ahead_of_all(const char* name, int priority) {
  pthread_setname_np(pthread_self(), name);
  const sched_param parameter{priority};
  if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter) != 0) {
    fmt::print(stderr, "feeder: {} runs without real-time priority\n", name);
  }
}

template <class Step>
void cycle(Duration period, Cost& cost, Step step) {
  RealClock clock;
  Periodic due(clock, period);
  while (!stop_requested.load()) {
    const MonoTime at = due.wait();
    cost.worst_lateness = std::max(cost.worst_lateness, clock.now() - at);
    step(at);
    ++cost.cycles;
  }
  cost.cpu = thread_cpu_time();
}

bool exists(const std::string& folder, const char* name) {
  return access((folder + "/" + name).c_str(), F_OK) == 0;
}

void write_text(const std::string& file, const char* text) {
  std::ofstream(file) << text;
}

/// Images: the first one until `play`, then each once, then the last one.
class ImageThread {
 public:
  ImageThread(const Options& options, Controls& controls)
      : feeder_(options.images), controls_(controls), period_(seconds(1.0 / options.rate_hz)) {}

  Result<void> load() {
    auto loaded = feeder_.load(false);
    if (loaded) order_.emplace(feeder_.images());
    return loaded;
  }
  Result<void> load_rest() { return feeder_.load_rest(); }

  void run() {
    run_ahead_of_all("feed images", 90);
    cycle(period_, cost, [this](MonoTime at) { step(at); });
    feeder_.close();
  }

  [[nodiscard]] nlohmann::ordered_json report() const {
    return {{"written", written_},
            {"refused", refused_},
            {"played", order_ ? order_->played() : 0},
            {"of", feeder_.images()},
            {"reopened", opened_ - 1},
            {"first_played_s", to_seconds(controls_.first_played.load().time_since_epoch())},
            {"cycles", cost.cycles},
            {"worst_lateness_us", to_seconds(cost.worst_lateness) * 1e6},
            {"cpu_us_each", cost.cycles == 0 ? 0.0 : to_seconds(cost.cpu) * 1e6 / static_cast<double>(cost.cycles)}};
  }

  Cost cost;

 private:
  void step(MonoTime at) {
    if (!feeder_.is_open()) {
      if (auto opened = feeder_.open(); !opened) return report_once(opened.error().message);
      ++opened_;
    }
    const ImageOrder::Wanted wanted{controls_.play.load(), controls_.still.load()};
    const auto image = order_->next(wanted);
    if (!image) return;
    if (order_->plays_on(wanted) && order_->played() == 0) controls_.first_played.store(at);
    if (auto put = feeder_.put(*image); !put) {
      ++refused_;
      return report_once(put.error().message);
    }
    ++written_;
    order_->written(wanted);
  }

  void report_once(const std::string& problem) {
    if (problem != problem_) fmt::print(stderr, "feeder: {}\n", problem);
    problem_ = problem;
  }

  ImageFeeder feeder_;
  Controls& controls_;
  Duration period_;
  std::optional<ImageOrder> order_;  // once it is known how many there are
  std::uint64_t written_ = 0;
  std::uint64_t refused_ = 0;
  int opened_ = 0;
  std::string problem_;
};

/// The base, the switch, and a look at the control folder, every 10 ms.
class BaseThread {
 public:
  BaseThread(const Options& options, Controls& controls, RecordedMotion* motion)
      : options_(options), controls_(controls), motion_(motion) {}

  void run() {
    run_ahead_of_all("feed base", 91);
    cycle(kBasePeriod, cost, [this](MonoTime at) { step(at); });
  }

  [[nodiscard]] nlohmann::ordered_json report() const {
    return {{"cycles", cost.cycles},
            {"worst_lateness_us", to_seconds(cost.worst_lateness) * 1e6},
            {"cpu_us_each", cost.cycles == 0 ? 0.0 : to_seconds(cost.cpu) * 1e6 / static_cast<double>(cost.cycles)}};
  }

  [[nodiscard]] Result<void> write_truth() const {
    return base_ && !options_.truth.empty() ? base_->write_truth(options_.truth) : Result<void>{};
  }

  Cost cost;

 private:
  void step(MonoTime at) {
    look_at_controls();
    if (!base_ && !options_.can.empty()) {
      if (auto base = BaseFeeder::start(options_.can, at, options_.keep_s, motion_)) base_ = std::move(*base);
    }
    if (base_) {
      base_->advance_to(at, {controls_.silent.load(), controls_.emergency_stop.load(), controls_.powered_off.load()},
                        recorded_at(at));
    }
    if (controls_.play.load()) press(at);
  }

  /// The robot takes an image's exposure to have begun so much before the driver handed it over: the recorded motion is ahead of the images by that.
  [[nodiscard]] std::optional<Duration> recorded_at(MonoTime at) const {
    const MonoTime first = controls_.first_played.load();
    if (first == MonoTime{}) return std::nullopt;
    return at - first + seconds(options_.end_of_frame_offset_s);
  }

  // Every tenth of a second, and each on a turn of its own: this costs the robot's time.
  void look_at_controls() {
    switch (cost.cycles % 10) {
      case 0:
        if (!controls_.play.load()) controls_.play.store(exists(options_.controls, "play"));
        break;
      case 1:
        controls_.still.store(exists(options_.controls, "still"));
        break;
      case 3:
        controls_.silent.store(exists(options_.controls, "silent"));
        break;
      case 6:
        controls_.emergency_stop.store(exists(options_.controls, "estop"));
        break;
      case 9:
        controls_.powered_off.store(exists(options_.controls, "poweroff"));
        break;
      default:
        break;
    }
  }

  void press(MonoTime at) {
    if (!plays_since_) plays_since_ = at;
    if (pressed_ || options_.arming_pull.empty() || at < *plays_since_ + seconds(options_.arm_after_s)) return;
    write_text(options_.arming_pull, "pull-up");
    pressed_ = true;
  }

  const Options& options_;
  Controls& controls_;
  RecordedMotion* motion_;
  std::unique_ptr<BaseFeeder> base_;
  std::optional<MonoTime> plays_since_;
  bool pressed_ = false;
};

/// Flags every image of the camera while it is wanted. Whichever end of vivid comes first uses a press up: with `still`, that is the camera.
void flag_images(const Options& options) {
  constexpr int kPresses = 9;
  FlagButton button(options.camera);
  run_ahead_of_all("feed flags", 89);
  Cost cost;
  std::string problem;
  cycle(kBasePeriod, cost, [&](MonoTime) {
    if (!exists(options.controls, "flagged")) return button.release();
    for (int i = 0; i < kPresses; ++i) {
      const auto pressed = button.press();
      if (!pressed && pressed.error().message != problem) {
        problem = pressed.error().message;
        fmt::print(stderr, "feeder: {}\n", problem);
      }
      std::this_thread::sleep_for(kBasePeriod / (kPresses + 1));
    }
  });
}

Result<void> write_report(const Options& options, const ImageThread& images, const BaseThread& base) {
  if (auto written = base.write_truth(); !written) return written;
  if (options.json.empty()) return {};
  std::ofstream(options.json) << nlohmann::ordered_json{{"images", images.report()}, {"base", base.report()}}.dump(1)
                              << "\n";
  return {};
}

int feed(const Options& options) {
  std::signal(SIGTERM, [](int) { stop_requested.store(true); });
  std::signal(SIGINT, [](int) { stop_requested.store(true); });
  (void)prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);  // to make its memory huge would cost the robot's time
  Controls controls;
  std::optional<RecordedMotion> motion;
  if (!options.motion.empty()) {
    auto loaded = RecordedMotion::load(options.motion);
    if (!loaded) return fmt::print(stderr, "feeder: {}\n", loaded.error().message), 1;
    motion = std::move(*loaded);
  }
  ImageThread images(options, controls);
  BaseThread base(options, controls, motion ? &*motion : nullptr);
  const bool has_images = !options.images.file.empty();
  if (has_images) {
    if (auto loaded = images.load(); !loaded) return fmt::print(stderr, "feeder: {}\n", loaded.error().message), 1;
  }
  std::thread base_thread([&] { base.run(); });
  std::thread image_thread([&] {
    if (has_images) images.run();
  });
  std::thread flag_thread([&] {
    if (!options.camera.empty()) flag_images(options);
  });
  Result<void> outcome;
  if (has_images) outcome = images.load_rest();
  if (outcome) {
    write_text(options.controls + "/loaded", "");
  } else {
    stop_requested.store(true);
  }
  base_thread.join();
  image_thread.join();
  flag_thread.join();
  if (outcome) outcome = write_report(options, images, base);
  if (!outcome) fmt::print(stderr, "feeder: {}\n", outcome.error().message);
  return outcome ? 0 : 1;
}

}  // namespace
}  // namespace cgsr::hil

int main(int argc, char** argv) {
  cgsr::hil::Options options;
  CLI::App app("plays a camera, a base and a switch to the drivers of this computer");
  app.add_option("--images", options.images.file, "images one after another, 640 x 480 YUYV");
  app.add_option("--count", options.images.count, "how many of them; without it as many as the file holds");
  app.add_option("--device", options.images.device, "the video output that they are written into");
  app.add_option("--buffers", options.images.buffers, "how many buffers the video output is asked for");
  app.add_option("--rate", options.rate_hz, "images per second");
  app.add_option("--can", options.can, "the CAN interface that the simulated Segway is on");
  app.add_option("--controls", options.controls, "the folder of `play` and of the faults");
  app.add_option("--arming-pull", options.arming_pull, "gpio-sim's `pull` file of the arming line");
  app.add_option("--arm-after", options.arm_after_s, "seconds from `play` until the switch is pressed");
  app.add_option("--camera", options.camera,
                 "the camera, of vivid, whose images are flagged as damaged while `flagged` exists");
  app.add_option("--motion", options.motion,
                 "what the base says of its motion while the images play, as the tap wrote it");
  app.add_option("--end-of-frame-offset", options.end_of_frame_offset_s, "of the robot's file, s");
  app.add_option("--json", options.json, "what was done and what it cost");
  app.add_option("--truth", options.truth, "what the base did");
  CLI11_PARSE(app, argc, argv);
  return cgsr::hil::feed(options);
}
