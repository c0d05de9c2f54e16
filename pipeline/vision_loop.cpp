#include "pipeline/vision_loop.h"

#include <cmath>
#include <utility>

namespace cgsr {
namespace {

behavior::LampBelief belief_in(const LampSight& sight, const ShadeSight& shade) {
  using illumination::ObservationStatus;
  behavior::LampBelief belief;
  belief.has_board = sight.has_board;
  const bool registered =
      sight.observation == ObservationStatus::kSeen || sight.observation == ObservationStatus::kNoShadow;
  belief.readable = sight.switching() || (registered && !sight.cone_missing);
  belief.probes_check = sight.probes_check.state;
  belief.lamp_proof = sight.lamp_proof.state;
  belief.seen = sight.seen.status == illumination::LampStatus::kFound;
  belief.masked = shade.status == ShadeStatus::kMasked;
  belief.known = sight.known;
  if (!sight.known) return belief;
  belief.x_m = sight.lamp.p_WL.x();
  belief.y_m = sight.lamp.p_WL.y();
  belief.z_m = sight.lamp.p_WL.z();
  belief.sigma_m = std::sqrt(sight.lamp.covariance.trace());
  return belief;
}

constexpr Duration kPoseKeeps = seconds(0.5);  // a pose that no stage renewed for so long is none to drive by

}  // namespace

Decision VisionLoop::on_image(const ImageLease& image) {
  const auto& view = runner_.run(decode_, image);
  const auto& where = runner_.run(localize_, image, view);  // where am I: chapter 4, glCorrect
  const auto& lamp =
      runner_.run(probes_, image, where);  // where is the lamp: Alg. 5.1, Eq. 5.1 and 5.2, by switching too
  const auto& shade = runner_.run(shade_, where, lamp);                   // what lies in its shadow: 5.2
  const auto& matches = runner_.run(search_, view);                       // where is the object: chapter 3, Alg. 3.2
  const auto& object = runner_.run(track_, image, view, matches, shade);  // and 5.3
  return runner_.run(decide_, image, object, where, lamp, shade);
}

VisionLoop::VisionLoop(runtime::StageRunner& runner, VisionParts parts, behavior::Follow follow, const Pinhole& camera,
                       int max_width_px, int max_height_px)
    : runner_(runner),
      parts_(std::move(parts)),
      follow_(follow),
      no_labels_(parts_.tracker ? 0 : imaging::kColorCodes, 0),
      camera_(camera),
      reduced_(max_width_px, max_height_px),
      decode_("decode", [this](const ImageLease& image) { return decode(image); }),
      localize_("localize", [this](WorkBudget& budget, const ImageLease& image,
                                   const View& view) { return localize(budget, image, view); }),
      probes_("probes", [this](const ImageLease& image,
                               const runtime::Aged<Whereabouts>& where) { return probes(image, where); }),
      shade_("shade",
             [this](const runtime::Aged<Whereabouts>& where, const LampSight& lamp) { return shade(where, lamp); }),
      search_("search", [this](WorkBudget& budget, const View& view) { return search(budget, view); }),
      track_("track",
             [this](WorkBudget& budget, const ImageLease& image, const View& view, const color::SearchResult& matches,
                    const ShadeSight& shade) { return track(budget, image, view, matches, shade); }),
      decide_("decide", [this](const ImageLease& image, const runtime::Aged<Found>& object,
                               const runtime::Aged<Whereabouts>& where, const runtime::Aged<LampSight>& lamp,
                               const ShadeSight& shade) { return decide(image, object, where, lamp, shade); }) {}

void VisionLoop::heard(const hal::Odometry& odometry) {
  if (parts_.where) parts_.where->heard(odometry);
}

VisionLoop::View VisionLoop::decode(const ImageLease& image) {
  const ImageView& view = image.view();
  const int factor = parts_.tracker ? parts_.tracker->reduction(view.width_px, view.height_px)
                                    : imaging::reduction_for(view.width_px, view.height_px, view.width_px);
  if (!imaging::reduce(view, factor, parts_.tracker ? parts_.tracker->labels() : no_labels_, reduced_)) return {};
  return {&reduced_};
}

Whereabouts VisionLoop::localize(WorkBudget& budget, const ImageLease& image, const View& view) {
  Whereabouts where;
  if (!parts_.where || view.reduced == nullptr) return where;
  const auto& reduced = *view.reduced;
  const ImageView grey{reduced.grey.data(), reduced.width_px, reduced.height_px, reduced.width_px, PixelFormat::kGrey8};
  where.has_map = true;
  const ImageView& seen = parts_.where->takes(grey) ? grey : image.view();
  where.camera = parts_.where->look(seen, image.stamp(), budget);
  const geometry::Pose X_WR = parts_.where->robot_at(where.camera.X_WC);
  const bool known = where.camera.state == localization::TrackState::kTracking ||
                     where.camera.state == localization::TrackState::kRecovered;
  where.robot = {known, X_WR.translation().x(), X_WR.translation().y(), geometry::heading_of(X_WR)};
  return where;
}

LampSight VisionLoop::probes(const ImageLease& image, const runtime::Aged<Whereabouts>& where) {
  if (!parts_.lamp) return {};
  using illumination::CheckedLamp;
  Switchboard& board = parts_.switchboard;
  const CheckedLines lines{board.state(LampLine::kProbeLamp, image.stamp()),
                           board.state(LampLine::kRoomLamp, image.stamp())};
  PlacedRobot robot;
  const bool placed = where.value.known() && where.age == Duration::zero();
  if (placed) robot = robot_of(where.value.camera.X_WC, where.value.camera.covariance, parts_.where->X_CR());
  LampSight sight = parts_.lamp->look(image.view(), placed ? &robot : nullptr, lines);
  board.want(LampLine::kProbeLamp, parts_.lamp->wants_on(CheckedLamp::kProbeLamp));
  board.want(LampLine::kRoomLamp, parts_.lamp->wants_on(CheckedLamp::kRoomLamp));
  return sight;
}

ShadeSight VisionLoop::shade(const runtime::Aged<Whereabouts>& where, const LampSight& lamp) {
  if (!parts_.shade) return {};
  if (!where.value.known() || where.age > Duration::zero()) return {.status = ShadeStatus::kPoseUnknown};
  const auto& camera = where.value.camera;
  return parts_.shade->look(camera.X_WC, camera.covariance, lamp.known ? &lamp.lamp : nullptr);
}

color::SearchResult VisionLoop::search(WorkBudget& budget, const View& view) {
  if (view.reduced == nullptr || !parts_.tracker) return {};
  return parts_.tracker->search(*view.reduced, budget);
}

Found VisionLoop::track(WorkBudget& budget, const ImageLease& image, const View& view,
                        const color::SearchResult& matches, const ShadeSight& shade) {
  Found found;
  if (parts_.seek && !parts_.seek->tracks()) return found;
  if (parts_.ball) {
    color::ShadeMaskView mask;
    if (shade.masks != nullptr) {
      mask = {shade.masks->possibly_shaded.data(), shade.masks->width, shade.masks->height, shade.masks->width};
    }
    found.ball = parts_.ball->track(image.view(), mask, budget);
    found.object = {found.ball.found, found.ball.box, found.ball.divergence, found.ball.light, found.ball.light};
    return found;
  }
  if (view.reduced == nullptr || !parts_.tracker) return found;
  found.object = parts_.tracker->track(image.view(), *view.reduced, matches, budget);
  return found;
}

Decision VisionLoop::decide(const ImageLease& image, const runtime::Aged<Found>& object,
                            const runtime::Aged<Whereabouts>& where, const runtime::Aged<LampSight>& lamp,
                            const ShadeSight& shade) {
  const ImageView& view = image.view();
  const Duration elapsed = last_image_ == MonoTime{} ? Duration::zero() : image.stamp() - last_image_;
  last_image_ = image.stamp();
  Decision decision;
  decision.object = object.value.object;
  decision.ball = object.value.ball;
  decision.object_age = object.age;
  decision.where = where.value;
  decision.lamp = lamp.value;
  decision.lamp_age = lamp.age;
  decision.shade = shade;
  behavior::FloorBelief here = where.value.robot;
  here.known = here.known && where.age <= kPoseKeeps;
  if (parts_.seek) {
    decision.seek = parts_.seek->decide(here, belief_in(lamp.value, shade), elapsed);
    decision.goal = decision.seek.goal;
    decision.halt = decision.seek.halt;
    if (parts_.lamp && decision.seek.make_sure) parts_.lamp->make_sure(*decision.seek.make_sure);
    return decision;
  }
  if (parts_.route) {
    decision.route = parts_.route->decide(here, elapsed);
    decision.goal = decision.route.goal;
    decision.halt = decision.route.halt;
    return decision;
  }
  const behavior::Sighting sighting{decision.object.found, decision.object.box, object.age,   view.width_px,
                                    view.height_px,        camera_.fx_px,       camera_.cx_px};
  decision.follow = follow_.decide(sighting, elapsed);
  decision.goal = decision.follow.goal;
  decision.halt = decision.follow.halt;
  return decision;
}

}  // namespace cgsr
