#pragma once
// A few threads that stay, for passes that take less than a millisecond.

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tsubu {

/// Runs numbered tasks on a fixed number of threads, the caller among them. Which thread takes which task is left to chance, so a
/// task must write only what is its own; then the results do not depend on the number of threads.
class ThreadTeam {
 public:
  explicit ThreadTeam(int threads);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls task(k, thread) for k in [0, tasks), thread in [0, threads()), and returns when all are done. Rethrows the first exception.
  void run(int tasks, const std::function<void(int, int)>& task);

 private:
  void work(int thread);
  void takeTasks(int thread);

  std::vector<std::thread> workers_;
  const std::function<void(int, int)>* task_ = nullptr;
  int tasks_ = 0;
  std::atomic<int> next_{0};
  std::atomic<int> busy_{0};
  std::atomic<unsigned> round_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable wake_;
  std::exception_ptr failure_;
};

}  // namespace tsubu
