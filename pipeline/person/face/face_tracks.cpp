#include "pipeline/person/face/face_tracks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "pipeline/person/context.h"
#include "pipeline/person/face/face_descriptor.h"

namespace cgsr::person {
namespace {

constexpr std::int64_t kSecond = 30;  // images

/// A box about the same centre, `size` times as large.
Box centred(const Box& box, double size) {
  const double width = size * box.width, height = size * box.height;
  return {box.x + (box.width - width) / 2, box.y + (box.height - height) / 2, width, height};
}

}  // namespace

FaceTracks::FaceTracks(FaceDetector detector, const FaceTrackParameters& parameters)
    : detector_(std::move(detector)),
      parameters_(parameters),
      asked_at_(static_cast<std::size_t>(parameters.max_comparisons), -kSecond) {
  tracks_.reserve(kMaxFaces);
  found_.reserve(16);
}

FaceTrack* FaceTracks::longest_waiting() {
  FaceTrack* longest = nullptr;
  for (FaceTrack& track : tracks_) {
    if (track.looks_waited_ > 0 && (longest == nullptr || track.looks_waited_ > longest->looks_waited_)) {
      longest = &track;
    }
  }
  return longest;
}

// What a track that has lost its face finds where another one follows a face is that one's: the robot has turned from one person to the next.
void FaceTracks::look_for(FaceTrack& track, const ImageView& image) {
  // A face that is between two of the sizes that are tried is missed again and again: the next look tries others.
  constexpr std::array kSizes{1.0, 1.13, 1.06};  // of thirds of the step between them
  track.looks_waited_ = 0;
  const double size = kSizes[static_cast<std::size_t>(track.missed) % kSizes.size()];
  auto face = detector_.find_near(image, centred(track.box, size));
  const auto follows_it = [&](const FaceTrack& other) {
    return &other != &track && other.missed == 0 && same_face(other.box, *face);
  };
  if (face && track.missed > 0 && std::ranges::any_of(tracks_, follows_it)) face.reset();
  track.seen = face.has_value();
  track.missed = face ? 0 : track.missed + 1;
  if (face) track.box = *face;
}

void FaceTracks::add(const Box& face) {
  if (std::ranges::any_of(tracks_, [&](const FaceTrack& track) { return same_face(track.box, face); })) return;
  if (tracks_.size() == kMaxFaces) {
    const auto lost = std::ranges::max_element(tracks_, {}, &FaceTrack::missed);
    if (lost->missed == 0) return;
    tracks_.erase(lost);
  }
  FaceTrack track;
  track.number = next_number_++;
  track.box = face;
  track.seen = true;
  tracks_.push_back(track);
}

void FaceTracks::age() {
  ++images_;
  for (FaceTrack& track : tracks_) {
    track.seen = false;
    ++track.images_waited_;
  }
}

void FaceTracks::search(const ImageView& image) {
  looks_without_search_ = 0;
  found_.clear();
  for (const FaceTrack& track : tracks_) found_.push_back(track.box);
  const std::size_t known = found_.size();
  detector_.search(image, found_);
  for (std::size_t i = known; i < found_.size(); ++i) add(found_[i]);
}

void FaceTracks::pass(const ImageView& image, WorkBudget& budget) {
  age();
  if (!image.empty() && budget.grant()) search(image);
}

// How large a face is follows from a shirt or a marker to within a third: one size after the other is looked for.
void FaceTracks::expect(const ImageView& image, const Box& expected) {
  constexpr std::array kSizes{1.0, 1.3, 0.77};
  const double size = kSizes[looks_at_expected_++ % kSizes.size()];
  if (const auto face = detector_.find_near(image, centred(expected, size))) add(*face);
}

void FaceTracks::forget_lost() {
  std::erase_if(tracks_, [this](const FaceTrack& track) { return track.missed >= parameters_.max_missed; });
  // Two that were followed onto one face are one: the older stays.
  for (std::size_t i = tracks_.size(); i-- > 1;) {
    const auto older = tracks_.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::any_of(tracks_.begin(), older, [&](const FaceTrack& t) { return same_face(t.box, tracks_[i].box); })) {
      tracks_.erase(older);
    }
  }
}

