// A grain in the light of the sun: the disc through its centre throws exactly its shadow, and never on its own lit side.
uniform samplerBuffer discs;  // two texels a disc: place in the frame of the sun, radii
uniform vec2 margin;          // added to the radii

out vec2 across;

void main() {
  int disc = gl_VertexID >> 2;
  vec3 centre = texelFetch(discs, 2 * disc).xyz;
  vec2 radii = texelFetch(discs, 2 * disc + 1).xy + margin;
  across = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID & 2) - 1);
  gl_Position = vec4(centre.xy + across * radii, centre.z, 1.0);
}
