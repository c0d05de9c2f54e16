#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace cgsr::test {

/// What a trace holds, for tests that count.
struct TraceContents {
  std::map<std::string, int> slices;    ///< by name.
  std::map<std::string, int> instants;  ///< by name.
  std::map<std::string, int> counters;  ///< samples by name.
  std::map<int, std::string> threads;   ///< names by number.
  int flows = 0;                        ///< arrows with both ends.
  std::map<std::string, int> arrows;    ///< of these, by name.
  std::vector<std::string> problems;    ///< empty: the trace is sound.
};

/// Reads the trace-event JSON of a run. \param text  a closed file, or the part before a cut: what follows the last whole line is ignored.
/// Problems are: an event that is not JSON or lacks a member; a thread with slices but without a name; stamps of begins, ends and
/// instants of a thread, or of a counter, that go back; an end without begin, a begin without end, a negative duration; slices
/// of one thread that overlap without one containing the other; a flow with one end, that ends before it starts, or whose end lies in
/// no slice. \param cut  the file was cut: what is still open at its end is no problem.
TraceContents check_trace(const std::string& text, bool cut = false);

/// check_trace() of a closed file, which must be one well-formed JSON array as well.
TraceContents check_trace_file(const std::filesystem::path& path);

}  // namespace cgsr::test
