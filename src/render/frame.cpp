#include "render/frame.h"

#include <algorithm>
#include <cmath>

#include "render/colour_map.h"

namespace tsubu::render {

namespace {

/// A grain's record without its neighbours: see grains.glsl.
void addGrain(Frame& frame, const SeenGrain& grain, Colour colour, Pattern pattern, const Quat& orientation) {
  const Vec3 light = toLinear(colour);
  // Directions of the eye into directions of the grain; the grain's own orientation leads from the grain to the world.
  const Quat turn = orientation.conjugate() * Quat(Mat3(frame.view.rotation.transpose()));
  append(frame.grains, grain.centre.x(), grain.centre.y(), grain.centre.z(), grain.radius);
  append(frame.grains, light.x(), light.y(), light.z(), static_cast<int>(pattern));
  append(frame.grains, turn.x(), turn.y(), turn.z(), turn.w());
  append(frame.grains, 0, 0, 0, 0);
  append(frame.grains, grain.box[0], grain.box[1], grain.box[2], grain.box[3]);
}

void addGrains(Frame& frame, const std::vector<SeenGrain>& seen, const Snapshot& snapshot, const Style& style) {
  const GrainColours colours = grainColours(style.grains, snapshot);
  frame.legend = colours.legend;
  const bool turns = snapshot.orientation.size() == snapshot.grains() && style.grains.pattern != Pattern::none;
  frame.grainCount = seen.size();
  frame.grains.reserve(seen.size() * 20);
  for (const SeenGrain& grain : seen) {
    const Quat orientation = turns ? snapshot.orientation[grain.index].normalized() : Quat::Identity();
    addGrain(frame, grain, colours.colours[grain.index], turns ? style.grains.pattern : Pattern::none, orientation);
  }
}

Box boundsOf(const Snapshot& snapshot, const std::vector<std::uint32_t>& drawable) {
  Box box;
  for (const std::uint32_t k : drawable) {
    box.extend(Vec3(snapshot.position[k] - Vec3::Constant(snapshot.radius[k])));
    box.extend(Vec3(snapshot.position[k] + Vec3::Constant(snapshot.radius[k])));
  }
  return box;
}

// What shadows are drawn for: the bounds of the scene and what has left them. In steps, since texels that grew with every frame would make
// shadows shimmer; no farther than the scene is wide, since the map would be too coarse for all the others; and not for what leaves them by
// little, again and again, as in a box that is shaken: shadows would flicker.
Box shadedBounds(const Box& bounds, const Box& grains) {
  const double width = bounds.diagonal().norm(), step = 0.25 * width, little = 0.1 * width;
  if (grains.isEmpty() || !(step > 0)) return bounds;
  const auto beyond = [&](double way) { return way > little ? std::min(std::ceil(way / step) * step, width) : 0.0; };
  Box all;
  all.extend(Vec3(bounds.min() - Vec3(bounds.min() - grains.min()).unaryExpr(beyond)));
  all.extend(Vec3(bounds.max() + Vec3(grains.max() - bounds.max()).unaryExpr(beyond)));
  return all;
}

}  // namespace

Pose poseOf(const std::vector<Pose>& poses, std::size_t k) { return k < poses.size() ? poses[k] : Pose(); }

Frame makeFrame(const Snapshot& snapshot, const Style& style, const std::vector<Wall>& walls, const Box& bounds, int side, int shadowSize,
                const FirstLooks& looks) {
  const int width = style.picture.width * side, height = style.picture.height * side;
  const std::vector<std::uint32_t> drawable = drawableGrains(snapshot);
  Frame frame;
  frame.bounds = bounds.isEmpty() ? boundsOf(snapshot, drawable) : bounds;
  frame.view = viewAt(style.camera, snapshot.time, static_cast<double>(width) / height, frame.bounds);
  frame.nearPlane = 1e-3 * frame.view.distance;
  frame.sun = sunOver(shadedBounds(frame.bounds, boundsOf(snapshot, drawable)), style.light.from);
  const std::vector<SeenGrain> seen = seenGrains(snapshot, drawable, frame.view, frame.nearPlane, width, height);
  addGrains(frame, seen, snapshot, style);
  addWalls(frame, walls, snapshot.walls, style, side);
  const bool bonds = style.bonds.shown && !snapshot.bonds.empty();
  const bool forces = style.forces.which != ShownForces::none && !snapshot.forces.empty();
  if (bonds) addBonds(frame, snapshot.bonds, style, looks.bonds, side);
  if (forces) addForces(frame, snapshot.forces, style, looks.forces, side);
  if (style.light.ambientOcclusion) addOcclusion(frame, seen, drawable, snapshot, walls, bonds || forces);
  if (style.light.shadows) {
    const std::vector<ShadowDisc> discs = shadowDiscs(snapshot, drawable, frame.sun, shadowSize);
    frame.sunDiscCount = discs.size();
    for (const ShadowDisc& d : discs) append(frame.sunDiscs, d.x, d.y, d.z, 0, d.radiusX, d.radiusY, 0, 0);
  }
  return frame;
}

}  // namespace tsubu::render
