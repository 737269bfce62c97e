#include "analysis/contact/exam/exam_map.h"

#include <exception>

#include "analysis/contact/demo_study/ridge_drag.h"
#include "analysis/contact/exam/mesh_file.h"

namespace haptrial::evaluation {
namespace {

constexpr double kTouch = 1e-9;  // a smaller force is none [N]

/// A candidate's contact on a ridge. What it throws is kept, since a renderer may not throw.
class RidgeCandidate final : public contact::Renderer {
 public:
  RidgeCandidate(Candidate& candidate, const Ridge& ridge, std::exception_ptr& failed)
      : candidate_(candidate), failed_(failed) {
    const MeshFile body(ridge_mesh(ridge));
    task_.body = body.path();
    candidate.begin(task_);
  }

  void start(const Eigen::Vector3d& tool) noexcept override {
    time_ = 0.0;
    guarded([&] { candidate_.start(Eigen::Isometry3d(Eigen::Translation3d(tool))); });
  }
  const contact::Contact& tick(const Eigen::Vector3d& tool, double period) noexcept override {
    contact_ = {};
    guarded([&] {
      contact_.force = candidate_.tick(time_, Eigen::Isometry3d(Eigen::Translation3d(tool))).force;
    });
    time_ += period;
    const double size = contact_.force.norm();
    contact_.proxy = tool + contact_.force / task_.stiffness;
    if (size > kTouch) {
      contact_.normal = contact_.force / size;
      contact_.depth = size / task_.stiffness;
      contact_.state = contact::ContactState::kSlip;
    }
    return contact_;
  }
  const contact::Operations& operations() const noexcept override { return none_; }

 private:
  template <class Work>
  void guarded(Work work) noexcept {
    if (failed_) {
      return;
    }
    try {
      work();
    } catch (...) {
      failed_ = std::current_exception();
    }
  }

  Candidate& candidate_;
  std::exception_ptr& failed_;
  ContactTask task_;
  contact::Contact contact_;
  contact::Operations none_;
  double time_{0.0};  // [s]
};

}  // namespace

FailureMap failure_map_of(Candidate& candidate, const std::string& renderer) {
  std::exception_ptr failed;
  FailureMap map = failure_map(renderer, 0.0, 0.0, [&](const Ridge& ridge) {
    return std::make_unique<RidgeCandidate>(candidate, ridge, failed);
  });
  if (failed) {
    std::rethrow_exception(failed);
  }
  return map;
}

}  // namespace haptrial::evaluation
