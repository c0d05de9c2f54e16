#include "tools/lab/tables/faces_caltech.h"

// Chapter 6's primary classifier on photographs: whose face it is, and whether it is anybody's (6.2.1).

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/person/face/eye_detector.h"
#include "pipeline/person/face/face_descriptor.h"
#include "pipeline/person/face/face_detector.h"
#include "pipeline/person/face/face_gallery.h"
#include "pipeline/person/face/face_recognizer.h"
#include "platform/config/canonical.h"

namespace cgsr::lab {
namespace {

namespace fs = std::filesystem;
using person::Label;

constexpr const char* kCascade = "/usr/share/opencv4/haarcascades/haarcascade_frontalface_alt2.xml";
constexpr const char* kEyeCascade = "/usr/share/opencv4/haarcascades/haarcascade_eye.xml";
constexpr int kEnrolled = 2;  // the first images of each person

struct Photograph {
  fs::path file;
  Label who = 0;
  bool enrolled = false;
  bool found = false;
  bool has_eye = false;
  person::GreyPatch face{};  // its crop
  cv::Mat sift{};            // what the dissertation keeps: descriptors of SIFT points in the crop
};

/// The photographs of one collection in their order; the first of each person who has more than one are enrolled.
struct Collection {
  std::string name;
  std::vector<Photograph> photographs;
  std::map<Label, int> images;

  void add(const fs::path& file, Label who) {
    photographs.push_back({.file = file, .who = who, .enrolled = images[who] < kEnrolled});
    ++images[who];
  }
  [[nodiscard]] bool is_known(Label who) const { return images.at(who) > kEnrolled; }
};

Result<Collection> caltech(const fs::path& folder) {
  Collection collection{"caltech", {}, {}};
  std::ifstream list(folder / "labels.csv");
  std::map<std::string, Label> numbers;
  std::string line;
  std::getline(list, line);
  while (std::getline(list, line)) {
    const auto comma = line.find(',');
    if (comma == std::string::npos) return fail(fmt::format("{}: no comma in '{}'", folder.string(), line));
    const auto who = numbers.try_emplace(line.substr(comma + 1), static_cast<Label>(numbers.size())).first->second;
    collection.add(folder / line.substr(0, comma), who);
  }
  if (collection.photographs.empty()) return fail(fmt::format("{}: no labels.csv with images", folder.string()));
  return collection;
}

struct Detectors {
  person::FaceDetector faces;
  person::EyeDetector eyes;
};

Collection essex(const fs::path& folder) {
  Collection collection{"essex94", {}, {}};
  std::error_code missing;
  std::set<fs::path> people;
  for (const auto& entry : fs::directory_iterator(folder, missing)) people.insert(entry.path());
  Label who = 0;
  for (const fs::path& one : people) {
    std::set<fs::path> files;
    for (const auto& entry : fs::directory_iterator(one, missing)) files.insert(entry.path());
    for (const fs::path& file : files) collection.add(file, who);
    ++who;
  }
  return collection;
}

Result<void> describe(Collection& collection, Detectors& detectors) {
  const auto sift = cv::SIFT::create();
  for (Photograph& photograph : collection.photographs) {
    const cv::Mat grey = cv::imread(photograph.file.string(), cv::IMREAD_GRAYSCALE);
    if (grey.empty()) return fail(fmt::format("{}: cannot be read", photograph.file.string()));
    const ImageView image{grey.data, grey.cols, grey.rows, static_cast<std::ptrdiff_t>(grey.step), PixelFormat::kGrey8};
    const auto faces = detectors.faces.find_all(image);
    const auto larger = [](const Box& a, const Box& b) { return a.area() < b.area(); };
    const auto face = std::max_element(faces.begin(), faces.end(), larger);
    if (face == faces.end()) continue;
    photograph.found = true;
    photograph.face = person::face_crop(image, *face);
    photograph.has_eye = detectors.eyes.has_eye(photograph.face);
    const cv::Rect crop =
        cv::Rect(cv::Rect2d(face->x, face->y, face->width, face->height)) & cv::Rect(0, 0, grey.cols, grey.rows);
    std::vector<cv::KeyPoint> points;
    sift->detectAndCompute(grey(crop), {}, points, photograph.sift);
  }
  return {};
}

int matches(const cv::Mat& seen, const cv::Mat& enrolled) {
  if (seen.empty() || enrolled.rows < 2) return 0;
  std::vector<std::vector<cv::DMatch>> pairs;
  cv::BFMatcher(cv::NORM_L2).knnMatch(seen, enrolled, pairs, 2);
  const auto clear = [](const auto& pair) { return pair[0].distance < 0.8F * pair[1].distance; };
  return static_cast<int>(std::count_if(pairs.begin(), pairs.end(), clear));
}

/// \return whose enrolled images share most SIFT points with this one, as in 6.2.1.
Label most_matches(const Collection& collection, const Photograph& seen) {
  std::map<Label, int> counts;
  for (const Photograph& one : collection.photographs) {
    if (one.enrolled && collection.is_known(one.who)) counts[one.who] += matches(seen.sift, one.sift);
  }
  const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
  return std::max_element(counts.begin(), counts.end(), fewer)->first;
}

void measure(const Collection& collection, const person::FaceMatchParameters& parameters, Report& report) {
  person::FaceGallery gallery(parameters);
  for (const Photograph& one : collection.photographs) {
    if (!one.enrolled || !one.found) continue;
    if (const auto face = person::describe_crop(one.face)) gallery.enroll(one.who, person::view_of(*face));
  }
  int seen = 0, found = 0, with_eye = 0, counted_right = 0, nearest_right = 0, accepted_right = 0, accepted_wrong = 0;
  int strangers = 0, accepted_strangers = 0, single = 0, single_accepted = 0;
  for (const Photograph& one : collection.photographs) {
    const bool known = collection.is_known(one.who);
    if (one.enrolled && known) continue;
    const auto left_out = person::identify_crop(one.face, gallery, one.who);
    ++strangers;
    accepted_strangers += left_out.label ? 1 : 0;
    if (!known) {
      ++single;
      single_accepted += person::identify_crop(one.face, gallery).label ? 1 : 0;
      continue;
    }
    ++seen;
    found += one.found ? 1 : 0;
    with_eye += one.has_eye ? 1 : 0;
    const auto match = person::identify_crop(one.face, gallery);
    nearest_right += match.nearest == one.who ? 1 : 0;
    accepted_right += match.label == one.who ? 1 : 0;
    accepted_wrong += match.label && match.label != one.who ? 1 : 0;
    counted_right += most_matches(collection, one) == one.who ? 1 : 0;
  }
  const auto add = [&](const char* row, const char* quantity, int share, int of) {
    if (of > 0) report.rows.push_back(share_row(collection.name + " / " + row, quantity, share, of));
  };
  add("detector", "found", found, seen);
  add("detector", "shows an eye, of those found", with_eye, found);
  add("SIFT points, count", "right, nobody refused", counted_right, seen);
  add("ours", "right, nobody refused", nearest_right, seen);
  add("ours", "accepted and right", accepted_right, seen);
  add("ours", "accepted and wrong", accepted_wrong, seen);
  add("ours", "false acceptance, leave one out", accepted_strangers, strangers);
  add("ours", "accepted with a single image", single_accepted, single);
}

Result<std::string> text_of(const char* cascade) {
  std::ifstream in(cascade);
  std::stringstream text;
  text << in.rdbuf();
  if (!in) return fail(fmt::format("{}: cannot be read: Debian's opencv-data has it", cascade));
  return text.str();
}

Result<Detectors> shipped_detectors() {
  const auto face_cascade = text_of(kCascade), eye_cascade = text_of(kEyeCascade);
  if (!face_cascade) return tl::unexpected(face_cascade.error());
  if (!eye_cascade) return tl::unexpected(eye_cascade.error());
  auto faces = person::FaceDetector::from_cascade(*face_cascade, {});
  if (!faces) return tl::unexpected(faces.error());
  auto eyes = person::EyeDetector::from_cascade(*eye_cascade);
  if (!eyes) return tl::unexpected(eyes.error());
  return Detectors{std::move(*faces), std::move(*eyes)};
}

struct Faces {
  person::FaceDetectorParameters detector;
  person::FaceMatchParameters match;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("detector", self.detector, "The face detector");
    visit.section("match", self.match, "Whose face it is");
  }
};

}  // namespace

