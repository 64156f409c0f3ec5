// Grains that go so far in a step that springs cannot stop them (docs/physics.md, C1–C4): their ways are swept against other grains and
// walls, and where they meet the impulse of hard spheres acts. Few grains and rare steps: one thread, in the order of time and ids.

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_map>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/laws/catalogue.h"
#include "sim/laws/damping_from_restitution.h"
#include "sim/simulation_impl.h"

namespace tsubu::sim {

namespace {

constexpr double never = std::numeric_limits<double>::infinity();
// Ways along walls are looked at in pieces of this share of the radius where the wall is near.
constexpr double piece = 0.01;
// More impacts of a grain in a step than this: grains that are wedged in and rattle without end.
constexpr std::size_t mostImpacts = 100;

struct Impact {
  double time = never;        // s, in the step
  std::int32_t partner = -1;  // a grain by place, or −1 − wall
  Vec3 normal = Vec3::UnitZ();
  double arm = 1;  // lever arms over radii: below 1 where they overlap already
  auto before(const Impact& other, std::uint32_t own, std::uint32_t others) const {
    return std::tie(time, own) < std::tie(other.time, others);
  }
};

struct Mover {
  std::int32_t grain;
  Vec3 x, u, s;  // at `since`; velocity of the way, r ω
  double since = 0;
  std::size_t impacts = 0;
  Impact next;
};

}  // namespace

class Simulation::Impl::Sweep {
 public:
  Sweep(Impl& sim, double dt) : sim_(sim), state_(sim.state), dt_(dt), start_(sim.time()) {
    for (std::size_t g = 0; g < state_.size(); ++g) largest_ = std::max(largest_, state_.rows[g].radius);
  }

  /// Returns the largest speed of what has been hit, m/s.
  double run() {
    std::vector<std::int32_t> fast;
    for (std::size_t g = 0; g < state_.size(); ++g) {
      const double way = wayVelocity(static_cast<std::int32_t>(g)).norm() * dt_;
      if (way > sim_.hardShare() * sim_.smallestRadius) fast.push_back(static_cast<std::int32_t>(g));
    }
    std::sort(fast.begin(), fast.end(), [&](std::int32_t a, std::int32_t b) { return idOf(a) < idOf(b); });
    for (const std::int32_t g : fast) enter(g, 0);
    for (std::size_t m = 0; m < movers_.size(); ++m) movers_[m].next = firstImpact(m);
    for (;;) {
      std::size_t first = 0;
      for (std::size_t m = 1; m < movers_.size(); ++m)
        if (movers_[m].next.before(movers_[first].next, idOf(movers_[m].grain), idOf(movers_[first].grain))) first = m;
      if (movers_.empty() || !(movers_[first].next.time <= dt_)) break;
      meet(first);
    }
    double most = 0;
    for (const Mover& mover : movers_) {
      leave(mover);
      most = std::max(most, mover.u.norm());
    }
    return most;
  }

 private:
  GrainRow& row(std::int32_t g) const { return state_.rows[static_cast<std::size_t>(g)]; }
  std::uint32_t idOf(std::int32_t g) const { return state_.id[static_cast<std::size_t>(g)]; }
  bool verlet() const { return state_.integrator == Integrator::velocityVerlet; }
  Vec3 wayVelocity(std::int32_t g) const {
    if (!verlet()) return {row(g).vx, row(g).vy, row(g).vz};
    const HalfStepRow& half = state_.half[static_cast<std::size_t>(g)];
    return {half.vx, half.vy, half.vz};
  }
  Vec3 waySpin(std::int32_t g) const {
    if (!verlet()) return {row(g).sx, row(g).sy, row(g).sz};
    const HalfStepRow& half = state_.half[static_cast<std::size_t>(g)];
    return {half.sx, half.sy, half.sz};
  }
  // Where a grain is at a time of the step, and how it goes on: its way is straight until it is hit.
  std::pair<Vec3, Vec3> wayOf(std::int32_t g, double t) const {
    const auto found = place_.find(g);
    if (found != place_.end()) {
      const Mover& mover = movers_[found->second];
      return {mover.x + (t - mover.since) * mover.u, mover.u};
    }
    const Vec3 u = wayVelocity(g);
    return {Vec3(row(g).x, row(g).y, row(g).z) - (dt_ - t) * u, u};
  }

