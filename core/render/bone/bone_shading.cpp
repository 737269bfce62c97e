#include "core/render/bone/bone_shading.h"

#include <GL/glcorearb.h>
#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace haptrial::render {
namespace {

/// Places in the eye's frame from the depths; in front of each of the shaders below.
constexpr const char* kPlaceOfPixel = R"(#version 330 core
uniform sampler2D bones;
uniform sampler2D normals;
uniform sampler2D depths;
uniform sampler2D openness;
uniform vec4 lens;         // slope of a line of sight by place in the picture: times xy, plus zw
uniform vec2 depth_terms;  // of the projection
uniform vec4 area;         // left, lower, width, height of the eye's picture [px]
uniform vec4 measures;
vec3 place(ivec2 at) {
  float depth = 2.0 * texelFetch(depths, at, 0).r - 1.0;
  float away = depth_terms.y / (depth + depth_terms.x);
  vec2 across = 2.0 * (vec2(at) + 0.5 - area.xy) / area.zw - 1.0;
  return away * vec3(across * lens.xy + lens.zw, -1.0);
}
bool is_bone(ivec2 at) { return texelFetch(depths, at, 0).r < 1.0; }
)";

/// How open a pixel lies: 1 less what other bone within reach covers of the half space before it,
/// and less of it the higher that rises, up to four times the reach: bone far in front is no wall.
/// Four turns of a spiral of eight places, by pixel, that the next pass takes the mean of.
/// measures: reach [m], the same in pixels at 1 m, the most of these, strength.
constexpr const char* kOpennessShader = R"(
out float result;
const int kPlaces = 8;
const vec2 kSpiral[kPlaces] = vec2[](
  vec2(0.250, 0.000), vec2(-0.319, 0.293), vec2(0.049, -0.557), vec2(0.402, 0.525),
  vec2(-0.739, -0.131), vec2(0.700, -0.445), vec2(-0.234, 0.870), vec2(-0.446, -0.859));
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  if (!is_bone(at)) {
    result = 1.0;
    return;
  }
  vec3 p = place(at);
  vec3 n = 2.0 * texelFetch(normals, at, 0).xyz - 1.0;
  float pixels = min(measures.y / -p.z, measures.z);
  float turn = 0.785398 * float((at.x & 1) + 2 * (at.y & 1));
  vec2 x = pixels * vec2(cos(turn), sin(turn));
  ivec2 low = ivec2(area.xy);
  ivec2 high = low + ivec2(area.zw) - 1;
  float closed = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    vec2 way = vec2(dot(kSpiral[i], vec2(x.x, -x.y)), dot(kSpiral[i], x.yx));
    ivec2 to = clamp(at + ivec2(floor(way + 0.5)), low, high);
    vec3 v = place(to) - p;
    float squared = dot(v, v);
    float near = max(1.0 - squared / (16.0 * measures.x * measures.x), 0.0);
    closed += near * max(dot(n, v) * inversesqrt(squared + 1e-12) - 0.1, 0.0);
  }
  result = 1.0 - min(measures.w * 2.0 * closed / float(kPlaces), 1.0);
})";

/// The bone's colour by the mean openness of the four pixels whose turns differ, of those at about
/// the same distance. measures: reach [m].
constexpr const char* kShadeShader = R"(
out vec4 result;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 colour = texelFetch(bones, at, 0);
  if (!is_bone(at)) {
    result = colour;
    return;
  }
  float away = place(at).z;
  ivec2 last = ivec2(area.xy + area.zw) - 1;
  float sum = 0.0;
  float count = 0.0;
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      ivec2 to = min(at + ivec2(i, j), last);
      float same = abs(place(to).z - away) < measures.x ? 1.0 : 0.0;
      sum += same * texelFetch(openness, to, 0).r;
      count += same;
    }
  }
  result = vec4(colour.rgb * (sum / count), colour.a);
})";

