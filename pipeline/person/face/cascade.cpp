#include "pipeline/person/face/cascade.h"

#include <fmt/format.h>

namespace cgsr::person {

Result<Cascade> Cascade::from_xml(const std::string& xml, const char* example) {
  Cascade cascade;
  try {
    const cv::FileStorage file(xml, cv::FileStorage::READ | cv::FileStorage::MEMORY);
    if (!file.isOpened() || !cascade.classifier_.read(file.getFirstTopLevelNode()) || cascade.classifier_.empty())
      return fail(fmt::format("not a cascade of OpenCV's: {} of Debian's opencv-data is one", example));
  } catch (const cv::Exception& error) {
    return fail(fmt::format("not a cascade of OpenCV's: {}", error.err));
  }
  return cascade;
}

std::vector<cv::Rect> Cascade::find(const GreyPatch& patch, const CascadeSearch& search) {
  std::vector<cv::Rect> found;
  const cv::Mat pixels(patch.height_px, patch.width_px, CV_8UC1, const_cast<std::uint8_t*>(patch.pixels.data()));
  classifier_.detectMultiScale(pixels, found, search.step, search.min_neighbors, 0, {search.min_px, search.min_px},
                               {search.max_px, search.max_px});
  return found;
}

}  // namespace cgsr::person
