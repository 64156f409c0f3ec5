#include <numbers>

#include "scene/alternatives.h"
#include "scene/describe.h"

namespace tsubu::scene {

namespace {

using namespace dimension;

struct DescribeChange {
  Form& form;

  void operator()(sim::GravityTurn& turn) const {
    form.vector({"axis", "Axis, any length; right-handed."}, turn.axis, number, VectorRule::notZero);
    form.quantity(required("speed", "How fast gravity turns."), turn.angularSpeed, angularVelocity);
    form.quantity({"angle", "Through which it turns, and stays. \"inf\": it never stops."}, turn.angle, angle, notNegativeOrForever);
  }
  void operator()(sim::GravityShake& shake) const {
    form.vector(required("amplitude", "Largest acceleration, with its direction."), shake.amplitude, acceleration);
    form.quantity(required("frequency", "Oscillations per second."), shake.frequency, frequency, positive);
    form.quantity({"phase", "Phase of the sine at the start."}, shake.phase, angle);
  }
};

void describeChange(Form& form, sim::GravityChange& change) {
  static constexpr Choice kinds[] = {{"turn", "Gravity turns at a constant rate, as in a box that is tilted."},
                                     {"shake", "A sine of time is added, as in a box that is shaken."}};
  byWord(form, required("kind", "How gravity changes."), change.kind, kinds, DescribeChange{form});
  form.quantity({"start", "When the change begins."}, change.start, time, notNegative);
  form.quantity({"end", "When it ends: a turn stays where it has come to, a shake is over."}, change.end, time, notNegativeOrForever);
}

struct DescribeFlow {
  Form& form;

  void operator()(sim::UniformFlow& flow) const { form.vector({"velocity", "Of the fluid everywhere."}, flow.velocity, velocity); }
  void operator()(sim::ShearFlow& flow) const {
    form.vector({"point", "A point where the fluid is at rest."}, flow.point, length);
    form.vector({"direction", "Along which it flows; any length."}, flow.direction, number, VectorRule::notZero);
    form.vector({"gradient", "Along which the speed grows; any length."}, flow.gradient, number, VectorRule::notZero);
    form.quantity(required("rate", "Growth of the speed per distance."), flow.rate, frequency);
  }
  void operator()(sim::VortexFlow& flow) const {
    axis(flow);
    form.quantity(required("speed", "Angular velocity, right-handed about the axis."), flow.angularSpeed, angularVelocity);
  }
  void operator()(sim::PipeFlow& flow) const {
    axis(flow);
    form.quantity(required("radius", "Of the pipe; the fluid is at rest outside."), flow.radius, length, positive);
    form.quantity(required("speed", "On the axis, along it."), flow.speed, velocity);
  }

 private:
  void axis(auto& flow) const {
    form.vector({"axis", "Axis, any length."}, flow.axis, number, VectorRule::notZero);
    form.vector({"point", "A point of the axis."}, flow.point, length);
  }
};

void describeFlow(Form& form, sim::Flow& flow) {
  static constexpr Choice kinds[] = {{"uniform", "The same everywhere; at rest when no velocity is given."},
                                     {"shear", "Layers slide over each other."},
                                     {"vortex", "Turns like a rigid body."},
                                     {"pipe", "Poiseuille's parabola in a round pipe."}};
  byWord(form, {"kind", "How the fluid flows."}, flow, kinds, DescribeFlow{form});
}

void describeDrag(Form& form, sim::Drag& drag) {
  constexpr Dimension viscosity{{-1, 1, -1}};
  form.quantity({"viscosity", "Of the fluid: Stokes' drag 6πμr, and the torque 8πμr³ against spin."}, drag.viscosity, viscosity,
                notNegative);
  form.quantity({"coefficient", "Linear drag, force per velocity, the same for every grain."}, drag.coefficient, massRate, notNegative);
  form.quantity({"drag_coefficient", "C_d of the quadratic drag ½ρ C_d πr² |v − u|²; 0.44 for a sphere in fast flow."},
                drag.dragCoefficient, number, notNegative);
  form.quantity({"density", "Of the fluid: for the quadratic drag and for buoyancy."}, drag.density, density, notNegative);
  form.boolean({"buoyancy", "Does the fluid carry the weight of what a grain displaces?"}, drag.buoyancy);
  form.boolean({"torque", "Does a viscous fluid slow down and take along the spin of grains (where grains turn at all)?"}, drag.torque);
  form.table({"flow", "How the fluid moves. Absent: it rests."}, [&](Form& f) { describeFlow(f, drag.flow); });
}

void describeDamping(Form& form, sim::GlobalDamping& damping) {
  constexpr Dimension torqueDamping{{2, 1, -1}};
  form.quantity({"force", "C of the force −C v, the same for every grain."}, damping.force, massRate, notNegative);
  form.quantity({"torque", "D of the torque −D ω, the same for every grain."}, damping.torque, torqueDamping, notNegative);
  form.quantity({"rate", "Adds rate·m to C and rate·I to D: every grain slows down alike."}, damping.rate, frequency, notNegative);
}

struct DescribeSource {
  Form& form;

