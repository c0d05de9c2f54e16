// Passes two stages in each of three images with loops whose instructions are known, while other threads work: what tools/count has to see.

#include <cstdio>
#include <thread>

#include "platform/count_marks.h"

namespace {

/// Exactly 2 n instructions, and a handful around them.
void spin(long n) {
  asm volatile(
      "1: dec %0\n\t"
      "jnz 1b"
      : "+r"(n));
}

void stage(const char* name, long n) {
  cgsr::count_stage_begin();
  spin(n);
  cgsr::count_stage_end(name);
}

}  // namespace

int main() {
  std::thread uncounted([] { spin(3'000'000); });
  std::thread counted([] {
    for (int i = 0; i < 4; ++i) stage("beside", 250'000);
  });
  for (long image = 1; image <= 3; ++image) {
    stage("labels", image * 1'000'000);  // long enough for valgrind to switch threads in the middle
    spin(500'000);                       // between stages: nobody's
    stage("search", 100'000);
    cgsr::count_image_end();
  }
  uncounted.join();
  counted.join();
  std::puts("configuration 0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f0f");
}
