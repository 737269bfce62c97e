#include "analysis/contact/exam/candidate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/contact/felt_body.h"
#include "core/contact/make_renderer.h"
#include "core/geometry/files/mesh_io.h"

namespace haptrial::evaluation {
namespace {

using contact::KindOfRenderer;

class OwnCandidate final : public Candidate {
 public:
  explicit OwnCandidate(contact::RendererKind kind) : kind_(kind) {}

  void begin(const ContactTask& task) override {
    renderer_.reset();
    body_.emplace(geometry::read_mesh(task.body));
    contact::RendererOptions options;
    options.stiffness = task.stiffness;
    if (contact::kind_of(kind_).friction) {
      options.friction = {task.friction, task.friction};
    }
    period_ = 1.0 / task.rate;
    renderer_ = contact::make_renderer(kind_, body_->mesh, body_->surface, options);
  }
  void start(const Eigen::Vector3d& tool) override { renderer_->start(tool); }
  Eigen::Vector3d tick(double, const Eigen::Vector3d& tool) override {
    return renderer_->tick(tool, period_).force;
  }

 private:
  contact::RendererKind kind_;
  std::optional<contact::FeltBody> body_;
  std::unique_ptr<contact::Renderer> renderer_;
  double period_{1e-3};  // [s]
};

std::string on_a_line(std::string word) {
  std::ranges::replace(word, ' ', '-');
  return word;
}

}  // namespace

std::unique_ptr<Candidate> own_candidate(const std::string& word) {
  std::vector<std::string> allowed;
  for (const KindOfRenderer& kind : contact::kinds_of_renderer()) {
    if (kind.tool == KindOfRenderer::Tool::kBall) {
      continue;  // the truth is that of a point
    }
    if (on_a_line(kind.word) == word) {
      return std::make_unique<OwnCandidate>(contact::renderer_kind(kind.word));
    }
    allowed.push_back(on_a_line(kind.word));
  }
  throw InputError(fmt::format("RENDERER is '{}'; allowed: {}, or another program by --program",
                               word, fmt::join(allowed, ", ")));
}

}  // namespace haptrial::evaluation
