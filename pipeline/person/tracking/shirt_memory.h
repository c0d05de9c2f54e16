#pragma once

#include <optional>

#include "platform/box.h"
#include "platform/image_view.h"

namespace cgsr::person {

/// What colour somebody's shirt is, and whether it is another one than before (6.4.3): the mean of what is below the face, as chromaticities, which a
/// brighter light leaves as they are. A light of another colour between the two looks like another shirt.
///
/// Threads: one. Allocates nothing.
class ShirtMemory {
 public:
  /// \param images_needed  of either shirt, before it is compared.
  explicit ShirtMemory(int images_needed) : images_needed_(images_needed) {}

  /// \param image  YUYV.  \param face  of the person, in its pixels. A face whose shirt is out of the image, dark or white says nothing.
  void see(const ImageView& image, const Box& face);

  /// From now on another shirt is seen, which may be the same; the one before is what it is compared with, where enough was seen of it.
  void begin_anew();

  /// \return how far the shirt is from the one before, as the distance of their chromaticities r and g, 0..1.4; nothing: too little was seen of one of them.
  [[nodiscard]] std::optional<double> change() const;

 private:
  /// Sums of chromaticities.
  struct Shirt {
    double r = 0.0, g = 0.0;
    int images = 0;
  };

  int images_needed_;
  Shirt before_;
  Shirt now_;
};

}  // namespace cgsr::person
