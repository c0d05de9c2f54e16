#pragma once

#include <array>
#include <cstddef>

#include "pipeline/runtime/frame_record.h"
#include "pipeline/stages/frame_result.h"
#include "pipeline/stages/switchboard.h"
#include "platform/image_lease.h"
#include "platform/pool.h"

namespace cgsr::sinks {

/// What vision reports about one frame. It holds no lease: what is as large as an image goes with the picture.
struct VisionReport {
  stages::FrameResult frame;
  runtime::FrameRecord record;
};

/// An image on its way to the sinks, with the masks that belong to it.
struct Picture {
  ImageLease image;
  Lease<shade::ShadeMasks> masks;  ///< empty: there are none.
};

/// What the switch worker reports about one switching.
struct SwitchRecord {
  static constexpr std::size_t kProblemBytes = 96;

  stages::SwitchAnswer answer;
  std::array<char, kProblemBytes> problem{};  ///< what the line said, cut to fit; empty: nothing.
};

}  // namespace cgsr::sinks
