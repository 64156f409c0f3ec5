#include "scene/alternatives.h"
#include "scene/describe.h"

namespace tsubu::scene {

namespace {

using namespace dimension;

struct DescribeObservable {
  Form& form;

  void operator()(DischargeRate& o) const {
    form.text(required("counter", "Name of the counter."), o.counter);
    form.quantity({"from", "Crossings before are left out."}, o.from, time, notNegative);
    form.quantity({"to", "Crossings after are left out."}, o.to, time, notNegativeOrForever);
  }
  void operator()(TimeToEmpty& o) const {
    form.text({"counter", "Name of the counter through which the grains leave."}, o.counter);
    bool present = o.box.has_value();
    sim::BoxRegion box = o.box.value_or(sim::BoxRegion{});
    form.optionalTable({"box", "Instead of a counter: what is to be empty."}, present, [&](Form& f) { describeBox(f, box); });
    o.box = present ? std::optional(box) : std::nullopt;
    form.quantity({"share", "Of all grains: so many must have left."}, o.share, number, {0, 1, false, false});
  }
  void operator()(CentreOfMass& o) const {
    form.vector({"axis", "Along which it is told; any length."}, o.axis, number, VectorRule::notZero);
    form.text({"material", "Of grains of this material alone. Absent: of all."}, o.material);
  }
  void operator()(AngleOfRepose& o) const {
    form.vector({"point", "A point of the axis of the heap, which stands against gravity."}, o.point, length);
  }
  void operator()(RunOut& o) const {
    form.vector(required("direction", "Along which grains run; any length."), o.direction, number, VectorRule::notZero);
    form.quantity({"share", "Of the grains that are behind the front; 1: the furthest grain."}, o.share, number, {0, 1, false, false});
  }
  void operator()(PeakForce& o) const { form.text(required("wall", "Name of the wall."), o.wall); }
  void operator()(MixingIndex& o) const {
    form.text(required("material", "Grains of this material, against all others."), o.material);
    form.quantity(required("cell", "Edge of the cells whose contents are compared: some diameters."), o.cell, length, positive);
  }
  void operator()(auto&) const {}
};

void describeObservable(Form& form, Observable& observable) {
  static constexpr Choice kinds[] = {
      {"discharge_rate", "Grains per second through a counter, a straight line through its count."},
      {"time_to_empty", "When a counter has seen a share of all grains, or a box has lost it."},
      {"centre_of_mass", "Of all grains, along an axis, in the end."},
      {"angle_of_repose", "Slope of the surface of a heap, in the end."},
      {"run_out", "How far the front has come along a direction, in the end."},
      {"peak_force", "Largest force on a wall."},
      {"mixing", "Lacey's index in the end: 0 apart, 1 mixed at random."},
      {"broken_bonds", "How many bonds have broken in the end."},
      {"largest_overlap", "Of any contact, in radii of the smaller grain."},
      {"energy_residual", "What no account of the ledger explains in the end, as a share of the energy turned over."},
      {"kinetic_energy", "Of all grains, in the end."}};
  byWord(form, required("kind", "What is measured; \"largest\" means of the rows of the ledger."), observable.kind, kinds,
         DescribeObservable{form});
}

}  // namespace

void describeObserve(Form& form, Scene& scene) {
  form.table({"observe", "What the scene is about, in a few numbers: in run.json, and what `tsubu tradeoff` measures errors of."},
             [&](Form& f) {
               f.others({"name", "A number to be measured."}, namedEntries(scene.observe, describeObservable));
             });
}

}  // namespace tsubu::scene
