#include "protocols/bone_drilling/display/bone_renderer.h"

#include <utility>

#include "protocols/bone_drilling/display/stage_stills.h"

namespace haptrial::protocols {

/// Nobody waits for them.
static render::BoneStyle style_of_pictures() {
  render::BoneStyle style = render::microscope_style();
  style.shades_moving = true;
  return style;
}

BoneRenderer::BoneRenderer(const BoneDefinition& definition, std::shared_ptr<const BoneStage> stage)
    : definition_(definition),
      stage_(std::move(stage)),
      has_stills_(stage_->stills != nullptr),
      context_(definition.display.width, definition.display.height),
      display_(context_.gl(), definition, stage_, definition.display.width,
               definition.display.height, style_of_pictures()) {}

render::Image BoneRenderer::draw(const bone::DrillingView& seen) {
  if (seen.stills_asked > 0 && !std::exchange(has_stills_, true)) {
    const auto stills = screen_stills(definition_, *stage_->model);  // in a context of its own
    context_.make_current();
    display_.set_stills(stills);
  }
  context_.make_current();
  display_.draw(seen);
  return context_.read();
}

}  // namespace haptrial::protocols
