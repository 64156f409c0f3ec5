#pragma once
// What a step may be (docs/physics.md, S1–S5).

#include "sim/laws/contact.h"
#include "sim/walls/moving_wall.h"

namespace tsubu::sim {

/// s: the longest stable step of one mode, ω² and 2ζω (S2). `alongNormal`: its spring knows its length and not only its history.
/// Explicit Euler has none for a mode that is hardly damped: then what is left is a step at which one can look at it.
double stableStep(ContactMode mode, Integrator integrator, bool alongNormal);

/// The stiffest contact along the normal between a wall and any grain of the model, as for a mass of 1 kg: k and η.
ContactMode stiffestContact(const Model& model, std::size_t law, std::size_t wall);

/// s: the longest stable step of a wall that moves under load, all its contacts pressing in one direction.
double stableStep(const MovingWall& wall, ContactMode contact, Integrator integrator);

/// Throws Error(scene) with an integrator whose steps all have one length.
void checkChangingSteps(Integrator integrator);

}  // namespace tsubu::sim
