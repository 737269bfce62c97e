#include "protocols/bone_drilling/display/bone_pictures.h"

#include <fmt/format.h>

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

BonePictures::BonePictures(const BoneDefinition& definition, int wanted)
    : definition_(definition), wanted_(static_cast<std::size_t>(wanted)) {}

void BonePictures::watch(std::shared_ptr<const BoneStage> stage) {
  if (stage != stage_) {
    renderer_.reset();
    stage_ = std::move(stage);
    renderer_ = std::make_unique<BoneRenderer>(definition_, stage_);
  }
}

void BonePictures::observe(const stimulus::Shown& shown, const stimulus::Forces&, double) noexcept {
  const auto* seen = shown.as<bone::DrillingView>();
  const double next = (static_cast<double>(images_.size()) + 0.5) / static_cast<double>(wanted_);
  if (seen == nullptr || images_.size() >= wanted_ || seen->progress < next || failure_) {
    return;
  }
  try {
    images_.push_back(renderer_->draw(*seen));
  } catch (...) {
    failure_ = std::current_exception();
  }
}

void BonePictures::write(const std::filesystem::path& folder, const std::string& name) {
  if (failure_) {
    std::rethrow_exception(std::exchange(failure_, nullptr));
  }
  int number = 0;
  for (const render::Image& image : images_) {
    render::write_png(folder / fmt::format("{}-{:02}.png", name, ++number), image);
  }
  images_.clear();
}

}  // namespace haptrial::protocols
