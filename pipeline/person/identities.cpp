#include "pipeline/person/identities.h"

namespace cgsr::person {

FaceGallery gallery_of(const Identities& identities, const FaceMatchParameters& parameters) {
  FaceGallery gallery(parameters);
  for (const Identity& one : identities.people) {
    for (const FaceView& view : one.views) gallery.enroll(one.number, view);
  }
  return gallery;
}

}  // namespace cgsr::person
