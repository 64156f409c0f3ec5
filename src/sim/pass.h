#pragma once
// What acts on grains beside their contacts: bonds, drag, magnets, … A scene has a pass for each that it names and pays for no other.
// A pass keeps its own state by the ids of grains or in their order, adds to the force rows, and answers for its energy.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/thread_team.h"
#include "sim/laws/contact.h"
#include "sim/ledger.h"
#include "sim/model.h"
#include "sim/neighbours/pair_lists.h"
#include "sim/neighbours/slab_order.h"
#include "sim/neighbours/slabs.h"
#include "sim/periodic.h"
#include "sim/state.h"

namespace tsubu {
struct Snapshot;
}

namespace tsubu::sim {

struct Counts;
class WallPass;
struct Link;

/// The running simulation as a pass sees it: positions and velocities of the present instant (docs/physics.md, I1, I2).
struct World {
  const Model& model;
  State& state;
  const Slabs& slabs;
  const SlabOrder& order;  ///< of the evaluation under way: for addForces
  PairLists& pairs;
  const Periods& periods;  ///< see `between`
  const WallPass& walls;
  ThreadTeam& team;
  Vec3 gravity;  ///< m/s²
  double skin;   ///< m: two grains approach each other by less between one regroup() and the next
  double time;   ///< s
  StepOf step;
  double way;    ///< s: the step that led here
  double share;  ///< s: the time that an evaluation stands for in accounts of energy: Δt, or less where a step has several
  std::function<double(std::int32_t, std::int32_t)> contactEnergy;  ///< J: in the contact of two grains, by place

  /// x_a − x_b, m: across the boundary of a periodic domain when that is shorter.
  Vec3 between(const GrainRow& a, const GrainRow& b) const { return periods.nearest(positionOf(a) - positionOf(b)); }
};

class ForcePass {
 public:
  virtual ~ForcePass() = default;

  /// For `tsubu explain`.
  virtual std::string name() const = 0;
  /// Grains have come, gone or changed their places, and the lists are new. `newPlace`: old place → new place, −1 for gone (empty at
  /// the start).
  virtual void regroup(const World&, const std::vector<std::int32_t>& /*newPlace*/) {}
  /// Adds to the force rows. The result must not depend on the number of threads: a slab's task writes to the grains of that slab
  /// alone, or slabs are gone over in world.order (`overSlabs`), which keeps apart those that share grains.
  virtual void addForces(const World& world) = 0;
  /// May forces be evaluated several times in a step (I7)? Not where a pass remembers.
  virtual bool evaluatesAnew() const { return false; }
  /// Adds what it stores, what it has dissipated and what work it has done, as of the present instant.
  virtual void account(const World&, Ledger&) const {}
  /// J: what goes when these grains (marked by their places) go, or has come with them.
  virtual double storedIn(const World&, const std::vector<char>& /*grains*/) const { return 0; }
  /// Adds the springs of the present instant between grains, and between grains and walls, by place.
  virtual void addLinks(const World&, std::vector<Link>&) const {}
  /// Counts what it has made and lost.
  virtual void count(Counts&) const {}
  /// Adds what is to be seen of it.
  virtual void show(const World&, Snapshot&) const {}
  /// Fingerprint of its own state, whatever the order of grains in memory.
  virtual std::uint64_t hash(const State&) const { return 0; }
};

/// Do grains turn? Without friction only bonds and lasting magnets ask for it.
bool grainsTurn(const Model& model);
/// Is it kept how far they have turned?
bool keepsOrientation(const Model& model);

/// Throws Error(scene) when grains are held from turning and something of the model is about turning.
void checkRotation(const Model& model);

/// Throws Error(scene) when the integrator cannot do what the model asks for.
void checkIntegrator(const Model& model);

/// Throws Error(scene) when the model asks for continuous collisions (C) with an integrator or a wall that cannot have them.
void checkContinuous(const Model& model);

/// The passes that this model asks for, in the order of the step.
std::vector<std::unique_ptr<ForcePass>> makePasses(const Model& model);

/// Throws Error(scene) when contacts between grains are to be computed in single precision, and these laws or this integrator cannot.
void checkPrecision(Precision precision, const ContactChoice& contact, Integrator integrator);
/// The same for all of the model, radii included.
void checkPrecision(const Model& model);

}  // namespace tsubu::sim
