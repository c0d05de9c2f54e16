#pragma once

#include <string>

#include "src/output/text_file.h"
#include "src/sinks/ground_truth.h"
#include "src/sinks/sink.h"

namespace cgsr::sinks {

/// \return the names of the columns of a file, joined by commas: those of image_row, and those of the truth in their place.
std::string csv_file_header();

/// One image as a row, without truth: number and stamp, then the described fields of the stages' outputs and of the motion loop.
/// New columns are appended, never inserted. What does not exist now is empty.
std::string image_row(const ImageReport& report);

/// A row for every image, with the columns of the truth.
class CsvSink final : public Sink {
 public:
  /// \param truth  of the image at hand; null: nobody knows it, and its columns stay empty. Outlives the sink.
  static Result<std::unique_ptr<CsvSink>> create(const std::string& path, const GroundTruth* truth);

  Result<void> on_image(const ImageReport& report) override;

 private:
  CsvSink(app::TextFile file, const GroundTruth* truth) : file_(std::move(file)), truth_(truth) {}

  app::TextFile file_;
  const GroundTruth* truth_;
};

}  // namespace cgsr::sinks
