#include "tests/sinks/trace_check.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

#include <fmt/format.h>

namespace cgsr::test {
namespace {

using nlohmann::json;

struct Slice {
  std::string name;
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
};

struct FlowEnd {
  int thread = 0;
  std::int64_t at_ns = 0;
};

std::int64_t nanoseconds(const json& event, const char* key) {
  return std::llround(event.at(key).get<double>() * 1000.0);
}

class Checker {
 public:
  explicit Checker(bool cut) : cut_(cut) {}

  void read(const json& event) {
    const std::string phase = event.at("ph");
    if (phase == "M") return read_metadata(event);
    const std::int64_t at = nanoseconds(event, "ts");
    const int thread = event.at("tid");
    const std::string name = event.value("name", "");
    if (phase == "X") {
      add_slice(thread, {name, at, at + nanoseconds(event, "dur")});
    } else if (phase == "B") {
      in_order(fmt::format("thread {}", thread), at);
      open_[thread].push_back({name, at, at});
    } else if (phase == "E") {
      in_order(fmt::format("thread {}", thread), at);
      read_end(thread, at);
    } else if (phase == "i") {
      in_order(fmt::format("thread {}", thread), at);
      ++contents_.instants[name];
    } else if (phase == "C") {
      in_order("counter " + name, at);
      ++contents_.counters[name];
      if (!event.at("args").at("value").is_number()) problem(fmt::format("counter {} has no number", name));
    } else if (phase == "s" || phase == "f") {
      auto& ends = phase == "s" ? flow_starts_ : flow_ends_;
      if (!ends.emplace(fmt::format("{} {}", name, event.at("id").dump()), FlowEnd{thread, at}).second) {
        problem(fmt::format("two flow events '{}' {} with the same id {}", phase, name, event.at("id").dump()));
      }
    } else {
      problem(fmt::format("unknown phase '{}'", phase));
    }
  }

  TraceContents finish() {
    for (const auto& [thread, open] : open_) {
      for (const Slice& slice : open) {
        if (!cut_) problem(fmt::format("thread {}: '{}' begins and never ends", thread, slice.name));
      }
    }
    for (auto& [thread, slices] : slices_) {
      if (contents_.threads.count(thread) == 0) problem(fmt::format("thread {} has slices and no name", thread));
      check_nesting(thread, slices);
    }
    check_flows();
    return std::move(contents_);
  }

  void problem(const std::string& problem) { contents_.problems.push_back(problem); }

 private:
  void read_metadata(const json& event) {
    if (event.at("name") == "thread_name") contents_.threads[event.at("tid")] = event.at("args").at("name");
  }

  void read_end(int thread, std::int64_t at) {
    auto& open = open_[thread];
    if (open.empty()) return problem(fmt::format("thread {}: an end at {} ns without a begin", thread, at));
    Slice slice = open.back();
    open.pop_back();
    slice.end_ns = at;
    add_slice(thread, slice);
  }

  void add_slice(int thread, const Slice& slice) {
    if (slice.end_ns < slice.begin_ns) problem(fmt::format("'{}' has a negative duration", slice.name));
    slices_[thread].push_back(slice);
    ++contents_.slices[slice.name];
  }

  void in_order(const std::string& row, std::int64_t at) {
    const auto [last, is_new] = last_.try_emplace(row, at);
    if (at < last->second) problem(fmt::format("{}: time goes back from {} to {} ns", row, last->second, at));
    last->second = at;
  }

  void check_nesting(int thread, std::vector<Slice>& slices) {
    std::stable_sort(slices.begin(), slices.end(), [](const Slice& a, const Slice& b) {
      return a.begin_ns != b.begin_ns ? a.begin_ns < b.begin_ns : a.end_ns > b.end_ns;
    });
    std::vector<const Slice*> around;
    for (const Slice& slice : slices) {
      while (!around.empty() && around.back()->end_ns <= slice.begin_ns) around.pop_back();
      if (!around.empty() && slice.end_ns > around.back()->end_ns) {
        problem(fmt::format("thread {}: '{}' [{}, {}] ns and '{}' [{}, {}] ns overlap and do not nest", thread,
                            around.back()->name, around.back()->begin_ns, around.back()->end_ns, slice.name,
                            slice.begin_ns, slice.end_ns));
      }
      around.push_back(&slice);
    }
  }

  bool lies_in_a_slice(const FlowEnd& end) {
    const auto& slices = slices_[end.thread];
    return std::any_of(slices.begin(), slices.end(),
                       [&](const Slice& slice) { return slice.begin_ns <= end.at_ns && end.at_ns <= slice.end_ns; });
  }

  void check_flows() {
    for (const auto& [id, start] : flow_starts_) {
      if (!cut_ && !lies_in_a_slice(start)) problem(fmt::format("flow {} starts in no slice", id));
      const auto end = flow_ends_.find(id);
      if (end == flow_ends_.end()) {
        if (!cut_) problem(fmt::format("flow {} never ends", id));
        continue;
      }
      ++contents_.flows;
      ++contents_.arrows[id.substr(0, id.rfind(' '))];
      if (end->second.at_ns < start.at_ns) problem(fmt::format("flow {} ends before it starts", id));
      if (!cut_ && !lies_in_a_slice(end->second)) problem(fmt::format("flow {} ends in no slice", id));
    }
    for (const auto& [id, end] : flow_ends_) {
      if (!cut_ && flow_starts_.count(id) == 0) problem(fmt::format("flow {} ends and never starts", id));
    }
  }

  bool cut_;
  TraceContents contents_;
  std::map<int, std::vector<Slice>> open_;
  std::map<int, std::vector<Slice>> slices_;
  std::map<std::string, std::int64_t> last_;
  std::map<std::string, FlowEnd> flow_starts_;
  std::map<std::string, FlowEnd> flow_ends_;
};

}  // namespace

TraceContents check_trace(const std::string& text, bool cut) {
  Checker checker(cut);
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    if (line == "[" || line == "]") continue;
    const bool whole = !lines.eof();  // its line feed is there
    if (!line.empty() && line.back() == ',') line.pop_back();
    const json event = json::parse(line, nullptr, false);
    if (event.is_discarded()) {
      if (whole || !cut) checker.problem("not JSON: " + line);
      continue;
    }
    try {
      checker.read(event);
    } catch (const json::exception& error) {
      checker.problem(fmt::format("{}: {}", error.what(), line));
    }
  }
  return checker.finish();
}

TraceContents check_trace_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  TraceContents contents = check_trace(text);
  const json whole = json::parse(text, nullptr, false);
  if (whole.is_discarded() || !whole.is_array())
    contents.problems.insert(contents.problems.begin(), "the file is not a JSON array");
  return contents;
}

}  // namespace cgsr::test
