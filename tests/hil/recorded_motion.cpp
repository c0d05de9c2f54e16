#include "tests/hil/recorded_motion.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

#include <fmt/format.h>

namespace cgsr::hil {
namespace {

/// A line of the file.
struct Line {
  std::uint16_t id = 0;
  Duration at{};
  std::array<std::uint8_t, 8> data{};
};

/// \return nothing when the line is not an id, nanoseconds and 8 bytes.
std::optional<Line> line_of(const std::string& text) {
  constexpr const char* kHexadecimal = "0123456789abcdefABCDEF";
  Line line;
  unsigned id = 0;
  std::int64_t at_ns = -1;
  std::string bytes;
  std::string rest;
  std::istringstream words(text);
  if (!(words >> std::hex >> id >> std::dec >> at_ns >> bytes) || words >> rest) return std::nullopt;
  if (id > 0x7FF || at_ns < 0 || bytes.size() != 2 * line.data.size()) return std::nullopt;
  if (bytes.find_first_not_of(kHexadecimal) != std::string::npos) return std::nullopt;
  line.id = static_cast<std::uint16_t>(id);
  line.at = Duration{at_ns};
  for (std::size_t i = 0; i < line.data.size(); ++i) {
    line.data[i] = static_cast<std::uint8_t>(std::stoul(bytes.substr(2 * i, 2), nullptr, 16));
  }
  return line;
}

}  // namespace

Result<RecordedMotion> RecordedMotion::load(const std::string& file) {
  std::ifstream lines(file);
  if (!lines) return fail(fmt::format("{}: {}", file, std::strerror(errno)));
  RecordedMotion recorded;
  std::string text;
  Duration before{};
  for (int number = 1; std::getline(lines, text); ++number) {
    const auto line = line_of(text);
    if (!line) {
      return fail(fmt::format("{}:{}: '{}': expected an id, nanoseconds and 8 bytes", file, number, text));
    }
    if (line->at < before) {
      return fail(fmt::format("{}:{}: {} ns: expected no earlier than {} ns, as in the line before", file, number,
                              line->at.count(), before.count()));
    }
    before = line->at;
    auto message = std::find_if(recorded.messages_.begin(), recorded.messages_.end(),
                                [&line](const Message& known) { return known.id == line->id; });
    if (message == recorded.messages_.end()) message = recorded.messages_.insert(message, Message{line->id, {}, 0});
    message->said.push_back({line->at, line->data});
  }
  if (recorded.messages_.empty()) return fail(fmt::format("{}: holds no message", file));
  return recorded;
}

void RecordedMotion::replace(hal::CanFrame& frame, Duration since_begin) {
  for (Message& message : messages_) {
    if (message.id != frame.id) continue;
    while (message.next + 1 < message.said.size() && message.said[message.next + 1].at <= since_begin) ++message.next;
    frame.data = message.said[message.next].data;
    return;
  }
}

}  // namespace cgsr::hil
