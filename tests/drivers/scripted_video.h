#pragma once

#include <linux/videodev2.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "hal/v4l2/video_device.h"
#include "platform/clock.h"

namespace cgsr::test {

/// A kernel with one camera, as a script sets it. It delivers an image every period of real time into the oldest queued
/// buffer; image i is filled with the byte i. Its lock is held by every call. It must outlive its devices. As in the kernel, a mapping keeps
/// the device and its queue, closed or not, until the camera is unplugged.
struct ScriptedVideo {
  struct Control {
    std::int32_t minimum = 0, maximum = 0, value = 0;
    bool sticks = true;  ///< false: it takes the value and keeps its own.
  };

  // What the camera is.
  std::vector<std::uint32_t> formats = {V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_MJPEG};
  int width_px = 64, height_px = 48;  ///< the only size; stepwise: the largest.
  bool stepwise = false;
  std::uint32_t capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  Duration period = std::chrono::milliseconds(10);
  std::uint32_t stamp_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  std::map<std::uint32_t, Control> controls;
  std::vector<std::uint8_t> jpeg;  ///< what an MJPEG stream delivers.
  std::function<std::uint8_t(std::uint32_t)> byte_of = [](std::uint32_t image) { return image & 0xFF; };  ///< of YUYV.

  // What goes wrong.
  std::atomic<bool> plugged{true};
  std::atomic<bool> stalled{false};
  std::atomic<int> flag_next{0};            ///< so many images are delivered flagged.
  std::atomic<int> short_next{0};           ///< so many images are cut in half.
  std::atomic<int> skip_next{0};            ///< so many images are lost in the driver.
  std::atomic<int> dequeue_error{0};        ///< answered once.
  std::atomic<bool> source_changed{false};  ///< an event, answered once.
  std::atomic<int> fills_in_turn{
      0};  ///< > 0: so many buffers are filled by turns, queued or not, as v4l2loopback does.
  std::atomic<bool> used_by_another{false};
  std::atomic<int> opened{0};
  std::atomic<int> mapped{0};

  // What it does.
  std::mutex mutex;
  std::condition_variable changed;
  RealClock clock;
  std::vector<std::shared_ptr<std::vector<std::uint8_t>>> memory;
  std::set<const std::uint8_t*> mapped_here;  ///< of the device as it is plugged in now.
  std::deque<int> queued;
  std::deque<v4l2_buffer> filled;
  std::uint32_t pixel_format = 0;
  std::uint32_t sequence = 0;
  MonoTime due{};
  bool streaming = false;
  bool woken = false;

  [[nodiscard]] std::size_t image_bytes() const {
    return static_cast<std::size_t>(width_px) * 2U * static_cast<std::size_t>(height_px);
  }

  void deliver_due() {
    while (streaming && plugged && !stalled && clock.now() >= due) {
      const MonoTime stamp = due;
      due += period;
      const std::uint32_t number = sequence++;
      if (skip_next > 0 || (queued.empty() && fills_in_turn == 0)) {
        if (skip_next > 0) --skip_next;
        continue;
      }
      v4l2_buffer buffer{};
      buffer.index =
          static_cast<std::uint32_t>(fills_in_turn > 0 ? static_cast<int>(number) % fills_in_turn : queued.front());
      std::erase(queued, static_cast<int>(buffer.index));
      auto& bytes = *memory[buffer.index];
      if (pixel_format == V4L2_PIX_FMT_MJPEG) {
        std::copy(jpeg.begin(), jpeg.end(), bytes.begin());
        buffer.bytesused = static_cast<std::uint32_t>(jpeg.size());
      } else {
        std::memset(bytes.data(), byte_of(number), bytes.size());
        buffer.bytesused = static_cast<std::uint32_t>(image_bytes());
      }
      buffer.sequence = number;
      buffer.flags = stamp_flags;
      if (flag_next > 0) {
        --flag_next;
        buffer.flags |= V4L2_BUF_FLAG_ERROR;
      }
      if (short_next > 0) {
        --short_next;
        buffer.bytesused /= 2;
      }
      const auto us = std::chrono::duration_cast<std::chrono::microseconds>(stamp.time_since_epoch()).count();
      buffer.timestamp = {us / 1'000'000, us % 1'000'000};
      filled.push_back(buffer);
    }
  }