/// Share of a pixel's light that capsules leave, as a factor: a shadow of a lamp beside the eye,
/// sharp where they touch and soft far from them, and the light that they keep off close by.
constexpr const char* kShadowShader = R"(
out vec4 result;
uniform vec4 from[4];  // and radius
uniform vec4 to[4];
uniform int count;
float near_by(vec3 p, vec3 n, vec3 a, vec3 b, float r) {
  vec3 ab = b - a;
  float t = clamp(dot(p - a, ab) / max(dot(ab, ab), 1e-12), 0.0, 1.0);
  vec3 v = a + t * ab - p;
  float d = max(length(v), r);
  return max(dot(n, v) / d, 0.0) * max(r * r / (d * d) - 0.0625, 0.0);
}
float in_shadow(vec3 p, vec3 n, vec3 lamp, vec3 a, vec3 b, float r) {
  vec3 ab = b - a;
  vec3 w = p - a;
  float along = dot(ab, ab);
  float skew = dot(lamp, ab);
  float both = along - skew * skew;
  float t = both > 1e-12 ? clamp((dot(w, ab) - dot(w, lamp) * skew) / both, 0.0, 1.0) : 0.0;
  float s = max(dot(a + t * ab - p, lamp), 0.0);
  t = along > 1e-12 ? clamp(dot(p + s * lamp - a, ab) / along, 0.0, 1.0) : 0.0;
  float d = length(p + s * lamp - (a + t * ab));
  float soft = 0.25 * s + 0.1 * r;
  float lit = smoothstep(r - soft, r + soft, d);
  float fades = max(1.0 - s / 0.04, 0.0);
  return s > 0.0 ? fades * (1.0 - lit) * smoothstep(0.0, 0.2, dot(n, lamp)) : 0.0;
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float light = 1.0;
  if (is_bone(at)) {
    vec3 p = place(at);
    vec3 n = 2.0 * texelFetch(normals, at, 0).xyz - 1.0;
    float shadow = 0.0;
    for (int i = 0; i < count; ++i) {
      light *= 1.0 - measures.w * near_by(p, n, from[i].xyz, to[i].xyz, from[i].w);
      shadow = max(shadow, in_shadow(p, n, measures.xyz, from[i].xyz, to[i].xyz, from[i].w));
    }
    light *= 1.0 - measures.w * shadow;
  }
  result = vec4(vec3(light), 1.0);
})";

constexpr double kMostPixels = BoneShading::kReach - 2;  // of the openness's reach
/// Capsules in the eye's frame.
std::vector<Capsule> seen_by(const EyeView& view, std::span<const Capsule> capsules) {
  std::vector<Capsule> seen;
  for (const Capsule& each : capsules) {
    seen.push_back({(view.view * each.from.homogeneous()).head<3>(),
                    (view.view * each.to.homogeneous()).head<3>(), each.radius});
  }
  return seen;
}

float real(double number) { return static_cast<float>(number); }

}  // namespace

BoneShading::BoneShading(const Gl& gl, const BoneStyle& style)
    : gl_(gl),
      style_(style),
      openness_(make_pass("the openness", kOpennessShader)),
      shade_(make_pass("the shaded bone", kShadeShader)),
      shadow_(make_pass("the tools' shadow", kShadowShader)) {
  gl_.gen_vertex_arrays(1, &nothing_);
  count_ = gl_.get_uniform_location(shadow_.program, "count");
  for (std::size_t i = 0; i < kMostCapsules; ++i) {
    from_[i] = gl_.get_uniform_location(shadow_.program, fmt::format("from[{}]", i).c_str());
    to_[i] = gl_.get_uniform_location(shadow_.program, fmt::format("to[{}]", i).c_str());
  }
}

BoneShading::~BoneShading() {
  gl_.delete_vertex_arrays(1, &nothing_);
  for (const Pass* pass : {&openness_, &shade_, &shadow_}) {
    gl_.delete_program(pass->program);
  }
}

BoneShading::Pass BoneShading::make_pass(const char* whose, const char* fragment) const {
  Pass pass;
  const std::string text = std::string(kPlaceOfPixel) + fragment;
  pass.program = build_program(gl_, whose, kScreenVertexShader, text.c_str());
  const auto find = [&](const char* name) { return gl_.get_uniform_location(pass.program, name); };
  pass.lens = find("lens");
  pass.depth_terms = find("depth_terms");
  pass.area = find("area");
  pass.measures = find("measures");
  gl_.use_program(pass.program);
  gl_.uniform1i(find("bones"), BoneLayer::kColour);
  gl_.uniform1i(find("normals"), BoneLayer::kNormal);
  gl_.uniform1i(find("depths"), BoneLayer::kDepth);
  gl_.uniform1i(find("openness"), BoneLayer::kOpenness);
  return pass;
}

