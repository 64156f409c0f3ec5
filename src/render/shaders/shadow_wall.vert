uniform samplerBuffer walls;  // one texel a vertex: place in the frame of the sun

void main() {
  gl_Position = vec4(texelFetch(walls, gl_VertexID).xyz, 1.0);
}