  std::size_t enter(std::int32_t g, double t) {
    const auto found = place_.find(g);
    if (found != place_.end()) return found->second;
    Mover mover{g, wayOf(g, t).first, wayVelocity(g), waySpin(g), t, 0, {}};
    movers_.push_back(mover);
    noteFar(movers_.size() - 1);
    place_.emplace(g, movers_.size() - 1);
    return movers_.size() - 1;
  }

  // The grid finds who has gone little since the lists were made; the others are tried by everybody.
  void noteFar(std::size_t m) {
    const Mover& mover = movers_[m];
    if (mover.u.norm() * dt_ > sim_.model.watch.travelLimit * row(mover.grain).radius &&
        std::find(far_.begin(), far_.end(), m) == far_.end())
      far_.push_back(m);
  }

  // C1: springs deal with what approaches by less than the share of the radius in a step.
  bool hard(double approach, double radius) const { return approach * dt_ > sim_.hardShare() * radius; }

  Impact firstImpact(std::size_t m) {
    const Mover& mover = movers_[m];
    Impact first;
    if (mover.impacts >= mostImpacts) return first;
    const double t = mover.since, r = row(mover.grain).radius, half = 0.5 * (dt_ - t) * mover.u.norm();
    const Vec3 middle = mover.x + 0.5 * (dt_ - t) * mover.u;
    near_.clear();
    const double around = r + half + sim_.largestSkin + sim_.model.watch.travelLimit * largest_;
    const Vec3 inside = sim_.periods.wrapped(middle);
    sim_.grid.near(inside, around, mover.grain, near_);
    sim_.periods.forImages(inside, sim_.grid.farthest(around),
                           [&](int shift) { sim_.grid.near(inside + sim_.periods.shift(shift), around, mover.grain, near_); });
    for (const std::size_t other : far_)
      if (other != m) near_.push_back(movers_[other].grain);
    for (const std::int32_t j : near_) {
      const Impact impact = impactWith(mover, j, t);
      if (impact.time < first.time || (impact.time == first.time && impact.time < never && idOf(j) < idOf(first.partner))) first = impact;
    }
    for (std::size_t w = 0; w < sim_.model.walls.size(); ++w) {
      const Impact impact = impactOnWall(mover, w, std::min(first.time, dt_));
      if (impact.time < first.time) first = impact;
    }
    return first;
  }

  // |s + w t| = r_i + r_j, the earlier root; across a periodic boundary with the image that is nearest at either end of the way.
  Impact impactWith(const Mover& mover, std::int32_t j, double t) const {
    Impact first;
    const auto [x, u] = wayOf(j, t);
    const Vec3 w = mover.u - u, direct = mover.x - x;
    const double touch = row(mover.grain).radius + row(j).radius, smaller = std::min(row(mover.grain).radius, row(j).radius);
    const Vec3 atEnd = direct + (dt_ - t) * w;
    for (const Vec3& s : {sim_.periods.nearest(direct), Vec3(sim_.periods.nearest(atEnd) - (dt_ - t) * w)}) {
      const double a = w.squaredNorm(), b = s.dot(w), c = s.squaredNorm() - touch * touch;
      if (!(b < 0) || b * b < a * c) continue;
      const double later = c > 0 ? c / (-b + std::sqrt(b * b - a * c)) : 0;
      if (!(t + later <= dt_) || t + later >= first.time) continue;
      const Vec3 apart = s + later * w;
      const double distance = apart.norm();
      if (!(distance > 0) || !hard(-apart.dot(w) / distance, smaller)) continue;
      first = {t + later, j, apart / distance, distance / touch};
    }
    return first;
  }

