#pragma once

namespace haptrial::render {

/// Light at the eye, as of a microscope: worked out at the vertices, which lie a few pixels apart.
inline constexpr const char* kLitVertexShader = R"(#version 330 core
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 colour;
uniform mat4 to_eye;
uniform mat4 to_clip;
uniform vec4 light;  // ambient, diffuse, specular, shininess
out vec4 shade;
void main() {
  vec4 p = to_eye * vec4(place, 1.0);
  vec3 n = normalize(mat3(to_eye) * normal);
  float facing = max(dot(n, -normalize(p.xyz)), 0.0);
  shade = vec4(colour.rgb * (light.x + light.y * facing) + light.z * pow(facing, light.w),
               colour.a);
  gl_Position = to_clip * p;
})";

inline constexpr const char* kLitFragmentShader = R"(#version 330 core
in vec4 shade;
out vec4 colour;
void main() { colour = shade; })";

/// Squares that face the eye, one an instance, faded to a disc.
inline constexpr const char* kDustVertexShader = R"(#version 330 core
layout(location = 0) in vec3 place;
layout(location = 1) in vec2 size_and_alpha;
uniform mat4 to_eye;
uniform mat4 to_clip;
out vec2 from_middle;
out float alpha;
void main() {
  from_middle = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  vec4 p = to_eye * vec4(place, 1.0);
  p.xy += 0.5 * size_and_alpha.x * from_middle;
  alpha = size_and_alpha.y;
  gl_Position = to_clip * p;
})";

inline constexpr const char* kDustFragmentShader = R"(#version 330 core
in vec2 from_middle;
in float alpha;
uniform vec4 dust;
out vec4 colour;
void main() {
  colour = vec4(dust.rgb, alpha * clamp(1.0 - dot(from_middle, from_middle), 0.0, 1.0));
})";

}  // namespace haptrial::render
