#pragma once
// Pictures to files while the simulation goes on.

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>
#include <vector>

#include "core/image.h"
#include "io/png_file.h"

namespace tsubu::io {

/// Worker threads that write PNG files from a queue of limited length, in no particular order among themselves. Every file is complete or
/// absent. One thread hands in frames; any failure reaches that thread with the next call.
class FrameWriter {
 public:
  /// At least one worker; `queue` frames may wait (at least one) before `write` does.
  explicit FrameWriter(std::size_t workers = 1, std::size_t queue = 4);
  /// Writes what waits. Failures that nobody asked for are lost: call `close` to hear of them.
  ~FrameWriter();
  FrameWriter(const FrameWriter&) = delete;
  FrameWriter& operator=(const FrameWriter&) = delete;

  /// Hands in a frame; waits while the queue is full. Throws the first failure of any earlier frame, once, and drops this frame then.
  void write(std::filesystem::path path, Image image, PngText text = {});

  /// Waits until all files are written and the workers are gone. Throws the first failure that has not been thrown.
  /// Afterwards `write` throws std::logic_error.
  void close();

 private:
  struct Frame {
    std::filesystem::path path;
    Image image;
    PngText text;
  };

  void work();
  void finish();
  void throwFailure(std::unique_lock<std::mutex>& lock);

  const std::size_t limit_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Frame> queue_;
  std::exception_ptr failure_;
  bool closed_ = false;
  std::vector<std::thread> workers_;
};

}  // namespace tsubu::io
