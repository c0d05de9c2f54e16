// Prints docs/worlds.md from the world file's structs: build/release/world_docs > docs/worlds.md

#include <cstdio>
#include <string>

#include "hal/sim/worlds/world_spec.h"
#include "platform/config/documentation.h"

int main() {
  const std::string text =
      "# World files\n\nWhat `config/worlds/*.toml` may say: every key with its unit, range and default. "
      "`build/release/world_docs` prints this page from\n"
      "the structs that read the files (hal/sim/worlds). An unknown key, a value out of range and a world that makes "
      "no sense (a lamp inside a\n"
      "wall, a mesh that is missing, no robot and so no camera) are refused, all mistakes at once, with file and line. "
      "Metres, seconds,\n"
      "degrees; z is up. Lists of sections, `[[shape]]`, come as often as needed.\n" +
      cgsr::config::markdown<cgsr::sim::WorldSpec>();
  return std::fwrite(text.data(), 1, text.size(), stdout) == text.size() ? 0 : 1;
}
