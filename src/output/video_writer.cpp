#include "src/output/video_writer.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>

#include <fmt/core.h>

#include "hal/replay/ffmpeg.h"

extern "C" {
#include <libavutil/opt.h>
}

namespace cgsr::app {
namespace {

namespace ffmpeg = hal::ffmpeg;

struct CloseOutput {
  void operator()(AVFormatContext* output) const {
    avio_closep(&output->pb);
    avformat_free_context(output);
  }
};
using Output = std::unique_ptr<AVFormatContext, CloseOutput>;

struct Container {
  std::string_view ending;
  const char* format;
  bool jpeg;
};
constexpr Container kContainers[] = {{".avi", "avi", true}, {".mkv", "matroska", true}, {".mp4", "mp4", false}};

const AVCodec* encoder_for(const Container& container) {
  if (container.jpeg) return avcodec_find_encoder(AV_CODEC_ID_MJPEG);
  const AVCodec* h264 = avcodec_find_encoder_by_name("libx264");
  return h264 != nullptr ? h264 : avcodec_find_encoder(AV_CODEC_ID_MPEG4);
}

}  // namespace

struct VideoWriter::File {
  std::string path;
  cv::Size size;  // as create() was told
  Output output;
  ffmpeg::Codec codec;
  ffmpeg::Frame frame{av_frame_alloc()};
  ffmpeg::Packet packet{av_packet_alloc()};
  ffmpeg::Scaler scaler;
  AVStream* stream = nullptr;
  std::int64_t pictures = 0;
  bool open = false;
  bool flush_each = false;  // the container collects pictures and is told to let each one go
  std::optional<Error> failure;

