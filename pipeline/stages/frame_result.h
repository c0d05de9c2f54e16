#pragma once

#include "pipeline/runtime/aged.h"
#include "pipeline/stages/decision.h"
#include "pipeline/stages/decode_stage.h"
#include "pipeline/stages/identify_stage.h"
#include "pipeline/stages/localize_stage.h"
#include "pipeline/stages/probes_stage.h"
#include "pipeline/stages/search_stage.h"
#include "pipeline/stages/shade_stage.h"
#include "pipeline/stages/track_stage.h"

namespace cgsr::stages {

/// What is known beside the image when it comes.
struct FrameInputs {
  std::optional<hal::Odometry> odometry;  ///< of the base, at the image's exposure.
  LampLines lamps{};                      ///< the switched lamps' lines as this image shows them.
  Requests requests;                      ///< of the decision about the last image.
};

/// What one image led to: the last output of every stage (the components of Fig. 5.1), with its age.
struct FrameResult {
  std::optional<hal::Odometry> odometry;  ///< of the base, at this image's exposure; for tasks that need no map.
  runtime::Aged<View> view;
  runtime::Aged<PoseEstimate> pose;
  runtime::Aged<LampReport> lamp;
  runtime::Aged<ShadowMasks> shade;
  runtime::Aged<color::SearchResult> matches;
  runtime::Aged<TrackedObjects> objects;
  runtime::Aged<IdentifiedPeople> people;
  runtime::Aged<Decision> decision;
};

/// Shows every described output of a frame to a reader: the one list from which CSV, summary, overlay, recording and digests are made.
/// A new output is appended: the columns and topics of the others stay where they are.
/// \param read  called with name (topic and key), meaning, and the Aged output.
template <class Frame, class Read>
void for_each_output(Frame& frame, Read read) {
  read("objects", "The tracked object.", frame.objects);
  read("decision", "What the task decided.", frame.decision);
  read("pose", "The estimated pose.", frame.pose);
  read("lamp", "What the probes say of the lamp.", frame.lamp);
  read("shade", "The state of the shadow masks.", frame.shade);
  read("people", "Who is in view.", frame.people);
}

/// Shows every event of this image to a reader, in the order of the outputs. One more event says how many of an output found no room.
/// \param read  called with an Event.
template <class Read>
void for_each_event(const FrameResult& frame, Read read) {
  for_each_output(frame, [&read](std::string_view name, std::string_view, const auto& output) {
    if constexpr (requires { output.value.events; }) {
      if (!output.fresh()) return;
      const Events& events = output.value.events;
      for (const Event& event : events) read(event);
      if (events.lost() == 0) return;
      read(Event{name, "events lost", {}, {{{"count", static_cast<double>(events.lost()), ""}}}, 1});
    }
  });
}

}  // namespace cgsr::stages
