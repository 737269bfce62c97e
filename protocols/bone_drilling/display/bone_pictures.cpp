#include "protocols/bone_drilling/display/bone_pictures.h"

#include <fmt/format.h>

#include <utility>

namespace haptrial::protocols {

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