  // Along the way by what is free, and by pieces where nothing is; then back to where the impact begins.
  Impact impactOnWall(const Mover& mover, std::size_t w, double end) {
    const Wall& wall = sim_.model.walls[w];
    const Surface& surface = *wall.surface;
    const double r = row(mover.grain).radius;
    const bool plane = surface.asPlane().has_value();
    const bool still = wall.motion.still();
    const double speed = mover.u.norm(), t0 = mover.since;
    double wallSpeed = 0;
    if (!still)
      wallSpeed = wall.motion.maxSpeed(plane ? Box(mover.x - Vec3::Constant(r), mover.x + Vec3::Constant(r)) : surface.bounds(),
                                       start_ + t0, start_ + dt_);
    const Pose fixed = wall.motion.at(start_);
    const auto localAt = [&](double t) { return (still ? fixed : wall.motion.at(start_ + t)).toLocal(mover.x + (t - t0) * mover.u); };
    surface.candidates(localAt(0.5 * (t0 + end)), r + (0.5 * speed + wallSpeed) * (end - t0) + piece * r, features_);
    if (features_.empty()) return {};
    // The normal of the fastest hard approach among what the grain touches at a time.
    const auto normalAt = [&](double t, Vec3& normal, double& arm) {
      const Pose pose = still ? fixed : wall.motion.at(start_ + t);
      WallContacts contacts;
      surface.nearestPoints(localAt(t), r, features_, contacts);
      double most = 0;
      for (const WallContact& contact : contacts) {
        const Vec3 n = pose.rotation * contact.normal;
        const double approach =
            -(mover.u - (still ? Vec3(Vec3::Zero()) : wall.motion.velocityAt(pose.toWorld(contact.point), start_ + t))).dot(n);
        if (approach > most && hard(approach, r)) most = approach, normal = n, arm = contact.distance / r;
      }
      return most > 0;
    };
    double t = t0, safe = t0;
    Vec3 normal;
    double arm = 1;
    while (!normalAt(t, normal, arm)) {
      if (t >= end) return {};
      safe = t;
      t = std::min(end, t + std::max(surface.clearance(localAt(t), r, features_), piece * r) / (speed + wallSpeed));
    }
    for (int n = 0; n < 60 && safe < t; ++n) {
      const double middle = 0.5 * (safe + t);
      if (middle <= safe || middle >= t) break;
      (normalAt(middle, normal, arm) ? t : safe) = middle;
    }
    normalAt(t, normal, arm);
    return {t, -1 - static_cast<std::int32_t>(w), normal, arm};
  }

  double restitutionOfPair(std::size_t a, std::size_t b, double inverseMass) const {
    const PropertyValues& pair = sim_.model.pairs.at(a, b);
    if (pair.has(Property::restitution)) return pair[Property::restitution];
    const double stiffness = pair.valueOr(Property::normalStiffness, 0);
    return restitutionOf(0.5 * pair.valueOr(Property::normalDampingRate, 0) / std::sqrt(stiffness * inverseMass),
                         sim_.model.contact.tension);
  }

