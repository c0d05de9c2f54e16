#include "pipeline/runtime/frame_record.h"

#include <algorithm>

namespace cgsr::runtime {

std::string_view to_string(StageOutcome outcome) {
  switch (outcome) {
    case StageOutcome::kNotCalled:
      return "not called";
    case StageOutcome::kNotDue:
      return "not due";
    case StageOutcome::kSkipped:
      return "skipped";
    case StageOutcome::kRan:
      return "ran";
    case StageOutcome::kFaulted:
      return "faulted";
  }
  return "unknown";
}

std::string_view fault_of(const FrameRecord& record) {
  const auto end = std::find(record.fault.begin(), record.fault.end(), '\0');
  return {record.fault.data(), static_cast<std::size_t>(end - record.fault.begin())};
}

void note_fault(FrameRecord& record, std::string_view stage, std::string_view what) noexcept {
  if (record.fault.front() != '\0') return;
  auto* place = record.fault.begin();
  for (const auto part : {stage, std::string_view(": "), what}) {
    const auto room = static_cast<std::size_t>(record.fault.end() - 1 - place);
    place = std::copy_n(part.begin(), std::min(part.size(), room), place);
  }
  *place = '\0';
}

}  // namespace cgsr::runtime
