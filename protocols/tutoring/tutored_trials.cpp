#include "protocols/tutoring/tutored_trials.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/longer.h"
#include "core/control/pd_controller.h"
#include "protocols/interface/session_file.h"

namespace haptrial::protocols {
namespace {

/// Everything is the protocol's own but the passes of its first phase.
class TutoredTrials final : public Trials {
 public:
  TutoredTrials(std::unique_ptr<Trials> inner, const TutoringOptions& options,
                const TutorChoice& tutor, const std::string& definition,
                std::function<bool(int)> led)
      : inner_(std::move(inner)),
        led_(std::move(led)),
        options_(options),
        from_(tutor.from),
        file_(tutor.file.filename().string()),
        motion_(read_model(tutor)),
        other_(motion_.definition == definition
                   ? std::string()
                   : fmt::format("; recorded by another definition, {}: whether its places and "
                                 "objects are the same is not checked",
                                 motion_.definition_name)) {
    for (const record::TableDescription* table : inner_->tables()) {
      if (table == &record::table_of<record::TutoringRow>()) {
        throw InputError("--tutor: conditions of the definition have an expert of their own");
      }
    }
  }

  Extent extent(int most) const override { return inner_->extent(most); }
  std::optional<PlannedTrial> next(const Outcome* last) override { return inner_->next(last); }
  bool presents_aborted_again() const override { return inner_->presents_aborted_again(); }
  bool can_take_back() const override { return inner_->can_take_back(); }
  std::optional<PlannedTrial> take_back() override { return inner_->take_back(); }
  std::span<const record::Phase> phases() const override { return inner_->phases(); }
  std::unique_ptr<Rig> virtual_rig() const override { return inner_->virtual_rig(); }
  std::vector<stimulus::Observer*> observers() override { return inner_->observers(); }
  TickLog* tick_log() override { return inner_->tick_log(); }
  void empty_logs(SessionFile& file) override {
    inner_->empty_logs(file);
    log_.flush([&file](std::span<const record::TutoringRow> rows) { file.add(rows); });
  }
  std::uint64_t dropped() const override { return inner_->dropped() + log_.dropped(); }
  record::TableList tables() const override {
    record::TableList tables = inner_->tables();
    tables.push_back(&record::table_of<record::TutoringRow>());
    return tables;
  }
  std::vector<record::Rows> first_rows() const override { return inner_->first_rows(); }
  void check_resumed(const record::SessionReader& file) const override {
    inner_->check_resumed(file);
  }
  void prepare(const PlannedTrial& trial, SessionFile& file) override {
    inner_->prepare(trial, file);
  }
  void begin_attempt(const PlannedTrial& trial, bool anew) override {
    inner_->begin_attempt(trial, anew);
  }
  MakeDrawing drawing() override { return inner_->drawing(); }
  bool waits_for_picture() const override { return inner_->waits_for_picture(); }
  std::vector<sound::Cue> varied_cues() const override { return inner_->varied_cues(); }
  Pass& make_pass(PlannedTrial& trial, const record::Phase& phase) override {
    Pass& pass = inner_->make_pass(trial, phase);
    if (!(phase == phases().front()) || !led_(trial.practice ? 0 : trial.trial)) {
      return pass;
    }
    pass_.emplace(pass, options_, motion_, from_, log_);
    return *pass_;
  }
  std::vector<record::ResponseRow> responses() override { return inner_->responses(); }
  void close_pass(SessionFile& file, std::int32_t row) override { inner_->close_pass(file, row); }
  void draw_pictures(const PlannedTrial& trial, const record::Phase& phase) override {
    inner_->draw_pictures(trial, phase);
  }
  std::string why_aborted() const override { return inner_->why_aborted(); }
  std::optional<record::LiveState> live() const override { return inner_->live(); }
  std::vector<std::string> take_warnings() override { return inner_->take_warnings(); }
  std::string why_given_up() const override { return inner_->why_given_up(); }
  std::vector<std::string> notices() const override {
    std::vector<std::string> all = inner_->notices();
    all.push_back(fmt::format("led by trial {} of {} ({}), {:.1f} s{}", motion_.trial,
                              motion_.subject, file_, motion_.duration() - from_, other_));
    return all;
  }

 private:
  std::unique_ptr<Trials> inner_;
  std::function<bool(int)> led_;
  TutoringOptions options_;
  double from_;
  std::string file_;
  ModelMotion motion_;
  std::string other_;  // what is to be said of a recording by another definition
  TutoringLog log_;
  std::optional<TutoredPass> pass_;
};

}  // namespace

std::unique_ptr<Trials> tutored(std::unique_ptr<Trials> trials, const TutoringOptions& options,
                                const TutorChoice& tutor, const std::string& definition,
                                std::function<bool(int)> led) {
  return std::make_unique<TutoredTrials>(std::move(trials), options, tutor, definition,
                                         std::move(led));
}

TutoredPass::TutoredPass(Pass& inner, const TutoringOptions& options, const ModelMotion& motion,
                         double from, TutoringLog& log) noexcept
    : inner_(&inner),
      options_(&options),
      playback_(motion, options.speed, from),
      log_(&log),
      handover_(options.ramp) {}

void TutoredPass::begin(std::uint64_t sequence) noexcept {
  sequence_ = sequence;
  inner_->begin(sequence);
}

bool TutoredPass::wants_attention() noexcept {
  return inner_->wants_attention() || log_->taken() > log_->capacity() / 2;
}

PassOutput TutoredPass::tick(const Readings& readings, double dt) noexcept {
  PassOutput out = inner_->tick(readings, dt);
  const bool runs = out.stage == record::Stage::kRun && !playback_.over();
  playback_.wait(!runs || asks_to_wait(*options_, readings[0]));
  handover_.ask(runs ? 1.0 : 0.0);
  handover_.step(dt);
  if (runs || handover_.share() > 0.0) {
    lead(out, readings[0]);
    playback_.step(dt);
  }
  ++sequence_;
  return out;
}

/// A tutor works on the hand: of his force only the spring has to be passive about his motion.
void TutoredPass::lead(PassOutput& out, const device::DeviceReading& reading) noexcept {
  const PointState& own = reading.tool;
  const tutoring::Partner tutor = playback_.now();
  const double share = handover_.share();
  const tutoring::TutoringGains& gains = options_->gains;
  const Eigen::Vector3d own_force = out.force;
  const Eigen::Vector3d wanted =
      tutoring::tutoring_force(gains, {share, 0.0}, tutor, own, own_force, reading.shares);
  out.force = control::saturate(wanted, options_->most_force);
  out.saturated = out.saturated || longer(wanted, options_->most_force);
  const Eigen::Vector3d stretch = tutor.tool.position - own.position;
  out.intent.push =
      out.force - share * tutoring::coupling_force(gains, tutor.tool, own, reading.shares);
  out.intent.drive = tutor.tool.velocity;
  out.intent.stored =
      0.5 * share * reading.shares.stiffness * gains.stiffness * stretch.squaredNorm();
  // The own world's counts as much as it is felt, what is recorded was meant to be felt.
  const double passed = out.saturated && !wanted.isZero() ? out.force.norm() / wanted.norm() : 1.0;
  out.intent.stimulus =
      passed * ((1.0 - share) * out.intent.stimulus + share * gains.force_share * tutor.force);
  out.intent.ended *= 1.0 - share;
  out.intent.added = 0.0;  // the own world's springs push
  log_->push({sequence_, playback_.time(), share, tutor.tool.position, tutor.force,
              out.force - (1.0 - share) * own_force});
}

}  // namespace haptrial::protocols