  int control(unsigned long request, void* argument);
  int control_value(unsigned long request, v4l2_ext_control& control);
  int enumerate(unsigned long request, void* argument);
  int stream(unsigned long request, void* argument);
};

inline int ScriptedVideo::control_value(unsigned long request, v4l2_ext_control& control) {
  const auto found = controls.find(control.id);
  if (found == controls.end()) return EINVAL;
  auto& own = found->second;
  if (request == VIDIOC_S_EXT_CTRLS && own.sticks) own.value = std::clamp(control.value, own.minimum, own.maximum);
  control.value = own.value;
  return 0;
}

inline int ScriptedVideo::enumerate(unsigned long request, void* argument) {
  if (request == VIDIOC_ENUM_FMT) {
    auto& entry = *static_cast<v4l2_fmtdesc*>(argument);
    if (entry.index >= formats.size()) return EINVAL;
    entry.pixelformat = formats[entry.index];
    std::memcpy(entry.description, "scripted", 9);
    return 0;
  }
  if (request == VIDIOC_ENUM_FRAMESIZES) {
    auto& entry = *static_cast<v4l2_frmsizeenum*>(argument);
    if (entry.index > 0) return EINVAL;
    const auto width = static_cast<std::uint32_t>(width_px);
    const auto height = static_cast<std::uint32_t>(height_px);
    if (stepwise) {
      entry.type = V4L2_FRMSIZE_TYPE_STEPWISE;
      entry.stepwise = {16, width, 2, 16, height, 2};
    } else {
      entry.type = V4L2_FRMSIZE_TYPE_DISCRETE;
      entry.discrete = {width, height};
    }
    return 0;
  }
  auto& entry = *static_cast<v4l2_frmivalenum*>(argument);
  if (entry.index > 0) return EINVAL;
  entry.type = V4L2_FRMIVAL_TYPE_DISCRETE;
  entry.discrete = {static_cast<std::uint32_t>(period.count() / 1000), 1'000'000};
  return 0;
}

inline int ScriptedVideo::stream(unsigned long request, void* argument) {
  if (request == VIDIOC_REQBUFS) {
    if (used_by_another || !mapped_here.empty()) return EBUSY;
    auto& wanted = *static_cast<v4l2_requestbuffers*>(argument);
    memory.clear();
    for (std::uint32_t i = 0; i < wanted.count; ++i)
      memory.push_back(std::make_shared<std::vector<std::uint8_t>>(std::max(image_bytes(), jpeg.size())));
    return 0;
  }
  if (request == VIDIOC_STREAMON) {
    streaming = true;
    sequence = 0;
    due = clock.now() + period;
    return 0;
  }
  if (request == VIDIOC_STREAMOFF) {
    streaming = false;
    queued.clear();
    filled.clear();
    return 0;
  }
  auto& buffer = *static_cast<v4l2_buffer*>(argument);
  if (request == VIDIOC_QUERYBUF) {
    if (buffer.index >= memory.size()) return EINVAL;
    buffer.length = static_cast<std::uint32_t>(memory[buffer.index]->size());
    buffer.m.offset = buffer.index;
    return 0;
  }
  if (request == VIDIOC_QBUF) {
    if (buffer.index >= memory.size()) return EINVAL;
    queued.push_back(static_cast<int>(buffer.index));
    return 0;
  }
  if (const int error = dequeue_error.exchange(0); error != 0) return error;
  deliver_due();
  if (filled.empty()) return EAGAIN;
  buffer = filled.front();
  filled.pop_front();
  return 0;
}

inline int ScriptedVideo::control(unsigned long request, void* argument) {
  const std::lock_guard lock(mutex);
  if (!plugged) {
    mapped_here.clear();
    return ENODEV;
  }
  switch (request) {
    case VIDIOC_QUERYCAP: {
      auto& facts = *static_cast<v4l2_capability*>(argument);
      std::memcpy(facts.card, "Scripted Camera", 16);
      std::memcpy(facts.driver, "scripted", 9);
      facts.capabilities = capabilities;
      return 0;
    }
    case VIDIOC_DQEVENT:
      if (!source_changed.exchange(false)) return ENOENT;
      static_cast<v4l2_event*>(argument)->type = V4L2_EVENT_SOURCE_CHANGE;
      return 0;
    case VIDIOC_SUBSCRIBE_EVENT:
      return 0;
    case VIDIOC_G_FMT: {
      auto& pix = static_cast<v4l2_format*>(argument)->fmt.pix;
      pix.pixelformat = pixel_format;
      pix.width = static_cast<std::uint32_t>(width_px);
      pix.height = static_cast<std::uint32_t>(height_px);
      return 0;
    }
    case VIDIOC_S_FMT: {
      if (used_by_another || !mapped_here.empty()) return EBUSY;
      auto& pix = static_cast<v4l2_format*>(argument)->fmt.pix;
      if (std::find(formats.begin(), formats.end(), pix.pixelformat) == formats.end())
        pix.pixelformat = formats.front();
      pixel_format = pix.pixelformat;
      pix.width = static_cast<std::uint32_t>(width_px);
      pix.height = static_cast<std::uint32_t>(height_px);
      pix.bytesperline = pixel_format == V4L2_PIX_FMT_YUYV ? 2 * pix.width : 0;
      return 0;
    }
    case VIDIOC_S_PARM:
      static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe = {
          static_cast<std::uint32_t>(period.count() / 1000), 1'000'000};
      return 0;
    case VIDIOC_QUERYCTRL: {
      auto& query = *static_cast<v4l2_queryctrl*>(argument);
      constexpr std::uint32_t kNext = V4L2_CTRL_FLAG_NEXT_CTRL;
      const bool next = (query.id & kNext) != 0;
      const auto found = next ? controls.upper_bound(query.id & ~kNext) : controls.find(query.id);
      if (found == controls.end()) return EINVAL;
      query.id = found->first;
      query.type = V4L2_CTRL_TYPE_INTEGER;
      std::memcpy(query.name, "scripted control", 17);
      query.minimum = found->second.minimum;
      query.maximum = found->second.maximum;
      query.step = 1;
      return 0;
    }
    case VIDIOC_S_EXT_CTRLS:
    case VIDIOC_G_EXT_CTRLS:
      return control_value(request, *static_cast<v4l2_ext_controls*>(argument)->controls);
    case VIDIOC_ENUM_FMT:
    case VIDIOC_ENUM_FRAMESIZES:
    case VIDIOC_ENUM_FRAMEINTERVALS:
      return enumerate(request, argument);
    case VIDIOC_REQBUFS:
    case VIDIOC_QUERYBUF:
    case VIDIOC_QBUF:
    case VIDIOC_DQBUF:
    case VIDIOC_STREAMON:
    case VIDIOC_STREAMOFF:
      return stream(request, argument);
    default:
      return ENOTTY;
  }
}

class ScriptedVideoDevice final : public hal::v4l2::VideoDevice {
 public:
  explicit ScriptedVideoDevice(ScriptedVideo& kernel) : kernel_(kernel) {}

