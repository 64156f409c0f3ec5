#pragma once
// How a run goes from output to output: by steps of one length, or by those that the live network of contacts and bonds allows.

#include <cstdint>
#include <limits>
#include <string>

#include "scene/build.h"
#include "sim/simulation.h"

namespace tsubu::scene {

class Pace {
 public:
  explicit Pace(const FramePlan& plan);

  bool ended() const { return ended_; }
  /// Has the state just reached the time of a frame, of a row of the ledger?
  bool frameDue() const { return whole_ && ticks_ % ticksPerFrame_ == 0; }
  bool rowDue() const { return (whole_ && ticks_ % ticksPerRow_ == 0) || ended_; }
  std::uint64_t rows() const { return ticks_ / ticksPerRow_; }  ///< so far, the one due not counted
  /// Between outputs?
  bool underWay() const { return left_ > 0; }
  /// Takes some steps, `most` at most, and never beyond the next output.
  void advance(sim::Simulation& simulation, std::uint64_t most);

  /// The shortest limit that the network has had, where steps follow it.
  struct Limit {
    double step = std::numeric_limits<double>::infinity(), time = 0;  ///< s
    std::string by;
  };
  const Limit& limit() const { return limit_; }
  double shortest() const { return shortest_; }  ///< s: steps taken
  double longest() const { return longest_; }

 private:
  void begin(sim::Simulation& simulation);
  void follow(sim::Simulation& simulation);

  FramePlan plan_;
  std::uint64_t stepsPerTick_, ticksPerFrame_, ticksPerRow_;
  std::uint64_t ticks_ = 0, left_ = 0, sinceLook_ = 0, contacts_ = 0;
  double next_ = 0;  // s: of the next output
  bool whole_ = true, ended_ = false, wholeTick_ = true;
  Limit limit_;
  double shortest_, longest_;
};

}  // namespace tsubu::scene
