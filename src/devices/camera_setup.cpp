#include "src/devices/camera_setup.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "hal/v4l2/controls.h"

namespace cgsr::devices {
namespace {

using hal::v4l2::V4l2Camera;
using hal::v4l2::V4l2Parameters;
using hal::v4l2::VideoDevice;

constexpr int kImagesToSettle = 30;     // a camera's automatics need about a second
constexpr int kImagesAfterSetting = 6;  // an exposure takes effect a few images later
constexpr int kMaxTries = 10;
constexpr double kExposureUnit_s = 100e-6;  // of V4L2_CID_EXPOSURE_ABSOLUTE
constexpr Duration kImageWithin = seconds(2.0);

/// Streams with these parameters and judges the image after `skip` others. \param looked_at  called before the stream ends.
Result<LumaHistogram> look(const V4l2Parameters& parameters, const CameraAccess& access, int skip,
                           const std::function<void(const ImageView&)>& looked_at) {
  auto device = access.make_device();
  const VideoDevice& clock = *device;
  V4l2Camera camera(parameters, std::move(device), access.locate);
  if (auto started = camera.start(); !started) return tl::unexpected(started.error());
  for (int good = 0, failures = 0;;) {
    auto image = camera.next_image(clock.now() + kImageWithin);
    if (!image) {
      if (++failures > skip + 3) return fail(fmt::format("no image: {}", camera.last_problem()));
      continue;
    }
    if (good++ < skip) continue;
    const LumaHistogram histogram = luma_histogram(image->view());
    looked_at(image->view());
    return histogram;
  }
}

struct ControlRange {
  std::int32_t minimum = 0, maximum = 0;
};

/// The device beside the one that streams: settings may be read and changed meanwhile.
class Settings {
 public:
  static Result<Settings> open(const std::string& name, const CameraAccess& access) {
    const auto path = access.locate(name);
    if (!path)
      return fail(fmt::format("camera '{}' is not there: `cgsr devices` lists the cameras of this computer", name));
    auto device = access.make_device();
    if (device->open(*path) != 0) return fail(fmt::format("camera '{}' ({}) cannot be opened", name, *path));
    return Settings(std::move(device));
  }

  void set_automatic() { hal::v4l2::set_automatic(*device_); }
  [[nodiscard]] std::optional<std::int32_t> value(std::uint32_t id) { return hal::v4l2::control_value(*device_, id); }
  [[nodiscard]] std::optional<ControlRange> range(std::uint32_t id) {
    const auto controls = hal::v4l2::offered_controls(*device_);
    const auto found = std::ranges::find(controls, id, &hal::v4l2::OfferedControl::id);
    if (found == controls.end()) return std::nullopt;
    return ControlRange{found->minimum, found->maximum};
  }

 private:
  explicit Settings(std::unique_ptr<VideoDevice> device) : device_(std::move(device)) {}
  std::unique_ptr<VideoDevice> device_;
};

/// What the camera's automatics arrived at becomes fixed.
void keep_automatic_values(Settings& settings, CameraSetup& setup) {
  V4l2Parameters& fixed = setup.parameters;
  const auto white = settings.value(V4L2_CID_WHITE_BALANCE_TEMPERATURE);
  fixed.white_balance_k = white ? std::clamp(*white, 1, 20000) : 0;
  if (!white) setup.notes.emplace_back("the camera has no fixed white balance: colours will change with what it sees");
  if (settings.value(V4L2_CID_AUTOGAIN)) fixed.gain = std::clamp(settings.value(V4L2_CID_GAIN).value_or(-1), -1, 65535);
}

void judge(CameraSetup& setup, double min_s, double max_s) {
  const double exposure_s = setup.parameters.exposure_s;
  if (setup.histogram.saturated_share() > 0.02) {
    setup.notes.push_back(fmt::format("{:.1f} % of the image are cut off{}", 100.0 * setup.histogram.saturated_share(),
                                      exposure_s <= min_s * 1.01 ? ": less light, or a lower gain" : ""));
  }
  if (setup.histogram.black_share() > 0.5) {
    setup.notes.push_back(fmt::format("{:.0f} % of the image are black{}", 100.0 * setup.histogram.black_share(),
                                      exposure_s >= max_s * 0.99 ? ": more light, or a higher gain" : ""));
  }
}

}  // namespace

Result<CameraSetup> set_up_camera(V4l2Parameters parameters, const CameraAccess& access,
                                  const std::function<void(const ImageView&, const std::string&)>& show) {
  CameraSetup setup{std::move(parameters), {}, {}};
  V4l2Parameters& fixed = setup.parameters;
  auto settings = Settings::open(fixed.device, access);
  if (!settings) return tl::unexpected(settings.error());

  fixed.exposure_s = 0.0;
  fixed.white_balance_k = 0;
  fixed.gain = -1;
  settings->set_automatic();
  const auto automatic = look(fixed, access, kImagesToSettle,
                              [&](const ImageView& image) { show(image, "exposure and white balance by the camera"); });
  if (!automatic) return tl::unexpected(automatic.error());
  setup.histogram = *automatic;
  keep_automatic_values(*settings, setup);

  const auto range = settings->range(V4L2_CID_EXPOSURE_ABSOLUTE);
  if (!range) {
    setup.notes.emplace_back("the camera has no fixed exposure: brightness will change with what it sees");
    return setup;
  }
  const double min_s = std::max(1, range->minimum) * kExposureUnit_s;
  const double max_s = std::max(min_s, std::min(range->maximum * kExposureUnit_s, 1.0 / fixed.rate_hz));
  const auto value = settings->value(V4L2_CID_EXPOSURE_ABSOLUTE);
  fixed.exposure_s = std::clamp(value.value_or(100) * kExposureUnit_s, min_s, max_s);
  for (int i = 0; i < kMaxTries; ++i) {
    const auto label = fmt::format("exposure {:.1f} ms", fixed.exposure_s * 1e3);
    const auto seen = look(fixed, access, kImagesAfterSetting, [&](const ImageView& image) { show(image, label); });
    if (!seen) return tl::unexpected(seen.error());
    setup.histogram = *seen;
    const double steps = std::round(next_exposure_s(fixed.exposure_s, *seen) / kExposureUnit_s);
    const double next_s = std::clamp(steps * kExposureUnit_s, min_s, max_s);
    if (std::abs(next_s - fixed.exposure_s) < kExposureUnit_s / 2.0) break;
    fixed.exposure_s = next_s;
  }
  judge(setup, min_s, max_s);
  return setup;
}

std::string setup_lines(const CameraSetup& setup) {
  const V4l2Parameters& fixed = setup.parameters;
  const V4l2Parameters defaults;
  std::string text = fmt::format("camera.kind = \"v4l2\"\ncamera.v4l2.device = \"{}\"\n", fixed.device);
  if (fixed.format != defaults.format) text += fmt::format("camera.v4l2.format = \"{}\"\n", to_string(fixed.format));
  if (fixed.width_px != defaults.width_px) text += fmt::format("camera.v4l2.width_px = {}\n", fixed.width_px);
  if (fixed.height_px != defaults.height_px) text += fmt::format("camera.v4l2.height_px = {}\n", fixed.height_px);
  if (fixed.exposure_s > 0.0) text += fmt::format("camera.v4l2.exposure_s = {:.4f}\n", fixed.exposure_s);
  if (fixed.gain >= 0) text += fmt::format("camera.v4l2.gain = {}\n", fixed.gain);
  return text + fmt::format("camera.v4l2.white_balance_k = {}\n", fixed.white_balance_k);
}

}  // namespace cgsr::devices
