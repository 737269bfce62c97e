#include "experiments/pass_pictures.h"

#include <fmt/format.h>

namespace haptrial::experiments {

PassPictures::PassPictures(const SessionRequest& request)
    : request_(request), capture_(request.frames_per_pass) {
  if (request.frames_per_pass > 0) {
    renderer_ = std::make_unique<render::FrameRenderer>(request.definition->display);
  }
}

void PassPictures::set_trajectory(const std::vector<Eigen::Vector3d>& points) {
  if (renderer_) {
    renderer_->set_trajectory(points);
  }
}

void PassPictures::draw(const protocols::PlannedTrial& trial, record::Phase phase) {
  int number = 0;
  for (const stimulus::Presentation& moment : capture_.take()) {
    const auto file =
        request_.frames_folder /
        fmt::format("{}-trial{:02}-{}-{:02}.png", request_.subject, trial.trial,
                    phase == record::Phase::kTest ? "test" : trial.condition, ++number);
    render::write_png(file, renderer_->draw(moment));
  }
}

}  // namespace haptrial::experiments