  // C2, C3.
  void meet(std::size_t first) {
    const Impact impact = movers_[first].next;
    const bool wall = impact.partner < 0;
    const std::size_t second = wall ? first : enter(impact.partner, impact.time);
    for (const std::size_t m : {first, second}) {
      Mover& mover = movers_[m];
      mover.x += (impact.time - mover.since) * mover.u;
      mover.since = impact.time;
      ++mover.impacts;
    }
    Mover &a = movers_[first], &b = movers_[second];
    const GrainRow &rowA = row(a.grain), &rowB = row(b.grain);
    const Vec3& n = impact.normal;
    const std::uint16_t materialA = state_.material[static_cast<std::size_t>(a.grain)];
    Vec3 wallVelocity = Vec3::Zero();
    std::uint16_t materialB = state_.material[static_cast<std::size_t>(b.grain)];
    double inverseMass = rowA.inverseMass + rowB.inverseMass;
    if (wall) {
      const Wall& hit = sim_.model.walls[static_cast<std::size_t>(-1 - impact.partner)];
      materialB = hit.material;
      inverseMass = rowA.inverseMass;
      if (!hit.motion.still()) wallVelocity = hit.motion.velocityAt(a.x - impact.arm * rowA.radius * n, start_ + impact.time);
    }
    const Vec3 relative = a.u - (wall ? wallVelocity : b.u) - impact.arm * (wall ? a.s : Vec3(a.s + b.s)).cross(n);
    const double approach = -relative.dot(n), e = restitutionOfPair(materialA, materialB, inverseMass);
    const Vec3 slip = relative + approach * n;
    const double normalImpulse = (1 + e) * approach / inverseMass, sliding = slip.norm();
    double tangentImpulse = 0;
    const double slipping = (state_.turns ? 1 + 2.5 * impact.arm * impact.arm : 1) * inverseMass;  // 1/m of the slip
    if (sim_.traits.turns && sliding > 0)
      tangentImpulse =
          std::min(sim_.model.pairs.at(materialA, materialB).valueOr(Property::friction, 0) * normalImpulse, sliding / slipping);
    const Vec3 impulse = normalImpulse * n - (sliding > 0 ? Vec3(tangentImpulse / sliding * slip) : Vec3(Vec3::Zero()));
    const Vec3 couple = impact.arm * n.cross(impulse);
    const auto push = [&](Mover& mover, const GrainRow& of, const Vec3& by) {
      mover.u += of.inverseMass * by;
      if (!state_.turns) return;
      const Vec3 spin = (-2.5 * of.inverseMass) * couple;
      mover.s += spin;
      if (!state_.keepsOrientation) return;
      AngleRow& turned = state_.turned[static_cast<std::size_t>(mover.grain)];
      const double angle = (dt_ - impact.time) * of.inverseRadius;
      turned.x += static_cast<float>(angle * spin.x()), turned.y += static_cast<float>(angle * spin.y()),
          turned.z += static_cast<float>(angle * spin.z());
    };
    push(a, rowA, impulse);
    if (!wall) push(b, rowB, -impulse);
    noteFar(first);
    if (!wall) noteFar(second);
    sim_.total[Accounts::normal] += 0.5 * (1 - e * e) * approach * approach / inverseMass;
    sim_.total[Accounts::friction] += tangentImpulse * (sliding - 0.5 * slipping * tangentImpulse);
    sim_.impactWork += impulse.dot(wallVelocity);
    ++sim_.counts.impacts;
    if (a.impacts == mostImpacts) sim_.warnRattle(static_cast<std::size_t>(a.grain));
    // Whoever was about to meet one of the two must look again; and the two may now meet others.
    for (std::size_t m = 0; m < movers_.size(); ++m) {
      const std::int32_t partner = movers_[m].next.partner;
      const bool stale = movers_[m].next.time < never && (partner == movers_[first].grain || (!wall && partner == movers_[second].grain));
      if (m == first || m == second || stale) movers_[m].next = firstImpact(m);
    }
  }

  void leave(const Mover& mover) {
    if (mover.impacts == 0) return;
    const auto g = static_cast<std::size_t>(mover.grain);
    GrainRow& to = state_.rows[g];
    const Vec3 x = mover.x + (dt_ - mover.since) * mover.u, straight(to.x, to.y, to.z), du = mover.u - wayVelocity(mover.grain),
               ds = mover.s - waySpin(mover.grain);
    double& haste2 = sim_.motions[static_cast<std::size_t>(sim_.slabs.of(mover.grain))].haste2;
    haste2 = std::max(haste2, (x - straight + dt_ * wayVelocity(mover.grain)).squaredNorm() / (dt_ * dt_) * state_.perSkin2[g]);
    to.x = x.x(), to.y = x.y(), to.z = x.z();
    to.vx += du.x(), to.vy += du.y(), to.vz += du.z();
    to.sx += ds.x(), to.sy += ds.y(), to.sz += ds.z();
    if (state_.mixed) state_.toSingle(g);
    if (!verlet()) return;
    HalfStepRow& half = state_.half[g];
    half.vx = mover.u.x(), half.vy = mover.u.y(), half.vz = mover.u.z();
    half.sx = mover.s.x(), half.sy = mover.s.y(), half.sz = mover.s.z();
  }

