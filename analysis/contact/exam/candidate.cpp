#include "analysis/contact/exam/candidate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/contact/felt_body.h"
#include "core/contact/make_renderer.h"
#include "core/contact/rigid_tool.h"
#include "core/contact/signed_distance.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/mesh/mesh_bounds.h"

namespace haptrial::evaluation {
namespace {

using contact::KindOfRenderer;

constexpr const char* kRigidTool = "rigid-tool";

class OwnCandidate final : public Candidate {
 public:
  explicit OwnCandidate(contact::RendererKind kind) : kind_(kind) {}

  void begin(const ContactTask& task) override {
    if (task.is_rigid()) {
      throw InputError(fmt::format("{} renders a point; allowed in an exam of rigid tools: {}",
                                   contact::kind_of(kind_).word, kRigidTool));
    }
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
  void start(const Eigen::Isometry3d& tool) override { renderer_->start(tool.translation()); }
  Answer tick(double, const Eigen::Isometry3d& tool) override {
    return {renderer_->tick(tool.translation(), period_).force, Eigen::Vector3d::Zero()};
  }

 private:
  contact::RendererKind kind_;
  std::optional<contact::FeltBody> body_;
  std::unique_ptr<contact::Renderer> renderer_;
  double period_{1e-3};  // [s]
};

/// Points a twentieth of the tool's longest side apart; each touches with a stiffness that gives
/// way by a few hundredths of a millimetre.
class RigidCandidate final : public Candidate {
 public:
  void begin(const ContactTask& task) override {
    if (!task.is_rigid()) {
      throw InputError(
          fmt::format("{} needs an exam of rigid tools (exam make --rigid)", kRigidTool));
    }
    constexpr double kContactStiffness = 1e5;  // [N/m]
    const geometry::Mesh tool = geometry::read_mesh(task.tool);
    const double spacing = geometry::bounds(tool).sizes().maxCoeff() / 20.0;
    contact::Coupling coupling;
    coupling.stiffness = task.stiffness;
    coupling.turning_stiffness = task.turning_stiffness;
    coupling.contact_stiffness = kContactStiffness;
    tool_.emplace(contact::points_on(tool, spacing), coupling);
    distance_.reset();
    body_.emplace(geometry::read_mesh(task.body));
    distance_.emplace(body_->mesh, body_->surface);
    period_ = 1.0 / task.rate;
  }
  void start(const Eigen::Isometry3d& tool) override { tool_->begin(tool); }
  Answer tick(double, const Eigen::Isometry3d& tool) override {
    const contact::CoupledTool::Felt felt = tool_->tick(*distance_, tool, period_);
    return {felt.force, felt.torque};
  }

 private:
  std::optional<contact::RigidTool> tool_;
  std::optional<contact::FeltBody> body_;
  std::optional<contact::SignedDistance> distance_;
  double period_{1e-3};  // [s]
};

std::string on_a_line(std::string word) {
  std::ranges::replace(word, ' ', '-');
  return word;
}

}  // namespace

std::unique_ptr<Candidate> own_candidate(const std::string& word) {
  if (word == kRigidTool) {
    return std::make_unique<RigidCandidate>();
  }
  std::vector<std::string> allowed{kRigidTool};
  for (const KindOfRenderer& kind : contact::kinds_of_renderer()) {
    if (kind.tool == KindOfRenderer::Tool::kBall) {
      continue;  // the truth is that of a point
    }
    if (on_a_line(kind.word) == word) {
      return std::make_unique<OwnCandidate>(contact::renderer_kind(kind.word));
    }
    allowed.push_back(on_a_line(kind.word));
  }
  std::ranges::rotate(allowed, allowed.begin() + 1);
  throw InputError(fmt::format("RENDERER is '{}'; allowed: {}, or another program by --program",
                               word, fmt::join(allowed, ", ")));
}

}  // namespace haptrial::evaluation
