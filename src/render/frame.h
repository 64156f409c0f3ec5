#pragma once
// Everything the passes of one picture read, as plain arrays. Made on the CPU from a snapshot; no OpenGL here.

#include <cstdint>
#include <vector>

#include "core/snapshot.h"
#include "render/grain_colours.h"
#include "render/grain_view.h"
#include "render/style.h"
#include "render/view.h"
#include "render/wall_model.h"

namespace tsubu::render {

/// A wall as the renderer keeps it.
struct Wall {
  WallModel model;
  WallLook look;
  int lookNumber = 0;  ///< walls that look the same share a number
};

/// Arrays in the layout of the shaders that read them (four floats a texel); see src/render/shaders.
struct Frame {
  View view;
  double nearPlane = 1e-3;
  SunView sun;
  Box bounds;

  std::vector<float> grains;        ///< grains.glsl
  std::vector<float> neighbours;    ///< resolve.frag
  std::vector<float> surroundings;  ///< occlusion.vert
  std::vector<float> walls;         ///< wall.vert: opaque triangles
  std::vector<float> sheets;        ///< sheet.vert: translucent triangles and lines, from back to front
  std::vector<float> sunDiscs;      ///< shadow_disc.vert
  std::vector<float> sunWalls;      ///< shadow_wall.vert
  std::size_t grainCount = 0, surroundingCount = 0, wallTriangles = 0, sheetTriangles = 0, sunDiscCount = 0, sunWallTriangles = 0;

  std::optional<Legend> legend;
};

/// Looks are numbered: those of the walls first, then those of what is drawn as bars, where it is shown.
struct FirstLooks {
  int bonds = 0, forces = 0;
};

/// `side`: samples along the side of a pixel; `shadowSize`: texels along the side of the shadow map.
Frame makeFrame(const Snapshot& snapshot, const Style& style, const std::vector<Wall>& walls, const Box& bounds, int side, int shadowSize,
                const FirstLooks& looks = {});

// The parts of makeFrame, each in a file of its own.

/// Fills walls, sheets and sunWalls.
void addWalls(Frame& frame, const std::vector<Wall>& walls, const std::vector<Pose>& poses, const Style& style, int side);

/// Adds the bonds to walls and sunWalls, and their legend when there is no other.
void addBonds(Frame& frame, const std::vector<SeenBond>& bonds, const Style& style, int firstLook, int side);

/// Bonds have looks as walls do: so many from unloaded to breaking, and one for the broken.
std::vector<WallLook> looksOfBonds(const Bonds& style);

/// The same for contact forces, of which there is at least one.
void addForces(Frame& frame, const std::vector<SeenForce>& forces, const Style& style, int firstLook, int side);

/// Fills neighbours and surroundings and writes their places into the records of the grains.
void addOcclusion(Frame& frame, const std::vector<SeenGrain>& seen, const std::vector<std::uint32_t>& drawable, const Snapshot& snapshot,
                  const std::vector<Wall>& walls, bool bars);

/// Where wall number `k` is: at the origin when the snapshot does not say.
Pose poseOf(const std::vector<Pose>& poses, std::size_t k);

/// Appends numbers to an array of floats.
template <class... Numbers>
void append(std::vector<float>& to, Numbers... numbers) {
  (to.push_back(static_cast<float>(numbers)), ...);
}

}  // namespace tsubu::render
