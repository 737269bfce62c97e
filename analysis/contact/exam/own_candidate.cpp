#include "analysis/contact/exam/own_candidate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "analysis/contact/exam/soft_candidates.h"
#include "core/base/error.h"
#include "core/contact/felt_body.h"
#include "core/contact/renderer_kinds.h"
#include "core/contact/rigid_tool.h"
#include "core/contact/signed_distance.h"
#include "core/geometry/files/mesh_io.h"
#include "core/geometry/mesh/mesh_size.h"

namespace haptrial::evaluation {
namespace {

using contact::KindOfRenderer;

constexpr const char* kRigidTool = "rigid-tool";

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

/// Kinds of renderer whose tool may be a point: the truth is that of one.
std::vector<const KindOfRenderer*> point_kinds() {
  std::vector<const KindOfRenderer*> kinds;
  for (const KindOfRenderer& kind : contact::kinds_of_renderer()) {
    if (kind.tool != KindOfRenderer::Tool::kBall) {
      kinds.push_back(&kind);
    }
  }
  return kinds;
}

std::vector<std::string> words_of(ExamKind kind) {
  if (kind == ExamKind::kSoft) {
    return soft_candidate_words();
  }
  if (kind == ExamKind::kRigid) {
    return {kRigidTool};
  }
  std::vector<std::string> words;
  for (const KindOfRenderer* one : point_kinds()) {
    words.push_back(on_a_line(one->word));
  }
  return words;
}

/// The word for the bodies of an exam, and what its candidates render.
std::pair<const char*, const char*> names_of(ExamKind kind) {
  return kind == ExamKind::kPoint   ? std::pair{"a point", "points"}
         : kind == ExamKind::kRigid ? std::pair{"rigid tools", "rigid tools"}
                                    : std::pair{"soft bodies", "soft bodies"};
}

void check_kind(const std::string& word, ExamKind renders, ExamKind exam) {
  if (renders != exam) {
    throw InputError(fmt::format("{} renders {}; allowed in an exam of {}: {}", word,
                                 names_of(renders).first, names_of(exam).second,
                                 fmt::join(words_of(exam), ", ")));
  }
}

}  // namespace

std::unique_ptr<Candidate> own_candidate(const std::string& word, ExamKind exam) {
  if (word == kRigidTool) {
    check_kind(word, ExamKind::kRigid, exam);
    return std::make_unique<RigidCandidate>();
  }
  for (const KindOfRenderer* kind : point_kinds()) {
    if (on_a_line(kind->word) == word) {
      check_kind(word, ExamKind::kPoint, exam);
      return std::make_unique<OwnCandidate>(contact::renderer_kind(kind->word));
    }
  }
  if (auto soft = soft_candidate(word)) {
    check_kind(word, ExamKind::kSoft, exam);
    return soft;
  }
  throw InputError(fmt::format("RENDERER is '{}'; allowed: {}, or another program by --program",
                               word, fmt::join(words_of(exam), ", ")));
}

}  // namespace haptrial::evaluation
