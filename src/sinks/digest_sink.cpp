#include "src/sinks/digest_sink.h"

#include "src/sinks/csv_sink.h"

namespace cgsr::sinks {

Result<void> DigestSink::on_image(const ImageReport& report) {
  decisions_.add_image(report.record.image_sequence, report.frame);
  const std::string row = image_row(report);
  outputs_.add(row.data(), row.size());
  if (!sums_pixels_ || report.picture == nullptr) return {};
  ++pictures_;
  const ImageView& view = report.picture->image.view();
  for (int y = 0; y < view.height_px; ++y) inputs_.add(view.row(y), static_cast<std::size_t>(view.width_px) * 2);
  return {};
}

Result<void> DigestSink::on_switching(const SwitchRecord& record) {
  decisions_.add_request(record.answer.request);
  return {};
}

void DigestSink::summarize(Summary& summary) {
  summary.json["decisions_sha256"] = decisions_.hex();
  summary.json["outputs_sha256"] = outputs_.hex();
  if (!sums_pixels_) return;
  summary.json["inputs_sha256"] = inputs_.hex();
  summary.json["inputs_images"] = pictures_;
}

}  // namespace cgsr::sinks
