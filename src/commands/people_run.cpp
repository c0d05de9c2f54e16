#include "src/commands/people_run.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "pipeline/person/face/face_descriptor.h"
#include "pipeline/person/face/face_recognizer.h"
#include "src/input/face_detector_file.h"
#include "src/input/identities_file.h"
#include "src/output/output_claims.h"
#include "src/output/text_file.h"

namespace cgsr::app {
namespace {

using person::FaceDescriptor;
using person::FaceView;
using person::Identity;
using person::Label;

constexpr std::size_t kMaxProblems = 20;  // that the summary tells one by one
constexpr const char* kColumns = "frame,identity,source,confidence,x,y,width,height";
constexpr std::size_t kMaxFaces = 200;  // of one enrolment: bounds memory

// How far faces are from somebody's views, by how far they are from each other. Photographs of two people are farther; generated faces of two in one light
// begin where those of one in two lights end, so that who looks alike may be refused (--alike), and whose light has changed may not be recognised as the same.
constexpr double kMuchFarther = 1.25;      // somebody else's
constexpr double kFartherThanNamed = 1.7;  // somebody else's than whose they are said to be
constexpr double kAlike = 0.055;           // nearer than this are only images of one sitting,
constexpr double kUnlike = 0.064;          // and farther only images of which some are bad

double distance(const FaceDescriptor& face, const FaceView& view) {
  std::array<double, person::kViewSide * person::kViewSide> points{};
  person::view_distances(face, view, points);
  return std::accumulate(points.begin(), points.end(), 0.0) / static_cast<double>(points.size());
}

/// The first face, then again and again the one that is farthest from those chosen.
/// \return their places.
std::vector<std::size_t> most_different(const std::vector<FaceDescriptor>& faces, std::size_t count) {
  std::vector<std::size_t> chosen;
  std::vector<double> nearest(faces.size(), 1.0);
  std::size_t next = 0;
  while (chosen.size() < std::min(count, faces.size())) {
    chosen.push_back(next);
    const FaceView view = person::view_of(faces[next]);
    for (std::size_t i = 0; i < faces.size(); ++i) nearest[i] = std::min(nearest[i], distance(faces[i], view));
    nearest[next] = -1.0;
    next = static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
  }
  return chosen;
}

/// How far faces of one person are from each other: the mean distance of each from all others together; 0 for a single one.
double mean_distance_among(const std::vector<FaceDescriptor>& faces, const std::vector<std::size_t>& chosen) {
  if (chosen.size() < 2) return 0.0;
  double sum = 0.0;
  for (const std::size_t one : chosen) {
    person::FaceGallery others(person::FaceMatchParameters{.min_views = 1});
    for (const std::size_t other : chosen) {
      if (other != one) others.enroll(1, person::view_of(faces[other]));
    }
    sum += others.identify(faces[one]).distance;
  }
  return sum / static_cast<double>(chosen.size());
}

/// The faces that are alone in their image.
Result<std::vector<FaceDescriptor>> lone_faces(const PeopleOptions& options, Enrolled& enrolled) {
  auto search = FaceSearch::open(options);
  if (!search) return tl::unexpected(search.error());
  auto input = ImageInput::open({options.input, 0, 0, 0, 0});
  if (!input) return tl::unexpected(input.error());
  std::vector<FaceDescriptor> faces;
  std::optional<Box> last;
  std::pair<int, int> last_size;
  for (auto next = input->next(); !next.end && faces.size() < kMaxFaces; next = input->next()) {
    ++enrolled.images;
    if (!next.image) continue;
    const ImageView image = next.image.view();
    if (std::pair(image.width_px, image.height_px) != last_size) last.reset();
    const auto found = search->find(image, last);
    if (found.size() > 1) continue;
    if (found.empty()) {
      last.reset();
      continue;
    }
    last = found.front();
    last_size = {image.width_px, image.height_px};
    if (auto described = person::describe_face(image, *last)) faces.push_back(std::move(*described));
  }
  enrolled.with_one_face = static_cast<int>(faces.size());
  if (faces.empty()) {
    return fail(fmt::format("{}: no image of {} with exactly one face", options.input, enrolled.images));
  }
  return faces;
}

std::string person_name(const person::Identities& identities, Label number) {
  const auto one = std::ranges::find(identities.people, number, &Identity::number);
  return one == identities.people.end() ? "a stranger" : one->name;
}

/// \return the person whose face most of these are, if they are one's: named by the gallery, and not much farther from that person than from each other.
/// The gallery alone is not enough where few are enrolled: nobody tells it how alike faces are in this light, from this camera.
std::optional<Label> person_of_most(const std::vector<FaceDescriptor>& faces, double among,
                                    const person::FaceGallery& gallery) {
  struct Named {
    std::size_t faces = 0;
    double distance = 0.0;  // sum
  };
  std::map<Label, Named> named;
  for (const FaceDescriptor& face : faces) {
    const auto match = gallery.identify(face);
    if (!match.label) continue;
    ++named[*match.label].faces;
    named[*match.label].distance += match.distance;
  }
  const auto fewer = [](const auto& a, const auto& b) { return a.second.faces < b.second.faces; };
  const auto most = std::ranges::max_element(named, fewer);
  if (most == named.end() || 2 * most->second.faces <= faces.size()) return std::nullopt;
  const double away = most->second.distance / static_cast<double>(most->second.faces);
  if (away > kMuchFarther * std::clamp(among, kAlike, kUnlike)) return std::nullopt;
  return most->first;
}

/// \return the person who gets the views: known already, or new.
Result<Identity*> person_to_enroll(person::Identities& identities, const PeopleOptions& options) {
  const auto known = std::ranges::find(identities.people, options.name, &Identity::name);
  const bool is_known = known != identities.people.end();
  if (is_known && !options.more) {
    return fail(
        fmt::format("{}: '{}' is there already, as number {}; --more adds views to that person, somebody else "
                    "needs another name",
                    options.identities, options.name, known->number));
  }
  if (!is_known && options.more) return fail(fmt::format("{}: there is no '{}'", options.identities, options.name));
  if (is_known) return &*known;
  if (const auto problem = name_problem(options.name)) return fail("--name: " + *problem);
  identities.people.push_back({identities.next_number++, options.name, {}});
  return &identities.people.back();
}

/// The first view stays, as in a run's gallery (FaceMatchParameters::max_views): the others were chosen by how they differ from it.
void add_views(std::vector<FaceView>& views, const std::vector<FaceDescriptor>& faces,
               const std::vector<std::size_t>& chosen, std::size_t max_views) {
  for (const std::size_t one : chosen) views.push_back(person::view_of(faces[one]));
  if (views.size() <= max_views) return;
  const auto too_many = static_cast<std::ptrdiff_t>(views.size() - max_views);
  views.erase(views.begin() + 1, views.begin() + 1 + too_many);
}

/// Whether faces are much farther from somebody's views than they are from each other: then they are somebody else's, or bad.
bool are_unlike(const std::vector<FaceDescriptor>& faces, double among, const std::vector<FaceView>& views) {
  if (views.empty()) return false;
  person::FaceGallery hers(person::FaceMatchParameters{.min_views = 1});
  for (const FaceView& view : views) hers.enroll(1, view);
  double sum = 0.0;
  for (const FaceDescriptor& face : faces) sum += hers.identify(face).distance;
  return sum / static_cast<double>(faces.size()) > kFartherThanNamed * std::clamp(among, kAlike, kUnlike);
}

/// Adds the person whose faces these are to those who are known.
Result<void> enroll_among(person::Identities& identities, const std::vector<FaceDescriptor>& faces,
                          const PeopleOptions& options, Enrolled& enrolled) {
  const person::FaceGallery others = gallery_of(identities);
  const auto who = person_to_enroll(identities, options);
  if (!who) return tl::unexpected(who.error());
  enrolled.number = (*who)->number;
  const auto max_views = static_cast<std::size_t>(person::FaceMatchParameters{}.max_views);
  const auto chosen = most_different(faces, max_views);
  const double among = mean_distance_among(faces, chosen);
  const auto other = person_of_most(faces, among, others);
  if (other && *other != enrolled.number && !options.alike) {
    return fail(
        fmt::format("{}: this is the face of '{}', who is enrolled already; --alike enrols somebody else who "
                    "looks like that person",
                    options.input, person_name(identities, *other)));
  }
  if (!options.alike && are_unlike(faces, among, (*who)->views)) {
    return fail(fmt::format("{}: this is not the face of '{}' as far as it is known; --alike adds it all the same",
                            options.input, options.name));
  }
  add_views((*who)->views, faces, chosen, max_views);
  enrolled.views = static_cast<int>((*who)->views.size());
  return {};
}

}  // namespace

Result<FaceSearch> FaceSearch::open(const PeopleOptions& options) {
  person::FaceDetectorParameters parameters;
  parameters.min_face_px = options.min_face_px;
  auto detector = read_face_detector(options.cascade, parameters);
  if (!detector) return tl::unexpected(detector.error());
  auto eyes = read_eye_detector(options.eye_cascade);
  if (!eyes) return tl::unexpected(eyes.error());
  return FaceSearch(std::move(*detector), std::move(*eyes));
}

std::vector<Box> FaceSearch::find(const ImageView& image, const std::optional<Box>& last) {
  auto faces = detector_.find_all(image);
  if (!faces.empty()) return faces;
  if (last) {
    if (const auto face = detector_.find_near(image, *last)) return {*face};
  }
  if (!eyes_) return {};
  faces = detector_.find_all_dark(image);
  std::erase_if(faces, [&](const Box& face) { return !eyes_->has_eye(person::face_crop(image, face)); });
  return faces;
}

// Looking through the images may take long: the file is not held meanwhile.
Result<Enrolled> enroll(const PeopleOptions& options) {
  if (const auto could = IdentitiesEdit::open(options.identities); !could) return tl::unexpected(could.error());
  Enrolled enrolled;
  const auto faces = lone_faces(options, enrolled);
  if (!faces) return tl::unexpected(faces.error());
  auto file = IdentitiesEdit::open(options.identities);
  if (!file) return tl::unexpected(file.error());
  if (const auto added = enroll_among(file->identities(), *faces, options, enrolled); !added)
    return tl::unexpected(added.error());
  auto note = file->save();
  if (!note) return tl::unexpected(note.error());
  enrolled.note = std::move(*note);
  return enrolled;
}

Result<Forgotten> forget(const PeopleOptions& options) {
  const auto sound = load_identities(options.identities);
  if (!sound) return tl::unexpected(sound.error());
  auto file = IdentitiesEdit::open(options.identities);
  if (!file) return tl::unexpected(file.error());
  const auto is_it = [&](const Identity& one) { return one.name == options.name; };
  if (std::erase_if(file->identities().people, is_it) == 0)
    return fail(fmt::format("{}: there is no '{}'", options.identities, options.name));
  if (const auto note = file->save(); !note) return tl::unexpected(note.error());
  return Forgotten{kept_aside(options.identities)};
}

IdentifyRun::IdentifyRun(PeopleOptions options, person::Identities identities, ImageInput input, FaceSearch search,
                         std::optional<TextFile> csv)
    : options_(std::move(options)),
      identities_(std::move(identities)),
      input_(std::move(input)),
      search_(std::move(search)),
      gallery_(gallery_of(identities_)),
      csv_(std::move(csv)) {}

Result<IdentifyRun> IdentifyRun::open(const PeopleOptions& options) {
  OutputClaims files(options.force);
  files.reads(options.identities, "--identities");
  files.reads(options.input, "--input");
  files.reads(options.cascade, "--cascade");
  if (!options.eye_cascade.empty()) files.reads(options.eye_cascade, "--eye-cascade");
  files.writes(options.csv, "--csv", csv_file(kColumns));
  if (auto claimed = files.claim(); !claimed) return tl::unexpected(claimed.error());
  auto identities = load_identities(options.identities);
  if (!identities) return tl::unexpected(identities.error());
  if (identities->people.empty()) return fail(fmt::format("{}: nobody is enrolled", options.identities));
  auto search = FaceSearch::open(options);
  if (!search) return tl::unexpected(search.error());
  auto input = ImageInput::open({options.input, 0, 0, 0, 0});
  if (!input) return tl::unexpected(input.error());
  std::optional<TextFile> csv;
  if (!options.csv.empty()) {
    auto created = TextFile::create(options.csv);
    if (!created) return tl::unexpected(created.error());
    csv = std::move(*created);
    if (auto added = csv->add_line(kColumns); !added) return tl::unexpected(added.error());
  }
  return IdentifyRun(options, std::move(*identities), std::move(*input), std::move(*search), std::move(csv));
}

Result<void> IdentifyRun::add_row(const std::string& row) {
  return csv_ ? csv_->add_line(row) : Result<void>{};
}

Result<bool> IdentifyRun::add_face(const ImageView& image, const Box& face) {
  const person::GreyPatch crop = person::face_crop(image, face);
  if (crop.pixels.empty()) return false;
  const auto match = person::identify_crop(crop, gallery_);
  if (!match.label && !search_.has_eye(crop)) return false;
  const Label number = match.label.value_or(0);
  ++seen_[number];
  ++faces_;
  const auto added = add_row(fmt::format("{},{},face,{:.3f},{:.1f},{:.1f},{:.1f},{:.1f}", images_, number,
                                         match.confidence, face.x, face.y, face.width, face.height));
  if (!added) return tl::unexpected(added.error());
  return true;
}

Result<bool> IdentifyRun::step() {
  const auto next = input_.next();
  if (next.end) return false;
  Result<void> written;
  if (next.image) {
    bool any = false;
    for (const Box& face : search_.find(next.image.view())) {
      const auto added = add_face(next.image.view(), face);
      if (!added) return tl::unexpected(added.error());
      any = any || *added;
    }
    if (!any) written = add_row(fmt::format("{},,none,,,,,", images_));
  } else {
    if (problems_.size() < kMaxProblems) problems_.push_back(fmt::format("image {}: {}", images_, next.problem));
    ++unreadable_;
    written = add_row(fmt::format("{},,unreadable,,,,,", images_));
  }
  if (!written) return tl::unexpected(written.error());
  ++images_;
  return true;
}

std::vector<std::string> IdentifyRun::summary() const {
  std::vector<std::string> lines;
  for (const auto& [number, count] : seen_)
    lines.push_back(fmt::format("{:6} faces: number {}, {}", count, number, person_name(identities_, number)));
  lines.insert(lines.end(), problems_.begin(), problems_.end());
  if (unreadable_ > static_cast<int>(problems_.size()))
    lines.push_back(fmt::format("{} images in all were not readable", unreadable_));
  return lines;
}

}  // namespace cgsr::app
