// A video file as an ImageSource, and single images other than JPEG, through FFmpeg.

#include <filesystem>

#include <fmt/format.h>

#include "hal/replay/ffmpeg.h"
#include "hal/replay/image_source.h"

namespace cgsr::hal {
namespace {

// FFmpeg also takes text for pictures (.txt is "ANSI art"), playlists that fetch from the network, and devices: only what is
// named here is opened.
struct Kind {
  const char* containers;
  const char* called;
};
constexpr Kind kVideo{
    "avi,mov,matroska,mjpeg,jpeg_pipe,mpeg,mpegvideo,mpegts,m4v,h264,hevc,ogg,flv,asf,nut,gif,yuv4mpegpipe,dv",
    "a video that can be read here"};
constexpr Kind kImage{"png_pipe,ppm_pipe,pgm_pipe,pbm_pipe,pam_pipe,bmp_pipe,tiff_pipe,webp_pipe",
                      "an image that can be read here"};

// What the conversion to B G R depends on.
struct PictureKind {
  int width_px = 0;
  int height_px = 0;
  AVPixelFormat format = AV_PIX_FMT_NONE;
  AVColorSpace space = AVCOL_SPC_UNSPECIFIED;
  bool full_range = false;
  friend bool operator==(const PictureKind&, const PictureKind&) = default;
};

// The J formats are the plain ones with their range in the name; libswscale wants the range said apart.
PictureKind kind_of(const AVFrame& frame) {
  PictureKind kind{frame.width, frame.height, static_cast<AVPixelFormat>(frame.format), frame.colorspace,
                   frame.color_range == AVCOL_RANGE_JPEG};
  switch (kind.format) {
    case AV_PIX_FMT_YUVJ420P:
      kind.format = AV_PIX_FMT_YUV420P;
      kind.full_range = true;
      break;
    case AV_PIX_FMT_YUVJ422P:
      kind.format = AV_PIX_FMT_YUV422P;
      kind.full_range = true;
      break;
    case AV_PIX_FMT_YUVJ444P:
      kind.format = AV_PIX_FMT_YUV444P;
      kind.full_range = true;
      break;
    case AV_PIX_FMT_YUVJ440P:
      kind.format = AV_PIX_FMT_YUV440P;
      kind.full_range = true;
      break;
    case AV_PIX_FMT_GRAY8:
      kind.full_range = frame.color_range != AVCOL_RANGE_MPEG;
      break;
    default:
      break;
  }
  return kind;
}

ffmpeg::Scaler scaler_for(const PictureKind& kind) {
  // Bit-exact and accurate: the same bytes whichever instruction set libswscale finds. Full chroma: without it limited range
  // comes out 1.8 steps too dark.
  ffmpeg::Scaler scaler(
      sws_getContext(kind.width_px, kind.height_px, kind.format, kind.width_px, kind.height_px, AV_PIX_FMT_BGR24,
                     SWS_BICUBIC | SWS_ACCURATE_RND | SWS_BITEXACT | SWS_FULL_CHR_H_INT, nullptr, nullptr, nullptr));
  if (!scaler) return scaler;
  const int space = kind.space == AVCOL_SPC_BT709                                             ? SWS_CS_ITU709
                    : kind.space == AVCOL_SPC_BT2020_NCL || kind.space == AVCOL_SPC_BT2020_CL ? SWS_CS_BT2020
                                                                                              : SWS_CS_ITU601;
  constexpr int kOne = 1 << 16;
  sws_setColorspaceDetails(scaler.get(), sws_getCoefficients(space), kind.full_range ? 1 : 0,
                           sws_getCoefficients(SWS_CS_DEFAULT), 1, 0, kOne, kOne);
  return scaler;
}

class FfmpegSource final : public ImageSource {
 public:
  FfmpegSource(std::string path, const Kind& kind) : path_(std::move(path)), kind_(kind) {}

  Result<void> open();
  ReadOutcome read(cv::Mat& bgr) override;
  ReadOutcome skip() override { return next_frame(); }
  Result<void> rewind() override { return open(); }  // seeking is not exact in every container
  [[nodiscard]] double claimed_rate_hz() const override { return claimed_rate_hz_; }
  [[nodiscard]] const std::string& problem() const override { return problem_; }
  [[nodiscard]] const std::vector<std::string>& notes() const override { return notes_; }

 private:
  Result<void> open_codec(const AVCodec& decoder, const AVStream& stream);
  ReadOutcome next_frame();
  ReadOutcome feed();
  ReadOutcome refuse(const std::string& why);
  ReadOutcome end();
  ReadOutcome to_bgr(cv::Mat& bgr);

