#pragma once

#include <string>
#include <vector>

#include "platform/error.h"

namespace cgsr {

/// One environment variable.
struct Variable {
  std::string name;
  std::string value;
};

/// The one place that says which instructions the libraries below us may pick at run time. OpenCV dispatches to AVX
/// code and libm's exp, log, sin and pow to FMA code where the CPU has them, and both round differently: the same image
/// would give other bytes on another machine. Both decide before main(), from the environment.
/// The robot itself, when nothing has to repeat, needs none of this: there a faster instruction is welcome.
///
/// \return what has to be in it wherever a run must repeat: replay, reproduce, golden tests, counting instructions.
///       Everything beyond SSE2 is off, OpenCL too. Not covered: cv::setNumThreads(1), which the program calls itself.
std::vector<Variable> pinned_environment();

/// Call it first in main(). Returns at once when the environment is already so; else sets it and starts the program
/// again in its own place, with the same arguments (execv: the process keeps its number, no destructor runs).
/// \return an error when that is not possible, or when the environment did not survive it. Under valgrind, which does
///       not follow a program into its successor, the variables are set outside.
Result<void> run_pinned(char** argv);

}  // namespace cgsr