void BoneShading::use(const Pass& pass, const EyeView& view, const EyeArea& area) const {
  const Eigen::Matrix4d& p = view.projection;
  gl_.use_program(pass.program);
  gl_.uniform4f(pass.lens, real(1.0 / p(0, 0)), real(1.0 / p(1, 1)), real(p(0, 2) / p(0, 0)),
                real(p(1, 2) / p(1, 1)));
  gl_.uniform2f(pass.depth_terms, real(p(2, 2)), real(p(2, 3)));
  gl_.uniform4f(pass.area, real(area.left), 0.0F, real(area.width), real(area.height));
}

/// Draws on a part of the eye's picture, and nowhere else.
void BoneShading::fill(const EyeArea& area, const PixelBox& part) const {
  gl_.disable(GL_DEPTH_TEST);
  gl_.disable(GL_CULL_FACE);
  gl_.enable(GL_SCISSOR_TEST);
  gl_.scissor(area.left + part.min().x(), part.min().y(), part.sizes().x() + 1,
              part.sizes().y() + 1);
  gl_.bind_vertex_array(nothing_);
  gl_.draw_arrays_instanced(GL_TRIANGLES, 0, 3, 1);
  gl_.bind_vertex_array(0);
  gl_.disable(GL_SCISSOR_TEST);
  gl_.enable(GL_CULL_FACE);
  gl_.enable(GL_DEPTH_TEST);
}

PixelBox BoneShading::reached_by(const PixelBox& part, int width, int height) {
  if (part.isEmpty()) {
    return part;
  }
  const Eigen::Vector2i around = Eigen::Vector2i::Constant(kReach);
  return PixelBox(part.min() - around, part.max() + around).intersection(all_pixels(width, height));
}

void BoneShading::draw(const BoneLayer& layer, const EyeView& view, const EyeArea& area,
                       const PixelBox& part) const {
  if (part.isEmpty()) {
    return;
  }
  const PixelBox wide = reached_by(part, area.width, area.height);
  const double reach = style_.occlusion_reach;
  const double pixels = 0.5 * reach * std::abs(view.projection(1, 1)) * area.height;
  gl_.disable(GL_BLEND);
  layer.begin_openness();
  use(openness_, view, area);
  gl_.uniform4f(openness_.measures, real(reach), real(pixels), real(kMostPixels),
                real(style_.occlusion));
  fill(area, wide);
  layer.begin_shaded();
  use(shade_, view, area);
  gl_.uniform4f(shade_.measures, real(reach), 0.0F, 0.0F, 0.0F);
  fill(area, wide);
}

std::vector<PixelBox> BoneShading::draw_shadows(const EyeView& view, const EyeArea& area,
                                                std::span<const Capsule> capsules,
                                                std::span<const BoneColumn> bone) const {
  if (capsules.empty() || style_.shadow <= 0.0) {
    return {};
  }
  const Eigen::Vector3d lamp = to_lamp();
  use(shadow_, view, area);
  gl_.uniform4f(shadow_.measures, real(lamp.x()), real(lamp.y()), real(lamp.z()),
                real(style_.shadow));
  gl_.enable(GL_BLEND);
  gl_.blend_equation(GL_FUNC_ADD);
  gl_.blend_func_separate(GL_ZERO, GL_SRC_COLOR, GL_ZERO, GL_ONE);
  gl_.depth_mask(GL_FALSE);
  std::vector<PixelBox> dark;
  const std::vector<Capsule> seen = seen_by(view, capsules);
  for (const auto& [box, what] : shadowed_parts(all_pixels(area.width, area.height), seen, bone)) {
    cast(seen, what);
    fill(area, box);
    dark.push_back(box);
  }
  gl_.depth_mask(GL_TRUE);
  return dark;
}

/// @param which  of the capsules take light, a bit each
void BoneShading::cast(std::span<const Capsule> capsules, unsigned which) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < std::min(capsules.size(), kMostCapsules); ++i) {
    if ((which >> i & 1U) == 0) {
      continue;
    }
    const auto& [from, to, radius] = capsules[i];
    gl_.uniform4f(from_[count], real(from.x()), real(from.y()), real(from.z()), real(radius));
    gl_.uniform4f(to_[count], real(to.x()), real(to.y()), real(to.z()), 0.0F);
    ++count;
  }
  gl_.uniform1i(count_, static_cast<int>(count));
}

}  // namespace haptrial::render
