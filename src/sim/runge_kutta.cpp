#include "sim/runge_kutta.h"

#include <algorithm>
#include <cmath>

namespace tsubu::sim {

namespace {

V3 v3(const Vec3& a) { return {a.x(), a.y(), a.z()}; }

void setRow(GrainRow& row, V3 x, V3 v, V3 s) {
  row.x = x.x, row.y = x.y, row.z = x.z;
  row.vx = v.x, row.vy = v.y, row.vz = v.z;
  row.sx = s.x, row.sy = s.y, row.sz = s.z;
}

}  // namespace

void RungeKutta::keepMemory(const PairLists& pairs, const WallPass& walls) {
  pairs_.resize(pairs.slabs().size());
  for (std::size_t s = 0; s < pairs_.size(); ++s) {
    const auto& memory = pairs.slabs()[s].memory.wide();
    pairs_[s].start.assign(memory.begin(), memory.end());
  }
  wallsBefore_ = walls.slabs();
}

// A contact that touches no more has let its memory go; one that has begun may have taken over that of its neighbour on the wall, and
// then starts with what the evaluation left.
void RungeKutta::noteBeginnings(std::size_t slabNumber) {
  const SlabWalls &slab = wallsAtStart_[slabNumber], &before = wallsBefore_[slabNumber];
  std::vector<double>& start = walls_[slabNumber].start;
  const auto size = static_cast<std::size_t>(stateSize_);
  for (const WallGroup& group : slab.groups) {
    const auto touched = [&](std::int32_t c) { return before.candidates[static_cast<std::size_t>(c)].touching; };
    bool any = false;
    for (std::int32_t c = group.first; c < group.last; ++c) any = any || touched(c);
    for (std::int32_t c = group.first; c < group.last; ++c) {
      const auto k = static_cast<std::size_t>(c);
      const WallCandidate& candidate = slab.candidates[k];
      const double* const source = (any && candidate.touching && !touched(c) ? slab : before).memoryOf(c);
      for (std::size_t m = 0; m < size; ++m) start[k * size + m] = candidate.touching ? source[m] : 0.0;
    }
  }
}

RungeKutta::Frame RungeKutta::frameOf(const GrainRow& a, const GrainRow& b) {
  const V3 d = a.position() - b.position(), dv = a.velocity() - b.velocity();
  const double distance = norm(d), safe = larger(distance, tiny);
  const V3 n = (1 / safe) * d, spin = (1 / (a.radius + b.radius)) * (a.surfaceSpin() + b.surfaceSpin());
  return {n, (1 / safe) * (dv - dot(dv, n) * n), dot(spin, n), distance < a.radius + b.radius};
}

// The normal of a face turns with the wall. That of an edge or corner also turns while the grain goes round it; what that does to a
// memory is left to the kernel, as in the other schemes (T3).
RungeKutta::Frame RungeKutta::frameOf(const GrainRow& row, const WallCandidate& candidate, const WallPlace& wall) {
  const V3 n = v3(candidate.normal), turning = v3(wall.twist.angularVelocity);
  const V3 spin = 0.5 * (row.inverseRadius * row.surfaceSpin() + turning);
  return {n, cross(turning, n), dot(spin, n), candidate.touching};
}

// Component c of the contact is at first + c × stride in the stages and at c × outStride in what the kernel has left.
void RungeKutta::collectMemory(int stage, MemoryStages& memory, std::size_t first, std::size_t stride, const double* out,
                               std::size_t outStride, const Frame& frame, double dt) const {
  const double b = weight[static_cast<std::size_t>(stage)], perSecond = 1 / dt;
  const auto note = [&](int c, double rate) {
    const std::size_t at = first + static_cast<std::size_t>(c) * stride;
    memory.rate[at] = frame.touching ? rate : 0.0;
    memory.sum[at] += b * memory.rate[at];
  };
  for (int c = 0; c < stateSize_;) {
    const auto in = [&](int k) { return memory.in[first + static_cast<std::size_t>(k) * stride]; };
    const auto left = [&](int k) { return out[static_cast<std::size_t>(k) * outStride]; };
    if ((odd_ >> c & 1U) == 0) {
      note(c, perSecond * (left(c) - in(c)));
      c += 1;
      continue;
    }
    // The kernel has laid the vector into the tangent plane first: that is no gain.
    const V3 laid = carried({in(c), in(c + 1), in(c + 2)}, frame.n, 0);
    const V3 gain = perSecond * (V3{left(c), left(c + 1), left(c + 2)} - laid);
    const V3 rate = gain - dot(frame.turning, laid) * frame.n + frame.spin * cross(frame.n, laid);
    note(c, rate.x), note(c + 1, rate.y), note(c + 2, rate.z);
    c += 3;
  }
}

void RungeKutta::countSprings(double share, const double* memory, std::size_t stride, std::size_t pair, double effectiveRadius,
                              double overlap, Springs& sum) const {
  double all[mostMemory] = {}, tangential[mostMemory] = {};
  bool any = false;
  for (int c = 0; c < stateSize_; ++c) {
    all[c] = memory[static_cast<std::size_t>(c) * stride];
    if (c < law_.traits.tangentialSize) tangential[c] = all[c];
    any = any || all[c] != 0;
  }
  if (!any || !model_.ledger) return;
  Contact contact{};
  contact.n = {0, 0, 1};
  contact.overlap = larger(overlap, 0);
  contact.effectiveMass = contact.rootMass = contact.inverseEffectiveMass = contact.inverseSpinInertia = 1;
  contact.effectiveRadius = effectiveRadius;
  const StepOf step{model_.timeStep, 0};
  const double own = law_.stored(constants_.of(pair), contact, step, tangential),
               both = law_.stored(constants_.of(pair), contact, step, all);
  sum.tangential += share * own;
  sum.rolling += share * (both - own);
}

void RungeKutta::countPair(double share, const State& state, const SlabPairs& slab, std::size_t k, const double* memory,
                           Springs& sum) const {
  const auto i = static_cast<std::size_t>(slab.i[k]), j = static_cast<std::size_t>(slab.j[k]);
  const GrainRow &a = state.rows[i], &b = state.rows[j];
  countSprings(share, memory, slab.memory.stride(), state.material[i] * model_.materials.size() + state.material[j],
               1 / (a.inverseRadius + b.inverseRadius), a.radius + b.radius - norm(a.position() - b.position()), sum);
}

void RungeKutta::countWall(double share, const State& state, const WallGroup& group, const WallCandidate& candidate, const double* memory,
                           Springs& sum) const {
  const auto g = static_cast<std::size_t>(group.grain);
  const std::size_t pair = state.material[g] * model_.materials.size() + model_.walls[group.wall].material;
  countSprings(share * candidate.weight, memory, 1, pair, state.rows[g].radius, 0, sum);
}

void RungeKutta::collectPairs(int stage, const State& state, const SlabPairs& slab, MemoryStages& memory, double dt) const {
  for (std::size_t k = 0; k < slab.i.size(); ++k) {
    const Frame frame = frameOf(state.rows[static_cast<std::size_t>(slab.i[k])], state.rows[static_cast<std::size_t>(slab.j[k])]);
    const double b = weight[static_cast<std::size_t>(stage)];
    countPair(stage == 0 ? 1 - b : -b, state, slab, k, memory.in.data() + k, memory.uncounted);
    countPair(b, state, slab, k, slab.memory.columns<double>() + k, memory.uncounted);
    if (stage == 0 && !frame.touching)
      for (std::size_t at = k; at < memory.start.size(); at += slab.memory.stride()) memory.start[at] = memory.in[at] = 0;
    collectMemory(stage, memory, k, slab.memory.stride(), slab.memory.columns<double>() + k, slab.memory.stride(), frame, dt);
  }
}

void RungeKutta::collectWalls(int stage, const State& state, const WallPass& walls, std::size_t slabNumber, double dt) {
  const SlabWalls &slab = walls.slabs()[slabNumber], &start = wallsAtStart_[slabNumber];
  MemoryStages& memory = walls_[slabNumber];
  for (const WallGroup& group : slab.groups) {
    for (std::int32_t c = group.first; c < group.last; ++c) {
      const auto k = static_cast<std::size_t>(c);
      Frame frame = frameOf(state.rows[static_cast<std::size_t>(group.grain)], slab.candidates[k], walls.places()[group.wall]);
      const double b = weight[static_cast<std::size_t>(stage)];
      const double* const in =
          stage == 0 ? wallsBefore_[slabNumber].memoryOf(c) : memory.in.data() + k * static_cast<std::size_t>(stateSize_);
      countWall(stage == 0 ? 1 - b : -b, state, group, slab.candidates[k], in, memory.uncounted);
      countWall(b, state, group, slab.candidates[k], slab.memoryOf(c), memory.uncounted);
      frame.touching = frame.touching && start.candidates[k].touching;  // one that begins within the step waits for the next
      collectMemory(stage, memory, k * static_cast<std::size_t>(stateSize_), 1, slab.memoryOf(c), 1, frame, dt);
    }
  }
}

// What a slab starts the step with.
void RungeKutta::startSlab(const State& state, std::int32_t first, std::int32_t last, std::size_t slab) {
  MemoryStages &pairs = pairs_[slab], &walls = walls_[slab];
  pairs.uncounted = walls.uncounted = {};
  pairs.in = pairs.start;
  pairs.rate.resize(pairs.start.size());
  pairs.sum.assign(pairs.start.size(), 0.0);
  walls.start.resize(wallsAtStart_[slab].candidates.size() * static_cast<std::size_t>(stateSize_));
  noteBeginnings(slab);
  walls.in = walls.start;
  walls.rate.resize(walls.start.size());
  walls.sum.assign(walls.start.size(), 0.0);
  for (std::int32_t g = first; g < last; ++g) {
    const auto k = static_cast<std::size_t>(g);
    const GrainRow& row = state.rows[k];
    grains_[k] = GrainStages{};
    grains_[k].start = {row.position(), row.velocity(), row.surfaceSpin(),
                        state.keepsOrientation ? state.orientation[k] : Quat::Identity()};
  }
}

void RungeKutta::collectGrain(int stage, State& state, std::size_t k, V3 gravity, double dt) {
  const double b = weight[static_cast<std::size_t>(stage)];
  const GrainRow& row = state.rows[k];
  const Acceleration a = accelerationOf(row, state.forces[k], gravity);
  state.forces[k] = ForceRow{};
  Moving &rate = grains_[k].rate, &sum = grains_[k].sum;
  if (state.keepsOrientation) {
    // q̇ = ½ ω q, at the orientation of this stage: where the last rate has led.
    const Quat q(grains_[k].start.q.coeffs() + place[static_cast<std::size_t>(stage)] * dt * rate.q.coeffs());
    const V3 w = row.inverseRadius * row.surfaceSpin();
    rate.q.coeffs() = 0.5 * (Quat(0, w.x, w.y, w.z) * q).coeffs();
    sum.q.coeffs() += b * rate.q.coeffs();
  }
  rate.x = row.velocity(), rate.v = a.linear, rate.s = state.turns ? a.surface : V3{0, 0, 0};
  sum.x = sum.x + b * rate.x, sum.v = sum.v + b * rate.v, sum.s = sum.s + b * rate.s;
}

void RungeKutta::collect(int stage, State& state, const Slabs& slabs, const PairLists& pairs, const WallPass& walls, const Vec3& gravity,
                         double dt, ThreadTeam& team) {
  const auto count = static_cast<std::size_t>(slabs.count());
  if (stage == 0) {
    grains_.resize(state.size());
    walls_.resize(count);
    wallsAtStart_ = walls.slabs();
    wallWork_.assign(count, 0.0);
  }
  team.run(slabs.count(), [&](int slab, int) {
    const auto s = static_cast<std::size_t>(slab);
    if (stage == 0) startSlab(state, slabs.begin(slab), slabs.end(slab), s);
    if (stateSize_ > 0) {
      collectPairs(stage, state, pairs.slabs()[s], pairs_[s], dt);
      collectWalls(stage, state, walls, s, dt);
    }
    wallWork_[s] += weight[static_cast<std::size_t>(stage)] * walls.slabs()[s].lastWork;
    for (std::int32_t g = slabs.begin(slab); g < slabs.end(slab); ++g)
      collectGrain(stage, state, static_cast<std::size_t>(g), v3(gravity), dt);
  });
}

void RungeKutta::moveTo(int stage, State& state, const Slabs& slabs, PairLists& pairs, WallPass& walls, double dt, ThreadTeam& team) {
  const double c = place[static_cast<std::size_t>(stage)] * dt;
  walls.slabs() = wallsAtStart_;
  team.run(slabs.count(), [&](int slab, int) {
    const auto s = static_cast<std::size_t>(slab);
    for (std::int32_t g = slabs.begin(slab); g < slabs.end(slab); ++g) {
      const GrainStages& grain = grains_[static_cast<std::size_t>(g)];
      setRow(state.rows[static_cast<std::size_t>(g)], grain.start.x + c * grain.rate.x, grain.start.v + c * grain.rate.v,
             grain.start.s + c * grain.rate.s);
    }
    for (MemoryStages* memory : {&pairs_[s], &walls_[s]})
      for (std::size_t k = 0; k < memory->in.size(); ++k) memory->in[k] = memory->start[k] + c * memory->rate[k];
    pairs.slabs()[s].memory.wide().assign(pairs_[s].in.begin(), pairs_[s].in.end());
    walls.slabs()[s].memory = walls_[s].in;
  });
}

Motion RungeKutta::finish(State& state, PairLists& pairs, WallPass& walls, double dt) {
  Motion motion;
  for (std::size_t k = 0; k < grains_.size(); ++k) {
    const GrainStages& grain = grains_[k];
    GrainRow& row = state.rows[k];
    setRow(row, grain.start.x + dt * grain.sum.x, grain.start.v + dt * grain.sum.v, grain.start.s + dt * grain.sum.s);
    if (state.keepsOrientation) state.orientation[k] = Quat(grain.start.q.coeffs() + dt * grain.sum.q.coeffs()).normalized();
    motion.add(norm2(grain.sum.x), dt * row.inverseRadius, state.perSkin2[k]);
  }
  walls.slabs() = wallsAtStart_;
  for (std::size_t s = 0; s < pairs_.size(); ++s) {
    const auto advance = [&](const MemoryStages& memory, std::size_t k) { return memory.start[k] + dt * memory.sum[k]; };
    SlabPairs& listed = pairs.slabs()[s];
    for (std::size_t k = 0; k < listed.memory.wide().size(); ++k) listed.memory.wide()[k] = advance(pairs_[s], k);
    for (std::size_t k = 0; k < listed.i.size() && stateSize_ > 0; ++k)
      countPair(-1, state, listed, k, listed.memory.columns<double>() + k, pairs_[s].uncounted);
    SlabWalls& slab = walls.slabs()[s];
    std::size_t k = 0;
    for (const WallGroup& group : slab.groups) {
      for (std::int32_t c = group.first; c < group.last; ++c) {
        for (int m = 0; m < stateSize_; ++m) slab.memoryOf(c)[m] = advance(walls_[s], k++);
        countWall(-1, state, group, slab.candidates[static_cast<std::size_t>(c)], slab.memoryOf(c), walls_[s].uncounted);
      }
    }
    slab.work += wallWork_[s] - slab.lastWork;
    slab.lastWork = 0;
  }
  return motion;
}

RungeKutta::Springs RungeKutta::uncounted() const {
  Springs sum;
  for (std::size_t s = 0; s < pairs_.size(); ++s) {
    sum.tangential += pairs_[s].uncounted.tangential + walls_[s].uncounted.tangential;
    sum.rolling += pairs_[s].uncounted.rolling + walls_[s].uncounted.rolling;
  }
  return sum;
}

}  // namespace tsubu::sim
