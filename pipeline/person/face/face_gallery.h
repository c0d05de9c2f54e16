#pragma once

#include <map>
#include <optional>
#include <vector>

#include "pipeline/person/classifier.h"
#include "pipeline/person/face/face_descriptor.h"
#include "platform/parameters.h"

namespace cgsr::person {

struct FaceMatchParameters {
  double min_margin = 0.0185;
  double typical_stranger = 0.105;
  int min_views = 2;
  int max_views = 6;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("min_margin", self.min_margin, Range{0.0, 0.5}, "",
                 "How much nearer a face must be to one person than to every other, else it is a stranger's.");
    visit.number("typical_stranger", self.typical_stranger, Range{0.01, 1.0}, "",
                 "How far a stranger's face is from an enrolled one, typically: stands in for the others where fewer "
                 "than five people are enrolled.");
    visit.number("min_views", self.min_views, Range{1, 20}, "",
                 "The number of views from which on a person can be named.");
    visit.number("max_views", self.max_views, Range{1, 50}, "",
                 "The number of views kept of a person; more replace the oldest but the first.");
  }
};

/// Whose face it is.
struct FaceMatch {
  std::optional<Label> label;    ///< nothing: a stranger's.
  double confidence = 0.0;       ///< of this answer, 0.5 at the threshold, 1 far from it.
  std::optional<Label> nearest;  ///< the person whose face is most like it, named or not.
  double distance = 1.0;  ///< to that one: the mean of view_distances() over the nearest four fifths of the points.
  double margin = 0.0;    ///< how much farther every other person is.
  FaceAlignment
      alignment{};  ///< how the face lies in its crop: against the nearest view of each person, in the mean over all.
};

/// The faces that are known, several views each, and the decision whose a face is (ClassifyPriChar of Alg. 6.1). The dissertation (6.2.1) counts
/// SIFT matches and names the person with most; here descriptors are compared place by place, and a face must be nearer to one person than to all
/// others by a margin: how far faces are from each other depends on the light, the difference of two such distances hardly.
///
/// Bounded: max_views per person. Threads: one at a time; enrolled in the background, read when it is handed over.
class FaceGallery {
 public:
  explicit FaceGallery(const FaceMatchParameters& parameters = {}) : parameters_(parameters) {}

  void enroll(Label person, const FaceView& view);
  /// \return whether there was such a person.
  bool forget(Label person) { return people_.erase(person) > 0; }
  [[nodiscard]] std::size_t people() const { return people_.size(); }
  [[nodiscard]] const std::vector<FaceView>* views_of(Label person) const;

  /// \param without  this person is left out, as if he had not been enrolled.
  /// Cost: 0.5 million instructions per view.
  [[nodiscard]] FaceMatch identify(const FaceDescriptor& face, std::optional<Label> without = std::nullopt) const;

 private:
  FaceMatchParameters parameters_;
  std::map<Label, std::vector<FaceView>> people_;
};

}  // namespace cgsr::person
