#include "sim/state.h"

#include <numbers>

namespace tsubu::sim {

double massOf(double density, double radius) { return density * (4.0 / 3.0 * std::numbers::pi) * radius * radius * radius; }

void State::add(const Grain& grain, double density, const Vec3& gravity, double dt) {
  if (images > 0) setImages(0);
  const Vec3& x = grain.position;
  const Vec3 before = grain.velocity - 0.5 * dt * gravity;
  const bool seesHalfSteps = integrator == Integrator::leapfrog || integrator == Integrator::centralDifferences;
  const Vec3& v = seesHalfSteps ? before : grain.velocity;
  const Vec3 s = turns ? Vec3(grain.radius * grain.angularVelocity) : Vec3(Vec3::Zero());
  rows.push_back(
      {x.x(), x.y(), x.z(), grain.radius, v.x(), v.y(), v.z(), 1 / massOf(density, grain.radius), s.x(), s.y(), s.z(), 1 / grain.radius});
  if (integrator == Integrator::velocityVerlet) half.push_back({before.x(), before.y(), before.z(), 0, s.x(), s.y(), s.z(), 0});
  if (integrator == Integrator::centralDifferences)
    previous.push_back({x.x() - dt * before.x(), x.y() - dt * before.y(), x.z() - dt * before.z(), 0});
  if (keepsOrientation) {
    orientation.push_back(grain.orientation.normalized());
    turned.push_back({});
  }
  if (conducts) {
    temperature.push_back(grain.temperature);
    warming.push_back(0);
  }
  material.push_back(grain.material);
  id.push_back(nextId++);
}

void State::reserve(std::size_t grains) {
  rows.reserve(grains);
  if (integrator == Integrator::velocityVerlet) half.reserve(grains);
  if (keepsOrientation) {
    orientation.reserve(grains);
    turned.reserve(grains);
  }
  material.reserve(grains);
  id.reserve(grains);
}

void State::setImages(std::size_t count) {
  const std::size_t grains = size();
  images = count;
  rows.resize(grains + count);
  forces.resize(grains + count);
  material.resize(grains + count);
  skin.resize(grains + count);
}

namespace {
template <class T>
void reorderOne(std::vector<T>& items, const std::vector<std::int32_t>& order) {
  if (items.empty()) return;
  std::vector<T> next;
  next.reserve(order.size());
  for (const std::int32_t old : order) next.push_back(items[static_cast<std::size_t>(old)]);
  items.swap(next);
}
}  // namespace

void State::reorder(const std::vector<std::int32_t>& order) {
  images = 0;
  forces = std::vector<ForceRow>();
  single = std::vector<SingleRow>();
  singleForces = std::vector<SingleForceRow>();
  reference = std::vector<Vec3>();
  reorderOne(rows, order);
  reorderOne(half, order);
  reorderOne(previous, order);
  reorderOne(orientation, order);
  reorderOne(turned, order);
  reorderOne(material, order);
  reorderOne(temperature, order);
  reorderOne(warming, order);
  reorderOne(id, order);
  reorderOne(sides, order);
  reorderOne(wrap, order);
  reorderOne(skin, order);
}

void State::clearForces() {
  forces.assign(rows.size(), ForceRow{});
  if (mixed) singleForces.assign(rows.size(), SingleForceRow{});
}

namespace {
SingleRow singleOf(const GrainRow& row) {
  const auto narrow = [](double value) { return static_cast<float>(value); };
  return {row.x,          row.y,          row.z,          row.radius,
          narrow(row.vx), narrow(row.vy), narrow(row.vz), narrow(row.inverseMass),
          narrow(row.sx), narrow(row.sy), narrow(row.sz), narrow(row.inverseRadius)};
}
}  // namespace

void State::toSingle(std::size_t g) { single[g] = singleOf(rows[g]); }

void State::allToSingle() {
  if (!mixed) return;
  single.clear();
  single.reserve(rows.size());
  for (const GrainRow& row : rows) single.push_back(singleOf(row));
}

void State::foldSingleForces(std::int32_t first, std::int32_t last) {
  for (auto g = static_cast<std::size_t>(first); g < static_cast<std::size_t>(last); ++g) {
    ForceRow& sum = forces[g];
    SingleForceRow& own = singleForces[g];
    sum.fx += own.fx, sum.fy += own.fy, sum.fz += own.fz;
    sum.qx += own.qx, sum.qy += own.qy, sum.qz += own.qz;
    own = SingleForceRow{};
  }
}

}  // namespace tsubu::sim