  std::string path_;
  const Kind& kind_;
  ffmpeg::Input input_;
  ffmpeg::Codec codec_;
  ffmpeg::Packet packet_{av_packet_alloc()};
  ffmpeg::Frame frame_{av_frame_alloc()};
  ffmpeg::Scaler scaler_;
  PictureKind picture_;  // what scaler_ was made for
  cv::Mat padded_;       // the image handed out
  int stream_ = -1;
  bool drained_ = false;          // the decoder has been told that no further packet comes,
  int read_error_ = AVERROR_EOF;  // because of this
  std::int64_t announced_ = 0;    // images by the container's word, 0 when it does not say
  std::int64_t seen_ = 0;         // decoded or refused
  double claimed_rate_hz_ = 0.0;
  std::string problem_;
  std::vector<std::string> notes_;
};

Result<void> FfmpegSource::open() {
  ffmpeg::forget_complaints();
  const auto refuse_file = [&](int error) {
    return fail(fmt::format("'{}' is not {}: {}", path_, kind_.called, ffmpeg::words(error)));
  };
  AVDictionary* options = nullptr;
  av_dict_set(&options, "protocol_whitelist", "file", 0);
  av_dict_set(&options, "format_whitelist", kind_.containers, 0);
  AVFormatContext* input = nullptr;
  std::error_code error;
  const std::string url = "file:" + std::filesystem::absolute(path_, error).string();
  const int opened = avformat_open_input(&input, url.c_str(), nullptr, &options);
  av_dict_free(&options);
  if (opened < 0) return refuse_file(opened);
  codec_.reset();
  input_.reset(input);

  if (&kind_ == &kVideo) {  // of an image there is nothing to find out but itself
    if (const int found = avformat_find_stream_info(input, nullptr); found < 0) return refuse_file(found);
  }
  const AVCodec* decoder = nullptr;
  stream_ = av_find_best_stream(input, AVMEDIA_TYPE_VIDEO, -1, -1, &decoder, 0);
  if (stream_ < 0) return fail(fmt::format("'{}' holds no video stream that can be decoded", path_));
  for (unsigned i = 0; i < input->nb_streams; ++i) {
    if (static_cast<int>(i) != stream_) input->streams[i]->discard = AVDISCARD_ALL;
  }
  return open_codec(*decoder, *input->streams[stream_]);
}

Result<void> FfmpegSource::open_codec(const AVCodec& decoder, const AVStream& stream) {
  const AVCodecParameters& parameters = *stream.codecpar;
  if (parameters.width > kLongestSide_px || parameters.height > kLongestSide_px) {
    return fail(fmt::format("'{}' is {}x{}: more than {} on a side is refused", path_, parameters.width,
                            parameters.height, kLongestSide_px));
  }
  codec_.reset(avcodec_alloc_context3(&decoder));
  if (!codec_ || !packet_ || !frame_) return fail("no memory for a video decoder");
  avcodec_parameters_to_context(codec_.get(), &parameters);
  codec_->thread_count = 1;  // no threads that docs/threads.md does not know, and complaints come to the caller
  codec_->flags |= AV_CODEC_FLAG_BITEXACT;
  codec_->max_pixels = std::int64_t{kLongestSide_px} * kLongestSide_px;  // before memory is taken for them
  // Where every image stands alone, a damaged one is refused; elsewhere the decoder conceals and flags what it can. (Not for
  // TIFF: to its decoder every tag that it does not know is damage, and what is cut off it refuses anyway.)
  const AVCodecDescriptor* descriptor = avcodec_descriptor_get(decoder.id);
  const bool image = &kind_ == &kImage && decoder.id != AV_CODEC_ID_TIFF;
  if (image || (&kind_ == &kVideo && descriptor != nullptr && (descriptor->props & AV_CODEC_PROP_INTRA_ONLY) != 0)) {
    codec_->err_recognition = AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER | AV_EF_EXPLODE;
  }
  if (const int opened = avcodec_open2(codec_.get(), &decoder, nullptr); opened < 0) {
    return fail(fmt::format("'{}': its {} images cannot be decoded: {}", path_, decoder.name, ffmpeg::words(opened)));
  }
  const AVRational rate = av_guess_frame_rate(input_.get(), input_->streams[stream_], nullptr);
  claimed_rate_hz_ = rate.den > 0 ? av_q2d(rate) : 0.0;
  announced_ = stream.nb_frames;
  seen_ = 0;
  drained_ = false;
  problem_.clear();
  notes_.clear();
  if (av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr) != nullptr) {
    notes_.emplace_back("the video asks to be turned for display: it is replayed as stored");
  }
  return {};
}

ReadOutcome FfmpegSource::refuse(const std::string& why) {
  problem_ = fmt::format("'{}', image {}: {}", path_, seen_, why);
  ++seen_;
  return ReadOutcome::kRefused;
}

ReadOutcome FfmpegSource::end() {
  if (read_error_ != AVERROR_EOF) {
    problem_ = fmt::format("'{}' ends after {} images: {}", path_, seen_, ffmpeg::words(read_error_));
  } else if (seen_ < announced_) {
    problem_ = fmt::format("'{}' ends after {} of {} announced images: is it cut off?", path_, seen_, announced_);
  }
  return ReadOutcome::kEnd;
}

// Hands the decoder one more packet, or the end. kImage: it may have an image now.
ReadOutcome FfmpegSource::feed() {
  if (drained_) return ReadOutcome::kImage;
  const int got = av_read_frame(input_.get(), packet_.get());
  if (got < 0) {
    drained_ = true;
    read_error_ = got;
    avcodec_send_packet(codec_.get(), nullptr);
    return ReadOutcome::kImage;
  }
  const bool ours = packet_->stream_index == stream_;
  // Half a packet decodes to an image whose rest is made up, and no decoder says so of its own.
  const bool damaged = (packet_->flags & AV_PKT_FLAG_CORRUPT) != 0;
  const int sent = ours && !damaged ? avcodec_send_packet(codec_.get(), packet_.get()) : 0;
  av_packet_unref(packet_.get());
  if (ours && damaged) return refuse("is damaged or cut off");
  return sent < 0 && sent != AVERROR(EAGAIN) ? refuse(ffmpeg::words(sent)) : ReadOutcome::kImage;
}

ReadOutcome FfmpegSource::next_frame() {
  if (!codec_) return ReadOutcome::kEnd;
  ffmpeg::forget_complaints();
  problem_.clear();
  while (true) {
    const int got = avcodec_receive_frame(codec_.get(), frame_.get());
    if (got == AVERROR_EOF) return end();
    if (got == AVERROR(EAGAIN)) {
      if (feed() == ReadOutcome::kRefused) return ReadOutcome::kRefused;
      continue;
    }
    if (got < 0) return refuse(ffmpeg::words(got));
    if ((frame_->flags & AV_FRAME_FLAG_CORRUPT) != 0 || frame_->decode_error_flags != 0) {
      return refuse("is damaged or cut off");
    }
    ++seen_;
    return ReadOutcome::kImage;
  }
}

ReadOutcome FfmpegSource::read(cv::Mat& bgr) {
  const ReadOutcome outcome = next_frame();
  return outcome == ReadOutcome::kImage ? to_bgr(bgr) : outcome;
}

ReadOutcome FfmpegSource::to_bgr(cv::Mat& bgr) {
  const PictureKind kind = kind_of(*frame_);
  if (kind.width_px > kLongestSide_px || kind.height_px > kLongestSide_px) {
    --seen_;
    return refuse(fmt::format("{}x{} is larger than {} on a side", kind.width_px, kind.height_px, kLongestSide_px));
  }
  if (!scaler_ || !(kind == picture_)) {
    scaler_ = scaler_for(kind);
    picture_ = kind;
  }
  if (!scaler_) {
    --seen_;
    return refuse(fmt::format("cannot be converted to B G R: {}", ffmpeg::words(AVERROR(EINVAL))));
  }
  // libswscale writes whole vectors: a row needs room behind its last pixel.
  constexpr int kRoom_px = 64;
  padded_.create(kind.height_px, kind.width_px + kRoom_px, CV_8UC3);
  bgr = padded_(cv::Rect(0, 0, kind.width_px, kind.height_px));
  std::uint8_t* const rows[] = {bgr.data};
  const int strides[] = {static_cast<int>(bgr.step[0])};
  sws_scale(scaler_.get(), frame_->data, frame_->linesize, 0, kind.height_px, rows, strides);
  return ReadOutcome::kImage;
}

}  // namespace

Result<std::unique_ptr<ImageSource>> open_video(const std::string& path) {
  ffmpeg::keep_quiet();
  auto source = std::make_unique<FfmpegSource>(path, kVideo);
  if (auto opened = source->open(); !opened) return tl::unexpected(opened.error());
  return source;
}

std::string read_image_file(const std::string& path, cv::Mat& bgr) {
  ffmpeg::keep_quiet();
  FfmpegSource source(path, kImage);
  if (auto opened = source.open(); !opened) return opened.error().message;
  switch (source.read(bgr)) {
    case ReadOutcome::kImage:
      return {};
    case ReadOutcome::kRefused:
      return source.problem();
    case ReadOutcome::kEnd:
      break;
  }
  return fmt::format("'{}' is cut off: it holds no whole image", path);
}

}  // namespace cgsr::hal
