#include "protocols/force_training/pass_pictures.h"

#include <fmt/format.h>

namespace haptrial::protocols {

PassPictures::PassPictures(const render::TrialDisplayStyle& style, const SessionPlace& place)
    : place_(place), capture_(place.frames_per_pass) {
  if (place.frames_per_pass > 0) {
    renderer_ = std::make_unique<render::FrameRenderer>(style);
  }
}

void PassPictures::set_trajectory(const std::vector<Eigen::Vector3d>& points) {
  if (renderer_) {
    renderer_->set_trajectory(points);
  }
}

void PassPictures::draw(const PlannedTrial& trial, const record::Phase& phase) {
  int number = 0;
  for (const stimulus::Presentation& moment : capture_.take()) {
    const auto file =
        place_.frames_folder /
        fmt::format("{}-trial{:02}-{}-{:02}.png", place_.subject, trial.trial,
                    phase == record::Phase::kTest ? "test" : trial.condition, ++number);
    render::write_png(file, renderer_->draw(moment));
  }
}

}  // namespace haptrial::protocols