Result<std::string> faces_hash(const Setting&) {
  return config::hash(Faces{});
}

Result<Report> faces_caltech(const Setting& setting) {
  if (!setting.data) return fail("faces-caltech needs the photographs: set CGSR_DATA or --data");
  Report report{"faces-caltech",
                "whose face it is: the first two images of each person enrol, the rest identify",
                "",
                setting.seed,
                {},
                {},
                {}};
  auto detectors = shipped_detectors();
  if (!detectors) return tl::unexpected(detectors.error());
  auto first = caltech(*setting.data / "faces/caltech");
  if (!first) return tl::unexpected(first.error());
  std::vector<Collection> collections{std::move(*first), essex(*setting.data / "faces/essex94")};
  for (Collection& collection : collections) {
    if (collection.photographs.empty()) continue;
    setting.progress(collection.name);
    if (auto done = describe(collection, *detectors); !done) return tl::unexpected(done.error());
    measure(collection, {}, report);
  }
  report.notes = {
      "SIFT points, count: OpenCV's SIFT in the crop, ratio 0.8 within each enrolled image, the person with most "
      "matches (6.2.1). It names somebody for every face.",
      "Shows an eye: what shows none is no stranger's face, in a single comparison "
      "(pipeline/person/face/eye_detector.h).",
      "Ours: SIFT descriptors on a grid, compared place by place, with the shipped threshold.",
      "Leave one out: everybody in turn is taken out of the gallery; whoever is then named is falsely accepted."};
  return report;
}

}  // namespace cgsr::lab
