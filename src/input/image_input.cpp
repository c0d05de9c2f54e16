#include "src/input/image_input.h"

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/core.h>

namespace cgsr::app {
namespace {

/// Reads exactly as many numbers as `numbers` holds, with `separator` between them and nothing else.
template <std::size_t kCount>
bool parse_numbers(std::string_view text, char separator, std::array<double, kCount>& numbers) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < kCount; ++i) {
    if (i > 0 && (at == end || *at++ != separator)) return false;
    const auto [rest, error] = std::from_chars(at, end, numbers[i]);
    if (error != std::errc{} || !std::isfinite(numbers[i])) return false;
    at = rest;
  }
  return at == end;
}

}  // namespace

Result<ImageInput> ImageInput::open(const InputOptions& options) {
  hal::ReplayParameters parameters;
  parameters.path = options.path;
  parameters.first = options.first;
  parameters.count = options.count;
  parameters.width_px = options.width_px;
  parameters.height_px = options.height_px;
  auto camera = std::make_unique<hal::ReplayCamera>(parameters);
  auto mode = camera->start();
  if (!mode) return tl::unexpected(mode.error());
  return ImageInput(std::move(camera), *mode);
}

ImageInput::Next ImageInput::next() {
  auto image = camera_->next_image(MonoTime::max());
  if (image) return {std::move(*image), {}, false};
  std::string problem = camera_->last_problem();
  if (image.error() == hal::CaptureFailure::kCorrupt) {
    told_ = problem;
    return {{}, std::move(problem), false};
  }
  if (problem == told_) problem.clear();
  return {{}, std::move(problem), true};
}

Result<std::pair<int, int>> parse_size(const std::string& text) {
  std::array<double, 2> numbers{};
  if (!parse_numbers(text, 'x', numbers) || numbers[0] != std::floor(numbers[0]) ||
      numbers[1] != std::floor(numbers[1]) || numbers[0] < 16 || numbers[1] < 16 || numbers[0] > hal::kLongestSide_px ||
      numbers[1] > hal::kLongestSide_px) {
    return fail(fmt::format("'{}' is not a size: expected WIDTHxHEIGHT in pixels, 16 to {} each, such as 640x480", text,
                            hal::kLongestSide_px));
  }
  return std::pair{static_cast<int>(numbers[0]), static_cast<int>(numbers[1])};
}

Result<Box> parse_box(const std::string& text) {
  std::array<double, 4> numbers{};
  if (!parse_numbers(text, ',', numbers)) {
    return fail(fmt::format("'{}' is not a region: expected X,Y,W,H in pixels, such as 298,160,48,80", text));
  }
  return Box{numbers[0], numbers[1], numbers[2], numbers[3]};
}

}  // namespace cgsr::app