void FaceTracks::look(const ImageView& image, WorkBudget& budget, const std::optional<Box>& expected) {
  constexpr int kMaxLooksWithoutSearch = 2;
  age();
  if (image.empty()) return;
  for (FaceTrack& track : tracks_) ++track.looks_waited_;
  if (looks_without_search_ >= kMaxLooksWithoutSearch && budget.grant()) search(image);
  ++looks_without_search_;
  bool looked_for_all = true;
  while (FaceTrack* const track = longest_waiting()) {
    looked_for_all = budget.grant();
    if (!looked_for_all) break;
    look_for(*track, image);
  }
  forget_lost();  // also where there are more faces than the budget allows for: a lost one would be found where the next person comes into view
  if (!looked_for_all) return;
  const auto is_there = [&](const FaceTrack& track) { return same_face(track.box, *expected); };
  if (expected && std::ranges::none_of(tracks_, is_there)) {
    if (!budget.grant()) return;
    expect(image, *expected);
  }
  const std::size_t most = detector_.round_of(image.width_px, image.height_px).size();
  for (std::size_t i = 0; i < most && budget.grant(); ++i) search(image);
}

std::optional<FaceQuestion> FaceTracks::question(const ImageView& image) const {
  if (images_ - asked_at_[next_asked_] < kSecond) return std::nullopt;
  const FaceTrack* wanted = nullptr;
  for (const FaceTrack& track : tracks_) {
    if (!track.seen || overdue(track) < 1.0) continue;
    const auto urgency = [this](const FaceTrack& t) { return std::pair(is_new(t), overdue(t)); };
    if (wanted == nullptr || urgency(track) > urgency(*wanted)) wanted = &track;
  }
  if (wanted == nullptr) return std::nullopt;
  const Box& box = wanted->box;
  const double edge = 0.15 * box.width;  // where the background begins
  const Box inner{box.x + edge, box.y + edge, box.width - 2 * edge, box.height - 2 * edge};
  FaceQuestion question{wanted->number, face_crop(image, box), signal_to_noise(image, inner)};
  if (question.crop.pixels.empty()) return std::nullopt;
  return question;
}

// Of some that hardly stand out of the noise it stays open whose they are: they take their turns with the others then.
bool FaceTracks::is_new(const FaceTrack& track) {
  constexpr int kComparisons = 3;
  return !track.match && track.compared_ < kComparisons;
}

// How long a face has waited, by how long it should. Where there are more than may be compared, each gets its share.
double FaceTracks::overdue(const FaceTrack& track) const {
  if (is_new(track)) return 1.0 + track.images_waited_;
  const bool sure =
      track.match && track.match->confidence >= parameters_.min_sure_confidence && !track.votes_.contradicted();
  const int after_images = sure ? parameters_.ask_again_images : parameters_.ask_again_unsure_images;
  return static_cast<double>(track.images_waited_) / after_images;
}

void FaceTracks::asked(std::uint32_t face) {
  asked_at_[next_asked_] = images_;
  next_asked_ = (next_asked_ + 1) % asked_at_.size();
  const auto track = std::ranges::find(tracks_, face, &FaceTrack::number);
  if (track != tracks_.end()) track->images_waited_ = 0;
}

void FaceTracks::hear(const FaceAnswer& answer) {
  const auto track = std::ranges::find(tracks_, answer.face, &FaceTrack::number);
  if (track == tracks_.end()) return;
  ++track->compared_;
  if (!answer.counts) return;
  track->votes_.add(answer.match, parameters_.min_agreeing);
  track->match = track->votes_.match();
}

}  // namespace cgsr::person
