#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "platform/description.h"

namespace cgsr::stages {

/// A number that belongs to an event: a place, a standard deviation.
struct EventNumber {
  std::string_view name;
  double value = 0.0;
  std::string_view unit;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("name", self.name, "what it is");
    visit.number("value", self.value, {4}, "", "its value");
    visit.text("unit", self.unit, "of the value");
  }
};

/// A change that a person who reads the log wants to know of, by the stage or task that it happened to. Its texts live as long as the program.
/// Ours.
struct Event {
  std::string_view source;  ///< what changed: "task", "pose".
  std::string_view state;   ///< into what.
  std::string_view reason;  ///< why; may be empty.
  std::array<EventNumber, 4> numbers{};
  std::size_t number_count = 0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("source", self.source, "what changed");
    visit.text("state", self.state, "the state that it is in now");
    visit.text("reason", self.reason, "why it changed");
    visit.list("numbers", Numbers{self}, "the numbers that belong to it");
  }

 private:
  struct Numbers {
    const Event& event;
    [[nodiscard]] const EventNumber* begin() const { return event.numbers.data(); }
    [[nodiscard]] const EventNumber* end() const { return begin() + event.number_count; }
    [[nodiscard]] std::size_t size() const { return event.number_count; }
  };
};

/// The events of one output in one image, in order; those that find no room are counted, and for_each_event() tells of them.
class Events {
 public:
  static constexpr std::size_t kMaxEvents = 4;

  void add(const Event& event) {
    if (count_ == kMaxEvents) {
      ++lost_;
      return;
    }
    events_[count_++] = event;
  }

  [[nodiscard]] const Event* begin() const { return events_.data(); }
  [[nodiscard]] const Event* end() const { return begin() + count_; }
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] std::size_t lost() const { return lost_; }

 private:
  std::array<Event, kMaxEvents> events_{};
  std::size_t count_ = 0;
  std::size_t lost_ = 0;
};

}  // namespace cgsr::stages
