#pragma once
// Scenes that several tests start from.

#include <string>

namespace tsubu::scene {

/// The shortest useful scene: every table that is required, and nothing else.
inline const std::string shortScene = R"(
[simulation]
end = "1 s"
[materials.glass]
density = "2500 kg/m^3"
[pairs]
normal_stiffness = "1 kN/m"
restitution = 0.5
friction = 0.4
[grains.bed]
source = "packing"
box = { min = [0, 0, 0], max = ["10 cm", "10 cm", "10 cm"] }
count = 10
radius = "2 mm"
)";

/// A scene that uses every alternative of the format.
inline const std::string richScene = R"(
title = "Every \"alternative\" – ö"
[simulation]
end = "2 s"
gravity = ["1 m/s^2", 0, -9.81]
integrator = "symplectic_euler"
time_step = "1e-5 s"
safety = 0.3
seed = 77
skin = "0.1 mm"
ledger = false
on_violation = "warn"
overlap_limit = "20 %"
travel_limit = 0.05
domain = { min = [-10, -10, -10], max = [10, 10, 10], periodic = ["x", "z"] }
[contact]
normal = "linear"
tangential = "spring"
rolling = "elastic_plastic"
tension = true
[materials.glass]
density = "2.5 g/cm^3"
conductivity = "0.8 W/m/K"
heat_capacity = "800 J/kg/K"
magnetisation = "1 kA/m"
colour = "#88ccee"
[materials."stainless steel"]
density = 7850
conductivity = 16
heat_capacity = "0.5 kJ/kg/K"
susceptibility = 1000
[pairs]
normal_stiffness = "1 kN/m"
restitution = 0.5
friction = 0.4
rolling_friction = 0.05
[pairs.glass."stainless steel"]
normal_damping_rate = "3118 1/s"
friction = 0.1
[grains.packed]
source = "packing"
cylinder = { base = [0, 0, 0], top = [0, 0, "5 cm"], radius = "2 cm" }
fill = "20 %"
radius = { min = "1 mm", max = "1.5 mm" }
material = "glass"
velocity = [0, 0, "-1 m/s"]
velocity_spread = "1 cm/s"
spin = ["60 rpm", 0, 0]
temperature = "350 K"
[grains.weighed]
source = "packing"
box = { min = [0.1, 0.1, 0], max = [0.2, 0.2, 0.1] }
mass = "50 g"
radius = { mean = "2 mm", deviation = "0.2 mm", min = "1.5 mm", max = "2.5 mm" }
material = "glass"
[grains.crystal]
source = "lattice"
box = { min = [0.3, 0, 0], max = [0.33, 0.03, 0.03] }
lattice = "fcc"
spacing = "5 mm"
jitter = 0.5
radius = "2 mm"
material = "stainless steel"
[grains.rain]
source = "stream"
box = { min = [0, 0, 0.3], max = [0.1, 0.1, 0.4] }
rate = "0.2 kg/s"
radius = { radii = ["1 mm", "2 mm"], mass_fractions = [0.25, 0.75] }
material = "glass"
start = "0.1 s"
end = "1 s"
count = 100
[grains.drops]
source = "stream"
cylinder = { base = [0, 0, 0.5], top = [0.1, 0, 0.5], radius = 0.02 }
rate = "50 grains/s"
radius = "1 mm"
material = "glass"
[grains.listed]
source = "list"
positions = [[0.5, 0, 0], ["51 cm", 0, 0]]
radius = "1 mm"
material = "glass"
[walls.floor]
plane = { normal = [0, 0, 2] }
material = "glass"
look = "translucent"
opacity = 0.4
temperature = "400 K"
[walls.side]
plane = { point = [-1, 0, 0], normal = [1, 0, 0], size = "1 m" }
material = "stainless steel"
colour = "#123456"
motion = { kind = "oscillate", amplitude = ["1 mm", 0, 0], frequency = "50 Hz", phase = "90 deg" }
[walls.roof]
plane = { point = [0, 0, 3], normal = [0, 0, -1] }
material = "glass"
look = "wire"
[[walls.roof.motion]]
kind = "translate"
velocity = [0, 0, -0.1]
end = "1 s"
[[walls.roof.motion]]
kind = "rotate"
axis = [0, 0, 1]
point = [0, 0, 3]
speed = "-12 rpm"
start = "0.5 s"
[[walls.roof.motion]]
kind = "oscillate"
amplitude = [0, 0, "1 cm"]
frequency = "2 Hz"
[walls.lid]
plane = { point = [0, 0, 2.9], normal = [0, 0, -1] }
material = "glass"
body = { mass = "2 kg", axis = [0, 0, 1], force = "-3 N", weight = false, damping = "5 kg/s", velocity = "-1 cm/s", start = "0.2 s" }
[sinks.below]
box = { min = [-inf, -inf, -inf], max = [inf, inf, -1] }
[counters.gate]
point = [0, 0, 0.1]
radius = "5 cm"
[bonds.mortar]
grains = "crystal"
with_grains = "packed"
with_material = "glass"
distance = 1.2
radius = 0.8
modulus = "20 MPa"
stiffness_ratio = 3
strength = { tension = "1 MPa", compression_ratio = 5, shear = "2 MPa", friction_angle = "20 deg", stretch = 1.1 }
damping = { kind = "percent", share = "5 %", bending = 0.1 }
start = "0.1 s"
end = "0.2 s"
probability = 0.7
contact = "beyond_rest"
[bonds.nail]
material = "glass"
wall = "side"
stiffness = "1e10 N/m^3"
damping = { kind = "exponential", rate = "10 1/s", torsion = 5 }
[bonds.gum]
stiffness = 1e9
damping = { kind = "viscous", ratio = 0.2, shear = 0.3 }
[[fields.gravity]]
kind = "turn"
axis = [0, 1, 0]
speed = "10 deg/s"
angle = "30 deg"
[[fields.gravity]]
kind = "shake"
amplitude = [0, 0, "2 m/s^2"]
frequency = "20 Hz"
phase = "90 deg"
start = "0.5 s"
end = "1.5 s"
[fields.drag]
viscosity = "1 mPa s"
drag_coefficient = 0.44
density = "1000 kg/m^3"
torque = false
flow = { kind = "pipe", axis = [1, 0, 0], point = [0, 0, 0.1], radius = "5 cm", speed = "0.2 m/s" }
[heat]
temperature = "300 K"
[magnets]
cut_off = "6 mm"
[magnets.sources.coil]
kind = "uniform"
field = [0, "10 mT", 0]
[magnets.sources.coils]
kind = "gradient"
axis = [0, 0, 2]
gradient = "0.3 T/m"
[magnets.sources.small]
kind = "dipole"
point = [0, 0, -0.5]
moment = [0, 0, "2 A m^2"]
[magnets.sources.roller]
kind = "roller"
axis = [0, 1, 0]
point = [0, 0, -0.6]
north = [0, 0, 1]
pairs = 3
radius = "1 cm"
field = "80 mT"
wall = "side"
[fields.damping]
force = "1e-5 kg/s"
torque = "1e-12 N m s"
rate = "0.1 1/s"
[diagnostics]
every = 3
regions = { left = { box = { min = [-1, -1, -1], max = [0, 1, 1] } }, right = { box = { min = [0, -1, -1], max = [1, 1, 1] } } }
grid = { box = { min = [-1, -1, 0], max = [1, 1, "50 cm"] }, cells = { x = 4, y = 1, z = 5 } }
[observe]
flow = { kind = "discharge_rate", counter = "gate", from = "0.5 s", to = "1.5 s" }
half = { kind = "time_to_empty", counter = "gate", share = "50 %" }
emptied = { kind = "time_to_empty", box = { min = [-1, -1, 0], max = [1, 1, 1] } }
height = { kind = "centre_of_mass", axis = [0, 1, 1], material = "glass" }
slope = { kind = "angle_of_repose", point = ["1 cm", 0, 0] }
front = { kind = "run_out", direction = [2, 0, 0], share = 1 }
blow = { kind = "peak_force", wall = "floor" }
mixed = { kind = "mixing", material = "glass", cell = "2 cm" }
broken = { kind = "broken_bonds" }
deepest = { kind = "largest_overlap" }
[show]
grains = false
bonds = false
grain_scale = 0.5
bond_scale = 0.7
bond_map = "batlow"
bond_range = [0, 0.5]
broken_for = "1 ms"
forces = "chains"
force_map = "viridis"
force_range = [0, "2 N"]
force_radius = "1 mm"
[output]
fps = "25 fps"
frame_interval = "4 ms"
ledger_interval = "1 ms"
[picture]
width = 640
height = 360
quality = "fine"
background = { top = "#000000", bottom = "#fff" }
[camera]
view = "key_frames"
[[camera.frames]]
time = 0
eye = [1, 1, 1]
target = [0, 0, 0]
[[camera.frames]]
time = "1 s"
eye = [0, 1, 1]
target = [0, 0, 0.1]
up = [0, 1, 0]
field_of_view = "40 deg"
[colours]
by = "speed"
map = "batlow"
range = [0, "2 m/s"]
pattern = "stripes"
[light]
from = [1, 0, 1]
sun = 1.5
shadows = false
[overlay]
title = false
time_decimals = 4
)";

}  // namespace tsubu::scene
