#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>

#include "platform/error.h"
#include "platform/time.h"

namespace cgsr::sinks {

/// A named value shown beside an event.
struct TraceArgument {
  std::string_view name;
  std::variant<double, std::int64_t, std::string_view> value;
};
using TraceArguments = std::initializer_list<TraceArgument>;

/// Writes Chrome's trace-event JSON, which ui.perfetto.dev and chrome://tracing open: one process, its threads as rows.
///
/// The file is an array with one event on each line. It goes to disk as it grows; only the line in work is kept in memory. A file that
/// was cut lacks the closing bracket, which both programs accept; one cut inside a line loses that line.
///
/// What the caller owes (tests/sinks/trace_check.h checks it): the slices of one thread nest, each begin has its end, a flow
/// starts and ends inside slices and has an id of its own. Work that overlaps gets different threads. Events may come in any order of
/// threads; the begins, ends and instants of one thread come in the order of time. Stamps are written in microseconds, three decimals.
///
/// Every call returns an error that names the file when it could not be written; after that every call fails.
/// Threads: one at a time. Not for the frame path.
class TraceFile {
 public:
  /// Creates or overwrites the file. \param process  the name of the process' row.
  static Result<TraceFile> create(const std::filesystem::path& path, std::string_view process);

  /// Names a thread's row. \param thread  any number > 0. Rows are sorted by it.
  Result<void> name_thread(int thread, std::string_view name);

  /// A slice that is over: [begin, begin + duration]. \param duration  >= 0.
  Result<void> slice(int thread, std::string_view name, MonoTime begin, Duration duration,
                     TraceArguments arguments = {});

  /// A slice in two events: end() ends the one begun last on this thread.
  Result<void> begin(int thread, std::string_view name, MonoTime at, TraceArguments arguments = {});
  Result<void> end(int thread, MonoTime at);

  /// A point in time on a thread: a fault, a skip, a change of state.
  Result<void> instant(int thread, std::string_view name, MonoTime at, TraceArguments arguments = {});

  /// The value of a counter from here on. Each counter has a row of its own.
  Result<void> counter(std::string_view name, MonoTime at, double value);

  /// An arrow between slices: what was handed over by a ring, from the slice of `from` to that of the other thread.
  /// \param id  the same for start and end, different for every arrow of this name: a sequence number.
  Result<void> flow_start(int thread, std::string_view name, std::uint64_t id, MonoTime from);
  Result<void> flow_end(int thread, std::string_view name, std::uint64_t id, MonoTime to);

  /// Hands what was written to the operating system.
  Result<void> flush();

  /// Writes the closing bracket. Idempotent; nothing may be added afterwards.
  Result<void> close();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  TraceFile(std::filesystem::path path, std::ofstream stream) : path_(std::move(path)), stream_(std::move(stream)) {}

  void open_event(char phase, int thread, std::string_view name);
  void add_stamp(std::string_view key, Duration time);
  void add_arguments(TraceArguments arguments);
  Result<void> write_event();
  Result<void> metadata(std::string_view what, int thread, std::string_view key, std::string_view json_value);
  [[nodiscard]] Result<void> state() const;

  std::filesystem::path path_;
  std::ofstream stream_;
  std::string event_;  // the line in work
  bool first_ = true;
  bool closed_ = false;
};

}  // namespace cgsr::sinks
