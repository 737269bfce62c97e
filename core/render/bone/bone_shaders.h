#pragma once

namespace haptrial::render {

/// Light at the eye, as of a microscope, for each pixel; the normal beside it, for what follows.
inline constexpr const char* kLitVertexShader = R"(#version 330 core
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 colour;
uniform mat4 to_eye;
uniform mat4 to_clip;
out vec3 at;
out vec3 facing;
out vec4 paint;
void main() {
  vec4 p = to_eye * vec4(place, 1.0);
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
layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 normal;
void main() {
  vec3 n = normalize(facing);
  float cosine = max(dot(n, -normalize(at)), 0.0);
  colour = vec4(paint.rgb * (light.x + light.y * cosine) + light.z * pow(cosine, light.w),
                paint.a);
  normal = vec4(0.5 * n + 0.5, 1.0);
})";

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
