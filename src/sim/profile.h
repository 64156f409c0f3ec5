#pragma once
// Where the time of a run goes. Kept only when a run asks for it: the clock is read a few times per slab and step.

#include <array>
#include <chrono>
#include <cstddef>
#include <string_view>
#include <vector>

namespace tsubu::sim {

enum class ProfilePart { pairs, walls, other, motion, lists, population, count };

constexpr std::string_view nameOf(ProfilePart part) {
  switch (part) {
    case ProfilePart::pairs:
      return "contacts of grains";
    case ProfilePart::walls:
      return "contacts with walls";
    case ProfilePart::other:
      return "other forces";
    case ProfilePart::motion:
      return "motion";
    case ProfilePart::lists:
      return "neighbour lists";
    case ProfilePart::population:
      return "arrivals and departures";
    case ProfilePart::count:
      break;
  }
  return "";
}

class Profile {
 public:
  /// s of all threads together, by part.
  using Seconds = std::array<double, static_cast<std::size_t>(ProfilePart::count)>;

  void start(int threads) { lanes_.assign(static_cast<std::size_t>(threads), Lane{}); }
  bool on() const { return !lanes_.empty(); }

  Seconds seconds() const {
    Seconds sum{};
    for (const Lane& lane : lanes_)
      for (std::size_t part = 0; part < sum.size(); ++part) sum[part] += lane.seconds[part];
    return sum;
  }

  /// Times what happens between its construction and the end of its scope, or the next part that it is told of.
  class Lap {
   public:
    Lap(Profile& profile, ProfilePart part, int thread = 0)
        : seconds_(profile.on() ? profile.lanes_[static_cast<std::size_t>(thread)].seconds.data() : nullptr), part_(part) {
      if (seconds_) began_ = Clock::now();
    }
    ~Lap() { end(); }
    Lap(const Lap&) = delete;
    Lap& operator=(const Lap&) = delete;

    void next(ProfilePart part) {
      end();
      part_ = part;
    }

   private:
    using Clock = std::chrono::steady_clock;

    void end() {
      if (!seconds_) return;
      const Clock::time_point now = Clock::now();
      seconds_[static_cast<std::size_t>(part_)] += std::chrono::duration<double>(now - began_).count();
      began_ = now;
    }

    double* seconds_;
    ProfilePart part_;
    Clock::time_point began_;
  };

 private:
  struct alignas(64) Lane {
    Seconds seconds{};
  };
  std::vector<Lane> lanes_;  // one per thread; none when nobody asks
};

}  // namespace tsubu::sim
