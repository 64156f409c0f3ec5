#include "sim/bonds/wall_bonds.h"

#include <numeric>

namespace tsubu::sim {

namespace {
// A bond to a wall ends on a sphere so small that its radius means nothing, but not zero, so that what is kept as r ω has a meaning.
constexpr double tinyRadius = 1e-9;
}  // namespace

void WallBonds::add(std::int32_t grain, const Vec3& place, const BondBody& body, const BondMemory& memory) {
  bonds.add(grain, static_cast<std::int32_t>(bonds.size()), body, memory);
  foot.push_back(place);
}

void WallBonds::take(const WallBonds& from, std::size_t k) {
  bonds.take(from.bonds, k);
  bonds.j.back() = static_cast<std::int32_t>(foot.size());
  foot.push_back(from.foot[k]);
}

void WallBonds::drop(const std::vector<char>& marked) {
  bonds.drop(marked);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < foot.size(); ++k)
    if (!marked[k]) foot[kept++] = foot[k];
  foot.resize(kept);
  std::iota(bonds.j.begin(), bonds.j.end(), 0);
}

void WallBonds::place(const WallMotion& motion, const std::vector<GrainRow>& grains, const Periods& periods, double time, double dt) {
  rows.resize(foot.size());
  half.resize(foot.size());
  forces.assign(foot.size(), ForceRow{});
  const Pose now = motion.at(time), before = motion.at(time - dt);
  const Twist twist = motion.twistAt(time);
  const Vec3 spin = motion.twistAt(time - 0.5 * dt).angularVelocity;
  for (std::size_t k = 0; k < foot.size(); ++k) {
    const GrainRow& grain = grains[static_cast<std::size_t>(bonds.i[k])];
    const double r = tinyRadius * grain.radius;
    const Vec3 home = now.toWorld(foot[k]), v = twist.at(home), u = (home - before.toWorld(foot[k])) / dt;
    Vec3 x = home;
    if (periods.any()) {
      const Vec3 branch = Vec3(grain.x, grain.y, grain.z) - home;
      x -= periods.nearest(branch) - branch;
    }
    const Vec3 s = r * twist.angularVelocity, w = r * spin;
    rows[k] = {x.x(), x.y(), x.z(), r, v.x(), v.y(), v.z(), 0, s.x(), s.y(), s.z(), 1 / r};
    half[k] = {u.x(), u.y(), u.z(), 0, w.x(), w.y(), w.z(), 0};
  }
}

// What the wall does to the grains is the opposite of what the bond does to its foot: force −F, torque −r Q (grain_rows.h).
void WallBonds::addWork(double dt) {
  double power = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const GrainRow& r = rows[k];
    const ForceRow& f = forces[k];
    power += f.qx * r.sx + f.qy * r.sy + f.qz * r.sz - (f.fx * r.vx + f.fy * r.vy + f.fz * r.vz);
  }
  work.add(power * dt);
}

}  // namespace tsubu::sim
