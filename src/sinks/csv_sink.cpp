#include "src/sinks/csv_sink.h"

#include <memory>

#include "platform/description/csv.h"

namespace cgsr::sinks {
namespace {

/// Number and stamp of an image, the first two columns.
struct ImageColumns {
  std::uint64_t image_sequence = 0;
  double stamp_s = 0.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.integer("frame", self.image_sequence, "", "number of the image, counted from 0, lost ones included");
    visit.number("stamp_s", self.stamp_s, {6}, "s", "start of its exposure");
  }
};

/// Calls `block` with every group of columns, in the order of the row.
template <class Block>
void for_each_block(const ImageReport& report, Block block) {
  block(ImageColumns{report.record.image_sequence, to_seconds(report.record.stamp.time_since_epoch())});
  block(report.frame.objects.value);
  block(report.frame.decision.value);
  block(report.motion);
  block(report.frame.pose.value);
  block(report.frame.lamp.value);
  block(report.frame.shade.value);
}

}  // namespace

std::string image_row_header() {
  std::string header;
  const stages::FrameResult frame;
  const runtime::FrameRecord record;
  const MotionStatus motion;
  for_each_block({frame, record, motion, nullptr}, [&header](const auto& block) {
    if (!header.empty()) header += ',';
    header += csv_header<std::remove_cvref_t<decltype(block)>>();
  });
  return header;
}

std::string image_row(const ImageReport& report) {
  std::string row;
  for_each_block(report, [&row](const auto& block) {
    if (!row.empty()) row += ',';
    append_csv_row(row, block);
  });
  return row;
}

Result<std::unique_ptr<CsvSink>> CsvSink::create(const std::string& path, const GroundTruth* truth) {
  auto file = app::TextFile::create(path);
  if (!file) return tl::unexpected(file.error());
  if (auto head = file->add_line(image_row_header() + "," + csv_header<GroundTruth>()); !head) {
    return tl::unexpected(head.error());
  }
  return std::unique_ptr<CsvSink>(new CsvSink(std::move(*file), truth));
}

Result<void> CsvSink::on_image(const ImageReport& report) {
  std::string row = image_row(report) + ",";
  append_csv_row(row, truth_ != nullptr ? *truth_ : GroundTruth{});
  return file_.add_line(row);
}

}  // namespace cgsr::sinks
