#pragma once

#include <string>
#include <vector>

#include "pipeline/person/classifier.h"
#include "pipeline/person/face/face_descriptor.h"
#include "pipeline/person/face/face_gallery.h"

namespace cgsr::person {

/// Somebody who was enrolled: personal data. Only the number leaves the identities file and the terminal. Ours: the dissertation (6.2.1) has a face database.
struct Identity {
  Label number = 0;  ///< from 1 on; never given again to somebody else.
  std::string name;
  std::vector<FaceView> views;
};

/// All who were enrolled.
struct Identities {
  Label next_number = 1;
  std::vector<Identity> people;
};

/// \return the views of all of them, by number.
FaceGallery gallery_of(const Identities& identities, const FaceMatchParameters& parameters = {});

}  // namespace cgsr::person
