#include "protocols/trials/subject/trials_rig.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>

#include "core/base/random.h"
#include "core/subject/hand.h"
#include "core/subject/motor_noise.h"
#include "core/subject/perceiver/sense.h"
#include "core/subject/perceiver/trial_stream.h"
#include "core/subject/subject_parameters.h"
#include "protocols/trials/definition/question.h"

namespace haptrial::protocols {
namespace {

constexpr std::size_t kMostIntervals = 16;

int index_of(const std::vector<std::string>& names, const std::string& name) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

}  // namespace

/// Servo thread, but for the constructor, recall() and carried_over().
class TrialsRig::Participant final : public stimulus::Observer {
 public:
  Participant(const Briefing& briefing, subject::HandModel& hand, std::uint64_t person_seed,
              std::uint64_t session_seed)
      : plan_(*briefing.plan),
        questions_(*briefing.questions),
        said_(*briefing.said),
        hand_(hand),
        seed_(derived_seed(session_seed, "subject")),
        hand_parameters_(briefing.definition->hand),
        step_(1.0 / briefing.definition->rate),
        prober_(hand_parameters_),
        judgement_(plan_.people->draw_judgement(derived_seed(person_seed, "subject"))),
        sense_(plan_.people->draw_senses(derived_seed(person_seed, "subject")), plan_.senses),
        judge_(judgement_, seed_),
        felt_in_(index_of(briefing.stages, plan_.stage)),
        reaction_(seed_, "reaction") {
    for (const std::string& stage : briefing.stages) {
      const StageAction* action = nullptr;
      for (const StageAction& each : plan_.actions) {
        action = each.stage == stage ? &each : action;
      }
      actions_.push_back(action);
    }
    if (plan_.adaptation) {
      adaptation_.emplace(plan_.adaptation->rates);
      error_.emplace(plan_.adaptation->field);
      learnt_in_ = index_of(briefing.stages, plan_.adaptation->stage);
    }
  }

  void recall(const CarriedOver& before) { recalled_ = before; }
  CarriedOver carried_over() const {
    return {-1, fast_.load(std::memory_order_relaxed), slow_.load(std::memory_order_relaxed)};
  }

  void observe(const stimulus::Shown& shown, const stimulus::Forces& forces,
               double dt) noexcept override {
    const TrialView* view = shown.as<TrialView>();
    const PointState hand = hand_.state();
    if (view == nullptr) {
      leave_stage();
      begun_ = false;
      hand_.command({});
      return;
    }
    if (!begun_ || view->trial != trial_) {
      begin_trial(view->trial);
    }
    follow(*view, hand);
    feel(*view, forces[0], hand, dt);
    answer(*view, dt);
    act(hand, dt);
    note_learnt();
  }

 private:
  /// The pass hands over to this thread what the session's thread wrote before it.
  void take_recalled() noexcept {
    if (!recalled_) {
      return;
    }
    judge_.set_previous(recalled_->previous);
    if (adaptation_) {
      adaptation_->recall(recalled_->fast, recalled_->slow);
    }
    recalled_.reset();
  }

  /// What is learnt if the reach ends with this tick: the pass may end before it is noticed.
  void note_learnt() noexcept {
    if (!adaptation_) {
      return;
    }
    subject::TwoRate after = *adaptation_;
    if (stage_ >= 0 && stage_ == learnt_in_) {
      after.learn(error_->error());
    }
    fast_.store(after.fast(), std::memory_order_relaxed);
    slow_.store(after.slow(), std::memory_order_relaxed);
  }

  void begin_trial(int trial) noexcept {
    take_recalled();
    begun_ = true;
    trial_ = trial;
    stage_ = interval_ = -1;
    question_ = 0;
    intervals_ = 1;
    percepts_ = {};
    judge_.begin_trial(trial);
    // A hand that is quite still would look like a device whose reading is frozen.
    prober_ = subject::Prober(hand_parameters_,
                              subject::MotorNoise(subject::SubjectParameters{}, step_,
                                                  subject::trial_stream(seed_, "motor", trial)));
    reaction_ = subject::trial_stream(seed_, "reaction", trial);
  }

  void follow(const TrialView& view, const PointState& hand) noexcept {
    const int stage = view.interval > 0 ? view.stage : -1;
    const int interval = view.interval - 1;
    intervals_ = std::max<std::size_t>(intervals_, view.interval);
    if (stage == stage_ && interval == interval_) {
      return;
    }
    const bool another = interval != interval_;
    leave_stage();
    if (another && interval >= 0) {
      RandomStream random =
          subject::trial_stream(seed_, interval == 0 ? "sense" : "sense again",
                                trial_ * static_cast<int>(kMostIntervals) + interval);
      sense_.begin(random);
    }
    stage_ = stage;
    interval_ = interval;
    const StageAction* action = stage >= 0 ? actions_[static_cast<std::size_t>(stage)] : nullptr;
    subject::Probe probe = action != nullptr ? action->probe : subject::Probe{subject::Rest{}};
    if (action != nullptr && action->to_mark && view.mark_count > 0) {
      auto& reach = std::get<subject::Reach>(probe);
      const auto& place = view.marks[0].place;
      reach.to = {place[0], place[1], place[2]};
    }
    prober_.begin(probe, hand);
    if (error_ && stage == learnt_in_) {
      error_->begin();
    }
  }

