#include "protocols/psychophysics/subject/trials_rig.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/random.h"
#include "core/device/motor_faults.h"
#include "core/questions/question_kind.h"
#include "core/subject/hand.h"
#include "core/subject/noise.h"
#include "core/subject/perceiver/grip.h"
#include "core/subject/perceiver/sense.h"
#include "core/subject/perceiver/sight.h"
#include "core/subject/perceiver/trial_stream.h"
#include "core/subject/subject_parameters.h"
#include "protocols/psychophysics/definition/question.h"
#include "protocols/psychophysics/definition/trials_definition.h"
#include "protocols/psychophysics/subject/answer_by_hand.h"
#include "protocols/psychophysics/subject/decider.h"
#include "protocols/psychophysics/subject/reach_adaptation.h"

namespace haptrial::protocols {
namespace {

int index_of(const std::vector<std::string>& names, const std::string& name) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

/// Motors that give another force than commanded; nothing for perfect ones.
std::optional<device::FaultyMotors> motors_of(const Definition& d) {
  const device::MotorFaults& faults = d.device.faults;
  const bool perfect = faults.gain == 1.0 && faults.dead_zone == 0.0 && faults.resonance == 0.0 &&
                       faults.cogging == 0.0 && faults.gravity_error == 0.0;
  return perfect ? std::nullopt : std::optional(device::FaultyMotors(faults, 1.0 / d.rate));
}

/// The virtual device in the place of this part. @param tip  of its device
device::VirtualDeviceParameters electronics_of(const Definition& d, const TrialDevice& tip,
                                               const DeviceArm& part) {
  device::VirtualDeviceParameters electronics = d.device;
  electronics.force_delay = tip.force_delay.value_or(electronics.force_delay);
  electronics.faults = part.faults.value_or(electronics.faults);
  return electronics;
}

/// The hand of [hand] at a part of a device, where its fingers are.
subject::HandParameters hand_at(const subject::HandParameters& hand, const DeviceArm& arm) {
  subject::HandParameters here = hand;
  here.handle_mass = arm.handle_mass.value_or(hand.handle_mass);
  return here;
}

}  // namespace

/// Servo thread, but for the constructor, recall() and carried_over().
class TrialsRig::Participant final : public stimulus::Observer {
 public:
  Participant(const Briefing& briefing, const std::vector<std::unique_ptr<Arm>>& arms,
              LeftDecision* left, std::uint64_t person_seed, std::uint64_t session_seed)
      : plan_(*briefing.plan),
        questions_(*briefing.questions),
        said_(*briefing.said),
        left_(left),
        seed_(derived_seed(session_seed, "subject")),
        step_(1.0 / briefing.definition->rate),
        rightwards_(briefing.definition->display.mirrored ? -1.0 : 1.0),
        motors_(motors_of(*briefing.definition)),
        senses_(plan_.people->draw_senses(derived_seed(person_seed, "subject"))),
        sense_(senses_, plan_.senses),
        grip_(senses_),
        decider_(plan_, plan_.people->draw_judgement(derived_seed(person_seed, "subject")), seed_),
        felt_in_(index_of(briefing.stages, plan_.stage)),
        reaction_(seed_, "reaction") {
    for (const auto& arm : arms) {
      const std::size_t device = hands_.size();
      const subject::HandParameters held = hand_at(briefing.definition->hand, arm->arm);
      SimulatedHand& hand = hands_.emplace_back(SimulatedHand{
          arm->hand.get(), &arm->device, held, subject::ExplorationController(held), {}});
      for (const std::string& stage : briefing.stages) {
        hand.actions.push_back(action_in(stage, device));
      }
    }
    if (plan_.sight) {
      sight_.emplace(*plan_.sight, derived_seed(person_seed, "subject"));
    }
    if (plan_.adaptation) {
      adaptation_.emplace(*plan_.adaptation, briefing.screen);
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
    if (view == nullptr) {
      leave_stage();
      begun_ = false;
      end_answer();
      for (SimulatedHand& hand : hands_) {
        hand.hand->command({});
      }
      return;
    }
    for (SimulatedHand& hand : hands_) {
      hand.state = hand.hand->state();
    }
    if (!begun_ || view->trial != trial_) {
      begin_trial(view->trial);
    }
    follow(*view);
    lead(*view);
    feel(*view, forces, dt);
    answer(*view, dt);
    act(forces, dt);
    note_learnt();
  }

 private:
  /// A hand, what it is about to do, and where it is.
  struct SimulatedHand {
    subject::HandModel* hand;
    device::VirtualDevice* device;
    subject::HandParameters held;
    subject::ExplorationController prober;
    std::vector<const StageAction*> actions;  // (stages), null: rests
    PointState state{};                       // at this tick
  };

  const StageAction* action_in(const std::string& stage, std::size_t device) const {
    const StageAction* action = nullptr;
    for (const StageAction& each : plan_.actions) {
      action = each.stage == stage && each.device == device ? &each : action;
    }
    return action;
  }

  /// The pass hands over to this thread what the session's thread wrote before it.
  void take_recalled() noexcept {
    if (!recalled_) {
      return;
    }
    decider_.set_previous(recalled_->previous);
    if (adaptation_) {
      adaptation_->recall(recalled_->fast, recalled_->slow);
    }
    recalled_.reset();
  }

  /// Notes the adaptation if the reach ends with this tick: the pass may end before it is noticed.
  void note_learnt() noexcept {
    if (!adaptation_) {
      return;
    }
    const subject::TwoRate after = reaches() ? adaptation_->after_reach() : adaptation_->learnt();
    fast_.store(after.fast(), std::memory_order_relaxed);
    slow_.store(after.slow(), std::memory_order_relaxed);
  }

  void begin_trial(int trial) noexcept {
    constexpr const char* kMotor[kMostDevices] = {"motor", "motor 2", "motor 3", "motor 4"};
    take_recalled();
    begun_ = true;
    trial_ = trial;
    stage_ = interval_ = -1;
    question_ = 0;
    thinks_ = false;
    if (left_ != nullptr) {
      left_->forget();
    }
    end_answer();
    intervals_ = 1;
    percepts_ = {};
    decider_.begin_trial(trial);
    // A hand that is quite still would look like a device whose reading is frozen.
    for (std::size_t i = 0; i < hands_.size(); ++i) {
      hands_[i].prober = subject::ExplorationController(
          hands_[i].held, subject::MotorNoise(subject::SubjectParameters{}, step_,
                                              subject::trial_stream(seed_, kMotor[i], trial)));
    }
    reaction_ = subject::trial_stream(seed_, "reaction", trial);
  }

  void follow(const TrialView& view) noexcept {
    const int stage = view.interval > 0 ? view.stage : -1;
    const int interval = view.interval - 1;
    intervals_ = std::max<std::size_t>(intervals_, view.interval);
    if (stage == stage_ && interval == interval_) {
      return;
    }
    const bool another = interval != interval_;
    leave_stage();
    if (another && interval >= 0) {
      begin_interval(interval);
    }
    stage_ = stage;
    interval_ = interval;
    if (reaches()) {
      adaptation_->begin_reach();
    }
    for (std::size_t i = 0; i < hands_.size(); ++i) {
      begin_probe(i, view);
    }
  }

  void begin_interval(int interval) noexcept {
    RandomStream random = sense_stream(seed_, trial_, interval);
    sense_.begin(random);
    RandomStream cues =
        subject::trial_stream(seed_, "cues", trial_ * static_cast<int>(kMostIntervals) + interval);
    grip_noise_ = subject::draw_noise(cues);
    sight_noise_ = cues.normal();
    grip_.begin();
    seen_ = {};
  }

  /// The first mark for a device that is shown [m].
  static std::optional<Eigen::Vector3d> mark_for(std::size_t device,
                                                 const TrialView& view) noexcept {
    for (std::size_t i = 0; i < view.mark_count; ++i) {
      if (view.marks[i].device == device) {
        const auto& [x, y, z] = view.marks[i].place;
        return Eigen::Vector3d(x, y, z);
      }
    }
    return std::nullopt;
  }

  /// Pursuits follow their marks; every other probe takes no notice.
  void lead(const TrialView& view) noexcept {
    for (std::size_t i = 0; i < hands_.size(); ++i) {
      if (const auto mark = mark_for(i, view)) {
        hands_[i].prober.lead(*mark);
      }
    }
  }

  void begin_probe(std::size_t device, const TrialView& view) noexcept {
    SimulatedHand& hand = hands_[device];
    const StageAction* action =
        stage_ >= 0 ? hand.actions[static_cast<std::size_t>(stage_)] : nullptr;
    subject::Probe probe = action != nullptr ? action->probe : subject::Probe{subject::Rest{}};
    const auto mark = action != nullptr && action->to_mark ? mark_for(device, view) : std::nullopt;
    if (auto* reach = std::get_if<subject::Reach>(&probe); reach != nullptr && mark) {
      reach->to = device == 0 && reaches() ? adaptation_->aim(*mark, view) : *mark;
    }
    hand.prober.begin(probe, hand.state);
  }

  /// Keeps the sensations of the stage, and learns from a reach.
  void leave_stage() noexcept {
    if (interval_ >= 0 && static_cast<std::size_t>(interval_) < kMostIntervals &&
        (felt_in_ < 0 || stage_ == felt_in_)) {
      percepts_[static_cast<std::size_t>(interval_)] = percept();
    }
    if (reaches()) {
      adaptation_->end_reach();
    }
    stage_ = interval_ = -1;
  }

  /// Percept of one hand; between two fingertips, or by eye, a size.
  double percept() const noexcept {
    const bool both = hands_.size() > 1 && plan_.senses == subject::Quantity::kExtent;
    if (!both && !sight_) {
      return sense_.percept();
    }
    constexpr double kNever = std::numeric_limits<double>::infinity();
    subject::Cue felt{0.0, kNever};
    if (both && grip_.held()) {
      const subject::ContactEpisode met = grip_.met();
      felt = {subject::felt(senses_, plan_.senses, met, grip_noise_),
              senses_.extent_weber * met.amount};
    } else if (!both && sense_.met().force > 0.0) {
      felt = {sense_.percept(), senses_.extent_weber * sense_.percept()};
    }
    const bool sees = sight_ && seen_.shown;
    const subject::Cue seen = sees ? sight_->see(seen_.dots.height, seen_.dots.noise, sight_noise_)
                                   : subject::Cue{0.0, kNever};
    return subject::combine(felt, seen).estimate;
  }

  void feel(const TrialView& view, const stimulus::Forces& forces, double dt) noexcept {
    const std::size_t device = plan_.device < forces.size() ? plan_.device : 0;
    const PointState& hand = hands_[device].state;
    const Eigen::Vector3d given =
        motors_ ? motors_->force(forces[device], hand.position) : Eigen::Vector3d(forces[device]);
    if (view.interval == 0) {
      return;
    }
    if (felt_in_ < 0 || stage_ == felt_in_) {
      sense_.feel(given, hand, dt);
      if (hands_.size() > 1 && forces.size() > 1) {
        grip_.feel({forces[0], hands_[0].state}, {forces[1], hands_[1].state}, dt);
      }
      seen_ = view.dots.shown ? view.dots : seen_;
    }
    if (reaches()) {
      adaptation_->feel(view, forces[0], hands_.front().prober.desired().velocity);
    }
  }

  /// In the stage of the reach that is learnt from.
  bool reaches() const noexcept { return adaptation_ && stage_ >= 0 && stage_ == learnt_in_; }

  Eigen::Vector3d compensation() const noexcept {
    return reaches() ? adaptation_->compensation(hands_.front().prober.desired().velocity)
                     : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }

  void act(const stimulus::Forces& forces, double dt) noexcept {
    for (std::size_t i = 0; i < hands_.size(); ++i) {
      const Eigen::Vector3d felt =
          i < forces.size() ? forces[i] : Eigen::Vector3d(Eigen::Vector3d::Zero());
      subject::HandCommand command = hands_[i].prober.command(hands_[i].state, dt, felt);
      if (i == 0) {
        command.force += compensation();
      }
      hands_[i].hand->command(command);
    }
  }

  void answer(const TrialView& view, double dt) noexcept {
    if (view.question == 0) {
      return;
    }
    if (view.question != question_ || view.told()) {
      end_answer();
    }
    if (view.question != question_) {
      question_ = view.question;
      constexpr double kSpread = 0.3;  // of the log of reaction times
      wait_ = plan_.reaction * std::exp(kSpread * reaction_.normal());
      leave_decision();
    }
    wait_ -= dt;
    take_decision();
    if (by_hand_.under_way()) {
      SimulatedHand& hand = hands_[by_hand_.device()];
      by_hand_.tick(hand.prober, hand.state, dt);
    }
    if (mark_.under_way()) {
      SimulatedHand& hand = hands_.front();
      hold(mark_.tick(hand.prober, hand.state, dt) ? mark_button_ : 0, 0.0);
    }
    if (wait_ > 0.0 || thinks_ || decided_ || view.told()) {
      return;
    }
    const Decider::DecidedAnswer said = left_ != nullptr ? left_said_ : decide();
    said_.choice = said.choice;
    said_.draft = said.draft;
    decided_ = true;
    give(questions_[view.question - 1U], view);
  }

  Decider::DecidedAnswer decide() noexcept {
    return decider_.decide(questions_[static_cast<std::size_t>(question_ - 1)], question_ == 1,
                           std::span(percepts_.data(), intervals_));
  }

  /// A question has come: the session's thread is asked what to say.
  void leave_decision() noexcept {
    if (left_ == nullptr) {
      return;
    }
    left_said_ = decide();
    left_reaction_ = wait_;
    left_->ask({static_cast<std::size_t>(question_ - 1),
                percepts_,
                std::min(intervals_, kMostIntervals),
                {left_said_.choice, left_said_.draft, left_reaction_}});
    thinks_ = true;
  }

  void take_decision() noexcept {
    const LeftDecision::Answer* answer = thinks_ ? left_->answer() : nullptr;
    if (answer == nullptr) {
      return;
    }
    left_said_ = {answer->choice, answer->draft};
    wait_ += answer->reaction - left_reaction_;
    if (question_ == 1) {
      decider_.set_previous(answer->choice);
    }
    thinks_ = false;
  }

  /// The answer that is decided, in the way in which it is to be given.
  void give(const TrialQuestion& question, const TrialView& view) noexcept {
    if (said_.choice >= 0 && said_.choice == question.silent_choice()) {
      return;  // nothing is to be done for it
    }
    if (question.mark.by == MarkedBy::kHand) {
      move_mark(question);
      return;
    }
    const int place = AnswerByHand::place_of(question, said_.choice);
    if (place >= 0 && place < view.mark_count) {
      const auto mark = static_cast<std::size_t>(place);
      SimulatedHand& hand =
          hands_[std::min<std::size_t>(view.marks[mark].device, hands_.size() - 1)];
      by_hand_.begin(view, mark, hand.prober, hand.state);
    } else if (said_.choice >= 0 &&
               question.means[static_cast<std::size_t>(said_.choice)].pedal > 0.0) {
      hold(0, 1.0);
    } else {
      said_.given = true;
    }
  }

  void move_mark(const TrialQuestion& question) noexcept {
    const MarkMeans& mark = question.mark;
    const double share = question.kind->share_of_mark(question, said_.draft);
    SimulatedHand& hand = hands_.front();
    mark_button_ = mark.buttons & (~mark.buttons + 1U);  // the first of them
    mark_.begin(mark, rightwards_ * mark.place_of(share), hand.prober, hand.state);
  }

  /// Holds buttons and the pedal of the first device down.
  void hold(std::uint32_t buttons, double depth) noexcept {
    const bool changed = buttons != buttons_ || depth != pedal_;
    buttons_ = buttons;
    pedal_ = depth;
    if (changed) {
      hands_.front().device->hold(buttons, depth, Eigen::Quaterniond::Identity());
    }
  }

  void end_answer() noexcept {
    decided_ = false;
    by_hand_.end();
    mark_.end();
    hold(0, 0.0);
  }

  const ObserverPlan& plan_;
  const std::vector<TrialQuestion>& questions_;
  SimulatedAnswer& said_;
  LeftDecision* left_;  // null: decides by itself
  Decider::DecidedAnswer left_said_;
  double left_reaction_{0.0};  // that was proposed [s]
  bool thinks_{false};         // until the decision that was left is there
  std::uint64_t seed_;
  double step_;                                 // [s]
  double rightwards_;                           // x of W on the screen; -1: to the left
  std::optional<device::FaultyMotors> motors_;  // of the device that is felt
  subject::SenseParameters senses_;
  subject::Sense sense_;
  subject::Grip grip_;
  subject::FeltNoise grip_noise_;
  std::optional<subject::Sight> sight_;
  double sight_noise_{0.0};           // of the interval, standard normal
  DotsShown seen_;                    // in the interval
  std::vector<SimulatedHand> hands_;  // (devices)
  Decider decider_;
  int felt_in_;  // stage; -1: all
  RandomStream reaction_;
  std::optional<ReachAdaptation> adaptation_;
  int learnt_in_{-1};
  std::optional<CarriedOver> recalled_;  // until the first trial
  std::atomic<double> fast_{0.0}, slow_{0.0};
  bool begun_{false};
  int trial_{0};
  int stage_{-1}, interval_{-1};
  std::size_t intervals_{1};
  int question_{0};
  double wait_{0.0};  // [s]
  bool decided_{false};
  AnswerByHand by_hand_;
  MarkByHand mark_;
  std::uint32_t mark_button_{0};  // bit of the button that gives the answer
  std::uint32_t buttons_{0};      // held down
  double pedal_{0.0};             // how far it is held down
  std::array<double, kMostIntervals> percepts_{};
};

TrialsRig::Arm::Arm(const Definition& d, const device::VirtualDeviceParameters& electronics,
                    const TrialDevice& held, const DeviceArm& as)
    : hand(std::make_unique<subject::Hand>(hand_at(d.hand, as), 1.0 / d.rate, held.start)),
      device(electronics, *hand, d.rate),
      arm(as) {}

TrialsRig::TrialsRig(const Briefing& briefing, std::uint64_t person_seed,
                     std::uint64_t session_seed)
    : decide_(briefing.decide), left_(decide_ ? std::make_unique<LeftDecision>() : nullptr) {
  const Definition& d = *briefing.definition;
  const std::vector<DeviceArm> arms = d.arms();
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const bool named = !briefing.devices->empty();
    const TrialDevice held = named ? (*briefing.devices)[i] : TrialDevice{};
    arms_.push_back(std::make_unique<Arm>(
        d, electronics_of(d, named ? (*briefing.devices)[held.of] : held, arms[i]), held, arms[i]));
  }
  participant_ =
      std::make_unique<Participant>(briefing, arms_, left_.get(), person_seed, session_seed);
}

TrialsRig::~TrialsRig() = default;

std::vector<DeviceSet::Arm> TrialsRig::others() {
  std::vector<DeviceSet::Arm> others;
  for (std::size_t i = 1; i < arms_.size(); ++i) {
    const DeviceArm& arm = arms_[i]->arm;
    others.push_back(
        {&arms_[i]->device, arm.limits, device::Part::kTip, arm.radius, arm.handle_mass});
  }
  return others;
}

stimulus::Observer* TrialsRig::subject() { return participant_.get(); }

void TrialsRig::attend() {
  if (left_ != nullptr && left_->waits()) {
    left_->answer(decide_(left_->asked()));
  }
}

void TrialsRig::recall(const CarriedOver& before) { participant_->recall(before); }

CarriedOver TrialsRig::carried_over() const { return participant_->carried_over(); }

}  // namespace haptrial::protocols
