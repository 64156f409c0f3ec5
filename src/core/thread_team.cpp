#include "core/thread_team.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace tsubu {

namespace {
// A pass follows the last one within microseconds, or within some milliseconds where lists are made anew: look for it a while before
// sleeping, the longer part of it in such a way that threads that draw and write pictures get the core. A thread that sleeps often is
// soon woken on the core of the one that wakes it, and the two share that from then on, with the other core idle.
constexpr int looksBeforeYield = 2000, looksBeforeSleep = 12000;
// Entries that take longer to go through than another thread takes to begin.
constexpr std::size_t leastPart = 1000;

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

ThreadTeam::ThreadTeam(int threads) : seats_(static_cast<std::size_t>(threads)), used_(threads) {
  for (int thread = 1; thread < threads; ++thread) workers_.emplace_back([this, thread] { work(thread); });
}

ThreadTeam::~ThreadTeam() {
  stop_ = true;
  begin(threads());
  for (std::thread& worker : workers_) worker.join();
}

void ThreadTeam::run(int tasks, const std::function<void(int, int)>& task) {
  run(
      tasks, [&](int thread) { return static_cast<int>(static_cast<std::int64_t>(tasks) * thread / used_); }, task);
}

void ThreadTeam::run(const std::vector<int>& begin, const std::function<void(int, int)>& task) {
  if (begin.size() != static_cast<std::size_t>(used_) + 1) throw std::logic_error("Shares of tasks for another number of threads.");
  run(
      begin.back(), [&](int thread) { return begin[static_cast<std::size_t>(thread)]; }, task);
}

void ThreadTeam::runParts(std::size_t size, const std::function<void(std::size_t, std::size_t)>& task) {
  const std::size_t parts = std::clamp<std::size_t>(size / leastPart, 1, static_cast<std::size_t>(used_));
  run(static_cast<int>(parts), [&](int k, int) {
    const auto part = static_cast<std::size_t>(k);
    task(size * part / parts, size * (part + 1) / parts);
  });
}

template <class First>
void ThreadTeam::run(int tasks, const First& first, const std::function<void(int, int)>& task) {
  if (used_ == 1 || tasks <= 1) {
    for (int k = 0; k < tasks; ++k) task(k, 0);
    return;
  }
  task_ = &task;
  for (int thread = 0; thread < used_; ++thread) {
    Seat& seat = seats_[static_cast<std::size_t>(thread)];
    seat.next = first(thread);
    seat.end = first(thread + 1);
  }
  busy_ = used_ - 1;
  begin(used_);
  takeTasks(0);
  for (int looks = 0; busy_.load(std::memory_order_acquire) > 0; looks += looks < looksBeforeYield) waitALittle(looks);
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

// Calls the first threads to a round.
void ThreadTeam::begin(int threads) {
  const std::lock_guard lock(mutex_);
  round_ = Round{round_.load().number + 1, static_cast<std::uint32_t>(threads)};
  for (int thread = 1; thread < threads; ++thread)
    if (Seat& seat = seats_[static_cast<std::size_t>(thread)]; seat.asleep) seat.wake.notify_one();
}

void ThreadTeam::takeTasks(int thread) {
  for (int n = 0; n < used_; ++n) {
    Seat& seat = seats_[static_cast<std::size_t>((thread + n) % used_)];
    for (int k = seat.next.fetch_add(1); k < seat.end; k = seat.next.fetch_add(1)) {
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
  Round seen{};
  Seat& seat = seats_[static_cast<std::size_t>(thread)];
  for (;;) {
    for (int looks = 0; looks < looksBeforeSleep && !calls(seen, thread); ++looks) waitALittle(looks);
    if (!calls(seen, thread)) {
      std::unique_lock lock(mutex_);
      seat.asleep = true;
      seat.wake.wait(lock, [&] { return calls(seen, thread); });
      seat.asleep = false;
    }
    seen = round_.load();
    if (stop_) return;
    takeTasks(thread);
    busy_.fetch_sub(1, std::memory_order_release);
  }
}

}  // namespace tsubu
