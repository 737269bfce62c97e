#include "core/render/flat/picture_quad.h"

#include <GL/glcorearb.h>

#include <array>

namespace haptrial::render {
namespace {

constexpr const char* kPictureVertexShader = R"glsl(#version 330 core
layout(location = 0) in vec4 place;  // left, top, width, height on the screen [px]
uniform vec2 screen;                 // [px]
out vec2 at;

void main() {
  at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  vec2 pixel = place.xy + at * place.zw;
  gl_Position = vec4(2.0 * pixel.x / screen.x - 1.0, 1.0 - 2.0 * pixel.y / screen.y, 0.0, 1.0);
}
)glsl";

constexpr const char* kPictureFragmentShader = R"glsl(#version 330 core
in vec2 at;
uniform sampler2D picture;
out vec4 result;

void main() { result = vec4(texture(picture, at).rgb, 1.0); }
)glsl";

}  // namespace

PictureQuad::PictureQuad(const Gl& gl, int width, int height)
    : gl_(gl), width_(width), height_(height), quads_(gl, 1) {
  program_ = build_program(gl_, "the picture", kPictureVertexShader, kPictureFragmentShader);
  gl_.use_program(program_);
  gl_.uniform2f(gl_.get_uniform_location(program_, "screen"), static_cast<float>(width),
                static_cast<float>(height));
  gl_.uniform1i(gl_.get_uniform_location(program_, "picture"), 0);
  gl_.gen_textures(1, &texture_);
}

PictureQuad::~PictureQuad() {
  gl_.delete_textures(1, &texture_);
  gl_.delete_program(program_);
}

void PictureQuad::draw(const std::shared_ptr<const Image>& image, const Rectangle& box) {
  begin_flat(gl_, width_, height_);
  gl_.use_program(program_);
  gl_.active_texture(GL_TEXTURE0);
  gl_.bind_texture(GL_TEXTURE_2D, texture_);
  if (image != loaded_) {
    gl_.pixel_storei(GL_UNPACK_ALIGNMENT, 1);
    gl_.tex_image_2d(GL_TEXTURE_2D, 0, GL_RGB8, image->width, image->height, 0, GL_RGB,
                     GL_UNSIGNED_BYTE, image->rgb.data());
    gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    loaded_ = image;
  }
  const std::array<float, 4> place{static_cast<float>(box.low.x()), static_cast<float>(box.low.y()),
                                   static_cast<float>(box.size().x()),
                                   static_cast<float>(box.size().y())};
  quads_.bind();
  quads_.draw(place.data(), 1);
}

}  // namespace haptrial::render
