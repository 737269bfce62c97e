#pragma once

namespace haptrial::render {

/// Light at the eye, as of a microscope, for each pixel; the normal beside it, for what follows.
/// Soft structures are bent by dents (core/bone/model/dent.h), and their normals with them.
inline constexpr const char* kLitVertexShader = R"(#version 330 core
layout(location = 0) in vec3 place;
layout(location = 1) in vec4 normal_and_label;  // of a mesh: 1, which is no label
layout(location = 2) in vec4 colour;
uniform mat4 to_eye;
uniform mat4 to_clip;
uniform vec4 dent_place[2];  // and its width
uniform vec4 dent_out[2];    // and its depth
uniform vec2 dent_label;
out vec3 at;
out vec3 facing;
out vec4 paint;
void main() {
  vec3 bent = place;
  vec3 normal = normal_and_label.xyz;
  for (int i = 0; i < 2; ++i) {
    vec3 off = place - dent_place[i].xyz;
    float width = dent_place[i].w;
    float left = 1.0 - dot(off, off) / (width * width);
    if (width > 0.0 && left > 0.0 &&
        abs(32767.0 * normal_and_label.w - dent_label[i]) < 0.5) {
      vec3 out_of = dent_out[i].xyz;
      float depth = dent_out[i].w;
      vec3 slope = -4.0 * depth * left / (width * width) * off;
      bent -= depth * left * left * out_of;
      normal += slope * dot(out_of, normal) / (1.0 - dot(slope, out_of));
    }
  }
  vec4 p = to_eye * vec4(bent, 1.0);
  at = p.xyz;
  facing = mat3(to_eye) * normal;
  paint = colour;
  gl_Position = to_clip * p;
})";

inline constexpr const char* kLitFragmentShader = R"(#version 330 core
in vec3 at;
in vec3 facing;
in vec4 paint;
uniform vec4 light;  // ambient, diffuse, specular, shininess
uniform vec4 lens;   // middle of the eye's picture [px], its half diagonal [px], light lost there
layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 normal;
void main() {
  vec3 n = normalize(facing);
  float cosine = max(dot(n, -normalize(at)), 0.0);
  float off = distance(gl_FragCoord.xy, lens.xy) / lens.z;
  float through = 1.0 - lens.w * smoothstep(0.45, 1.0, off);
  colour = vec4(through * (paint.rgb * (light.x + light.y * cosine) +
                           light.z * pow(cosine, light.w)),
                paint.a);
  normal = vec4(0.5 * n + 0.5, 1.0);
})";

/// Lumps of dust, kGrains a cell: discs that face the eye, each a little off the middle of its
/// cell by a random way that follows from where the cell is, so that they make no lattice, and so
/// wide that they run into each other as a paste. Four vertices a lump.
inline constexpr unsigned kGrains = 2;
inline constexpr const char* kDustVertexShader = R"(#version 330 core
layout(location = 0) in vec3 place;
layout(location = 1) in vec2 size_and_alpha;
uniform mat4 to_eye;
uniform mat4 to_clip;
uniform float widen;  // a grain: this many times
out vec2 from_middle;
flat out vec2 alpha_and_shade;
uint mixed(uint x) {
  x = (x ^ (x >> 16)) * 0x7feb352dU;
  x = (x ^ (x >> 15)) * 0x846ca68bU;
  return x ^ (x >> 16);
}
float between(float low, float high, inout uint state) {
  state = mixed(state + 0x9e3779b9U);
  return mix(low, high, float(state >> 8) / 16777216.0);
}
void main() {
  uvec3 bits = floatBitsToUint(place);
  uint state = mixed(bits.x ^ mixed(bits.y ^ mixed(bits.z + uint(gl_VertexID / 4 % 2))));
  float size = size_and_alpha.x;
  vec3 off;
  off.x = between(-0.5, 0.5, state);
  off.y = between(-0.5, 0.5, state);
  off.z = between(-0.5, 0.5, state);
  float radius = 0.68 * widen * size * sqrt(size_and_alpha.y) * between(0.6, 1.15, state);
  from_middle = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1 & 1)) * 2.0 - 1.0;
  vec4 p = to_eye * vec4(place + size * off, 1.0);
  p.xy += radius * from_middle;
  alpha_and_shade = vec2(sqrt(size_and_alpha.y), between(0.90, 1.0, state));
  gl_Position = to_clip * p;
})";

/// Lit as a flat lump by a lamp beside the eye, with a soft edge, and darker where the bone behind
/// is closed in.
inline constexpr const char* kDustFragmentShader = R"(#version 330 core
in vec2 from_middle;
flat in vec2 alpha_and_shade;
uniform vec4 dust;  // and how much of the openness counts
uniform sampler2D openness;
out vec4 colour;
const vec3 kLamp = vec3(0.36, 0.48, 0.8);
void main() {
  float squared = dot(from_middle, from_middle);
  if (squared > 1.0) {
    discard;
  }
  vec3 n = normalize(vec3(0.55 * from_middle, 1.0));
  ivec2 first = ivec2(gl_FragCoord.xy) & ~1;  // of four pixels whose places differ
  float four = texelFetch(openness, first, 0).r + texelFetch(openness, first + ivec2(1, 0), 0).r +
               texelFetch(openness, first + ivec2(0, 1), 0).r +
               texelFetch(openness, first + ivec2(1, 1), 0).r;
  float open = mix(1.0, 0.25 * four, dust.a);
  float light = open * alpha_and_shade.y * (0.38 + 0.72 * max(dot(n, kLamp), 0.0));
  colour = vec4(dust.rgb * light, alpha_and_shade.x * (1.0 - squared));
})";

}  // namespace haptrial::render
