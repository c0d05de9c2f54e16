#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "platform/error.h"

namespace cgsr::lab {

struct Cost {
  double mean_minstr = 0.0;
  double worst_minstr = 0.0;
  double worst_second_minstr = 0.0;  ///< of an image, in the mean over the 30 images in a row that cost most.
  int images = 0;                    ///< in which it ran; 0 where that was not counted.
};

/// What tools/count says about a command.
struct Counted {
  std::map<std::string, Cost> stages;
  Cost image;
  Cost frame_path;  ///< without what a thread of its own does on a robot: the recognition of faces.
  int images = 0;
};

/// Runs this very program's command `follow` once more under tools/count.
///
/// \param tracker  its name. \param config_file  the configuration; empty: what ships. \param film  the options that name the film.
/// \return what went wrong, in words.
Result<Counted> count_follow(std::string_view tracker, const std::string& config_file,
                             const std::vector<std::string>& film);

/// The same of a program that lies beside this one. \param program  its name, e.g. "cgsr".
Result<Counted> count_program(const std::string& program, const std::vector<std::string>& arguments);

/// The same of any command of this program. \param words  the command and its options, without `--config`.
Result<Counted> count_lab(const std::vector<std::string>& words, const std::string& config_file);

}  // namespace cgsr::lab
