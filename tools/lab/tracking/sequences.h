#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "platform/error.h"
#include "tools/lab/film.h"

namespace cgsr::lab {

/// A recorded sequence: a folder that open_film() takes.
struct Sequence {
  std::string name;  ///< of the folder
  std::filesystem::path folder;
};

/// Finds the sequences of folders that hold one each, or are one.
///
/// \return all of them in the order of their names; or which folder is not there, holds no sequence, or has a name that another one has.
Result<std::vector<Sequence>> find_sequences(std::span<const std::filesystem::path> folders);

/// Reads a sequence into memory, so that many runs decode it once: 5 bytes a pixel.
///
/// \param max_images  the images after these are left out; 0: none.
/// \return the film; or what open_film() refuses, an image that cannot be read, or one of another size than the first.
Result<Film> read_sequence(const Sequence& sequence, int max_images = 0);

/// A film of images that are there.
Film film_of_images(std::string name, std::vector<Image> images, Boxes truth);

/// \return the images first .. first + count - 1 of a film; count 0: up to its end. Its image 0 may show no object.
Film part_of(const Film& film, int first, int count = 0);

}  // namespace cgsr::lab
