#include "app/film.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "core/error.h"
#include "io/frame_writer.h"

namespace tsubu::app {

namespace {

constexpr std::size_t mostWaiting = 4;  // snapshots; a bed of a million grains takes 150 MB each

bool isFrame(const std::filesystem::path& path) {
  const std::string stem = path.stem().string();
  return path.extension() == ".png" && stem.size() == 6 &&
         std::all_of(stem.begin(), stem.end(), [](unsigned char c) { return std::isdigit(c); });
}

void clearFrames(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Error(ErrorKind::files, fmt::format("Cannot make the folder '{}': {}.", folder.string(), failed.message()));
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (isFrame(entry.path())) std::filesystem::remove(entry.path(), failed);
}

}  // namespace

std::string frameName(std::size_t number) { return fmt::format("{:06}.png", number); }

Film::Film(Parts parts) : parts_(std::move(parts)) {
  clearFrames(parts_.folder);
  thread_ = std::thread([this] { draw(); });
}

Film::~Film() { stop(); }

void Film::stop() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Film::add(Snapshot snapshot) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return waiting_.size() < mostWaiting || failure_; });
  if (failure_) std::rethrow_exception(failure_);
  waiting_.push_back(std::move(snapshot));
  ++handedIn_;
  changed_.notify_all();
}

void Film::finish() {
  stop();
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

std::string Film::renderer() {
  const std::lock_guard lock(mutex_);
  return renderer_;
}

void Film::draw() {
  try {
    render::Renderer renderer(parts_.style, std::move(parts_.walls), parts_.bounds);
    {
      const std::lock_guard lock(mutex_);
      renderer_ = renderer.description();
    }
    io::PngText text = parts_.text;
    text["renderer"] = renderer.description();
    io::FrameWriter writer(1);
    for (std::size_t number = 0;; ++number) {
      Snapshot snapshot;
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return !waiting_.empty() || closed_; });
        if (waiting_.empty()) break;
        snapshot = std::move(waiting_.front());
        waiting_.pop_front();
        changed_.notify_all();
      }
      text["time"] = fmt::format("{:.9g} s", snapshot.time);
      writer.write(parts_.folder / frameName(number), renderer.draw(snapshot), text);
    }
    writer.close();
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
    changed_.notify_all();
  }
}

}  // namespace tsubu::app
