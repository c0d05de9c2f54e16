#include "tools/lab/tables/people_human3.h"

// Chapter 6's secondary classifiers on a recorded person, learned from the first box and never shown a face (6.2.2, 6.3).

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "pipeline/person/tracking/person_tracker.h"
#include "platform/config/canonical.h"
#include "src/scoring/scoring.h"
#include "tools/lab/film.h"

namespace cgsr::lab {
namespace {

constexpr person::Label kPerson = 1;
constexpr int kMagnified = 4;

// A body by its height: the detector's box of a face is 0.16 m wide, that of a standing person 1.75 m tall; the face begins below the hair.
constexpr double kFacePerHeight = 0.16 / 1.75;
constexpr double kHairPerHeight = 0.03;

Box face_of(const Box& body) {
  const double side = kFacePerHeight * body.height;
  return {body.x + 0.5 * (body.width - side), body.y + kHairPerHeight * body.height, side, side};
}

/// A body whose part was seen: placed and scaled as the body of the first image is about the same part.
class BodyAboutPart {
 public:
  BodyAboutPart(const Box& body, const person::PersonSighting& part)
      : body_(body), part_(part.box), face_px_(part.face_px) {}

  [[nodiscard]] Box at(const person::PersonSighting& part) const {
    const double scale = part.face_px > 0.0 && face_px_ > 0.0 ? part.face_px / face_px_ : 1.0;
    const double middle_x = part.box.x + 0.5 * part.box.width, middle_y = part.box.y + 0.5 * part.box.height;
    return {middle_x + scale * (body_.x - part_.x - 0.5 * part_.width),
            middle_y + scale * (body_.y - part_.y - 0.5 * part_.height), scale * body_.width, scale * body_.height};
  }

 private:
  Box body_, part_;
  double face_px_;
};

/// As shipped, but for images as large as these.
person::PersonTrackerParameters parameters_for(const Image& first) {
  person::PersonTrackerParameters parameters;
  parameters.shirt.max_width_px = std::max(parameters.shirt.max_width_px, first.bgr.cols);
  parameters.shirt.max_height_px = std::max(parameters.shirt.max_height_px, first.bgr.rows);
  return parameters;
}

/// Shows the first image, with a face where the body's would be, until shirt and skin are learned.
void learn(person::PersonTracker& tracker, const Image& first, const Box& body, int images) {
  person::PersonImage shown{.image = first.view()};
  shown.interest = kPerson;
  person::FaceMatch match;
  match.label = match.nearest = kPerson;
  match.confidence = 1.0;
  shown.face = person::FaceSighting{face_of(body), match};
  for (int i = 0; i < images; ++i) tracker.update(shown);
}

struct Followed {
  std::vector<double> ours, stays;  // IoU of each image
  int identified = 0;
};

Result<Followed> follow(const Film& film) {
  const auto first = film.image(0);
  if (!first) return tl::unexpected(first.error());
  const Box body = *film.truth.front();
  const auto parameters = parameters_for(*first);
  person::PersonTracker tracker(parameters);
  learn(tracker, *first, body, 2 * parameters.shirt.images_to_learn);

  Followed followed;
  std::optional<BodyAboutPart> about;
  for (int i = 0; i < film.size(); ++i) {
    const auto image = film.image(i);
    if (!image) return tl::unexpected(image.error());
    const person::PersonImage seen{.image = image->view(), .interest = kPerson};
    const person::PersonSighting sighting = tracker.update(seen);
    const bool is_person = sighting.person == kPerson && !sighting.box.empty();
    if (is_person && !about) about.emplace(body, sighting);
    if (!film.truth[static_cast<std::size_t>(i)] || i == 0) continue;
    const Box& truth = *film.truth[static_cast<std::size_t>(i)];
    followed.identified += is_person ? 1 : 0;
    followed.ours.push_back(is_person ? app::score_image(truth, about->at(sighting)).iou : 0.0);
    followed.stays.push_back(app::score_image(truth, body).iou);
  }
  return followed;
}

}  // namespace

Result<std::string> person_tracker_hash(const Setting&) {
  return config::hash(person::PersonTrackerParameters{});
}

Result<Report> people_human3(const Setting& setting) {
  if (!setting.data) return fail("people-human3 needs the recorded person: set CGSR_DATA or --data");
  const auto folder = *setting.data / "people/human3";
  const auto recorded = open_film(folder);
  if (!recorded) return tl::unexpected(recorded.error());
  const auto first = recorded->image(0);
  if (!first) return tl::unexpected(first.error());
  const auto near = open_film(folder, cv::Size(kMagnified * first->bgr.cols, kMagnified * first->bgr.rows));
  if (!near) return tl::unexpected(near.error());
  Report report{"people-human3", "a person by colours alone, learned from the first box", "", setting.seed, {}, {}, {}};
  const auto add = [&](const std::string& row, const Followed& followed) {
    const int images = static_cast<int>(followed.ours.size());
    report.rows.push_back(mean_row(row, "IoU with the person's box", "", followed.ours, setting.seed));
    report.rows.push_back(share_row(row, "identified", followed.identified, images));
  };
  const auto as_recorded = follow(*recorded);
  if (!as_recorded) return tl::unexpected(as_recorded.error());
  const auto as_near = follow(*near);
  if (!as_near) return tl::unexpected(as_near.error());
  add("human3 / ours, magnified", *as_near);
  add("human3 / ours", *as_recorded);
  report.rows.push_back(
      mean_row("human3 / first box kept", "IoU with the person's box", "", as_recorded->stays, setting.seed));
  report.notes = {
      "The first image is shown with a face where that of a standing body would be, until shirt and skin are learned; "
      "no other image has one.",
      "Magnified: every image four times as large, by which the person, 69 pixels high, is as large as before the "
      "robot; colours are looked up at a "
      "quarter of the image's size.",
      "The body's box lies about the part that identified it as in the first image, scaled by the face's width that "
      "goes with the part. An image in which nobody is identified counts as 0."};
  return report;
}

}  // namespace cgsr::lab