  /// What was felt of it is kept; a reach is learnt from.
  void leave_stage() noexcept {
    if (interval_ >= 0 && static_cast<std::size_t>(interval_) < kMostIntervals &&
        (felt_in_ < 0 || stage_ == felt_in_)) {
      percepts_[static_cast<std::size_t>(interval_)] = sense_.percept();
    }
    if (adaptation_ && stage_ >= 0 && stage_ == learnt_in_) {
      adaptation_->learn(error_->error());
    }
    stage_ = interval_ = -1;
  }

  void feel(const TrialView& view, const Eigen::Vector3d& force, const PointState& hand,
            double dt) noexcept {
    if (view.interval == 0) {
      return;
    }
    if (felt_in_ < 0 || stage_ == felt_in_) {
      sense_.feel(force, hand, dt);
    }
    if (error_ && stage_ == learnt_in_) {
      error_->feel(force, compensation(), prober_.desired().velocity);
    }
  }

  Eigen::Vector3d compensation() const noexcept {
    return adaptation_ && stage_ >= 0 && stage_ == learnt_in_
               ? adaptation_->compensation(plan_.adaptation->field, prober_.desired().velocity)
               : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }

  void act(const PointState& hand, double dt) noexcept {
    subject::HandCommand command = prober_.command(hand, dt);
    command.force += compensation();
    hand_.command(command);
  }

  void answer(const TrialView& view, double dt) noexcept {
    if (view.question == 0) {
      return;
    }
    if (view.question != question_) {
      question_ = view.question;
      constexpr double kSpread = 0.3;  // of the log of reaction times
      wait_ = plan_.reaction * std::exp(kSpread * reaction_.normal());
    }
    wait_ -= dt;
    if (wait_ > 0.0 || said_.given || view.verdict != Verdict::kNone) {
      return;
    }
    decide(questions_[view.question - 1U], view.question == 1);
    said_.given = true;
  }

  void decide(const Question& question, bool first) noexcept {
    if (question.types()) {
      said_.choice = -1;
      said_.value =
          std::clamp(judge_.magnitude(std::max(0.0, percepts_[0])), question.low, question.high);
      return;
    }
    const int most = static_cast<int>(question.choices.size());
    if (first) {
      decision_ = judged();
      said_.choice = plan_.decides == Decides::kYes
                         ? (decision_.answer == 1 ? plan_.yes : 1 - plan_.yes)
                         : decision_.answer;
    } else {  // a rating of how sure it is
      said_.choice = subject::confidence(decision_, judgement_.noise, most) - 1;
    }
    said_.choice = std::clamp(said_.choice, 0, most - 1);
    if (first) {
      judge_.set_previous(said_.choice);
    }
  }

  subject::Decision judged() noexcept {
    if (plan_.decides == Decides::kYes) {
      return judge_.yes_no(percepts_[0]);
    }
    const auto extreme = plan_.decides == Decides::kSmallest ? subject::Extreme::kSmallest
                                                             : subject::Extreme::kLargest;
    return judge_.between(std::span(percepts_.data(), intervals_), extreme);
  }

  const ObserverPlan& plan_;
  const std::vector<Question>& questions_;
  SaidAnswer& said_;
  subject::HandModel& hand_;
  std::uint64_t seed_;
  subject::HandParameters hand_parameters_;
  double step_;  // [s]
  subject::Prober prober_;
  subject::JudgementParameters judgement_;
  subject::Sense sense_;
  subject::Judge judge_;
  int felt_in_;  // stage; -1: all
  RandomStream reaction_;
  std::vector<const StageAction*> actions_;  // (stages), null: rests
  std::optional<subject::TwoRate> adaptation_;
  std::optional<subject::FieldError> error_;
  int learnt_in_{-1};
  std::optional<CarriedOver> recalled_;  // until the first trial
  std::atomic<double> fast_{0.0}, slow_{0.0};
  bool begun_{false};
  int trial_{0};
  int stage_{-1}, interval_{-1};
  std::size_t intervals_{1};
  int question_{0};
  double wait_{0.0};  // [s]
  subject::Decision decision_;
  std::array<double, kMostIntervals> percepts_{};
};

TrialsRig::TrialsRig(const Briefing& briefing, std::uint64_t person_seed,
                     std::uint64_t session_seed)
    : hand_(std::make_unique<subject::Hand>(
          briefing.definition->hand, 1.0 / briefing.definition->rate, Eigen::Vector3d::Zero())),
      device_(briefing.definition->device, *hand_, briefing.definition->rate),
      participant_(std::make_unique<Participant>(briefing, *hand_, person_seed, session_seed)) {}

TrialsRig::~TrialsRig() = default;

stimulus::Observer* TrialsRig::subject() { return participant_.get(); }

void TrialsRig::recall(const CarriedOver& before) { participant_->recall(before); }

CarriedOver TrialsRig::carried_over() const { return participant_->carried_over(); }

}  // namespace haptrial::protocols
