#pragma once

#include <optional>

#include "pipeline/person/classifier.h"
#include "pipeline/person/face/face_gallery.h"
#include "pipeline/person/marker/marker_tracks.h"
#include "platform/box.h"
#include "platform/image_view.h"

namespace cgsr::person {

/// A face that was found and compared.
struct FaceSighting {
  Box box;  ///< in pixels of the image.
  FaceMatch match;
};

/// Where somebody's head is, by face or colour.
struct PersonHead {
  Label person = 0;
  Box box;  ///< as a face's, in pixels of the image.
};

/// What the classifiers of a person look at (6.2, 6.3).
struct PersonImage {
  ImageView image;  ///< YUYV, of at most the size that the tracker was made for.
  std::optional<FaceSighting> face = std::nullopt;
  std::optional<Label> interest =
      std::nullopt;  ///< whose shirt counts where several are in view; nothing: the largest.
  std::optional<MarkerSighting> marker = std::nullopt;  ///< that was read in this image.
  std::optional<PersonHead> head = std::nullopt;  ///< where somebody's head is or was a moment ago; nothing: not known.
};

}  // namespace cgsr::person
