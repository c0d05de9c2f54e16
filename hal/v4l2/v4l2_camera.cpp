#include "hal/v4l2/v4l2_camera.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <utility>

#include <fmt/format.h>

#include "hal/v4l2/formats.h"

namespace cgsr::hal::v4l2 {
namespace {

constexpr int kImagesUntilControlsAreChecked = 5;  // some cameras take an exposure only once they stream
constexpr int kMaxRestartsInARow = 3;              // then the device is opened anew

MonoTime to_time(const timeval& time) {
  return MonoTime{std::chrono::seconds(time.tv_sec) + std::chrono::microseconds(time.tv_usec)};
}

}  // namespace

V4l2Camera::Buffers::~Buffers() {
  for (const auto& mapping : mapped) device.unmap(mapping.at, mapping.bytes);
}

V4l2Camera::V4l2Camera(V4l2Parameters parameters, std::unique_ptr<VideoDevice> device, LocateCamera locate)
    : parameters_(std::move(parameters)),
      device_(std::move(device)),
      locate_(std::move(locate)),
      wishes_(wishes_of(parameters_)) {}

V4l2Camera::~V4l2Camera() {
  V4l2Camera::stop();
  buffers_.reset();
  retired_.clear();
}

std::string V4l2Camera::name() const {
  return fmt::format("camera '{}'", parameters_.device);
}

std::string V4l2Camera::without_name(const std::string& message) const {
  const std::string prefix = name() + ": ";
  return message.rfind(prefix, 0) == 0 ? message.substr(prefix.size()) : message;
}

/// Who may have the device that is busy: the kernel keeps one whose memory is mapped, closed or not.
const char* V4l2Camera::user() const {
  return retired_.empty() ? ": another program uses the camera" : ": images of it are on lease";
}

// ---- opening ------------------------------------------------------------------------------------------------------------

Result<CameraMode> V4l2Camera::start() {
  const std::lock_guard lock(stream_mutex_);
  if (running_) return fail(name() + " is started already");
  if (parameters_.width_px % 2 != 0) return fail(fmt::format("{}: width_px = {} is odd", name(), parameters_.width_px));
  counters_ = {};
  notes_.clear();
  stamps_noted_ = false;
  next_sequence_ = 0;
  restarts_in_a_row_ = 0;
  remember({});
  auto mode = open_device();
  if (!mode) return mode;
  mode_ = *mode;
  running_ = true;
  return mode;
}

void V4l2Camera::close_device() {
  if (buffers_) stream_off();
  device_->close();
  if (buffers_) retired_.push_back(std::move(buffers_));
  unmap_what_came_back();
}

/// Memory that is on lease stays mapped until its leases have ended, and no longer: while it is, the kernel keeps the device, which then can
/// neither be set up anew nor, when it was unplugged, come back under its number.
void V4l2Camera::unmap_what_came_back() {
  std::erase_if(retired_, [](const auto& old) { return !old->slots.any_on_lease(); });
}

void V4l2Camera::stop() {
  running_ = false;
  device_->wake();
  const std::lock_guard lock(stream_mutex_);
  close_device();
}

// ---- streaming ----------------------------------------------------------------------------------------------------------

tl::expected<ImageLease, CaptureFailure> V4l2Camera::next_image(MonoTime give_up_at) {
  const std::lock_guard lock(stream_mutex_);
  return take_image(give_up_at);
}

tl::expected<ImageLease, CaptureFailure> V4l2Camera::take_image(MonoTime give_up_at) {
  for (;;) {
    if (!running_) return tl::unexpected(CaptureFailure::kDisconnected);
    const MonoTime now = device_->now();
    if (now >= give_up_at) return tl::unexpected(CaptureFailure::kTimeout);
    if (!buffers_) {
      look_for_it(give_up_at);
      continue;
    }
    queue_returned();
    if (auto answer = look(give_up_at)) return std::move(*answer);
  }
}

/// One wait, and what came of it. \return nothing: look again.
std::optional<tl::expected<ImageLease, CaptureFailure>> V4l2Camera::look(MonoTime give_up_at) {
  const bool starved = queued_ == 0;
  buffers_->slots.set_starving(starved);
  if (starved) {
    queue_returned();  // one may have come back just before
    if (queued_ > 0) return std::nullopt;
    const Waited met = device_->wait(give_up_at, false);
    alive_at_ = device_->now();  // no wonder that no image comes
    if (met.woken || alive_at_ < give_up_at) return std::nullopt;
    remember(fmt::format("{}: all {} buffers are on lease: the reader is too slow", name(), buffers_->mapped.size()));
    return tl::unexpected(CaptureFailure::kNoSlot);
  }
  const MonoTime stalls_at = alive_at_ + seconds(parameters_.stall_s);
  const Waited met = device_->wait(std::min(give_up_at, stalls_at), true);
  if (!running_) return std::nullopt;
  if (met.event) {
    v4l2_event event{};
    if (device_->control(VIDIOC_DQEVENT, &event) == 0 && event.type == V4L2_EVENT_SOURCE_CHANGE) {
      if (format_stands()) {
        restart_stream("the driver reports a change of its source");
      } else {
        lose("its source has another format now");
      }
      return std::nullopt;
    }
  }
  if (!met.image && !met.error) {
    if (device_->now() >= stalls_at) {
      restart_stream(fmt::format("no image for {:.1f} s, the last was number {}", parameters_.stall_s,
                                 next_sequence_ == 0 ? std::string("none") : std::to_string(next_sequence_ - 1)));
    }
    return std::nullopt;
  }
  queue_returned();  // what came back while it waited: only so is it known who has what
  Filled filled;
  const int error = dequeue(filled);
  if (error == EAGAIN && !met.error) return std::nullopt;
  if (error == ENODEV || error == ENXIO || error == EBADF) {
    lose(fmt::format("unplugged ({})", error_words(error)));
  } else if (error != 0) {
    restart_stream(fmt::format("an image could not be taken from the driver ({})", error_words(error)));
  }
  if (error != 0) return std::nullopt;
  return deliver(filled);
}

int V4l2Camera::dequeue(Filled& filled) {
  v4l2_buffer buffer = capture_buffer(0);
  if (const int error = device_->control(VIDIOC_DQBUF, &buffer); error != 0) return error;
  if (buffer.index >= buffers_->mapped.size()) return EIO;
  filled.on_lease =
      parameters_.format == StreamFormat::kYuyv && buffers_->slots.on_lease(static_cast<int>(buffer.index));
  if (!filled.on_lease) --queued_;  // else the driver took one that was not its own
  filled.index = static_cast<int>(buffer.index);
  filled.sequence = buffer.sequence;
  filled.bytes = std::min<std::size_t>(buffer.bytesused, buffers_->mapped[buffer.index].bytes);
  filled.stamp = stamp_of(buffer.flags, to_time(buffer.timestamp));
  filled.flagged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0;
  return 0;
}

MonoTime V4l2Camera::stamp_of(std::uint32_t flags, MonoTime driver_stamp) {
  const MonoTime now = device_->now();
  const bool monotonic = (flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  const bool of_exposure = (flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  if (!stamps_noted_) {
    stamps_noted_ = true;
    if (!monotonic) {
      remember(fmt::format("{}: the driver's stamps are not of the monotonic clock: the moment of reading is taken",
                           name()));
    }
  }
  MonoTime stamp = monotonic ? driver_stamp : now;
  if (!monotonic || !of_exposure) stamp -= seconds(parameters_.end_of_frame_offset_s);
  return std::max(std::min(stamp, now), last_stamp_);
}

/// \return the number of the image in this camera's own count, which goes on when the driver's begins anew.
std::uint64_t V4l2Camera::count_sequence(std::uint32_t driver_sequence) {
  const std::uint32_t step = driver_sequence - driver_sequence_;  // modulo 2^32
  // A driver that does not count, or counts backwards, is taken to have lost nothing.
  const bool counts = !fresh_stream_ && step >= 1 && step < 0x8000'0000U;
  const std::uint64_t gap = counts ? step - 1 : 0;
  fresh_stream_ = false;
  driver_sequence_ = driver_sequence;
  counters_.lost += gap;
  const std::uint64_t sequence = next_sequence_ + gap;
  next_sequence_ = sequence + 1;
  return sequence;
}

tl::expected<ImageLease, CaptureFailure> V4l2Camera::deliver(const Filled& filled) {
  const std::uint64_t sequence = count_sequence(filled.sequence);
  alive_at_ = device_->now();
  restarts_in_a_row_ = 0;
  const bool yuyv = parameters_.format == StreamFormat::kYuyv;
  if (filled.on_lease) {
    remember(
        fmt::format("{}: image {} is lost: the driver put it where a reader still has an older one", name(), sequence));
    return tl::unexpected(CaptureFailure::kNoSlot);
  }
  if (filled.flagged || filled.bytes == 0 || (yuyv && filled.bytes < image_bytes_)) {
    ++counters_.flagged;
    remember(filled.flagged
                 ? fmt::format("{}: image {} is flagged as damaged by the driver", name(), sequence)
                 : fmt::format("{}: image {} has {} of {} bytes", name(), sequence, filled.bytes, image_bytes_));
    (void)queue(filled.index);
    return tl::unexpected(CaptureFailure::kCorrupt);
  }
  if (!yuyv) return decode(filled, sequence, filled.stamp);
  last_stamp_ = filled.stamp;
  ++counters_.images;
  buffers_->slots.lend(filled.index);
  const ImageView view{buffers_->mapped[static_cast<std::size_t>(filled.index)].at, mode_.width_px, mode_.height_px,
                       stride_bytes_, PixelFormat::kYuyv};
  ImageLease lease(buffers_->slots, filled.index, view, sequence, filled.stamp);
  check_controls();
  return lease;
}

tl::expected<ImageLease, CaptureFailure> V4l2Camera::decode(const Filled& filled, std::uint64_t sequence,
                                                            MonoTime stamp) {
  const auto& source = buffers_->mapped[static_cast<std::size_t>(filled.index)];
  if (buffers_->free_decoded == 0) {
    (void)queue(filled.index);
    remember(
        fmt::format("{}: image {} is lost: all {} buffers are on lease", name(), sequence, buffers_->decoded.size()));
    return tl::unexpected(CaptureFailure::kNoSlot);
  }
  const int slot = std::countr_zero(buffers_->free_decoded);
  std::uint8_t* pixels = buffers_->decoded[static_cast<std::size_t>(slot)].data();
  const auto problem = jpeg_.decode({source.at, filled.bytes}, mode_.width_px, mode_.height_px, pixels);
  (void)queue(filled.index);
  if (!problem.empty()) {
    ++counters_.flagged;
    remember(fmt::format("{}: image {}: {}", name(), sequence, problem));
    return tl::unexpected(CaptureFailure::kCorrupt);
  }
  buffers_->free_decoded &= ~(std::uint32_t{1} << slot);
  last_stamp_ = stamp;
  ++counters_.images;
  buffers_->slots.lend(slot);
  ImageLease lease(buffers_->slots, slot, {pixels, mode_.width_px, mode_.height_px, stride_bytes_, PixelFormat::kYuyv},
                   sequence, stamp);
  check_controls();
  return lease;
}

int V4l2Camera::queue(int index) {
  v4l2_buffer buffer = capture_buffer(index);
  const int error = device_->control(VIDIOC_QBUF, &buffer);
  if (error == 0) ++queued_;
  return error;
}

void V4l2Camera::queue_returned() {
  for (std::uint32_t back = buffers_->slots.take_returned(); back != 0; back &= back - 1) {
    const int slot = std::countr_zero(back);
    if (parameters_.format == StreamFormat::kMjpeg) {
      buffers_->free_decoded |= std::uint32_t{1} << slot;
    } else {
      (void)queue(slot);  // a device that is gone says so when the next image is taken
    }
  }
}

void V4l2Camera::check_controls() {
  if (++images_since_open_ != kImagesUntilControlsAreChecked || all_stand(*device_, wishes_)) return;
  std::string text;
  for (const auto& refused : apply_controls(*device_, wishes_)) text += (text.empty() ? "" : "; ") + refused;
  if (!text.empty()) remember(fmt::format("{}: {}", name(), text));
}

// ---- faults -------------------------------------------------------------------------------------------------------------

void V4l2Camera::restart_stream(const std::string& why) {
  ++counters_.restarts;
  remember(fmt::format("{}: {}; the stream is started again", name(), why));
  if (++restarts_in_a_row_ > kMaxRestartsInARow)
    return lose("it does not deliver images, however often it is restarted");
  // The buffers stay, also those that are on lease: a device whose memory is mapped cannot be set up anew.
  stream_off();
  if (auto streams = stream_on(); !streams) lose(without_name(streams.error().message));
}

/// \return whether the camera still sends what was agreed.
bool V4l2Camera::format_stands() {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  const auto& pix = format.fmt.pix;
  return device_->control(VIDIOC_G_FMT, &format) == 0 && pix.pixelformat == fourcc_of(parameters_.format) &&
         static_cast<int>(pix.width) == parameters_.width_px && static_cast<int>(pix.height) == parameters_.height_px;
}

void V4l2Camera::lose(const std::string& why) {
  close_device();
  gone_since_ = device_->now();
  look_at_ = gone_since_ + seconds(parameters_.reopen_wait_s);
  restarts_in_a_row_ = 0;
  remember(fmt::format("{}: {}; it is looked for every {} s", name(), why, parameters_.reopen_wait_s));
}

void V4l2Camera::look_for_it(MonoTime give_up_at) {
  unmap_what_came_back();
  if (device_->now() < look_at_) {
    (void)device_->wait(std::min(give_up_at, look_at_), false);
    return;
  }
  look_at_ = device_->now() + seconds(parameters_.reopen_wait_s);
  auto mode = open_device();
  if (mode && mode->frame_period == mode_.frame_period) {
    ++counters_.returns;
    remember(fmt::format("{}: back after {:.1f} s", name(), to_seconds(device_->now() - gone_since_)));
    return;
  }
  if (mode) close_device();
  remember(fmt::format("{}: gone for {:.1f} s ({})", name(), to_seconds(device_->now() - gone_since_),
                       mode ? "it came back with another rate" : without_name(mode.error().message)));
}

void V4l2Camera::remember(std::string problem) {
  const std::lock_guard lock(problem_mutex_);
  problem_ = std::move(problem);
}

std::string V4l2Camera::last_problem() const {
  const std::lock_guard lock(problem_mutex_);
  return problem_;
}

}  // namespace cgsr::hal::v4l2
