// The simulated home as a plug-in that also writes down what it delivers, for a virtual robot computer that plays it later. Into the folder that
// the environment names (CGSR_HIL_TAP): images.yuyv, the images one after another without padding, and stamps.txt, a line for each with its
// sequence number and its stamp in nanoseconds; motion.txt, what the base said of its motion (recorded_motion.h).
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hal/sim/home/simulated_home.h"
#include "hal/simulation.h"

namespace {

using cgsr::Duration;
using cgsr::ImageLease;
using cgsr::MonoTime;
using cgsr::Result;
namespace hal = cgsr::hal;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

class TappedCamera final : public hal::Camera {
 public:
  TappedCamera(std::unique_ptr<hal::Camera> camera, File images, File stamps)
      : camera_(std::move(camera)), images_(std::move(images)), stamps_(std::move(stamps)) {}

  Result<hal::CameraMode> start() override { return camera_->start(); }
  void stop() override { camera_->stop(); }
  [[nodiscard]] std::string last_problem() const override { return camera_->last_problem(); }

  tl::expected<ImageLease, hal::CaptureFailure> next_image(MonoTime give_up_at) override {
    auto image = camera_->next_image(give_up_at);
    if (image) write(*image);
    return image;
  }

 private:
  void write(const ImageLease& image) {
    const cgsr::ImageView& view = image.view();
    const auto row_bytes = static_cast<std::size_t>(view.width_px) * 2;
    for (int y = 0; y < view.height_px; ++y) {
      if (std::fwrite(view.row(y), 1, row_bytes, images_.get()) != row_bytes) std::abort();  // the disk is full
    }
    fmt::print(stamps_.get(), "{} {}\n", image.sequence(), image.stamp().time_since_epoch().count());
  }

  std::unique_ptr<hal::Camera> camera_;
  File images_;
  File stamps_;
};

/// Writes down what the base says of its motion.
class TappedBus final : public hal::CanBus {
 public:
  TappedBus(std::unique_ptr<hal::CanBus> bus, File file) : bus_(std::move(bus)), file_(std::move(file)) {}

  Result<void> start() override { return bus_->start(); }
  tl::expected<void, hal::CanSendFailure> send(const hal::CanFrame& frame) override { return bus_->send(frame); }
  std::size_t receive(MonoTime until, std::span<hal::CanFrame> into) override {
    const std::size_t count = bus_->receive(until, into);
    for (const hal::CanFrame& frame : into.first(count)) write(frame);
    return count;
  }
  [[nodiscard]] hal::CanState state() const override { return bus_->state(); }
  [[nodiscard]] hal::CanCounters counters() const override { return bus_->counters(); }
  void stop() override { bus_->stop(); }

 private:
  void write(const hal::CanFrame& frame) {
    constexpr std::uint16_t kAttitude = 0x401, kIntegrated = 0x404;  // and motion and wheel distances between them
    if (frame.id < kAttitude || frame.id > kIntegrated) return;
    fmt::print(file_.get(), "{:x} {} {:02x}\n", frame.id, frame.stamp.time_since_epoch().count(),
               fmt::join(frame.data, ""));
  }

  std::unique_ptr<hal::CanBus> bus_;
  File file_;
};

class TappedHome final : public hal::Simulation {
 public:
  TappedHome(std::unique_ptr<hal::Simulation> home, std::string folder)
      : home_(std::move(home)), folder_(std::move(folder)) {}

  std::unique_ptr<hal::Camera> take_camera() override {
    File images(std::fopen((folder_ + "/images.yuyv").c_str(), "wb"));
    File stamps(std::fopen((folder_ + "/stamps.txt").c_str(), "w"));
    if (!images || !stamps) std::abort();
    return std::make_unique<TappedCamera>(home_->take_camera(), std::move(images), std::move(stamps));
  }
  std::unique_ptr<hal::CanBus> take_can_bus() override {
    File file(std::fopen((folder_ + "/motion.txt").c_str(), "w"));
    if (!file) std::abort();
    return std::make_unique<TappedBus>(home_->take_can_bus(), std::move(file));
  }
  std::unique_ptr<hal::Switches> take_switches() override { return home_->take_switches(); }
  [[nodiscard]] Duration image_delay() const override { return home_->image_delay(); }
  void advance_to(MonoTime time) override { home_->advance_to(time); }
  [[nodiscard]] std::optional<hal::ImageTruth> truth(MonoTime stamp) const override { return home_->truth(stamp); }
  [[nodiscard]] const hal::Plan& plan() const override { return home_->plan(); }
  [[nodiscard]] std::vector<std::string> notes() const override { return home_->notes(); }

 private:
  std::unique_ptr<hal::Simulation> home_;
  std::string folder_;
};

}  // namespace

extern "C" __attribute__((visibility("default"))) int cgsr_simulation_version() {
  return hal::kSimulationVersion;
}

extern "C" __attribute__((visibility("default"))) hal::Simulation* cgsr_make_simulation(
    const hal::SimulationParameters* parameters, std::string* error) try {
  const char* folder = std::getenv("CGSR_HIL_TAP");
  if (folder == nullptr) {
    *error = "CGSR_HIL_TAP names no folder";
    return nullptr;
  }
  auto home = cgsr::sim::SimulatedHome::make(*parameters);
  if (home) return std::make_unique<TappedHome>(std::move(*home), folder).release();
  *error = home.error().message;
  return nullptr;
} catch (const std::exception& caught) {
  *error = std::string("the simulator failed: ") + caught.what();
  return nullptr;
}
