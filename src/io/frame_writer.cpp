#include "io/frame_writer.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace tsubu::io {

FrameWriter::FrameWriter(std::size_t workers, std::size_t queue) : limit_(std::max<std::size_t>(queue, 1)) {
  for (std::size_t k = 0; k < std::max<std::size_t>(workers, 1); ++k) workers_.emplace_back([this] { work(); });
}

FrameWriter::~FrameWriter() { finish(); }

void FrameWriter::write(std::filesystem::path path, Image image, PngText text) {
  std::unique_lock lock(mutex_);
  if (closed_) throw std::logic_error("a frame was handed to a closed FrameWriter");
  changed_.wait(lock, [&] { return queue_.size() < limit_ || failure_; });
  throwFailure(lock);
  queue_.push_back({std::move(path), std::move(image), std::move(text)});
  changed_.notify_all();
}

void FrameWriter::close() {
  finish();
  std::unique_lock lock(mutex_);
  throwFailure(lock);
}

void FrameWriter::finish() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  for (std::thread& worker : workers_) worker.join();
  workers_.clear();
}

void FrameWriter::throwFailure(std::unique_lock<std::mutex>& lock) {
  if (!failure_) return;
  const std::exception_ptr failure = std::exchange(failure_, nullptr);
  lock.unlock();
  std::rethrow_exception(failure);
}

void FrameWriter::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return !queue_.empty() || closed_; });
    if (queue_.empty()) return;
    const Frame frame = std::move(queue_.front());
    queue_.pop_front();
    changed_.notify_all();
    lock.unlock();
    std::exception_ptr failure;
    try {
      writePng(frame.path, frame.image, frame.text);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    if (failure && !failure_) failure_ = failure;
    if (failure) changed_.notify_all();
  }
}

}  // namespace tsubu::io
