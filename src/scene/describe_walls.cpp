#include "scene/alternatives.h"
#include "scene/describe.h"

namespace tsubu::scene {

namespace {

using namespace dimension;

struct DescribeShape {
  Form& form;

  void operator()(PlaneShape& plane) const {
    form.table({"plane", "An endless plane, solid behind."}, [&](Form& f) {
      f.vector({"point", "A point of the plane."}, plane.point, length);
      f.vector({"normal", "Towards the grains; any length."}, plane.normal, number, VectorRule::notZero);
      f.quantityOrAuto({"size", "Edge of the square that is drawn around the point. \"auto\": as large as the scene."}, plane.size, length,
                       positive);
    });
  }

  void operator()(MeshShape& mesh) const {
    form.text({"mesh", "STL, OBJ, PLY or glTF file; the path starts at the scene."}, mesh.file);
    form.quantity({"scale", "Length of one unit of the file."}, mesh.scale, length, positive);
    form.table({"rotation", "Turns the scaled mesh about the origin."}, [&](Form& f) {
      f.vector({"axis", "Axis, any length; right-handed."}, mesh.rotationAxis, number, VectorRule::notZero);
      f.quantity({"angle", "Angle."}, mesh.rotationAngle, angle);
    });
    form.vector({"position", "Then moves it."}, mesh.position, length);
  }
};

struct DescribeMotion {
  Form& form;

  void operator()(Translate& m) const { form.vector(required("velocity", "Constant velocity."), m.velocity, velocity); }
  void operator()(Rotate& m) const {
    axis(m);
    form.quantity(required("speed", "Angular velocity, right-handed about the axis."), m.speed, angularVelocity);
  }
  void operator()(Oscillate& m) const {
    form.vector(required("amplitude", "Largest displacement, with its direction."), m.amplitude, length);
    oscillation(m);
  }
  void operator()(Rock& m) const {
    axis(m);
    form.quantity(required("amplitude", "Largest angle."), m.amplitude, angle);
    oscillation(m);
  }

 private:
  void axis(auto& m) const {
    form.vector({"axis", "Axis, any length."}, m.axis, number, VectorRule::notZero);
    form.vector({"point", "A point of the axis."}, m.point, length);
  }
  void oscillation(auto& m) const {
    form.quantity(required("frequency", "Oscillations per second."), m.frequency, frequency, positive);
    form.quantity({"phase", "Phase at the start; the motion begins where the wall was put, whatever the phase."}, m.phase, angle);
  }
};

void describeMotion(Form& form, Motion& motion) {
  static constexpr Choice kinds[] = {{"translate", "Constant velocity."},
                                     {"rotate", "Constant angular velocity about an axis."},
                                     {"oscillate", "To and fro along a line, a sine of time."},
                                     {"rock", "To and fro about an axis, a sine of time."}};
  byWord(form, required("kind", "How the wall moves."), motion.kind, kinds, DescribeMotion{form});
  form.quantity({"start", "The wall rests before."}, motion.start, time, notNegative);
  form.quantity({"end", "The wall rests after."}, motion.end, time, notNegativeOrForever);
}

void describeBody(Form& form, sim::WallBody& body) {
  form.quantity(required("mass", "Of the wall."), body.mass, mass, positive);
  form.vector({"axis", "Along which it may move; any length."}, body.axis, number, VectorRule::notZero);
  form.quantity({"force", "From outside, along the axis. With weight = false and a damping: a wall held at a constant force."}, body.force,
                force);
  form.boolean({"weight", "Does gravity act on it?"}, body.weight);
  form.quantity({"damping", "Of the guide, force per velocity."}, body.damping, massRate, notNegative);
  form.quantity({"velocity", "Along the axis when it is let go."}, body.velocity, velocity);
  form.quantity({"start", "When it is let go; it is held before."}, body.start, time, notNegative);
}

void describeWall(Form& form, Wall& wall) {
  static constexpr Choice shapes[] = {{"plane", "An endless plane."}, {"mesh", "Triangles from a file."}};
  static constexpr Choice looks[] = {{"auto", "Planes that carry grains are ground, other planes translucent, meshes opaque."},
                                     {"opaque", "Solid."},
                                     {"translucent", "Grains shine through."},
                                     {"wire", "Only borders and creases."},
                                     {"ground", "A floor without end that fades into the background."},
                                     {"hidden", "Not drawn."}};
  byKey(form, wall.shape, shapes, true, DescribeShape{form});
  form.text({"material", "Name of the material; may be left out when there is only one."}, wall.material);
  form.list({"motion", "A table, or an array of them that are applied one after the other. Absent: the wall stands still."},
            plainEntries(wall.motions, describeMotion));
  bool moves = wall.body.has_value();
  sim::WallBody body = wall.body.value_or(sim::WallBody{});
  form.optionalTable({"body", "The wall moves under load along an axis: a piston, a falling plate. Absent: it moves as `motion` says."},
                     moves, [&](Form& f) { describeBody(f, body); });
  wall.body = moves ? std::optional(body) : std::nullopt;
  form.optionalQuantity({"temperature", "At which the wall is held; needs [heat]. Absent: it is insulated."}, wall.temperature, temperature,
                        positive);
  words(form, {"look", "How it is drawn."}, wall.look, looks);
  form.optionalColour({"colour", "Of the wall, \"#rrggbb\". Absent: that of its material, or grey."}, wall.colour);
  form.optionalQuantity({"opacity", "Of a translucent wall seen face on."}, wall.opacity, number, share);
}

void describeSink(Form& form, Sink& sink) { describeRegion(form, sink.region); }

void describeCounter(Form& form, Counter& counter) {
  form.vector(required("point", "A point of the plane."), counter.point, length);
  form.vector({"normal", "Crossing this way counts +1, the other way −1."}, counter.normal, number, VectorRule::notZero);
  form.quantity({"radius", "Only crossings this near to the point count."}, counter.radius, length, {0, forever, false, true});
}

}  // namespace

void describeWalls(Form& form, Scene& scene) {
  form.table({"walls", "What grains cannot pass."}, [&](Form& f) {
    f.others({"name", "A wall."}, namedEntries(scene.walls, describeWall));
  });
  form.table({"sinks", "Regions that take grains out."}, [&](Form& f) {
    f.others({"name", "A sink."}, namedEntries(scene.sinks, describeSink));
  });
  form.table({"counters", "Planes that count the grains that cross them."}, [&](Form& f) {
    f.others({"name", "A counter."}, namedEntries(scene.counters, describeCounter));
  });
}

}  // namespace tsubu::scene
