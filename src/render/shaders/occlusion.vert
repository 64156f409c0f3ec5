// The surroundings of a grain near a wall: where it hides the sky from the wall.
#include "grains.glsl"

uniform samplerBuffer surroundings;  // two texels each: centre and radius in the frame of the eye, clip-space rectangle

flat out vec4 ball;

void main() {
  int k = gl_VertexID >> 2;
  ball = texelFetch(surroundings, 2 * k);
  gl_Position = vec4(cornerOf(texelFetch(surroundings, 2 * k + 1), gl_VertexID & 3), 0.5, 1.0);
}
