// Opaque walls: triangles in the frame of the eye, normals towards the eye.
#include "names.glsl"

uniform samplerBuffer walls;  // two texels a vertex: position and look, normal
uniform vec2 openings;        // tangents of half the opening angles
uniform float nearPlane;

out vec3 normal;
flat out uint look;

void main() {
  vec4 place = texelFetch(walls, 2 * gl_VertexID);
  normal = texelFetch(walls, 2 * gl_VertexID + 1).xyz;
  look = uint(place.w);
  gl_Position = vec4(place.xy / openings, nearPlane, -place.z);
}
