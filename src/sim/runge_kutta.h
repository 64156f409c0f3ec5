#pragma once
// The classical Runge–Kutta method (docs/physics.md, I7): four evaluations of all forces in a step.
//
//   I7   k_i = f(t + c_i Δt, y + c_i Δt k_{i−1}),  c = 0, ½, ½, 1;    y ← y + Δt (k_1 + 2k_2 + 2k_3 + k_4)/6
//
// The state y is positions, velocities, r ω, orientations and what contacts remember. The kernels advance a memory by a step and read
// it as it was (lead 0); what they add, over Δt, is its rate, and every stage starts from the memory of the step's start. A memory in
// the tangent plane also turns with its contact: Ω × m with Ω = n × ṅ + (ω̄·n) n. Neighbour lists stay as they are within a step.

#include <array>
#include <vector>

#include "sim/integrate.h"
#include "sim/neighbours/pair_lists.h"
#include "sim/pair_constants.h"
#include "sim/wall_pass.h"

namespace tsubu::sim {

class RungeKutta {
 public:
  static constexpr int stages = 4;
  static constexpr std::array<double, stages> place{0, 0.5, 0.5, 1};                       ///< c_i
  static constexpr std::array<double, stages> weight{1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};  ///< b_i

  /// `model` and `constants` must outlive it.
  RungeKutta(const Model& model, const LawFunctions& law, const PairConstants& constants)
      : model_(model), law_(law), constants_(constants), stateSize_(law.traits.stateSize), odd_(law.traits.odd) {}

  /// Before the first evaluation of a step: notes what contacts remember.
  void keepMemory(const PairLists& pairs, const WallPass& walls);
  /// After the evaluation at a stage: takes the rates from forces and memories, and clears the forces.
  void collect(int stage, State& state, const Slabs& slabs, const PairLists& pairs, const WallPass& walls, const Vec3& gravity, double dt,
               ThreadTeam& team);
  /// Brings grains and memories to where the next stage is to be evaluated.
  void moveTo(int stage, State& state, const Slabs& slabs, PairLists& pairs, WallPass& walls, double dt, ThreadTeam& team);
  /// Brings them to the end of the step.
  Motion finish(State& state, PairLists& pairs, WallPass& walls, double dt);

  /// Energy in the springs of contacts, J.
  struct Springs {
    double tangential = 0, rolling = 0;
  };
  /// What the accounts of the evaluations say too little about what springs have lost in this step. A kernel takes what its own step does
  /// to a memory; the memory goes on by the weighted mean of four, and where it is cut back that is not the same.
  Springs uncounted() const;

 private:
  /// All that moves of a grain; as a place or as a rate.
  struct Moving {
    V3 x, v, s;
    Quat q = Quat(0, 0, 0, 0);
  };
  struct GrainStages {
    Moving start, rate, sum;
  };
  /// Memory of the contacts of a slab, in the order of their lists.
  struct MemoryStages {
    std::vector<double> start, in, rate, sum;
    Springs uncounted;
  };
  /// How a contact lies and turns.
  struct Frame {
    V3 n, turning;  // ṅ, 1/s
    double spin;    // ω̄·n, rad/s
    bool touching;
  };
  static Frame frameOf(const GrainRow& a, const GrainRow& b);
  static Frame frameOf(const GrainRow& row, const WallCandidate& candidate, const WallPlace& wall);
  void collectMemory(int stage, MemoryStages& memory, std::size_t first, std::size_t stride, const double* out, std::size_t outStride,
                     const Frame& frame, double dt) const;
  void collectPairs(int stage, const State& state, const SlabPairs& slab, MemoryStages& memory, double dt) const;
  void countSprings(double share, const double* memory, std::size_t stride, std::size_t pair, double effectiveRadius, double overlap,
                    Springs& sum) const;
  void countPair(double share, const State& state, const SlabPairs& slab, std::size_t k, const double* memory, Springs& sum) const;
  void countWall(double share, const State& state, const WallGroup& group, const WallCandidate& candidate, const double* memory,
                 Springs& sum) const;
  void collectWalls(int stage, const State& state, const WallPass& walls, std::size_t slabNumber, double dt);
  void noteBeginnings(std::size_t slabNumber);
  void startSlab(const State& state, std::int32_t first, std::int32_t last, std::size_t slab);
  void collectGrain(int stage, State& state, std::size_t k, V3 gravity, double dt);

  const Model& model_;
  const LawFunctions& law_;
  const PairConstants& constants_;
  int stateSize_;
  unsigned odd_;
  std::vector<GrainStages> grains_;
  std::vector<MemoryStages> pairs_, walls_;  // by slab
  std::vector<SlabWalls> wallsBefore_;       // before the first evaluation
  std::vector<SlabWalls> wallsAtStart_;      // after it: which candidates touch at the start of the step
  std::vector<double> wallWork_;             // by slab, J: of this step so far
};

}  // namespace tsubu::sim
