#pragma once
// Contacts of grains with walls: candidates found with the outer lists, geometry evaluated anew in every step, forces by the same
// kernels as between grains.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/thread_team.h"
#include "sim/diagnostics/acting_contact.h"
#include "sim/kernel/kernels.h"
#include "sim/laws/catalogue.h"
#include "sim/model.h"
#include "sim/neighbours/slabs.h"
#include "sim/state.h"
#include "sim/walls/moving_wall.h"

namespace tsubu::sim {

/// A feature of a wall that a grain may touch.
struct WallCandidate {
  std::uint32_t feature = 0;
  bool touching = false;       ///< in the last step
  Vec3 normal = Vec3::Zero();  ///< of that contact, world
  double weight = 1;           ///< share of the law that acted (W3)
};

/// The candidates of one grain on one wall.
struct WallGroup {
  std::int32_t grain = 0;
  std::uint16_t wall = 0;
  std::uint16_t awake = 0;           ///< how many of the candidates the grain may touch before it has gone as far as its room
  std::int32_t first = 0, last = 0;  ///< in `candidates` and `features`; the first ones there of `awake` and `awakeFeatures`

  std::int32_t size() const { return last - first; }
};

/// Where the grain of a group has been, in the frame of the wall.
struct WallWay {
  Vec3 centre = Vec3::Zero();  ///< at the last evaluation
  Vec3 start = Vec3::Zero();   ///< when it was found out which candidates are awake
  double room = 0;             ///< m: how far it may go from there
};

struct SlabWalls {
  std::vector<WallGroup> groups;         ///< by wall, then grain
  std::vector<std::int32_t> firstGroup;  ///< of each wall, and the end
  std::vector<WallWay> ways;             ///< of the groups
  std::vector<WallCandidate> candidates;
  std::vector<std::uint32_t> features;  ///< of the candidates, ascending within a group
  std::vector<std::int32_t> awake;      ///< candidates, and their features, marked as Surface::nearestPoints wants them
  std::vector<std::uint32_t> awakeFeatures;
  std::vector<double> memory;  ///< of the contacts, `stateSize` doubles for each candidate
  std::size_t stateSize = 0;
  double work = 0, lastWork = 0;        ///< J: done by walls that move as they are told so far, and in the last step
  std::vector<WallLoad> loads;          ///< in this step, of the walls that move under load
  std::vector<std::int32_t> tunnelled;  ///< grains whose centre went through a face in the last step

  double* memoryOf(std::int32_t candidate) { return memory.data() + static_cast<std::size_t>(candidate) * stateSize; }
  const double* memoryOf(std::int32_t candidate) const { return memory.data() + static_cast<std::size_t>(candidate) * stateSize; }
  std::span<const std::uint32_t> featuresOf(const WallGroup& group) const {
    return {features.data() + group.first, static_cast<std::size_t>(group.size())};
  }
};

/// Where a wall is at one instant.
struct WallPlace {
  Pose pose;
  Twist twist;
  // Made from these before the slabs are evaluated.
  Mat3 rotation = Mat3::Identity();
  bool turns = false;
  double inverseMass = 0;      ///< 1/kg
  std::optional<Plane> plane;  ///< in the world, when the wall is an unbounded plane

  Vec3 toLocal(const Vec3& world) const { return rotation.transpose() * (world - pose.translation); }
};

class WallPass {
 public:
  WallPass(const std::vector<Wall>& walls, const LawTraits& law);

  /// Places of all walls at time t, before the slabs are evaluated. Returns how far any wall may move against its place in the time dt.
  double moveTo(double t, double dt);
  const std::vector<WallPlace>& places() const { return places_; }
  /// Where a wall is that moves under load.
  void place(std::size_t wall, const Pose& pose, const Twist& twist) {
    places_[wall].pose = pose;
    places_[wall].twist = twist;
  }
  /// What the grains did to the walls that move under load, in the order of these, in the last step.
  std::vector<WallLoad> loads() const;

  /// New candidates for grains in their new order; memory goes along. They hold until a grain has gone as far as its skin or a wall as far
  /// as `wallSkin` (m). `newPlace`: old place → new place, −1 for gone. `dt`: of the step that has just been made (0: none yet), so that a
  /// grain that came from behind a wall is found out.
  void build(const State& state, const Slabs& slabs, double wallSkin, double dt, const std::vector<std::int32_t>& newPlace,
             ThreadTeam& team);

  /// The walls are where they will be in this step: before the slabs are evaluated.
  void settle();
  /// Adds the wall forces on the grains of a slab, and the contacts that touch to `acting`, if there is one.
  void evaluateSlab(int slab, const PassContext& context, WallKernel kernel, bool account, Stage& stage, Accounts& accounts,
                    std::vector<ActingContact>* acting);

  /// Would a sphere at this place touch a wall?
  bool touches(const Vec3& centre, double radius) const;

  std::vector<SlabWalls>& slabs() { return slabs_; }
  const std::vector<SlabWalls>& slabs() const { return slabs_; }

 private:
  struct Batch;
  struct Before;
  struct Few;
  static std::vector<Few> fewByFew(const State& state, std::int32_t begin, std::int32_t end, double wallSkin);
  bool mayMeet(std::size_t wall, const Few& few, double dt) const;
  void buildSlab(const State& state, std::int32_t begin, std::int32_t end, double wallSkin, double dt, const Before& before,
                 SlabWalls& slab) const;
  void addGroup(const State& state, std::int32_t grain, std::size_t wall, const Vec3& start, const std::vector<std::uint32_t>& features,
                const Before& before, SlabWalls& slab) const;
  void findNearMesh(const SlabWalls& slab, std::size_t wall, const PassContext& context, std::vector<std::int32_t>& found) const;
  void evaluatePlane(SlabWalls& slab, std::size_t wall, const PassContext& context, Batch& batch);
  static void note(SlabWalls& slab, std::int32_t candidateIndex, const Vec3& normal, double weight);
  TSUBU_INLINE void put(SlabWalls& slab, const WallPlace& place, const WallGroup& group, std::int32_t candidateIndex, double weight,
                        const Vec3& d, const Vec3& velocity, const PassContext& context, Batch& batch);
  void putEnded(SlabWalls& slab, const WallPlace& place, const WallGroup& group, std::int32_t candidateIndex, const PassContext& context,
                Batch& batch);
  void evaluateGroup(SlabWalls& slab, WallGroup& group, WallWay& way, const PassContext& context, Batch& batch);
  static void wake(const Surface& surface, const Vec3& centre, double radius, double margin, SlabWalls& slab, WallGroup& group,
                   WallWay& way);
  void handOver(const Surface& surface, SlabWalls& slab, const WallGroup& group, const WallContacts& contacts, const Mat3& rotation);
  void flush(SlabWalls& slab, const PassContext& context, Batch& batch);

  const std::vector<Wall>* walls_;
  LawTraits law_;
  std::vector<WallPlace> places_;
  std::vector<int> loadOf_;  // by wall: its place among those that move under load; −1: none of them
  std::size_t loaded_ = 0;
  std::vector<SlabWalls> slabs_;
  std::vector<std::vector<std::int32_t>> near_;  // by slab: groups that must be evaluated
};

}  // namespace tsubu::sim
