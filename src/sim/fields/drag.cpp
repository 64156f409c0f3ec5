#include "sim/fields/drag.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"

namespace tsubu::sim {

namespace {

constexpr double pi = std::numbers::pi;

V3 v3(const Vec3& a) { return {a.x(), a.y(), a.z()}; }

void addForce(ForceRow& row, V3 force) { row.fx += force.x, row.fy += force.y, row.fz += force.z; }

/// A torque T as the couple Q of the row: T = −r Q.
void addTorque(ForceRow& row, V3 torque, double inverseRadius) {
  row.qx -= inverseRadius * torque.x, row.qy -= inverseRadius * torque.y, row.qz -= inverseRadius * torque.z;
}

}  // namespace

DampingRates dampingRates(const Fields& fields, double mass, double radius, double slip, bool turns) {
  const double inertia = 0.4 * mass * radius * radius;
  DampingRates fluid, rest;
  if (fields.drag) {
    const Drag& d = *fields.drag;
    // The slope of k w² is 2 k w.
    fluid.linear = (6 * pi * d.viscosity * radius + d.coefficient + d.density * d.dragCoefficient * pi * radius * radius * slip) / mass;
    if (turns && d.torque) fluid.rotary = 8 * pi * d.viscosity * radius * radius * radius / inertia;
  }
  if (fields.damping) {
    rest.linear = fields.damping->force / mass + fields.damping->rate;
    if (turns) rest.rotary = fields.damping->torque / inertia + fields.damping->rate;
  }
  return {fluid.linear + rest.linear, fluid.rotary + rest.rotary, fluid.linear + fluid.rotary > rest.linear + rest.rotary};
}

DragPass::DragPass(const Drag& drag, bool turns, double limit)
    : drag_(drag), flow_(drag.flow), turns_(turns && drag.torque && drag.viscosity > 0), limit_(limit) {}

std::string DragPass::name() const { return drag_.buoyancy && drag_.density > 0 ? "drag and buoyancy" : "drag"; }

void DragPass::addForces(const World& world) {
  const double stokes = 6 * pi * drag_.viscosity, quadratic = 0.5 * drag_.density * drag_.dragCoefficient * pi;
  const double twist = 8 * pi * drag_.viscosity, dt = world.step.dt;
  const V3 lift = (drag_.buoyancy ? -drag_.density * 4.0 / 3.0 * pi : 0.0) * v3(world.gravity);
  const FieldShare sum = sumOverGrains(world, shares_, [&](std::size_t g, FieldShare& share) {
    const GrainRow& row = world.state.rows[g];
    ForceRow& force = world.state.forces[g];
    const double r = row.radius;
    const FlowAt flow = flow_.at(row.position());
    const V3 slip = row.velocity() - flow.velocity;
    const double rushing = quadratic * r * r * norm(slip), coefficient = stokes * r + drag_.coefficient + rushing;
    const V3 drag = -coefficient * slip, buoyancy = (r * r * r) * lift;
    addForce(force, drag + buoyancy);
    share.dissipated += coefficient * norm2(slip);
    share.work += dot(drag, flow.velocity) + dot(buoyancy, row.velocity());
    const double taken = (coefficient + rushing) * row.inverseMass * dt;
    if (!(taken <= share.strongest)) share.strongest = taken, share.where = g;
    if (!turns_) return;
    const V3 spin = row.inverseRadius * row.surfaceSpin() - flow.turning;
    const double turning = twist * r * r * r;
    addTorque(force, -turning * spin, row.inverseRadius);
    share.dissipated += turning * norm2(spin);
    share.work -= turning * dot(spin, flow.turning);
  });
  dissipated_.add(sum.dissipated * world.share);
  work_.add(sum.work * world.share);
  if (sum.strongest > limit_) {
    const GrainRow& row = world.state.rows[sum.where];
    throw Error(ErrorKind::simulation,
                fmt::format("The drag would reverse a grain within one step: grain {} at ({:.6g}, {:.6g}, {:.6g}) m, t = {:.6g} s.",
                            world.state.id[sum.where], row.x, row.y, row.z, world.time),
                "it is too fast against the fluid for this time_step");
  }
}

void DragPass::account(const World& world, Ledger& ledger) const {
  ledger.dissipatedDrag += dissipated_.now(world.step.lead);
  ledger.workFields += work_.now(world.step.lead);
}

void DampingPass::addForces(const World& world) {
  const FieldShare sum = sumOverGrains(world, shares_, [&](std::size_t g, FieldShare& share) {
    const GrainRow& row = world.state.rows[g];
    ForceRow& force = world.state.forces[g];
    const double c = damping_.force + damping_.rate / row.inverseMass;
    addForce(force, -c * row.velocity());
    share.dissipated += c * norm2(row.velocity());
    if (!turns_) return;
    const double d = damping_.torque + damping_.rate * 0.4 * row.radius * row.radius / row.inverseMass;
    const V3 spin = row.inverseRadius * row.surfaceSpin();
    addTorque(force, -d * spin, row.inverseRadius);
    share.dissipated += d * norm2(spin);
  });
  dissipated_.add(sum.dissipated * world.share);
}

void DampingPass::account(const World& world, Ledger& ledger) const { ledger.dissipatedDrag += dissipated_.now(world.step.lead); }

}  // namespace tsubu::sim
