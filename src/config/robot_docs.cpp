#include "src/config/robot_docs.h"

#include "platform/config/documentation.h"
#include "src/config/robot.h"

namespace cgsr::config {

std::string robot_docs() {
  return "# The keys of a robot's file\n\n"
         "Printed by `config_docs` from the parameter structs; a test compares this page with them. Do not edit it.\n\n"
         "A robot's file (`config/robots/*.toml`) names every key; the files of tools and tests name only what they "
         "change. An unknown\n"
         "key, a missing one and a value out of range each stop the start, all of them together and each with its "
         "line. Ranges are\n"
         "closed. A path is relative to the folder of the file that names it. The configuration hash in every report "
         "is the SHA-256\n"
         "of all values in canonical form: comments, order and omitted defaults do not change it.\n" +
         markdown<Robot>();
}

}  // namespace cgsr::config
