#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "pipeline/runtime/schedule.h"
#include "platform/time.h"

namespace cgsr::runtime {

enum class StageOutcome : std::uint8_t {
  kNotCalled,  ///< the loop did not come to it.
  kNotDue,     ///< the schedule has no turn for it in this frame.
  kSkipped,    ///< it was due and lost the turn, because its last run took too long.
  kRan,
  kFaulted,  ///< it, or a library below it, threw.
};
std::string_view to_string(StageOutcome outcome);

/// What one stage did in one frame.
struct StageRecord {
  std::int64_t elapsed_ns = 0;
  std::uint32_t granted = 0;  ///< units of work the budget permitted.
  StageOutcome outcome = StageOutcome::kNotCalled;
  bool refused =
      false;  ///< the budget ended the work: the output is the best until then. Else the stage stopped by itself.
  bool overran = false;  ///< it took longer than its budget.
};

/// What one frame did: everything that time decided in it, so that a replay can repeat it. Plain bytes of fixed size:
/// it travels through a ring to housekeeping and into recordings.
struct FrameRecord {
  static constexpr std::size_t kFaultBytes = 96;

  std::uint64_t frame = 0;  ///< cycles of the loop since its start.
  std::uint64_t image_sequence = 0;
  MonoTime stamp{};  ///< of the image; without one, the time for which the frame ran.
  MonoTime started{};
  MonoTime finished{};
  std::uint32_t stage_count = 0;
  bool has_image = false;
  bool warm_up = false;  ///< every stage ran, nothing was judged.
  bool late = false;     ///< the frame took longer than the time between two images.
  std::array<char, kFaultBytes>
      fault{};  ///< "stage: what the library said" of the first fault, cut to fit; empty: none.
  std::array<StageRecord, kMostStages> stages{};
};
static_assert(std::is_trivially_copyable_v<FrameRecord>);

/// \return the record's fault as text; valid as long as the record.
std::string_view fault_of(const FrameRecord& record);

/// Writes "stage: what" if the record holds no fault yet. Does not allocate.
void note_fault(FrameRecord& record, std::string_view stage, std::string_view what) noexcept;

}  // namespace cgsr::runtime