  void operator()(sim::UniformSource& s) const { form.vector(required("field", "Of the source, everywhere."), s.field, magneticField); }
  void operator()(sim::GradientSource& s) const {
    form.vector({"point", "Where the field is nothing."}, s.point, length);
    form.vector({"axis", "Along which it grows; any length."}, s.axis, number, VectorRule::notZero);
    form.quantity(required("gradient", "Growth of the field per distance along the axis."), s.gradient, fieldGradient);
  }
  void operator()(sim::DipoleSource& s) const {
    form.vector(required("point", "Where the magnet is."), s.point, length);
    form.vector(required("moment", "Its strength and direction."), s.moment, magneticMoment);
  }
  void operator()(sim::RollerSource& s) const {
    form.vector({"axis", "Axis, any length."}, s.axis, number, VectorRule::notZero);
    form.vector({"point", "A point of the axis."}, s.point, length);
    form.vector({"north", "From the axis towards a north pole; any length."}, s.north, number, VectorRule::notZero);
    std::uint64_t pairs = static_cast<std::uint64_t>(s.pairs);
    form.integer({"pairs", "Of poles along the circumference."}, pairs, 1, 32);
    s.pairs = static_cast<int>(pairs);
    form.quantity(required("radius", "Where the field has the strength that is given."), s.radius, length, positive);
    form.quantity(required("field", "Strength at that radius."), s.field, magneticField);
  }

 private:
  static constexpr Dimension magneticField{{0, 1, -2, 0, 0, -1}}, fieldGradient{{-1, 1, -2, 0, 0, -1}}, magneticMoment{{2, 0, 0, 0, 0, 1}};
};

void describeSource(Form& form, FieldSource& source) {
  static constexpr Choice kinds[] = {{"uniform", "The same everywhere."},
                                     {"gradient", "Grows along an axis, between two coils that oppose each other."},
                                     {"dipole", "A small magnet."},
                                     {"roller", "A long round magnet with poles along its circumference, seen from outside."}};
  byWord(form, required("kind", "What makes the field."), source.kind, kinds, DescribeSource{form});
  form.text({"wall", "Name of a wall with which the source moves. Absent: it stands still."}, source.wall);
}

void describeMagnets(Form& form, Magnets& magnets) {
  constexpr std::string_view cutOff =
      "Distance of centres from which on two grains do not feel each other; the last fifth of the way is "
      "smooth. \"auto\": four diameters of the largest magnet.";
  form.quantityOrAuto({"cut_off", cutOff}, magnets.cutOff, length, positive);
  form.table({"sources", "Magnets that are not grains."}, [&](Form& f) {
    f.others({"name", "A source."}, namedEntries(magnets.sources, describeSource));
  });
}

// A table that may be absent; what it holds then is gone.
template <class T, class Describe>
void describeOptional(Form& form, const Field& field, std::optional<T>& value, Describe&& describePart) {
  bool present = value.has_value();
  T held = value.value_or(T{});
  form.optionalTable(field, present, [&](Form& f) { describePart(f, held); });
  value = present ? std::optional<T>(held) : std::nullopt;
}

}  // namespace

void describeFields(Form& form, Scene& scene) {
  describeOptional(form, {"magnets", "Grains are magnets, through magnetisation or susceptibility of their materials."}, scene.magnets,
                   describeMagnets);
  describeOptional(
      form, {"heat", "Heat flows between grains that touch. Materials then need conductivity and heat_capacity."}, scene.heat,
      [](Form& f, Heat& heat) {
        f.quantity({"temperature", "Of grains at the start, where their source says nothing."}, heat.temperature, temperature, positive);
      });
  form.table({"fields", "What acts on grains from afar. Each part is computed only when it is written."}, [&](Form& f) {
    f.list({"gravity", "A table, or an array of them that are applied one after the other. Absent: gravity stays as it is."},
           plainEntries(scene.fields.gravity, describeChange));
    describeOptional(f, {"drag", "A fluid between the grains, which flows as it is told and does not feel them."}, scene.fields.drag,
                     describeDrag);
    describeOptional(f, {"damping", "Slows down every motion and spin, whatever the reason."}, scene.fields.damping, describeDamping);
  });
}

}  // namespace tsubu::scene