  Impl& sim_;
  State& state_;
  double dt_, start_;
  double largest_ = 0;
  std::vector<Mover> movers_;
  std::unordered_map<std::int32_t, std::size_t> place_;
  std::vector<std::size_t> far_;
  std::vector<std::int32_t> near_;
  std::vector<std::uint32_t> features_;
};

// The speed at which the softest contact of the heaviest grains would be pressed to the watch's limit, in radii per second, and a half of
// that: two grains may approach each other so. A Hertz contact holds 4/15 S δ² where a linear one holds ½ S δ².
void Simulation::Impl::prepareSweep() {
  const std::size_t n = model.materials.size();
  const std::vector<char> meet = pairsThatMeet(model);
  std::vector<double> least(n, std::numeric_limits<double>::infinity()), most(n, 0);
  const auto see = [&](std::uint16_t material, double smallest, double largest) {
    least[material] = std::min(least[material], smallest);
    most[material] = std::max(most[material], largest);
    smallestRadius = std::min(smallestRadius, smallest);
  };
  for (const Grain& grain : model.grains) see(grain.material, grain.radius, grain.radius);
  for (const Stream& stream : model.streams) see(stream.material, stream.radii.smallest(), stream.radii.largest());
  hardRate = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) {
      if (!meet[a * n + b] || most[a] == 0) continue;
      const bool grains = most[b] > 0;
      const auto inverseMass = [&](std::size_t m) { return 1 / massOf(model.materials[m].values[Property::density], most[m]); };
      const double overlap = model.watch.overlapLimit * (grains ? std::min(least[a], least[b]) : least[a]);
      const double radius = grains ? 1 / (1 / least[a] + 1 / least[b]) : least[a];
      // A material of grains may be that of walls as well.
      const double stiffness = lawFunctions(law).modes(constants.of(a * n + b), overlap, radius, inverseMass(a))[0].stiffness;
      hardRate = std::min(hardRate, 0.35 * model.watch.overlapLimit * std::sqrt(stiffness));
    }
}

double Simulation::Impl::hardShare() const { return std::min(model.watch.travelLimit, hardRate * model.timeStep); }

double Simulation::Impl::sweep(double dt) {
  for (std::size_t g = 0; g < state.size(); ++g) {
    const GrainRow& row = state.rows[g];
    if (!std::isfinite(row.x + row.y + row.z + row.vx + row.vy + row.vz)) notANumber(g);
  }
  return Sweep(*this, dt).run();
}

void Simulation::Impl::warnRattle(std::size_t grain) {
  if (std::exchange(warnedRattle_, true)) return;
  complain(fmt::format("A grain meets others {} times in one step: {}.", mostImpacts, describe(grain)), "use a smaller time_step");
}

void checkContinuous(const Model& model) {
  if (!model.continuous) return;
  const Integrator i = model.integrator;
  if (i == Integrator::explicitEuler || i == Integrator::centralDifferences || i == Integrator::rungeKutta)
    throw Error(
        ErrorKind::scene,
        fmt::format("Continuous collisions change the velocity by which a grain goes on in a step; with {} there is no such velocity.",
                    schemeOf(i).name),
        "choose velocity_verlet, symplectic_euler or leapfrog");
  for (const Wall& wall : model.walls)
    if (wall.body)
      throw Error(ErrorKind::scene,
                  fmt::format("Continuous collisions need walls that nothing can push, and wall '{}' moves under load.", wall.name),
                  "leave continuous out, or let the wall move by a given motion");
}

}  // namespace tsubu::sim
