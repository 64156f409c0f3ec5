#include "scene/pace.h"

#include <algorithm>
#include <cmath>

namespace tsubu::scene {

namespace {

// While steps follow the network it is looked at with every output, and so often in between whether it has got more contacts by this share.
constexpr std::uint64_t lookEvery = 128;
constexpr double grown = 0.1;
constexpr std::uint64_t grownBy = 4;

}  // namespace

Pace::Pace(const FramePlan& plan)
    : plan_(plan),
      stepsPerTick_(std::min(plan.stepsPerFrame, plan.stepsPerLedgerRow)),
      ticksPerFrame_(plan.stepsPerFrame / stepsPerTick_),
      ticksPerRow_(plan.stepsPerLedgerRow / stepsPerTick_),
      ended_(plan.steps == 0),
      shortest_(plan.timeStep),
      longest_(plan.timeStep) {}

void Pace::begin(sim::Simulation& simulation) {
  whole_ = false;
  if (!plan_.live) {
    left_ = std::min(stepsPerTick_, plan_.steps - simulation.steps());
    wholeTick_ = left_ == stepsPerTick_;
    return;
  }
  const double interval = std::min(plan_.interval, plan_.ledgerInterval), end = static_cast<double>(plan_.steps) * plan_.timeStep;
  next_ = static_cast<double>(ticks_ + 1) * interval;
  wholeTick_ = next_ <= end * (1 + 1e-9);
  if (!wholeTick_) next_ = end;
  follow(simulation);
}

// The next step still has the old length; those after it share what is left until the next output.
void Pace::follow(sim::Simulation& simulation) {
  const sim::StepLimit limit = simulation.stableStep();
  contacts_ = simulation.contacts().touching;
  sinceLook_ = 0;
  if (limit.step < limit_.step) limit_ = {limit.step, simulation.time(), limit.by};
  const double old = simulation.timeStep(), wanted = std::min(plan_.live->longest, plan_.live->safety * limit.step);
  const double rest = next_ - simulation.time() - old;
  if (rest < 1e-6 * old) {
    left_ = 1;
    return;
  }
  const double steps = std::max(1.0, std::ceil(rest / wanted * (1 - 1e-9))), step = rest / steps;
  left_ = 1 + static_cast<std::uint64_t>(steps);
  if (std::abs(step / old - 1) > 1e-9) simulation.setTimeStep(step);
  shortest_ = std::min(shortest_, step);
  longest_ = std::max(longest_, step);
}

void Pace::advance(sim::Simulation& simulation, std::uint64_t most) {
  if (ended_) return;
  if (left_ == 0) begin(simulation);
  std::uint64_t steps = std::min(most, left_);
  if (plan_.live) steps = std::min(steps, lookEvery - sinceLook_);
  simulation.advance(steps);
  left_ -= steps;
  sinceLook_ += steps;
  if (left_ > 0) {
    if (!plan_.live || sinceLook_ < lookEvery) return;
    sinceLook_ = 0;
    if (static_cast<double>(simulation.contacts().touching) > (1 + grown) * static_cast<double>(contacts_) + grownBy) follow(simulation);
    return;
  }
  if (wholeTick_) ++ticks_, whole_ = true;
  const double interval = std::min(plan_.interval, plan_.ledgerInterval), end = static_cast<double>(plan_.steps) * plan_.timeStep;
  ended_ = plan_.live ? !wholeTick_ || static_cast<double>(ticks_) * interval >= end * (1 - 1e-9) : simulation.steps() >= plan_.steps;
}

}  // namespace tsubu::scene
