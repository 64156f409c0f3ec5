#include "scene/writer.h"

#include <gtest/gtest.h>

#include "scene/reader.h"
#include "scenes.h"

namespace tsubu::scene {
namespace {

TEST(Writer, WhatIsWrittenReadsAsTheSameScene) {
  for (const std::string& text : {shortScene, richScene}) {
    const Scene scene = readText(text, "folder/scene.toml");
    const std::string written = write(scene);
    const Scene again = readText(written, "folder/scene.toml");
    EXPECT_TRUE(scene == again) << written;
    EXPECT_EQ(written, write(again));
  }
}

// A writer that left something out would pass above if equality left it out as well.
TEST(Writer, AnyValueThatDiffersMakesAnotherSceneAndAnotherText) {
  const Scene scene = readText(richScene, "scene.toml");
  const char* changes[] = {"title=other",
                           "simulation.end=3",
                           "simulation.gravity=[0,0,-1]",
                           "simulation.seed=3",
                           "simulation.skin=auto",
                           "simulation.domain.min=[-9,-9,-9]",
                           "simulation.domain.periodic=[\"y\"]",
                           "contact.tension=false",
                           "contact.rolling=constant",
                           "materials.glass.density=1",
                           "materials.glass.colour=#000000",
                           "pairs.friction=0.3",
                           "pairs.glass.\"stainless steel\".friction=0.2",
                           "grains.packed.fill=0.1",
                           "grains.packed.radius.max=1.4 mm",
                           "grains.packed.spin=[0,0,1]",
                           "grains.weighed.mass=40 g",
                           "grains.weighed.radius.deviation=0.3 mm",
                           "grains.crystal.lattice=hcp",
                           "grains.crystal.jitter=0",
                           "grains.rain.count=9",
                           "grains.rain.rate=0.1 kg/s",
                           "grains.rain.rate=0.2",
                           "grains.rain.radius.mass_fractions=[0.5,0.5]",
                           "grains.drops.cylinder.radius=0.01",
                           "grains.listed.positions=[[0.5,0,0]]",
                           "walls.floor.opacity=0.5",
                           "walls.floor.look=opaque",
                           "walls.side.plane.size=2",
                           "walls.side.motion.phase=0",
                           "walls.roof.motion.1.speed=3",
                           "walls.roof.motion.0.end=inf",
                           "walls.lid.body.mass=3",
                           "walls.lid.body.axis=[0,1,0]",
                           "walls.lid.body.force=0",
                           "walls.lid.body.weight=true",
                           "walls.lid.body.damping=0",
                           "walls.lid.body.velocity=0",
                           "diagnostics.every=2",
                           "diagnostics.regions.left.box.max=[0,1,2]",
                           "diagnostics.grid.box.max=[1,1,1]",
                           "diagnostics.grid.cells.y=2",
                           "walls.lid.body.start=0",
                           "sinks.below.box.max=[1,1,1]",
                           "counters.gate.radius=inf",
                           "bonds.mortar.grains=packed",
                           "bonds.mortar.with_material=",
                           "bonds.mortar.distance=1.3",
                           "bonds.mortar.radius=1",
                           "bonds.mortar.modulus=1e6",
                           "bonds.mortar.strength.tension=2e6",
                           "bonds.mortar.strength.compression_ratio=4",
                           "bonds.mortar.strength.friction_angle=0",
                           "bonds.mortar.strength.stretch=2",
                           "bonds.mortar.damping.share=0.1",
                           "bonds.mortar.damping.bending=0.2",
                           "bonds.mortar.end=1",
                           "bonds.mortar.probability=1",
                           "bonds.mortar.contact=off",
                           "bonds.nail.wall=floor",
                           "bonds.nail.stiffness=1",
                           "bonds.nail.damping.rate=1",
                           "bonds.gum.damping.shear=1",
                           "bonds.gum.stiffness_ratio=1",
                           "show.grains=true",
                           "show.bonds=true",
                           "show.grain_scale=auto",
                           "show.bond_scale=1",
                           "show.bond_map=vik",
                           "show.bond_range=auto",
                           "show.broken_for=0",
                           "show.forces=all",
                           "show.force_map=vik",
                           "show.force_range=auto",
                           "show.force_radius=2 mm",
                           "fields.gravity.0.angle=inf",
                           "fields.gravity.1.phase=0",
                           "fields.gravity.1.end=2",
                           "fields.drag.viscosity=2",
                           "fields.drag.coefficient=1",
                           "fields.drag.buoyancy=false",
                           "fields.drag.flow.radius=1",
                           "fields.damping.rate=0",
                           "heat.temperature=310",
                           "magnets.cut_off=auto",
                           "magnets.sources.coil.field=[0,0,1]",
                           "magnets.sources.coils.gradient=1",
                           "magnets.sources.small.moment=[0,0,1]",
                           "magnets.sources.roller.pairs=2",
                           "magnets.sources.roller.north=[1,0,0]",
                           "magnets.sources.roller.wall=roof",
                           "materials.glass.magnetisation=1",
                           "grains.packed.temperature=360",
                           "walls.floor.temperature=410",
                           "materials.glass.conductivity=1",
                           "materials.glass.heat_capacity=1",
                           "output.fps=24",
                           "output.ledger_interval=auto",
                           "picture.width=320",
                           "picture.quality=draft",
                           "picture.background.top=#111111",
                           "camera.frames.1.eye=[5,5,5]",
                           "colours.map=vik",
                           "colours.uniform=#111111",
                           "colours.range=auto",
                           "light.sun=1",
                           "overlay.time_decimals=1"};
  for (const char* change : changes) {
    SCOPED_TRACE(change);
    const Scene other = readText(richScene, "scene.toml", {change});
    EXPECT_FALSE(scene == other);
    EXPECT_NE(write(scene), write(other));
    EXPECT_TRUE(readText(write(other), "scene.toml") == other);
  }
}

}  // namespace
}  // namespace tsubu::scene
