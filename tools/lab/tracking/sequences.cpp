#include "tools/lab/tracking/sequences.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace cgsr::lab {
namespace {

namespace fs = std::filesystem;

bool is_sequence(const fs::path& folder) {
  constexpr std::array<std::string_view, 2> kTruthFiles{"groundtruth.txt", "groundtruth_rect.txt"};
  return std::ranges::any_of(kTruthFiles, [&](std::string_view name) { return fs::exists(folder / name); });
}

/// The last part of a path's name, also of one that ends in a slash.
std::string name_of_folder(const fs::path& folder) {
  const fs::path plain = folder.lexically_normal();
  return plain.has_filename() ? plain.filename().string() : plain.parent_path().filename().string();
}

}  // namespace

Result<std::vector<Sequence>> find_sequences(std::span<const fs::path> folders) {
  std::vector<Sequence> all;
  for (const fs::path& folder : folders) {
    if (!fs::is_directory(folder)) return fail(fmt::format("there is no folder {}", folder.string()));
    if (is_sequence(folder)) {
      all.push_back({name_of_folder(folder), folder});
      continue;
    }
    const std::size_t before = all.size();
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.is_directory() && is_sequence(entry.path()))
        all.push_back({name_of_folder(entry.path()), entry.path()});
    }
    if (all.size() == before) {
      return fail(fmt::format("{} holds no sequence: expected folders with img/ and groundtruth.txt", folder.string()));
    }
  }
  std::ranges::sort(all, {}, &Sequence::name);
  const auto twice = std::ranges::adjacent_find(all, {}, &Sequence::name);
  if (twice != all.end()) {
    return fail(fmt::format("two sequences have the name {}: {} and {}", twice->name, twice->folder.string(),
                            std::next(twice)->folder.string()));
  }
  return all;
}

Film film_of_images(std::string name, std::vector<Image> images, Boxes truth) {
  const auto kept = std::make_shared<const std::vector<Image>>(std::move(images));
  return {std::move(name), [kept](int i) -> Result<Image> { return (*kept)[static_cast<std::size_t>(i)]; },
          std::move(truth)};
}

Result<Film> read_sequence(const Sequence& sequence, int max_images) {
  auto film = open_film(sequence.folder);
  if (!film) return tl::unexpected(film.error());
  if (max_images > 0 && max_images < film->size()) film->truth.resize(static_cast<std::size_t>(max_images));
  std::vector<Image> images;
  images.reserve(film->truth.size());
  for (int i = 0; i < film->size(); ++i) {
    auto image = film->image(i);
    if (!image) return tl::unexpected(image.error());
    if (i > 0 && image->bgr.size() != images.front().bgr.size()) {
      return fail(fmt::format("{}: image {} is {}x{}, the first one {}x{}; expected one size", sequence.folder.string(),
                              i, image->bgr.cols, image->bgr.rows, images.front().bgr.cols, images.front().bgr.rows));
    }
    images.push_back(std::move(*image));
  }
  return film_of_images(sequence.name, std::move(images), std::move(film->truth));
}

Film part_of(const Film& film, int first, int count) {
  const int end = count > 0 ? std::min(film.size(), first + count) : film.size();
  return {film.name, [image = film.image, first](int i) { return image(first + i); },
          Boxes(film.truth.begin() + first, film.truth.begin() + end)};
}

}  // namespace cgsr::lab
