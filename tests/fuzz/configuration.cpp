// Whatever stands in the sections of camera and base in a configuration file: read with every value in its range, or refused with the reason.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "hal/rmp/parameters.h"
#include "hal/v4l2/parameters.h"
#include "platform/config/document.h"
#include "platform/config/reader.h"

namespace {

/// What a robot's file says of its camera and its base.
struct Devices {
  cgsr::hal::v4l2::V4l2Parameters v4l2;
  cgsr::hal::rmp::RmpParameters rmp;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("v4l2", self.v4l2, "The camera.");
    visit.section("rmp", self.rmp, "The base.");
  }
};

/// Ends the program at a number that is out of its stated range.
struct InRange {
  void number(std::string_view /*name*/, int value, cgsr::Range<int> range, std::string_view /*unit*/,
              std::string_view /*meaning*/) {
    if (value < range.minimum || value > range.maximum) std::abort();
  }
  void number(std::string_view /*name*/, double value, cgsr::Range<double> range, std::string_view /*unit*/,
              std::string_view /*meaning*/) {
    if (!(value >= range.minimum && value <= range.maximum)) std::abort();
  }
  void flag(std::string_view /*name*/, const bool& /*value*/, std::string_view /*meaning*/) {}
  void text(std::string_view /*name*/, const std::string& /*value*/, std::string_view /*meaning*/) {}
  template <class Enum, class Names>
  void choice(std::string_view /*name*/, const Enum& value, const Names& names, std::string_view /*meaning*/) {
    for (const auto& named : names) {
      if (named.value == value) return;
    }
    std::abort();
  }
  template <class Struct>
  void section(std::string_view /*name*/, const Struct& value, std::string_view /*meaning*/) {
    Struct::describe(value, *this);
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto document = cgsr::config::Document::parse(text, "fuzzed.toml");
  if (!document) {
    if (document.error().message.empty()) std::abort();
    return 0;
  }
  const auto read = cgsr::config::read<Devices>(*document);
  if (!read && read.error().message.empty()) std::abort();
  if (read) {
    InRange check;
    Devices::describe(*read, check);
  }
  return 0;
}
