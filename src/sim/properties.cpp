#include "sim/properties.h"

namespace tsubu::sim {

std::span<const PropertyInfo, propertyCount> propertyTable() {
  constexpr double big = 1e30;
  static constexpr std::array<PropertyInfo, propertyCount> table{{
      {Property::density, Scope::material, "density", "ρ", "kg/m^3", 1e-6, big, "Mass per volume of the grain itself."},
      {Property::youngModulus, Scope::material, "young_modulus", "E", "Pa", 1e-6, big,
       "Young's modulus, for contacts of hertz and mindlin."},
      {Property::poissonRatio, Scope::material, "poisson_ratio", "ν", "", -0.999, 0.5,
       "Poisson's ratio, for contacts of hertz and mindlin."},
      {Property::normalStiffness, Scope::pair, "normal_stiffness", "k_n", "N/m", 1e-12, big, "Spring constant along the line of centres."},
      {Property::tangentialStiffness, Scope::pair, "tangential_stiffness", "k_t", "N/m", 0, big,
       "Spring constant of the sticking contact; 2/7 of the normal one when absent."},
      {Property::restitution, Scope::pair, "restitution", "e", "", 1e-6, 1, "Speed after over speed before a head-on collision."},
      {Property::normalDampingRate, Scope::pair, "normal_damping_rate", "γ_n", "1/s", 0, big,
       "Normal dashpot per effective mass, η_n = m* γ_n: an alternative to restitution."},
      {Property::tangentialDampingRate, Scope::pair, "tangential_damping_rate", "γ_t", "1/s", 0, big,
       "Tangential dashpot per effective mass, η_t = m* γ_t; when absent the damping ratio of the normal contact is used."},
      {Property::tangentialDampingFactor, Scope::pair, "tangential_damping_factor", "f", "", 0, 1e6,
       "η_t over η_n √(k_t/k_n); √(2/7) when absent: the damping ratio of the normal contact."},
      {Property::friction, Scope::pair, "friction", "μ", "", 0, 1e9,
       "Coulomb coefficient: the tangential force is at most μ times the normal one."},
      {Property::rollingFriction, Scope::pair, "rolling_friction", "μ_r", "", 0, 1e9,
       "Rolling resistance: the torque is at most μ_r R* times the normal force."},
      {Property::rollingDamping, Scope::pair, "rolling_damping", "ζ_r", "", 0, 1e3,
       "Damping ratio of the rolling spring; 0.3 when absent."},
      {Property::rollingViscosity, Scope::pair, "rolling_viscosity", "μ_v", "s/m", 0, big,
       "Viscous rolling: the lever of the normal force is R* times this times the rolling speed."},
      {Property::twistingFriction, Scope::pair, "twisting_friction", "μ_w", "", 0, 1e9,
       "Twisting resistance: the torque about the normal is at most μ_w R* times the normal force."},
      {Property::conductivity, Scope::material, "conductivity", "k", "W/(m K)", 1e-12, big, "Of heat, in the grain or wall itself."},
      {Property::heatCapacity, Scope::material, "heat_capacity", "c", "J/(kg K)", 1e-12, big, "Heat per mass and kelvin."},
      {Property::magnetisation, Scope::material, "magnetisation", "M", "A/m", -big, big,
       "Of a lasting magnet: moment per volume, along the z axis of the grain, with which it turns."},
      {Property::susceptibility, Scope::material, "susceptibility", "χ", "", -1, big,
       "Of a grain that is magnetised by the sources of [magnets]; 1000 and more for iron."},
  }};
  return table;
}

}  // namespace tsubu::sim
