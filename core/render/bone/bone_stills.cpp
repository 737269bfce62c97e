#include "core/render/bone/bone_stills.h"

#include <GL/glcorearb.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptrial::render {
namespace {

constexpr double kMargin = 0.02;  // of the picture's width

constexpr const char* kStillVertexShader = R"(#version 330 core
layout(location = 0) in vec4 place;  // left, top, width, height [px]
uniform vec2 screen;                 // [px]
out vec2 local;                      // [px]
flat out vec2 size;
void main() {
  const float kFrame = 2.0;  // [px]
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  local = mix(vec2(-kFrame), place.zw + kFrame, corner);
  size = place.zw;
  vec2 pixel = place.xy + local;
  gl_Position = vec4(2.0 * pixel.x / screen.x - 1.0, 1.0 - 2.0 * pixel.y / screen.y, 0.0, 1.0);
})";

constexpr const char* kStillFragmentShader = R"(#version 330 core
in vec2 local;
flat in vec2 size;
uniform sampler2D still;
out vec4 result;
void main() {
  vec2 at = local / size;
  bool inside = all(greaterThanEqual(at, vec2(0.0))) && all(lessThanEqual(at, vec2(1.0)));
  result = vec4(inside ? texture(still, at).rgb : vec3(0.55), 1.0);
})";

}  // namespace

BoneStills::BoneStills(const Gl& gl, std::shared_ptr<const std::vector<Image>> stills,
                       StillSide side)
    : gl_(gl), stills_(std::move(stills)), side_(side), quads_(gl, 1) {
  program_ = build_program(gl_, "the stills", kStillVertexShader, kStillFragmentShader);
  gl_.gen_textures(1, &texture_);
  gl_.bind_texture(GL_TEXTURE_2D, texture_);
  gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

BoneStills::~BoneStills() {
  gl_.delete_textures(1, &texture_);
  gl_.delete_program(program_);
}

void BoneStills::replace(std::shared_ptr<const std::vector<Image>> stills) {
  stills_ = std::move(stills);
  uploaded_ = static_cast<std::size_t>(-1);
}

Eigen::Vector4d BoneStills::place_of(const Image& still, int width, int height, StillSide side) {
  const bool left = side == StillSide::kLeft;
  const double margin = kMargin * width;
  const double most = (left ? kLeftHeight : 1.0) * height - 2.0 * margin;
  const double wide = std::min(kShare * width, most * still.width / std::max(1, still.height));
  const double high = wide * still.height / std::max(1, still.width);
  return {std::round(left ? margin : width - margin - wide), std::round(margin), std::round(wide),
          std::round(high)};
}

void BoneStills::upload(std::size_t number) {
  gl_.active_texture(GL_TEXTURE0);
  gl_.bind_texture(GL_TEXTURE_2D, texture_);
  if (number == uploaded_) {
    return;
  }
  const Image& still = (*stills_)[number];
  gl_.pixel_storei(GL_UNPACK_ALIGNMENT, 1);
  gl_.tex_image_2d(GL_TEXTURE_2D, 0, GL_RGB8, still.width, still.height, 0, GL_RGB,
                   GL_UNSIGNED_BYTE, still.rgb.data());
  uploaded_ = number;
}

void BoneStills::draw(std::size_t number, int left, int width, int height) {
  upload(number);
  begin_flat(gl_, width, height);
  gl_.viewport(left, 0, width, height);
  gl_.use_program(program_);
  gl_.uniform1i(gl_.get_uniform_location(program_, "still"), 0);
  gl_.uniform2f(gl_.get_uniform_location(program_, "screen"), static_cast<float>(width),
                static_cast<float>(height));
  quads_.bind();
  const Eigen::Vector4f place = place_of((*stills_)[number], width, height, side_).cast<float>();
  quads_.draw(place.data(), 1);
  gl_.bind_vertex_array(0);
  gl_.use_program(0);
  gl_.disable(GL_BLEND);
}

}  // namespace haptrial::render
