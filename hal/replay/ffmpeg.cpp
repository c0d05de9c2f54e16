#include "hal/replay/ffmpeg.h"

#include <array>
#include <cstdarg>
#include <cstdio>
#include <string_view>

#include <fmt/format.h>

namespace cgsr::hal::ffmpeg {
namespace {

// Codecs run on the calling thread here (thread_count = 1), so a complaint lands with the call that caused it.
alignas(64) thread_local std::array<char, 256> complaint{};  // aligned: see the linker in cmake/options.cmake

void remember(void*, int level, const char* format, std::va_list arguments) {
  if (level <= AV_LOG_ERROR) std::vsnprintf(complaint.data(), complaint.size(), format, arguments);
}

}  // namespace

void keep_quiet() {
  av_log_set_callback(remember);
}

void forget_complaints() {
  complaint[0] = '\0';
}

std::string words(int error) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> meaning{};
  av_strerror(error, meaning.data(), meaning.size());
  std::string_view said = complaint.data();
  while (!said.empty() && (said.back() == '\n' || said.back() == ' ')) said.remove_suffix(1);
  return said.empty() ? meaning.data() : fmt::format("{} ({})", meaning.data(), said);
}

}  // namespace cgsr::hal::ffmpeg
