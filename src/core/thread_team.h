#pragma once
// A few threads that stay, for passes that take less than a millisecond.

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tsubu {

/// Runs numbered tasks on a fixed number of threads, the caller among them. A thread has a share of the numbers, the same in every run of
/// as many tasks: what its tasks work on stays in the caches of its core, and to move it to those of another one costs more than most
/// tasks. Only a thread that has nothing left takes what is left of others. So which thread does what is left to chance, and a task must
/// write only what is its own; then the results do not depend on the number of threads.
class ThreadTeam {
 public:
  explicit ThreadTeam(int threads);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int threads() const { return static_cast<int>(seats_.size()); }

  /// From now on only the first so many threads work, 1 ≤ count ≤ threads(). The others sleep.
  void use(int count) { used_ = count; }
  int used() const { return used_; }

  /// Calls task(k, thread) for k in [0, tasks), thread in [0, threads()), and returns when all are done. Rethrows the first exception.
  void run(int tasks, const std::function<void(int, int)>& task);
  /// The same with given shares: thread k begins with the tasks from begin[k] on; begin[used()], the last, is their number.
  /// Throws std::logic_error where there are more shares or fewer.
  void run(const std::vector<int>& begin, const std::function<void(int, int)>& task);

  /// Calls task(first, last) for parts of [0, size) that make it up: one for each thread, or fewer where there is little to do.
  void runParts(std::size_t size, const std::function<void(std::size_t, std::size_t)>& task);

 private:
  /// `first`: of the tasks of a thread.
  template <class First>
  void run(int tasks, const First& first, const std::function<void(int, int)>& task);
  void work(int thread);
  void takeTasks(int thread);
  void begin(int threads);

  /// What is one thread's own. A cache line for itself: threads write here for every task.
  struct alignas(64) Seat {
    std::atomic<int> next{0};  ///< of its share of the tasks, what nobody has taken yet
    int end = 0;
    bool asleep = false;
    std::condition_variable wake;
  };

  /// A round of tasks: its number, and how many threads take part. In one word: who reads it knows whether it is meant.
  struct alignas(8) Round {
    std::uint32_t number, threads;
  };

  bool calls(const Round& seen, int thread) const {
    const Round now = round_.load(std::memory_order_acquire);
    return now.number != seen.number && static_cast<int>(now.threads) > thread;
  }

  std::vector<std::thread> workers_;
  std::vector<Seat> seats_;
  int used_;
  const std::function<void(int, int)>* task_ = nullptr;
  alignas(64) std::atomic<int> busy_{0};
  alignas(64) std::atomic<Round> round_{};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::exception_ptr failure_;
};

}  // namespace tsubu
