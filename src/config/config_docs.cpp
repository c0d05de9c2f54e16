// Prints docs/config.md from the parameter structs: build/release/config_docs > docs/config.md

#include <cstdio>

#include "src/config/robot_docs.h"

int main() {
  const std::string text = cgsr::config::robot_docs();
  return std::fwrite(text.data(), 1, text.size(), stdout) == text.size() ? 0 : 1;
}
