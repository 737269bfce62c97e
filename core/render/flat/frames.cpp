#include "core/render/flat/frames.h"

#include "core/render/flat/trial_display.h"
#include "core/render/gl/offscreen.h"

namespace haptrial::render {

struct FrameRenderer::Impl {
  explicit Impl(const TrialDisplayStyle& style)
      : context(style.width, style.height),
        display(context.gl(), style, style.width, style.height) {}
  // The display frees what it has in this context, which another may have replaced as current.
  ~Impl() { context.make_current(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  OffscreenContext context;
  TrialDisplay display;
};

FrameRenderer::FrameRenderer(const TrialDisplayStyle& style)
    : impl_(std::make_unique<Impl>(style)) {}

FrameRenderer::~FrameRenderer() = default;

void FrameRenderer::set_trajectory(std::span<const Eigen::Vector3d> points) {
  impl_->display.set_trajectory(points);
}

Image FrameRenderer::draw(const stimulus::Presentation& presentation) {
  impl_->context.make_current();
  impl_->display.draw(presentation);
  return impl_->context.read();
}

Image render_presentation(const TrialDisplayStyle& style,
                          std::span<const Eigen::Vector3d> trajectory,
                          const stimulus::Presentation& presentation) {
  FrameRenderer renderer(style);
  renderer.set_trajectory(trajectory);
  return renderer.draw(presentation);
}

}  // namespace haptrial::render
