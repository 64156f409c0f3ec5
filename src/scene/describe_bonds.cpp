#include <numbers>

#include "scene/alternatives.h"
#include "scene/describe.h"

namespace tsubu::scene {

namespace {

using namespace dimension;

constexpr Dimension stiffnessPerArea{{-2, 1, -2}};
constexpr Bounds lessThanOne{0, 0.999, true, false};

struct DescribeStiffness {
  Form& form;
  void operator()(StiffnessPerArea& s) const {
    form.quantity(required("stiffness", "k_n: stress per stretch of the bond, \"1e11 N/m^3\"."), s.stiffness, stiffnessPerArea, positive);
  }
  void operator()(YoungsModulus& s) const {
    form.quantity(required("modulus", "Young's modulus E of the glue: k_n is E over the length of the bond."), s.modulus, pressure,
                  positive);
  }
};

void describeByWay(Form& form, const Field& field, ByWay& way, Dimension dimension, const Bounds& bounds) {
  form.quantity(field, way.value, dimension, bounds);
  form.optionalQuantity({"shear", "Of motion across the bond, where it differs."}, way.shear, dimension, bounds);
  form.optionalQuantity({"torsion", "Of twisting, where it differs."}, way.torsion, dimension, bounds);
  form.optionalQuantity({"bending", "Of bending, where it differs."}, way.bending, dimension, bounds);
}

struct DescribeDamper {
  Form& form;
  void operator()(NoDamper&) const {}
  void operator()(PercentDamper& d) const {
    describeByWay(form, required("share", "Of each spring force and moment, against the motion."), d.share, number, lessThanOne);
  }
  void operator()(ExponentialDamper& d) const {
    describeByWay(form, required("rate", "At which the springs forget: they hold 1/e after one over the rate."), d.rate, frequency,
                  notNegative);
  }
  void operator()(ViscousDamper& d) const {
    describeByWay(form, required("ratio", "The dashpot over the critical one of the bond alone."), d.ratio, number, notNegative);
  }
};

void describeStrength(Form& form, BondStrength& s) {
  form.optionalQuantity({"tension", "Tensile stress at which it breaks, bending included. Absent: never."}, s.tension, pressure, positive);
  form.optionalQuantity({"compression_ratio", "Strength in compression over that in tension. Absent: compression never breaks it."},
                        s.compressionRatio, number, positive);
  form.optionalQuantity({"shear", "Shear stress at which it breaks, torsion included. Absent: never."}, s.shear, pressure, positive);
  form.quantity({"friction_angle", "Pressure on the bond times the tangent of this angle adds to the shear strength."}, s.frictionAngle,
                angle, {0, 0.49 * std::numbers::pi, true, false});
  form.optionalQuantity({"stretch", "Length at which it breaks, over that when it was made. Absent: at any."}, s.stretch, number,
                        {1, 1e6, false, false});
}

void describeBond(Form& form, Bonds& bonds) {
  static constexpr Choice stiffnesses[] = {{"stiffness", "Per area."}, {"modulus", "From a modulus."}};
  static constexpr Choice dampers[] = {{"none", "Nothing is lost."},
                                       {"percent", "A share of each force against the motion, at any speed."},
                                       {"exponential", "The springs forget what they hold, the length of the bond included: it creeps."},
                                       {"viscous", "A dashpot beside each spring."}};
  static constexpr Choice contacts[] = {{"off", "Bonded grains do not touch each other."},
                                        {"beyond_rest", "They touch where the bond is shorter than when it was made."}};
  form.text({"grains", "A source of grains: only these are bonded. Absent: all."}, bonds.grains);
  form.text({"material", "Only grains of this material are bonded. Absent: of any."}, bonds.material);
  form.text({"with_grains", "The source of the grains at the other end, where it is another."}, bonds.withGrains);
  form.text({"with_material", "The material of the grains at the other end, where it is another."}, bonds.withMaterial);
  form.text({"wall", "Bonds the grains to the nearest point of this wall instead of to each other; they go with it."}, bonds.wall);
  form.quantity({"distance", "Grains are bonded up to this distance of their centres, over the sum of their radii."}, bonds.distance,
                number, {0.1, 5, true, false});
  form.quantity({"radius", "Of the bond, over the smaller of the grains' radii."}, bonds.radius, number, {0.01, 2, true, false});
  byKey(form, bonds.stiffness, stiffnesses, true, DescribeStiffness{form});
  form.quantity({"stiffness_ratio", "k_n over k_t, stretch against shear."}, bonds.stiffnessRatio, number, {0.1, 1000, true, false});
  form.table({"strength", "When it breaks. What is not written does not break it."}, [&](Form& f) { describeStrength(f, bonds.strength); });
  form.table({"damping", "How its vibrations die."}, [&](Form& f) {
    byWord(f, {"kind", "Of damping."}, bonds.damping, dampers, DescribeDamper{f});
  });
  form.quantity({"start", "When the bonds are made."}, bonds.start, time, notNegative);
  form.optionalQuantity({"end", "Bonds are made all the time until then. Absent: once, at the start."}, bonds.end, time,
                        notNegativeOrForever);
  form.quantity({"probability", "That a pair that could be bonded is; drawn once for each pair."}, bonds.probability, number, share);
  words(form, {"contact", "Between grains that are bonded."}, bonds.contact, contacts);
}

}  // namespace

void describeBonds(Form& form, Scene& scene) {
  form.table({"bonds", "Glue between grains. A pair is bonded once, by the first table that claims it."}, [&](Form& f) {
    f.others({"name", "A kind of bonds."}, namedEntries(scene.bonds, describeBond));
  });
}

}  // namespace tsubu::scene
