#include "pipeline/stages/switchboard.h"

namespace cgsr::stages {

std::string_view to_string(LampLine line) {
  switch (line) {
    case LampLine::kProbeLamp:
      return "probe lamp";
    case LampLine::kRoomLamp:
      return "room lamp";
    case LampLine::kFillLight:
      return "fill light";
  }
  return "unknown";
}

Switchboard::Switchboard(const std::array<bool, kLampLines>& there, Duration frame_period, Duration answer_within)
    : frame_period_(frame_period), answer_within_(answer_within) {
  for (std::size_t i = 0; i < kLampLines; ++i) lines_[i].there = there[i];
}

void Switchboard::want(LampLine line, bool on) {
  of(line).wanted = of(line).there && on;
}

std::optional<SwitchRequest> Switchboard::next(MonoTime now) {
  for (std::size_t i = 0; i < kLampLines; ++i) {
    Line& line = lines_[i];
    if (line.under_way != 0) {
      if (now - line.asked_at <= answer_within_) continue;
      line.silent = true;
      line.under_way = 0;
    }
    const bool asked_lately = line.tries > 0 && now - line.asked_at <= answer_within_;
    if (line.wanted == line.on || line.tries >= kMostTries || asked_lately) continue;
    line.under_way = ++requests_;
    line.asked_at = now;
    ++line.tries;
    return SwitchRequest{static_cast<LampLine>(i), line.wanted, line.under_way, now};
  }
  return std::nullopt;
}

void Switchboard::on_answer(const SwitchAnswer& answer) {
  Line& line = of(answer.request.line);
  if (line.under_way == answer.request.number) line.under_way = 0;
  if (!answer.done) {
    line.silent = true;
    return;
  }
  line.on = answer.request.on;
  line.changed_at = answer.at;
  line.tries = 0;
}

illumination::LineState Switchboard::state(LampLine which, MonoTime stamp) const {
  const Line& line = of(which);
  const bool shown = !line.changed_at || stamp >= *line.changed_at + frame_period_;
  return {line.there, line.on, line.under_way == 0 && line.wanted == line.on && shown, line.silent};
}

}  // namespace cgsr::stages
