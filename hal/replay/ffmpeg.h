#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

#include <memory>
#include <string>

/// FFmpeg's handles as owners, and its errors as words. Video files are read and written through it directly: OpenCV 4.6's
/// videoio converts an image whose size changed midway with the size of the first one (it reads beyond the decoder's
/// buffer), hides damaged images, and does not report a failed write.
namespace cgsr::hal::ffmpeg {

struct Deleter {
  void operator()(AVFormatContext* input) const { avformat_close_input(&input); }
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};
using Input = std::unique_ptr<AVFormatContext, Deleter>;
using Codec = std::unique_ptr<AVCodecContext, Deleter>;
using Packet = std::unique_ptr<AVPacket, Deleter>;
using Frame = std::unique_ptr<AVFrame, Deleter>;
using Scaler = std::unique_ptr<SwsContext, Deleter>;

/// Keeps FFmpeg off the terminal, for the whole process, and lets it collect its complaints for words(). Call before use.
void keep_quiet();

/// \return what `error` means, with FFmpeg's last complaint on this thread since forget_complaints() where there is one.
std::string words(int error);
void forget_complaints();

}  // namespace cgsr::hal::ffmpeg