  int open(const std::string&) override {
    const std::lock_guard lock(kernel_.mutex);
    if (!kernel_.plugged) return ENOENT;
    ++kernel_.opened;
    return 0;
  }
  void close() override {
    const std::lock_guard lock(kernel_.mutex);
    kernel_.streaming = false;
    kernel_.queued.clear();
    kernel_.filled.clear();
  }
  int control(unsigned long request, void* argument) override { return kernel_.control(request, argument); }

  int map(std::size_t, std::uint32_t offset, std::uint8_t*& at) override {
    const std::lock_guard lock(kernel_.mutex);
    ++kernel_.mapped;
    at = kernel_.memory[offset]->data();
    kernel_.mapped_here.insert(at);
    kept_[at] = kernel_.memory[offset];  // as a mapping keeps its pages
    return 0;
  }
  void unmap(std::uint8_t* at, std::size_t) override {
    const std::lock_guard lock(kernel_.mutex);
    --kernel_.mapped;
    kernel_.mapped_here.erase(at);
    kept_.erase(at);
  }

  hal::v4l2::Waited wait(MonoTime give_up_at, bool for_images) override {
    std::unique_lock lock(kernel_.mutex);
    for (;;) {
      hal::v4l2::Waited met;
      met.woken = std::exchange(kernel_.woken, false);
      if (for_images) {
        kernel_.deliver_due();
        met.image = !kernel_.filled.empty();
        met.error = !kernel_.plugged;
        met.event = kernel_.source_changed;
      }
      const MonoTime now = kernel_.clock.now();
      if (met.woken || met.image || met.event || met.error || now >= give_up_at) return met;
      kernel_.changed.wait_for(lock, std::min<Duration>(give_up_at - now, std::chrono::milliseconds(1)));
    }
  }

  void wake() noexcept override {
    const std::lock_guard lock(kernel_.mutex);
    kernel_.woken = true;
    kernel_.changed.notify_all();
  }

  [[nodiscard]] MonoTime now() const override { return kernel_.clock.now(); }

 private:
  ScriptedVideo& kernel_;
  std::map<std::uint8_t*, std::shared_ptr<std::vector<std::uint8_t>>> kept_;
};

}  // namespace cgsr::test
