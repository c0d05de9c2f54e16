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

// Columns are appended as outputs are: what was there before an output keeps its place.
constexpr int kOutputsBeforeMotion = 2;
constexpr int kOutputsBeforeTruth = 5;

/// Calls `block` with every group of columns, in the order of the row.
/// \param truth  null: its columns are left out.
template <class Block>
void for_each_block(const ImageReport& report, const GroundTruth* truth, Block block) {
  block(ImageColumns{report.record.image_sequence, to_seconds(report.record.stamp.time_since_epoch())});
  int outputs = 0;
  stages::for_each_output(report.frame, [&](std::string_view, std::string_view, const auto& output) {
    block(output.value);
    ++outputs;
    if (outputs == kOutputsBeforeMotion) block(report.motion);
    if (outputs == kOutputsBeforeTruth && truth != nullptr) block(*truth);
  });
}

std::string row_of(const ImageReport& report, const GroundTruth* truth) {
  std::string row;
  for_each_block(report, truth, [&row](const auto& block) {
    if (!row.empty()) row += ',';
    append_csv_row(row, block);
  });
  return row;
}

}  // namespace

std::string csv_file_header() {
  std::string header;
  const stages::FrameResult frame;
  const runtime::FrameRecord record;
  const MotionStatus motion;
  const GroundTruth truth;
  for_each_block({frame, record, motion, nullptr}, &truth, [&header](const auto& block) {
    if (!header.empty()) header += ',';
    header += csv_header<std::remove_cvref_t<decltype(block)>>();
  });
  return header;
}

std::string image_row(const ImageReport& report) {
  return row_of(report, nullptr);
}

Result<std::unique_ptr<CsvSink>> CsvSink::create(const std::string& path, const GroundTruth* truth) {
  auto file = app::TextFile::create(path);
  if (!file) return tl::unexpected(file.error());
  if (auto head = file->add_line(csv_file_header()); !head) return tl::unexpected(head.error());
  return std::unique_ptr<CsvSink>(new CsvSink(std::move(*file), truth));
}

Result<void> CsvSink::on_image(const ImageReport& report) {
  const GroundTruth nothing;
  return file_.add_line(row_of(report, truth_ != nullptr ? truth_ : &nothing));
}

}  // namespace cgsr::sinks
