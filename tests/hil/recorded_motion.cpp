#include "tests/hil/recorded_motion.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

namespace cgsr::hil {

Result<RecordedMotion> RecordedMotion::load(const std::string& file) {
  std::ifstream lines(file);
  if (!lines) return fail(fmt::format("{}: {}", file, std::strerror(errno)));
  RecordedMotion recorded;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    unsigned id = 0;
    std::int64_t at_ns = -1;
    std::uint64_t bytes = 0;
    std::istringstream words(line);
    if (!(words >> std::hex >> id >> std::dec >> at_ns >> std::hex >> bytes) || id > 0x7FF || at_ns < 0) {
      return fail(fmt::format("{}:{}: '{}': expected an id, nanoseconds and 8 bytes", file, number, line));
    }
    auto message = std::find_if(recorded.messages_.begin(), recorded.messages_.end(),
                                [id](const Message& known) { return known.id == id; });
    if (message == recorded.messages_.end()) {
      message = recorded.messages_.insert(message, Message{static_cast<std::uint16_t>(id), {}, 0});
    }
    Said said{.at = Duration{at_ns}};
    for (std::size_t i = 0; i < said.data.size(); ++i) said.data[i] = static_cast<std::uint8_t>(bytes >> (56 - 8 * i));
    message->said.push_back(said);
  }
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
