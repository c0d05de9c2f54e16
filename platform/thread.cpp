#include "platform/thread.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/resource.h>

#include <algorithm>
#include <climits>
#include <cstring>
#include <utility>

#include "platform/memory.h"

namespace cgsr {

struct ThreadTable::Entry {
  ThreadReport report;
  std::function<void()> body;
  WakeUp* wake = nullptr;
  pthread_t thread{};
  bool joined = false;

  static void* run(void* self);
};

namespace {

constexpr std::size_t kLongestName = 15;  // the kernel's TASK_COMM_LEN, without the final zero
constexpr int kHighestPriority = 89;
constexpr std::size_t kStackMargin = 16 * 1024;  // left untouched at the far end, for the call that touches

/// A thread attribute that is destroyed with its scope.
class Attributes {
 public:
  Attributes(const ThreadSpec& spec, bool with_priority) {
    pthread_attr_init(&attributes_);
    pthread_attr_setstacksize(&attributes_, spec.stack_bytes);
    if (!with_priority) return;
    const sched_param priority{spec.priority};
    pthread_attr_setinheritsched(&attributes_, PTHREAD_EXPLICIT_SCHED);
    pthread_attr_setschedpolicy(&attributes_, SCHED_FIFO);
    pthread_attr_setschedparam(&attributes_, &priority);
  }
  ~Attributes() { pthread_attr_destroy(&attributes_); }
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;
  [[nodiscard]] const pthread_attr_t* get() const { return &attributes_; }

 private:
  pthread_attr_t attributes_{};
};

std::string refusal() {
  rlimit limit{};
  getrlimit(RLIMIT_RTPRIO, &limit);
  return fmt::format("SCHED_FIFO is not permitted (RLIMIT_RTPRIO {}); LimitRTPRIO=80 or CAP_SYS_NICE would grant it",
                     limit.rlim_cur);
}

Result<void> check(const ThreadSpec& spec) {
  if (spec.name.empty() || spec.name.size() > kLongestName) {
    return fail(fmt::format("thread '{}': a name has 1..{} characters", spec.name, kLongestName));
  }
  const bool fifo = spec.policy == SchedulingPolicy::kFifo;
  if (fifo ? spec.priority < 1 || spec.priority > kHighestPriority : spec.priority != 0) {
    return fail(fmt::format("thread '{}': priority {} is not in {}", spec.name, spec.priority,
                            fifo ? fmt::format("1..{} of SCHED_FIFO", kHighestPriority) : "0..0 of SCHED_OTHER"));
  }
  const auto least = static_cast<std::size_t>(PTHREAD_STACK_MIN) + 2 * kStackMargin;
  if (spec.stack_bytes < least) {
    return fail(fmt::format("thread '{}': a stack of {} bytes is less than {}", spec.name, spec.stack_bytes, least));
  }
  return {};
}

/// \return the bytes of the calling thread's stack below this frame. Above it lie start-up frames and thread-local
///       variables, whose size the libraries decide.
std::size_t stack_left() {
  pthread_attr_t attributes;
  pthread_getattr_np(pthread_self(), &attributes);
  void* lowest = nullptr;
  std::size_t bytes = 0;
  pthread_attr_getstack(&attributes, &lowest, &bytes);
  pthread_attr_destroy(&attributes);
  const auto* const here = static_cast<const char*>(__builtin_frame_address(0));
  const auto left = here - static_cast<const char*>(lowest);
  return std::max(static_cast<std::size_t>(left), 2 * kStackMargin);
}

}  // namespace

std::string_view to_string(SchedulingPolicy policy) {
  switch (policy) {
    case SchedulingPolicy::kOther:
      return "SCHED_OTHER";
    case SchedulingPolicy::kFifo:
      return "SCHED_FIFO";
  }
  return "";
}

void* ThreadTable::Entry::run(void* self) {
  auto& entry = *static_cast<Entry*>(self);
  const auto& spec = entry.report.asked;
  prefault_stack(stack_left() - kStackMargin);
  if (spec.heap_bytes > 0) prefault_heap(spec.heap_bytes);
  entry.body();
  return nullptr;
}

ThreadTable::ThreadTable(StopRequest& stop) : stop_(stop) {}

ThreadTable::~ThreadTable() {
  stop_and_join();
}

Result<void> ThreadTable::start(const ThreadSpec& spec, std::function<void()> body, WakeUp* wake) {
  if (auto checked = check(spec); !checked) return checked;
  auto entry = std::make_unique<Entry>();
  entry->report = {spec, spec.policy, spec.priority, {}};
  entry->body = std::move(body);
  entry->wake = wake;

  const bool fifo = spec.policy == SchedulingPolicy::kFifo;
  int outcome = pthread_create(&entry->thread, Attributes(spec, fifo).get(), &Entry::run, entry.get());
  if (outcome == EPERM && fifo) {
    entry->report.policy = SchedulingPolicy::kOther;
    entry->report.priority = 0;
    entry->report.remark = refusal();
    outcome = pthread_create(&entry->thread, Attributes(spec, false).get(), &Entry::run, entry.get());
  }
  if (outcome != 0) {
    return fail(
        fmt::format("thread '{}' with a stack of {} KiB could not be created: {}{}", spec.name, spec.stack_bytes / 1024,
                    std::strerror(outcome),
                    outcome == EAGAIN ? " (limits on threads, or on locked memory: LimitMEMLOCK=infinity)" : ""));
  }
  pthread_setname_np(entry->thread, std::string(spec.name).c_str());
  entries_.push_back(std::move(entry));
  return {};
}

void ThreadTable::stop_and_join() {
  stop_.request();
  for (const auto& entry : entries_) {
    if (entry->wake != nullptr && !entry->joined) entry->wake->wake();
  }
  for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry) {
    if (std::exchange((*entry)->joined, true)) continue;
    pthread_join((*entry)->thread, nullptr);
  }
}

std::vector<ThreadReport> ThreadTable::report() const {
  std::vector<ThreadReport> report;
  for (const auto& entry : entries_) report.push_back(entry->report);
  return report;
}

std::string to_text(const std::vector<ThreadReport>& report) {
  fmt::memory_buffer text;
  auto out = fmt::appender(text);
  fmt::format_to(out, "{:<15} {:<11} {:>8} {:>9} {:>8}\n", "thread", "policy", "priority", "stack/KiB", "heap/KiB");
  for (const auto& row : report) {
    fmt::format_to(out, "{:<15} {:<11} {:>8} {:>9} {:>8}\n", row.asked.name, to_string(row.policy), row.priority,
                   row.asked.stack_bytes / 1024, row.asked.heap_bytes / 1024);
  }
  for (const auto& row : report) {
    if (!row.remark.empty()) {
      fmt::format_to(out, "{} asked for {} {}: {}\n", row.asked.name, to_string(row.asked.policy), row.asked.priority,
                     row.remark);
    }
  }
  return fmt::to_string(text);
}

}  // namespace cgsr
