#pragma once
// A running simulation: the only class of `sim` that others hold.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/snapshot.h"
#include "sim/diagnostics/instant.h"
#include "sim/ledger.h"
#include "sim/model.h"
#include "sim/network.h"
#include "sim/profile.h"

namespace tsubu::sim {

struct Counts {
  std::uint64_t inserted = 0;
  std::uint64_t removed = 0;
  std::uint64_t lost = 0;
  std::vector<std::int64_t> crossed;  ///< per counter
  std::uint64_t bonds = 0;            ///< that hold
  std::uint64_t broken = 0;           ///< that have broken so far
  std::uint64_t impacts = 0;          ///< hard ones, of continuous collisions
};

struct LostGrain {
  std::uint32_t id;
  Vec3 position;
  double time;
  std::string why;
};

/// What the contacts look like at the present instant.
struct ContactSummary {
  std::uint64_t touching = 0;
  double deepestOverlap = 0;  ///< largest overlap over the smaller radius
};

/// A wall that moves under load, at the present instant.
struct WallState {
  std::string wall;
  double way, speed;  ///< along its axis, m and m/s
  double load;        ///< N: of the grains, along its axis
};

/// What is modelled and what it costs; printed by `tsubu explain`.
struct Plan {
  std::vector<std::string> passes;  ///< in the order of the step
  std::vector<std::string> modelled;
  std::vector<std::string> notModelled;
  std::size_t bytesPerGrain = 0;
  std::size_t bytesPerContact = 0;     ///< memory that the laws keep for a contact
  std::size_t bytesPerListedPair = 0;  ///< neighbour lists
};

class Simulation {
 public:
  /// Takes a complete model. `threads` ≥ 1; the results do not depend on it. Throws Error(scene) when laws and properties do not fit.
  Simulation(Model model, int threads);
  /// From now on uses as many of the threads as make the steps fast (core/thread_choice.h): few for few grains.
  void chooseThreads();
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Takes `steps` steps. Throws Error(simulation) with grain, place, time and likely cause when the watch says stop, which
  /// may be in the middle of a step: it is over then, neither to be advanced nor to be looked at.
  void advance(std::uint64_t steps);

  double time() const;
  double timeStep() const;
  /// Steps have this length (s) from the second one on that is taken after this; the next one still has the old length, its forces being
  /// known. Throws Error(scene) where the integrator has steps of one length only.
  void setTimeStep(double dt);
  std::uint64_t steps() const;
  std::size_t grains() const;
  const Counts& counts() const;
  const std::vector<LostGrain>& lostGrains() const;
  const std::vector<std::string>& warnings() const;  ///< one sentence each, in the order they came up
  std::uint64_t grainSteps() const;                  ///< sum over steps of the number of grains
  double threadsUsed() const;                        ///< mean over the steps

  /// All of these evaluate the state at time(), forces included.
  Ledger ledger();
  ContactSummary contacts();
  std::vector<WallState> movingWalls();
  void fill(Snapshot& snapshot);
  /// Grains and the forces of their contacts. Throws Error(simulation) unless the model has `contactForces`.
  Instant instant();
  /// Contacts and bonds of the present instant as springs and dashpots, and the longest step that they bear (S8); need `contactForces`.
  ContactNetwork network();
  StepLimit stableStep();
  /// Hash over the grains in the order of their ids (position, velocity, orientation where it is kept) and the contact memory; equal for
  /// equal bits.
  std::uint64_t stateHash();

  /// From here on, where the time of the steps goes. The results do not depend on it.
  void startProfile();
  /// s of all threads together, since `startProfile`; Runge–Kutta's own work is in none of the parts.
  Profile::Seconds profile() const;

  /// Without running: what this model will do.
  static Plan plan(const Model& model);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tsubu::sim
