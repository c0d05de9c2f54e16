#include "src/scoring/scoring.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace cgsr::app {
namespace {

std::string_view trimmed(std::string_view word) {
  const auto first = word.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return word.substr(first, word.find_last_not_of(" \t\r") - first + 1);
}

std::optional<double> to_number(std::string_view word) {
  word = trimmed(word);
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> words;
  for (;;) {
    const auto end = line.find(separator);
    words.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return words;
    line.remove_prefix(end + 1);
  }
}

/// The beginning of a line as a message can show it.
std::string start_of(std::string_view line) {
  constexpr std::size_t kMaxShown = 40;
  std::string shown(trimmed(line).substr(0, kMaxShown));
  std::ranges::replace_if(
      shown, [](char c) { return c < ' ' || c > '~'; }, '?');
  return shown;
}

/// \return the box, unless it is none: NaN, infinite or without area.
std::optional<Box> valid(const Box& box) {
  for (double value : {box.x, box.y, box.width, box.height}) {
    if (!std::isfinite(value)) return std::nullopt;
  }
  return box.empty() ? std::nullopt : std::optional(box);
}

/// \return the numbers of a line of a truth file; nothing when a word is no number.
std::optional<std::vector<double>> truth_numbers(std::string line) {
  std::ranges::replace_if(
      line, [](char c) { return c == '\t' || c == ';'; }, ',');
  std::vector<double> numbers;
  for (std::string_view word : split(trimmed(line), line.find(',') != std::string::npos ? ',' : ' ')) {
    if (word.empty()) continue;
    const auto number = to_number(word);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

/// \param numbers  four, or an even number of at least eight.
std::optional<Box> truth_box(const std::vector<double>& numbers) {
  if (numbers.size() == 4) return valid({numbers[0], numbers[1], numbers[2], numbers[3]});

  double left = numbers[0], right = left, top = numbers[1], bottom = top;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (std::isnan(numbers[i])) return std::nullopt;
    double& low = i % 2 == 0 ? left : top;
    double& high = i % 2 == 0 ? right : bottom;
    low = std::min(low, numbers[i]);
    high = std::max(high, numbers[i]);
  }
  return valid({left, top, right - left, bottom - top});
}

}  // namespace

ImageScore score_image(const Box& truth, const std::optional<Box>& found) {
  if (!found || found->empty()) return {};
  const double shared = intersection(truth, *found).area();
  const double iou = intersection_over_union(truth, *found);
  return {shared / found->area(), shared / truth.area(), iou, iou > 0.5, true};
}

std::vector<ImageScore> score_images(const Boxes& track, const Boxes& truth, int skip_first) {
  std::vector<ImageScore> scores;
  for (auto i = static_cast<std::size_t>(std::max(skip_first, 0)); i < truth.size(); ++i) {
    if (truth[i]) scores.push_back(score_image(*truth[i], i < track.size() ? track[i] : std::nullopt));
  }
  return scores;
}

Score score(const Boxes& track, const Boxes& truth, int skip_first) {
  Score mean;
  for (const ImageScore& image : score_images(track, truth, skip_first)) {
    mean.precision += image.precision;
    mean.recall += image.recall;
    mean.iou += image.iou;
    mean.success += image.success;
    mean.found += image.found;
    ++mean.images;
  }
  for (double* sum : {&mean.precision, &mean.recall, &mean.iou, &mean.success, &mean.found}) {
    *sum /= std::max(mean.images, 1);
  }
  const std::size_t both = std::min(truth.size(), track.size());
  for (auto i = static_cast<std::size_t>(std::max(skip_first, 0)); i < both; ++i) {
    mean.found_when_absent += !truth[i] && track[i] && !track[i]->empty();
  }
  return mean;
}

Result<Boxes> read_truth(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return fail(fmt::format("cannot read the truth {}", path.string()));
  Boxes boxes;
  for (std::string line; std::getline(file, line);) {
    const auto numbers = truth_numbers(line);
    const std::size_t count = numbers ? numbers->size() : 1;
    if (count != 0 && count != 4 && (count < 8 || count % 2 != 0)) {
      return fail(
          fmt::format("{}:{}: '{}' is no box; expected x,y,width,height or the corners x1,y1,x2,y2,... of a polygon, "
                      "numbers only; nan,nan,nan,nan or a blank line where the object is not visible",
                      path.string(), boxes.size() + 1, start_of(line)));
    }
    boxes.push_back(count == 0 ? std::nullopt : truth_box(*numbers));
  }
  if (file.bad()) return fail(fmt::format("cannot read the truth {}: expected a text file", path.string()));
  if (boxes.empty()) return fail(fmt::format("{}: holds no box; expected a line for each image", path.string()));
  return boxes;
}

Result<void> check_length(const std::filesystem::path& path, const Boxes& truth, std::size_t images) {
  const auto visible = [](const std::optional<Box>& box) { return box.has_value(); };
  if (truth.size() >= images && std::none_of(truth.begin() + static_cast<std::ptrdiff_t>(images), truth.end(), visible))
    return {};
  return fail(fmt::format("{}: has {} lines for {} images; expected a line for each image", path.string(), truth.size(),
                          images));
}

Result<Boxes> read_track(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return fail(fmt::format("cannot read the track {}", path.string()));
  Boxes boxes;
  for (std::string line; std::getline(file, line);) {
    const auto words = split(line, ',');
    std::vector<double> numbers;
    for (std::size_t i = 0; i < std::min<std::size_t>(words.size(), 6); ++i) {
      numbers.push_back(to_number(words[i]).value_or(std::nan("")));
    }
    if (!(numbers[0] >= 0.0 && numbers[0] < 1e9)) continue;
    const auto image = static_cast<std::size_t>(numbers[0]);
    if (image >= boxes.size()) boxes.resize(image + 1);
    if (numbers.size() < 6 || !(numbers[1] > 0.0)) continue;
    if (const auto box = valid({numbers[2], numbers[3], numbers[4], numbers[5]})) boxes[image] = box;
  }
  return boxes;
}

}  // namespace cgsr::app
