// The only file that knows libgpiod, in its version 1.6. Version 2 has another interface (no line objects, requests for
// several lines of a chip): it would be a second file beside this one, chosen in CMakeLists.txt.
#include <gpiod.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <memory>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "hal/gpiod/line_access.h"

namespace cgsr::hal::gpiod {
namespace {

constexpr const char* kConsumer = "cgsr";

struct CloseChip {
  void operator()(gpiod_chip* chip) const { gpiod_chip_close(chip); }
};
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

std::string words(int error) {
  return std::generic_category().message(error);
}

std::string text(const char* value) {
  return value == nullptr ? std::string{} : std::string{value};
}

/// A line that was found; the chip keeps it valid.
struct Found {
  Chip chip;
  gpiod_line* line = nullptr;
};

Result<Found> find_by_offset(const std::string& wish, std::size_t colon) {
  const std::string chip_name = wish.substr(0, colon);
  unsigned offset = 0;
  const char* end = wish.data() + wish.size();
  const auto parsed = std::from_chars(wish.data() + colon + 1, end, offset);
  if (parsed.ec != std::errc{} || parsed.ptr != end) {
    return fail(fmt::format("line '{}': expected CHIP:OFFSET, such as gpiochip0:17", wish));
  }
  Found found;
  found.chip.reset(gpiod_chip_open_lookup(chip_name.c_str()));
  if (!found.chip)
    return fail(fmt::format("line '{}': chip '{}' cannot be opened ({})", wish, chip_name, words(errno)));
  found.line = gpiod_chip_get_line(found.chip.get(), offset);
  if (found.line == nullptr) {
    return fail(fmt::format("line '{}': chip '{}' has the lines 0 to {}", wish, chip_name,
                            gpiod_chip_num_lines(found.chip.get()) - 1));
  }
  return found;
}

Result<Found> find_by_name(const std::string& name) {
  Found found;
  found.line = gpiod_line_find(name.c_str());
  if (found.line == nullptr) {
    return fail(
        fmt::format("there is no line '{}' ({}): `cgsr devices` lists the lines of this computer", name, words(errno)));
  }
  found.chip.reset(gpiod_line_get_chip(found.line));
  return found;
}

Result<Found> find_line(const std::string& wish) {
  const auto colon = wish.rfind(':');
  return colon == std::string::npos ? find_by_name(wish) : find_by_offset(wish, colon);
}

class GpiodLines final : public LineAccess {
 public:
  GpiodLines() = default;
  ~GpiodLines() override { GpiodLines::release_all(); }
  GpiodLines(const GpiodLines&) = delete;
  GpiodLines& operator=(const GpiodLines&) = delete;

  Result<int> request(const LineWish& wish) override {
    auto found = find_line(wish.name);
    if (!found) return tl::unexpected(found.error());
    gpiod_line_request_config config{};
    config.consumer = kConsumer;
    config.request_type = wish.output ? GPIOD_LINE_REQUEST_DIRECTION_OUTPUT : GPIOD_LINE_REQUEST_DIRECTION_INPUT;
    config.flags = wish.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
    if (gpiod_line_request(found->line, &config, 0) != 0) {
      const int error = errno;
      const std::string user = error == EBUSY ? text(gpiod_line_consumer(found->line)) : std::string{};
      return fail(fmt::format("line '{}' cannot be requested ({}){}", wish.name, words(error),
                              user.empty() ? "" : ": '" + user + "' uses it"));
    }
    const auto free = std::find_if(lines_.begin(), lines_.end(), [](const Found& held) { return !held.chip; });
    const auto number = free - lines_.begin();
    if (free == lines_.end()) {
      lines_.push_back(std::move(*found));
    } else {
      *free = std::move(*found);
    }
    return static_cast<int>(number);
  }

  int set(int line, bool on) override {
    return gpiod_line_set_value(lines_[static_cast<std::size_t>(line)].line, on ? 1 : 0) == 0 ? 0 : errno;
  }

  int read(int line, bool& on) override {
    const int value = gpiod_line_get_value(lines_[static_cast<std::size_t>(line)].line);
    if (value < 0) return errno;
    on = value != 0;
    return 0;
  }

  void release(int line) override {
    Found& found = lines_[static_cast<std::size_t>(line)];
    if (!found.chip) return;
    gpiod_line_release(found.line);
    found = {};
  }

  void release_all() override {
    for (std::size_t i = 0; i < lines_.size(); ++i) release(static_cast<int>(i));
    lines_.clear();
  }

 private:
  std::vector<Found> lines_;
};

void list_chip(gpiod_chip* chip, std::vector<ListedLine>& lines) {
  for (unsigned offset = 0; offset < gpiod_chip_num_lines(chip); ++offset) {
    gpiod_line* line = gpiod_chip_get_line(chip, offset);
    if (line == nullptr) continue;
    lines.push_back({text(gpiod_chip_name(chip)), offset, text(gpiod_line_name(line)), text(gpiod_line_consumer(line)),
                     gpiod_line_direction(line) == GPIOD_LINE_DIRECTION_OUTPUT});
  }
}

}  // namespace

std::unique_ptr<LineAccess> make_line_access() {
  return std::make_unique<GpiodLines>();
}

std::vector<ListedLine> list_lines() {
  std::vector<ListedLine> lines;
  gpiod_chip_iter* chips = gpiod_chip_iter_new();
  if (chips == nullptr) return lines;  // no chip, or one that may not be opened
  for (gpiod_chip* chip = gpiod_chip_iter_next(chips); chip != nullptr; chip = gpiod_chip_iter_next(chips)) {
    list_chip(chip, lines);
  }
  gpiod_chip_iter_free(chips);
  return lines;
}

}  // namespace cgsr::hal::gpiod
