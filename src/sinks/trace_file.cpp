#include "src/sinks/trace_file.h"

#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "platform/description/json.h"

namespace cgsr::sinks {

Result<TraceFile> TraceFile::create(const std::filesystem::path& path, std::string_view process) {
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  if (!stream) {
    return fail(fmt::format("{}: the trace cannot be created; check the folder and its permissions", path.string()));
  }
  stream << '[';
  TraceFile trace(path, std::move(stream));
  std::string name;
  append_json_string(name, process);
  if (auto written = trace.metadata("process_name", 0, "name", name); !written) return tl::unexpected(written.error());
  return trace;
}

Result<void> TraceFile::name_thread(int thread, std::string_view name) {
  std::string json;
  append_json_string(json, name);
  if (auto written = metadata("thread_name", thread, "name", json); !written) return written;
  return metadata("thread_sort_index", thread, "sort_index", fmt::to_string(thread));
}

Result<void> TraceFile::slice(int thread, std::string_view name, MonoTime begin, Duration duration,
                              TraceArguments arguments) {
  open_event('X', thread, name);
  add_stamp("ts", begin.time_since_epoch());
  add_stamp("dur", duration);
  add_arguments(arguments);
  return write_event();
}

Result<void> TraceFile::begin(int thread, std::string_view name, MonoTime at, TraceArguments arguments) {
  open_event('B', thread, name);
  add_stamp("ts", at.time_since_epoch());
  add_arguments(arguments);
  return write_event();
}

Result<void> TraceFile::end(int thread, MonoTime at) {
  open_event('E', thread, "");
  add_stamp("ts", at.time_since_epoch());
  return write_event();
}

Result<void> TraceFile::instant(int thread, std::string_view name, MonoTime at, TraceArguments arguments) {
  open_event('i', thread, name);
  add_stamp("ts", at.time_since_epoch());
  event_ += R"(,"s":"t")";
  add_arguments(arguments);
  return write_event();
}

Result<void> TraceFile::counter(std::string_view name, MonoTime at, double value) {
  open_event('C', 0, name);
  add_stamp("ts", at.time_since_epoch());
  add_arguments({{"value", value}});
  return write_event();
}

Result<void> TraceFile::flow_start(int thread, std::string_view name, std::uint64_t id, MonoTime from) {
  open_event('s', thread, name);
  add_stamp("ts", from.time_since_epoch());
  fmt::format_to(std::back_inserter(event_), R"(,"cat":"flow","id":{})", id);
  return write_event();
}

Result<void> TraceFile::flow_end(int thread, std::string_view name, std::uint64_t id, MonoTime to) {
  open_event('f', thread, name);
  add_stamp("ts", to.time_since_epoch());
  // bp e: it ends in the slice around `to`, not in the next one.
  fmt::format_to(std::back_inserter(event_), R"(,"cat":"flow","bp":"e","id":{})", id);
  return write_event();
}

Result<void> TraceFile::flush() {
  stream_.flush();
  return state();
}

Result<void> TraceFile::close() {
  if (!closed_) {
    closed_ = true;
    stream_ << "\n]\n";
    stream_.close();
  }
  return state();
}

void TraceFile::open_event(char phase, int thread, std::string_view name) {
  event_.clear();
  fmt::format_to(std::back_inserter(event_), R"({{"ph":"{}","pid":1,"tid":{})", phase, thread);
  if (name.empty()) return;
  event_ += R"(,"name":)";
  append_json_string(event_, name);
}

void TraceFile::add_stamp(std::string_view key, Duration time) {
  const std::int64_t ns = time.count();
  const std::uint64_t magnitude = ns < 0 ? 0 - static_cast<std::uint64_t>(ns) : static_cast<std::uint64_t>(ns);
  fmt::format_to(std::back_inserter(event_), R"(,"{}":{}{}.{:03})", key, ns < 0 ? "-" : "", magnitude / 1000,
                 magnitude % 1000);
}

void TraceFile::add_arguments(TraceArguments arguments) {
  if (arguments.size() == 0) return;
  event_ += R"(,"args":{)";
  for (const TraceArgument& argument : arguments) {
    if (event_.back() != '{') event_ += ',';
    append_json_string(event_, argument.name);
    event_ += ':';
    if (const auto* text = std::get_if<std::string_view>(&argument.value)) {
      append_json_string(event_, *text);
    } else if (const auto* integer = std::get_if<std::int64_t>(&argument.value)) {
      event_ += fmt::to_string(*integer);
    } else {
      const double number = std::get<double>(argument.value);
      event_ += std::isfinite(number) ? fmt::to_string(number) : "null";
    }
  }
  event_ += '}';
}

Result<void> TraceFile::metadata(std::string_view what, int thread, std::string_view key, std::string_view json_value) {
  open_event('M', thread, what);
  fmt::format_to(std::back_inserter(event_), R"(,"args":{{"{}":{}}})", key, json_value);
  return write_event();
}

Result<void> TraceFile::write_event() {
  event_ += '}';
  stream_ << (first_ ? "\n" : ",\n") << event_;
  first_ = false;
  return state();
}

Result<void> TraceFile::state() const {
  if (stream_.fail()) return fail(fmt::format("{}: the trace cannot be written; is the disk full?", path_.string()));
  return {};
}

}  // namespace cgsr::sinks
