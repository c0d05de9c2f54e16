#include "platform/cpu_pin.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace cgsr {
namespace {

constexpr const char* kMark = "CGSR_CPU_PINNED";  // set before the restart: a second one would go on for ever

bool is_set(const Variable& variable) {
  const char* const value = std::getenv(variable.name.c_str());
  return value != nullptr && variable.value == value;
}

}  // namespace

std::vector<Variable> pinned_environment() {
  return {
      {"OPENCV_CPU_DISABLE", "SSE3,SSSE3,SSE4.1,SSE4.2,POPCNT,AVX,FP16,AVX2,FMA3,AVX512-SKX"},
      {"OPENCV_IPP", "disabled"},
      {"OPENCV_OPENCL_RUNTIME", "disabled"},
      {"GLIBC_TUNABLES",  // libm and string functions
       "glibc.cpu.hwcaps=-SSE3,-SSSE3,-SSE4_1,-SSE4_2,-POPCNT,-LZCNT,-MOVBE,-BMI1,-BMI2,-AVX,-AVX2,-FMA,-FMA4,-AVX512F,"
       "-AVX512VL,-AVX512BW,-ERMS,-FSRM,-RTM,-AVX_Fast_Unaligned_Load,-Fast_Unaligned_Copy"},
      {"JSIMD_FORCESSE2", "1"},  // libjpeg-turbo
      {"OPENBLAS_CORETYPE", "Prescott"},
      {"OPENBLAS_NUM_THREADS", "1"},
  };
}

Result<void> run_pinned(char** argv) {
  const auto wanted = pinned_environment();
  if (std::all_of(wanted.begin(), wanted.end(), is_set)) return {};
  if (std::getenv(kMark) != nullptr) {
    return fail(fmt::format(
        "the instruction set is not pinned: {} is set, yet the variables it stands for did not survive the restart",
        kMark));
  }
  for (const auto& variable : wanted) setenv(variable.name.c_str(), variable.value.c_str(), 1);
  setenv(kMark, "1", 1);
  execv("/proc/self/exe", argv);
  return fail(fmt::format("the instruction set is not pinned: the program could not be started again: {}",
                          std::strerror(errno)));
}

}  // namespace cgsr
