#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace cgsr::sim {

/// Threads that share numbered jobs. What a job computes may depend on its number alone: then the result does not depend on how many
/// threads there are.
///
/// Threads: run() from one thread at a time; that thread works too, so Workers(1) starts none.
class Workers {
 public:
  explicit Workers(int threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Calls job(0) .. job(count - 1), each once, and returns when all are done. Denormal floats count as zero inside, on every thread.
  void run(int count, const std::function<void(int)>& job);

 private:
  void serve();
  void work();

  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::condition_variable begin_;
  std::condition_variable done_;
  const std::function<void(int)>* job_ = nullptr;
  std::uint64_t round_ = 0;
  int busy_ = 0;
  bool stop_ = false;
  std::atomic<int> next_{0};
  int count_ = 0;
};

}  // namespace cgsr::sim
