#include "src/sinks/event_text.h"

#include <fmt/format.h>

namespace cgsr::sinks {

std::string text_of(const stages::Event& event) {
  std::string text = fmt::format("{}: {}", event.source, event.state);
  if (!event.reason.empty()) text += fmt::format(": {}", event.reason);
  for (std::size_t i = 0; i < event.number_count; ++i) {
    const stages::EventNumber& number = event.numbers[i];
    text += fmt::format("{}{} {:.4g}{}{}", i == 0 ? " (" : ", ", number.name, number.value,
                        number.unit.empty() ? "" : " ", number.unit);
  }
  if (event.number_count > 0) text += ")";
  return text;
}

}  // namespace cgsr::sinks
