#pragma once
// From snapshots to PNG files, while the simulation goes on: one thread draws (a drawing context belongs to one thread), others write.

#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/snapshot.h"
#include "render/renderer.h"

namespace tsubu::app {

class Film {
 public:
  /// What the renderer is made of, and where frames go. `text` travels in every frame.
  struct Parts {
    render::Style style;
    std::vector<render::VisibleWall> walls;
    Box bounds;
    std::filesystem::path folder;
    std::map<std::string, std::string> text;
  };

  /// Starts drawing; removes the frames of an earlier run from the folder.
  explicit Film(Parts parts);
  /// Finishes what was handed in, complaints swallowed: call finish() to hear them.
  ~Film();
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// Hands in the next frame; waits when too many are under way. Rethrows what went wrong with earlier ones.
  void add(Snapshot snapshot);
  /// Waits until every frame is a complete file.
  void finish();

  std::size_t frames() const { return handedIn_; }
  /// What draws; known after the first frame is under way or finish().
  std::string renderer();

 private:
  void draw();
  void stop();

  Parts parts_;
  std::size_t handedIn_ = 0;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Snapshot> waiting_;
  bool closed_ = false;
  std::exception_ptr failure_;
  std::string renderer_;
  std::thread thread_;
};

/// "000042.png"
std::string frameName(std::size_t number);

}  // namespace tsubu::app
