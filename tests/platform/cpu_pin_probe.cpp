// Started by cpu_pin_test: pins itself and shows what came of it.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "platform/cpu_pin.h"

int main(int argc, char** argv) {
  if (argc > 1 && std::getenv("CGSR_CPU_PINNED") == nullptr)
    setenv("PROBE_FIRST_PID", std::to_string(getpid()).c_str(), 1);
  if (const auto pinned = cgsr::run_pinned(argv); !pinned) {
    std::printf("refused: %s\n", pinned.error().message.c_str());
    return 1;
  }
  const char* const first_pid = std::getenv("PROBE_FIRST_PID");
  std::printf("same process: %d\n", first_pid != nullptr && std::atol(first_pid) == getpid() ? 1 : 0);
  for (const auto& [name, value] : cgsr::pinned_environment()) {
    const char* const found = std::getenv(name.c_str());
    std::printf("%s: %d\n", name.c_str(), found != nullptr && value == found ? 1 : 0);
  }
  for (int i = 1; i < argc; ++i) std::printf("argument: %s\n", argv[i]);
}
