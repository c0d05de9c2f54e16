#include "tools/lab/source_path.h"

namespace cgsr::lab {

std::string source_path(std::string_view path) {
  return std::string(CGSR_SOURCE_DIR "/").append(path);
}

}  // namespace cgsr::lab