  Result<void> start(const Container& container, double rate_hz);
  int open_codec(const Container& container, double rate_hz);
  int open_file(const Container& container);
  int encode(const AVFrame* picture);
  int finish();
  Result<void> check(int error, std::string_view doing);
};

// Keeps the first error for every later call.
Result<void> VideoWriter::File::check(int error, std::string_view doing) {
  if (error >= 0) return {};
  if (!failure) failure = Error{fmt::format("cannot {} the video '{}': {}", doing, path, ffmpeg::words(error))};
  return tl::unexpected(*failure);
}

int VideoWriter::File::open_codec(const Container& container, double rate_hz) {
  const AVCodec* encoder = encoder_for(container);
  if (encoder == nullptr) return AVERROR_ENCODER_NOT_FOUND;
  codec.reset(avcodec_alloc_context3(encoder));
  if (!codec || !frame || !packet) return AVERROR(ENOMEM);
  codec->width = size.width / 2 * 2;
  codec->height = size.height / 2 * 2;
  codec->framerate = av_d2q(rate_hz, 100'000);
  codec->time_base = av_inv_q(codec->framerate);
  codec->pix_fmt = container.jpeg ? AV_PIX_FMT_YUVJ420P : AV_PIX_FMT_YUV420P;
  codec->color_range = container.jpeg ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
  codec->colorspace = AVCOL_SPC_SMPTE170M;  // BT.601
  codec->thread_count = 1;
  codec->gop_size = std::clamp(static_cast<int>(std::lround(rate_hz / 2)), 1, 30);  // a fragment begins with each
  codec->max_b_frames = 0;
  if ((output->oformat->flags & AVFMT_GLOBALHEADER) != 0) codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  if (container.jpeg || encoder->id == AV_CODEC_ID_MPEG4) {
    codec->flags |= AV_CODEC_FLAG_QSCALE;
    codec->global_quality = 3 * FF_QP2LAMBDA;  // 2 is the best, 31 the worst
  } else {
    av_opt_set(codec->priv_data, "preset", "veryfast", 0);
    av_opt_set(codec->priv_data, "tune", "zerolatency", 0);
    av_opt_set(codec->priv_data, "crf", "20", 0);
  }
  if (const int error = avcodec_open2(codec.get(), encoder, nullptr); error < 0) return error;

  frame->width = codec->width;
  frame->height = codec->height;
  frame->format = codec->pix_fmt;
  frame->quality = codec->global_quality;
  scaler.reset(sws_getContext(codec->width, codec->height, AV_PIX_FMT_BGR24, codec->width, codec->height,
                              AV_PIX_FMT_YUV420P, SWS_BICUBIC | SWS_ACCURATE_RND | SWS_BITEXACT, nullptr, nullptr,
                              nullptr));
  if (!scaler) return AVERROR(ENOMEM);
  const int* bt601 = sws_getCoefficients(SWS_CS_ITU601);
  sws_setColorspaceDetails(scaler.get(), bt601, 1, bt601, container.jpeg ? 1 : 0, 0, 1 << 16, 1 << 16);
  return av_frame_get_buffer(frame.get(), 0);
}

int VideoWriter::File::open_file(const Container& container) {
  stream = avformat_new_stream(output.get(), nullptr);
  if (stream == nullptr) return AVERROR(ENOMEM);
  stream->time_base = codec->time_base;
  stream->avg_frame_rate = codec->framerate;
  if (const int error = avcodec_parameters_from_context(stream->codecpar, codec.get()); error < 0) return error;

  std::error_code ignored;
  const std::string url = "file:" + std::filesystem::absolute(path, ignored).string();
  if (const int error = avio_open(&output->pb, url.c_str(), AVIO_FLAG_WRITE); error < 0) return error;
  AVDictionary* options = nullptr;
  if (!container.jpeg) av_dict_set(&options, "movflags", "frag_keyframe+empty_moov+default_base_moof", 0);
  const int error = avformat_write_header(output.get(), &options);
  av_dict_free(&options);
  if (error < 0) return error;
  avio_flush(output->pb);
  return output->pb->error;
}

Result<void> VideoWriter::File::start(const Container& container, double rate_hz) {
  ffmpeg::keep_quiet();
  ffmpeg::forget_complaints();
  flush_each = container.jpeg;  // an MP4 lets go by fragments
  AVFormatContext* made = nullptr;
  if (auto good = check(avformat_alloc_output_context2(&made, nullptr, container.format, nullptr), "create"); !good) {
    return good;
  }
  output.reset(made);
  if (auto good = check(open_codec(container, rate_hz), "encode"); !good) return good;
  if (auto good = check(open_file(container), "create"); !good) return good;
  open = true;
  return {};
}

// Encodes one picture, or with nullptr what the encoder still holds, and hands all of it to the operating system.
int VideoWriter::File::encode(const AVFrame* picture) {
  int error = avcodec_send_frame(codec.get(), picture);
  while (error >= 0) {
    error = avcodec_receive_packet(codec.get(), packet.get());
    if (error == AVERROR(EAGAIN) || error == AVERROR_EOF) break;
    if (error < 0) return error;
    packet->stream_index = stream->index;
    packet->duration = 1;
    av_packet_rescale_ts(packet.get(), codec->time_base, stream->time_base);
    error = av_write_frame(output.get(), packet.get());
    av_packet_unref(packet.get());
  }
  if (error < 0 && error != AVERROR(EAGAIN) && error != AVERROR_EOF) return error;
  if (flush_each) av_write_frame(output.get(), nullptr);
  avio_flush(output->pb);
  return output->pb->error;
}

int VideoWriter::File::finish() {
  if (const int error = encode(nullptr); error < 0) return error;
  if (const int error = av_write_trailer(output.get()); error < 0) return error;
  avio_flush(output->pb);
  if (output->pb->error < 0) return output->pb->error;
  return avio_closep(&output->pb);
}

VideoWriter::VideoWriter(std::unique_ptr<File> file) : file_(std::move(file)) {}
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&& other) noexcept {
  if (this != &other) {
    static_cast<void>(close());
    file_ = std::move(other.file_);
  }
  return *this;
}
VideoWriter::~VideoWriter() {
  static_cast<void>(close());
}

Result<VideoWriter> VideoWriter::create(const std::string& path, cv::Size size, double rate_hz) {
  const std::string ending = std::filesystem::path(path).extension().string();
  const auto* container =
      std::find_if(std::begin(kContainers), std::end(kContainers), [&](const auto& c) { return c.ending == ending; });
  if (container == std::end(kContainers)) {
    return fail(fmt::format("cannot write the video '{}': its name must end in .avi, .mkv or .mp4", path));
  }
  if (size.width < 2 || size.height < 2 || !(rate_hz > 0.0) || !std::isfinite(rate_hz)) {
    return fail(
        fmt::format("cannot write the video '{}': {}x{} at {} Hz is no video", path, size.width, size.height, rate_hz));
  }
  auto file = std::make_unique<File>();
  file->path = path;
  file->size = size;
  if (auto started = file->start(*container, rate_hz); !started) return tl::unexpected(started.error());
  return VideoWriter(std::move(file));
}

Result<void> VideoWriter::add(const cv::Mat& picture) {
  if (!file_ || !file_->open) return fail("a picture for a video that is closed");
  File& file = *file_;
  if (file.failure) return tl::unexpected(*file.failure);
  if (picture.size() != file.size || picture.type() != CV_8UC3) {
    return fail(fmt::format("a picture of {}x{} and type {} does not fit the video '{}' of {}x{} B G R", picture.cols,
                            picture.rows, picture.type(), file.path, file.size.width, file.size.height));
  }
  ffmpeg::forget_complaints();
  if (auto good = file.check(av_frame_make_writable(file.frame.get()), "encode"); !good) return good;
  const std::uint8_t* const rows[] = {picture.data};
  const int strides[] = {static_cast<int>(picture.step[0])};
  sws_scale(file.scaler.get(), rows, strides, 0, file.codec->height, file.frame->data, file.frame->linesize);
  file.frame->pts = file.pictures;
  if (auto good = file.check(file.encode(file.frame.get()), "write"); !good) return good;
  ++file.pictures;
  return {};
}

Result<void> VideoWriter::close() {
  if (!file_) return {};
  File& file = *file_;
  if (file.open) {
    file.open = false;
    ffmpeg::forget_complaints();
    if (!file.failure) static_cast<void>(file.check(file.finish(), "finish"));
    file.output.reset();
  }
  if (file.failure) return tl::unexpected(*file.failure);
  return {};
}

std::int64_t VideoWriter::pictures() const {
  return file_ ? file_->pictures : 0;
}

}  // namespace cgsr::app
