#include "core/thread_team.h"

#include <utility>

namespace tsubu {

namespace {
// A pass follows the last one within microseconds, or within some milliseconds where lists are made anew: look for it a while before
// sleeping, the longer part of it in such a way that threads that draw and write pictures get the core. A thread that sleeps often is
// soon woken on the core of the one that wakes it, and the two share that from then on, with the other core idle.
constexpr int looksBeforeYield = 2000, looksBeforeSleep = 12000;

inline void waitALittle(int looks) {
  if (looks >= looksBeforeYield) {
    std::this_thread::yield();
    return;
  }
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}
}  // namespace

ThreadTeam::ThreadTeam(int threads) : shares_(static_cast<std::size_t>(threads)) {
  for (int thread = 1; thread < threads; ++thread) workers_.emplace_back([this, thread] { work(thread); });
}

ThreadTeam::~ThreadTeam() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    ++round_;
  }
  wake_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadTeam::run(int tasks, const std::function<void(int, int)>& task) {
  if (workers_.empty() || tasks <= 1) {
    for (int k = 0; k < tasks; ++k) task(k, 0);
    return;
  }
  task_ = &task;
  for (int thread = 0; thread < threads(); ++thread) {
    const auto first = [&](int share) { return static_cast<int>(static_cast<std::int64_t>(tasks) * share / threads()); };
    Share& share = shares_[static_cast<std::size_t>(thread)];
    share.next = first(thread);
    share.end = first(thread + 1);
  }
  busy_ = static_cast<int>(workers_.size());
  {
    const std::lock_guard lock(mutex_);
    ++round_;
  }
  wake_.notify_all();
  takeTasks(0);
  for (int looks = 0; busy_.load(std::memory_order_acquire) > 0; looks += looks < looksBeforeYield) waitALittle(looks);
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void ThreadTeam::takeTasks(int thread) {
  for (int n = 0; n < threads(); ++n) {
    Share& share = shares_[static_cast<std::size_t>((thread + n) % threads())];
    for (int k = share.next.fetch_add(1); k < share.end; k = share.next.fetch_add(1)) {
      try {
        (*task_)(k, thread);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::current_exception();
      }
    }
  }
}

void ThreadTeam::work(int thread) {
  unsigned seen = 0;
  for (;;) {
    for (int looks = 0; looks < looksBeforeSleep && round_.load(std::memory_order_acquire) == seen; ++looks) waitALittle(looks);
    if (round_.load(std::memory_order_acquire) == seen) {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [&] { return round_.load() != seen; });
    }
    ++seen;
    if (stop_) return;
    takeTasks(thread);
    busy_.fetch_sub(1, std::memory_order_release);
  }
}

}  // namespace tsubu
