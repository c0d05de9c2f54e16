#include "tools/lab/tables/people_human3.h"

// Chapter 6's secondary classifiers on recorded people, learned from the first box and never shown a face (6.2.2, 6.3).

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core/types.hpp>

#include "pipeline/person/tracking/person_tracker.h"
#include "platform/config/canonical.h"
#include "src/scoring/scoring.h"
#include "tools/lab/film.h"

namespace cgsr::lab {
namespace {

constexpr person::Label kPerson = 1;
constexpr double kMagnified = 4.0;
constexpr double kNearHeight_px = 276.0;  // of a person before the robot: human3's, magnified

// The recordings that show a whole standing person in the first box.
constexpr std::array<std::string_view, 7> kOthers{"blurbody", "crossing", "jogging", "person12",
                                                  "skating1", "skating2", "subway"};

// A body by its height: the detector's box of a face is 0.16 m wide, that of a standing person 1.75 m tall; the face begins below the hair.
constexpr double kFacePerHeight = 0.16 / 1.75;
constexpr double kHairPerHeight = 0.03;

Box face_of(const Box& body) {
  const double side = kFacePerHeight * body.height;
  return {body.x + 0.5 * (body.width - side), body.y + kHairPerHeight * body.height, side, side};
}

/// Where the body of the first image is now, by the part of it that was seen: about a head as about that image's, about a shirt as about the one that was
/// found first.
class BodyAboutPart {
 public:
  explicit BodyAboutPart(const Box& body) : body_(body), head_{face_of(body), face_of(body).width} {}

  [[nodiscard]] Box at(const person::PersonSighting& part) {
    if (part.source == person::PersonSource::kFaceColor) return about(part, head_);
    if (shirt_.box.empty()) shirt_ = {part.box, part.face_px};
    return about(part, shirt_);
  }

 private:
  struct Seen {
    Box box;
    double face_px = 0.0;
  };
  [[nodiscard]] Box about(const person::PersonSighting& part, const Seen& first) const {
    const double scale = part.face_px > 0.0 && first.face_px > 0.0 ? part.face_px / first.face_px : 1.0;
    const double middle_x = part.box.x + 0.5 * part.box.width, middle_y = part.box.y + 0.5 * part.box.height;
    return {middle_x + scale * (body_.x - first.box.x - 0.5 * first.box.width),
            middle_y + scale * (body_.y - first.box.y - 0.5 * first.box.height), scale * body_.width,
            scale * body_.height};
  }

  Box body_;
  Seen head_;
  Seen shirt_{};
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
  BodyAboutPart about(body);
  for (int i = 0; i < film.size(); ++i) {
    const auto image = film.image(i);
    if (!image) return tl::unexpected(image.error());
    const person::PersonImage seen{.image = image->view(), .interest = kPerson};
    const person::PersonSighting sighting = tracker.update(seen);
    const bool is_person = sighting.person == kPerson && !sighting.box.empty();
    const Box found = is_person ? about.at(sighting) : Box{};
    if (!film.truth[static_cast<std::size_t>(i)] || i == 0) continue;
    const Box& truth = *film.truth[static_cast<std::size_t>(i)];
    followed.identified += is_person ? 1 : 0;
    followed.ours.push_back(is_person ? app::score_image(truth, found).iou : 0.0);
    followed.stays.push_back(app::score_image(truth, body).iou);
  }
  return followed;
}

/// A film magnified by so much.
Result<Film> open_near(const std::filesystem::path& folder, double magnified) {
  const auto recorded = open_film(folder);
  if (!recorded) return tl::unexpected(recorded.error());
  const auto first = recorded->image(0);
  if (!first) return tl::unexpected(first.error());
  const auto even = [magnified](int side) { return 2 * static_cast<int>(magnified * side / 2.0); };
  return open_film(folder, cv::Size(even(first->bgr.cols), even(first->bgr.rows)));
}

void add_rows(Report& report, const std::string& row, const Followed& followed) {
  const int images = static_cast<int>(followed.ours.size());
  report.rows.push_back(mean_row(row, "IoU with the person's box", "", followed.ours, report.seed));
  report.rows.push_back(share_row(row, "identified", followed.identified, images));
}

/// A row for each of the other recordings that is there.
Result<void> add_others(Report& report, const std::filesystem::path& data) {
  for (const std::string_view name : kOthers) {
    const auto folder = data / "tracking" / name;
    if (!std::filesystem::exists(folder)) continue;
    const auto recorded = open_film(folder);
    if (!recorded) return tl::unexpected(recorded.error());
    const double magnified = std::clamp(kNearHeight_px / recorded->truth.front()->height, 1.0, kMagnified);
    const auto followed = open_near(folder, magnified).and_then(follow);
    if (!followed) return tl::unexpected(followed.error());
    add_rows(report, fmt::format("{} / ours, magnified", name), *followed);
  }
  return {};
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
  const auto near = open_near(folder, kMagnified);
  if (!near) return tl::unexpected(near.error());
  Report report{"people-human3", "a person by colours alone, learned from the first box", "", setting.seed, {}, {}, {}};
  const auto as_recorded = follow(*recorded);
  if (!as_recorded) return tl::unexpected(as_recorded.error());
  const auto as_near = follow(*near);
  if (!as_near) return tl::unexpected(as_near.error());
  add_rows(report, "human3 / ours, magnified", *as_near);
  add_rows(report, "human3 / ours", *as_recorded);
  report.rows.push_back(
      mean_row("human3 / first box kept", "IoU with the person's box", "", as_recorded->stays, setting.seed));
  if (const auto added = add_others(report, *setting.data); !added) return tl::unexpected(added.error());
  report.notes = {
      "The first image is shown with a face where that of a standing body would be, until shirt and skin are learned; "
      "no other image has one.",
      "Magnified: every image four times as large, by which the person, 69 pixels high, is as large as before the "
      "robot; colours are looked up at a "
      "quarter of the image's size.",
      "The other recordings that show a whole standing person, where they are there: magnified until the person is as "
      "high, by four at most. "
      "They are no requirement; what makes one recording better has to do so on most.",
      "The body's box lies about the part that identified it, the shirt or the head, as in the first image, scaled by "
      "the face's width that "
      "goes with the part. An image in which nobody is identified counts as 0."};
  return report;
}

}  // namespace cgsr::lab
