uniform samplerBuffer walls;  // one texel a vertex: place in the frame of the sun
uniform vec2 shift;

void main() {
  vec3 place = texelFetch(walls, gl_VertexID).xyz;
  gl_Position = vec4(place.xy + shift, place.z, 1.0);
}
