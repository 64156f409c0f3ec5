// The records of the grains that may be seen, in the frame of the eye.
uniform samplerBuffer grains;

const int grainTexels = 5;

vec4 grainBall(int grain) { return texelFetch(grains, grainTexels * grain); }            // centre, radius
vec4 grainPaint(int grain) { return texelFetch(grains, grainTexels * grain + 1); }       // linear colour, pattern
vec4 grainTurn(int grain) { return texelFetch(grains, grainTexels * grain + 2); }        // quaternion: eye to grain directions
vec4 grainNeighbours(int grain) { return texelFetch(grains, grainTexels * grain + 3); }  // first neighbour, number of neighbours
vec4 grainBox(int grain) { return texelFetch(grains, grainTexels * grain + 4); }         // clip space: low x, low y, high x, high y

// Corner 0 to 3 of a rectangle, as Geometry::drawQuads numbers them.
vec2 cornerOf(vec4 box, int corner) {
  return vec2((corner & 1) == 0 ? box.x : box.z, (corner & 2) == 0 ? box.y : box.w);
}
