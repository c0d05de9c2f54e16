#include "pipeline/illumination/probe_observation.h"

namespace cgsr::illumination {
namespace {

constexpr int kAlong = 8;  // places on the board, where its edges are lost in the light
constexpr int kAcross = 16;

/// \return the share of the board's places, seen from where the mount says, that are as bright as the camera can tell.
double share_saturated(const Board& board, const LumaView& luma) {
  const BoardView view(board.camera, board.X_BC);
  int places = 0;
  int saturated = 0;
  for (int i = 0; i < kAlong; ++i) {
    for (int k = 0; k < kAcross; ++k) {
      const auto pixel =
          view.pixel({((i + 0.5) / kAlong - 0.5) * board.depth_m, ((k + 0.5) / kAcross - 0.5) * board.width_m, 0.0});
      if (!pixel.in_front || !luma.holds(pixel.at.x(), pixel.at.y())) continue;
      ++places;
      const float level = luma.at(pixel.at.x(), pixel.at.y());
      saturated += luma.is_clipped(pixel.at.x(), pixel.at.y(), level) ? 1 : 0;
    }
  }
  return places == 0 ? 0.0 : static_cast<double>(saturated) / places;
}

}  // namespace

std::string_view to_string(ObservationStatus status) {
  switch (status) {
    case ObservationStatus::kSeen:
      return "seen";
    case ObservationStatus::kNoShadow:
      return "no shadow";
    case ObservationStatus::kNoImage:
      return "no image";
    case ObservationStatus::kWrongSize:
      return "not the calibrated camera's size";
    case ObservationStatus::kNotRegistered:
      return "board and probes not found";
    case ObservationStatus::kSaturated:
      return "board saturated";
  }
  return "unknown";
}

ProbeObserver::ProbeObserver(const Board& board, const ProbesParameters& parameters, double lamp_height_m)
    : board_(board), parameters_(parameters) {
  finders_.reserve(static_cast<std::size_t>(board.probes));
  strips_.reserve(static_cast<std::size_t>(board.probes));
  for (int i = 0; i < board.probes; ++i) {
    finders_.emplace_back(board, i, parameters.shadow, lamp_height_m);
    strips_.emplace_back(board, i, parameters.shadow, lamp_height_m);
  }
}

ProbeObservation ProbeObserver::observe(const ImageView& image) {
  ProbeObservation observation;
  if (image.empty() || image.format == PixelFormat::kBgr24) return observation;
  if (image.width_px != board_.camera.width_px || image.height_px != board_.camera.height_px) {
    observation.status = ObservationStatus::kWrongSize;
    return observation;
  }
  const LumaView luma(image);
  observation.registration = register_board(board_, parameters_.registration, luma, last_X_BC_, has_last_);
  if (!observation.registration.good && has_last_) {
    observation.registration = register_board(board_, parameters_.registration, luma, last_X_BC_, false);
  }
  has_last_ = observation.registration.good;
  if (!observation.registration.good) {
    observation.status = share_saturated(board_, luma) > kMostSaturated ? ObservationStatus::kSaturated
                                                                        : ObservationStatus::kNotRegistered;
    return observation;
  }
  last_X_BC_ = observation.registration.X_BC;
  int shadows = 0;
  for (std::size_t i = 0; i < finders_.size(); ++i) {
    if ((observation.registration.cones & (1 << i)) == 0) {
      observation.missing |= 1 << i;
      continue;
    }
    observation.probe[i] = finders_[i].find(luma, observation.registration.X_BC);
    shadows += observation.probe[i].count;
    if (finders_[i].is_saturated()) observation.saturated |= 1 << i;
  }
  bool whole = false;
  for (const auto& found : observation.probe) {
    for (int k = 0; k < found.count; ++k) whole = whole || found.shadow[static_cast<std::size_t>(k)].lines == 2;
  }
  if (!whole) shadows += look_beside_cones(luma, observation);
  observation.status = shadows > 0                  ? ObservationStatus::kSeen
                       : observation.saturated != 0 ? ObservationStatus::kSaturated
                                                    : ObservationStatus::kNoShadow;
  return observation;
}

// A strip alone is easily something else: only where no probe shows a whole shadow.
int ProbeObserver::look_beside_cones(const LumaView& luma, ProbeObservation& observation) {
  const BoardView view(board_.camera, observation.registration.X_BC);
  std::array<Outline, kMostProbes> behind;
  for (std::size_t i = 0; i < strips_.size(); ++i) {
    const Probe& probe = board_.probe[i];
    behind[i] = outline_of(probe.foot_B, probe.radius_m, cast(view.p_BC(), probe.p_BA));
  }
  int more = 0;
  for (std::size_t i = 0; i < strips_.size(); ++i) {
    if (((observation.missing | observation.saturated) & (1 << i)) != 0) continue;
    ProbeShadow shadow;
    if (!strips_[i].find(luma, view, behind, shadow)) continue;
    more += 1 - observation.probe[i].count;
    observation.probe[i].count = 1;
    observation.probe[i].shadow[0] = shadow;
  }
  return more;
}

}  // namespace cgsr::illumination
