#pragma once

#include "pipeline/behavior/search_people.h"
#include "pipeline/geometry/camera.h"
#include "pipeline/stages/task.h"

namespace cgsr::stages {

/// Who Is Who spread through the home (6.4.1.2): a face's bearing and width say where in the map somebody stands. What is said is an event of the source
/// `says`, with number, confidence and place, never a name: once when somebody is named, and of all in the end.
class SearchPeopleTask final : public Task {
 public:
  /// \param camera  of the images that come, with its lens.  \param parameters  those of the search.
  SearchPeopleTask(behavior::SearchPeople search, const behavior::SearchPeopleParameters& parameters,
                   const geometry::Camera& camera);
  Decision decide(const FrameResult& frame, const ImageView& image, Duration elapsed) override;

 private:
  /// \return where the face's owner stands; nothing: it is too small to be named, or at a height at which there are no faces.
  [[nodiscard]] std::optional<behavior::FaceInMap> in_map(const person::SeenFace& face,
                                                          const geometry::Pose& X_WC) const;

  behavior::SearchPeople search_;
  behavior::SearchPeopleParameters parameters_;
  geometry::Camera camera_;
};

}  // namespace cgsr::stages
