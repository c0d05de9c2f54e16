#include "src/config/robot_docs.h"

#include "platform/config/documentation.h"
#include "src/config/robot.h"

namespace cgsr::config {

std::string robot_docs() {
  return "# The keys of a robot's file\n\n"
         "Printed by `cgsr config keys --output docs/config.md` from the parameter structs; a test compares this page "
         "with them. Do not "
         "edit it.\n\n"
         "A robot's file (`config/robots/*.toml`) names only what differs from the defaults below. The same file, or "
         "one with just the "
         "sections\n"
         "that a command needs, is the `--config` of every command. With `extends = \"other.toml\"` a file takes over "
         "all keys of another one "
         "and\n"
         "names only what differs from that. An unknown key, a wrong type and a value out of range each stop the "
         "start, all of them together\n"
         "and each with file and line. Ranges are closed. A path is relative to the folder of the file that names "
         "it.\n\n"
         "`cgsr config show FILE` prints every value that takes effect and where it comes from, `cgsr config diff FILE "
         "[OTHER]` the values that\n"
         "differ, `cgsr config keys WORD` the rows below whose key contains WORD, and `cgsr config new` a short file "
         "to start from. The\n"
         "configuration hash in every report is the SHA-256 of all values: comments, order, omitted defaults and the "
         "place of the checkout do\n"
         "not change it.\n" +
         markdown<Robot>();
}

}  // namespace cgsr::config
