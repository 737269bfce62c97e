#include "protocols/tutoring/linked_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/record/rows/partner_rows.h"
#include "protocols/interface/session_file.h"

namespace haptrial::protocols {
namespace {

using tutoring::PassBarrier;

/// Attempts of an aborted trial on a real clock before it is left.
constexpr int kMostAgain = 3;

/// Everything is the protocol's own but when a pass begins and ends, and what the hand feels.
class LinkedTrials final : public Trials {
 public:
  LinkedTrials(std::unique_ptr<Trials> inner, const TutoringOptions& options,
               const LinkChoice& link, const SessionPlace& place)
      : inner_(std::move(inner)),
        options_(options),
        link_(link),
        real_(place.real),
        seed_(place.session_seed),
        world_(inner_->share_world(link.role == LinkRole::kTeaches)),
        hand_({options_, link.role, *link_.wire, inner_->tick_log(), place.stop, world_}) {}
  ~LinkedTrials() override {
    link_.wire->close(hand_.last_words(all_presented_ ? tutoring::kOver : tutoring::kLeft));
  }
  LinkedTrials(const LinkedTrials&) = delete;
  LinkedTrials& operator=(const LinkedTrials&) = delete;

  Extent extent(int most) const override { return inner_->extent(most); }
  std::optional<PlannedTrial> next(const Outcome* last) override;
  bool presents_aborted_again() const override { return inner_->presents_aborted_again(); }
  std::span<const record::Phase> phases() const override { return inner_->phases(); }
  std::unique_ptr<Rig> virtual_rig() const override { return inner_->virtual_rig(); }
  std::vector<stimulus::Observer*> observers() override {
    std::vector<stimulus::Observer*> all = inner_->observers();
    all.push_back(&hand_);
    return all;
  }
  TickLog* tick_log() override { return &hand_; }
  void empty_logs(SessionFile& file) override;
  std::uint64_t dropped() const override { return inner_->dropped() + hand_.dropped(); }
  record::TableList tables() const override {
    record::TableList tables = inner_->tables();
    tables.push_back(&record::table_of<record::LinkRow>());
    if (has_networks()) {
      tables.push_back(&record::table_of<record::NetworkRow>());
    }
    return tables;
  }
  std::vector<record::Rows> first_rows() const override { return inner_->first_rows(); }
  void check_resumed(const record::SessionReader& file) const override {
    inner_->check_resumed(file);
  }
  void prepare(const PlannedTrial& trial, SessionFile& file) override;
  void begin_attempt(const PlannedTrial& trial, bool anew) override {
    ++attempts_;
    inner_->begin_attempt(trial, anew);
  }
  MakeDrawing drawing() override { return inner_->drawing(); }
  bool waits_for_picture() const override { return inner_->waits_for_picture(); }
  std::vector<sound::Cue> varied_cues() const override { return inner_->varied_cues(); }
  Pass& make_pass(PlannedTrial& trial, const record::Phase& phase) override;
  std::vector<record::ResponseRow> responses() override { return inner_->responses(); }
  void close_pass(SessionFile& file, std::int32_t row) override;
  void draw_pictures(const PlannedTrial& trial, const record::Phase& phase) override {
    inner_->draw_pictures(trial, phase);
  }
  std::string why_aborted() const override;
  AfterAbort after_abort() const override;
  std::optional<record::PartnerState> partner() override { return hand_.state(); }
  void take_lead(bool take) override { hand_.take_lead(take); }
  std::optional<record::LiveState> live() const override { return inner_->live(); }
  std::vector<std::string> take_warnings() override { return inner_->take_warnings(); }
  std::string why_given_up() const override { return inner_->why_given_up(); }
  std::vector<std::string> notices() const override;

 private:
  void check_partner();
  bool has_networks() const { return !real_ && !options_.networks.empty(); }

  std::unique_ptr<Trials> inner_;
  TutoringOptions options_;
  LinkChoice link_;
  bool real_;
  std::uint64_t seed_;                       // of the session
  const TutoringNetwork* network_{nullptr};  // of the present trial; null: of all alike
  SharedSimulation* world_;                  // of the inner trials; null: there is none
  LinkedHand hand_;
  std::optional<LinkedPass> pass_;
  std::uint32_t walked_{0};    // trials in the order of the plan, to the present one
  int attempts_{0};            // at the present trial, in this run
  bool all_presented_{false};  // the session has come to its end
  bool begun_{false};
  bool told_{false};  // why the session ends
};

std::optional<PlannedTrial> LinkedTrials::next(const Outcome* last) {
  std::optional<PlannedTrial> trial = inner_->next(last);
  ++walked_;
  all_presented_ = !trial;
  return trial;
}

void LinkedTrials::prepare(const PlannedTrial& trial, SessionFile& file) {
  attempts_ = 0;
  if (has_networks()) {
    const std::size_t which = network_of_trial(walked_ - 1, options_.networks.size(), seed_);
    network_ = &options_.networks[which];
    link_.wire->change(network_->channel);
  }
  if (!std::exchange(begun_, true)) {
    file.event("partner", fmt::format("{}; link {}", name_of(link_.role), link_.session));
  }
  inner_->prepare(trial, file);
}

Pass& LinkedTrials::make_pass(PlannedTrial& trial, const record::Phase& phase) {
  const std::span<const record::Phase> all = phases();
  const auto at =
      static_cast<std::uint32_t>(std::find(all.begin(), all.end(), phase) - all.begin());
  // A pass that is simulated again from the file needs every tick, and a world that both sides work
  // on is the same only when both are through.
  const bool holds = inner_->tick_log() == nullptr || world_ != nullptr;
  pass_.emplace(inner_->make_pass(trial, phase), hand_, walked_ * PassBarrier::kPhases + at, holds,
                world_);
  return *pass_;
}

void LinkedTrials::empty_logs(SessionFile& file) {
  inner_->empty_logs(file);
  hand_.flush([&file](std::span<const record::LinkRow> rows) { file.add(rows); });
  check_partner();
}

/// Said once: whoever ends the session empties the logs again.
void LinkedTrials::check_partner() {
  constexpr double kToBegin = 60.0;  // a partner may have much to load [s]
  const record::PartnerState& s = hand_.state();
  if (all_presented_ || (s.over && !s.left) || told_) {
    return;
  }
  const double most = s.heard || !real_ ? options_.patience : std::max(kToBegin, options_.patience);
  if (s.left || s.silence > most) {
    told_ = true;
    const std::string why =
        s.left ? "the other side has ended its session with trials left"
               : fmt::format("the other side was not heard for {:.0f} s", s.silence);
    throw RunError(real_ ? why + "; what was recorded is kept: continue with --resume on both sides"
                         : why);
  }
}

void LinkedTrials::close_pass(SessionFile& file, std::int32_t row) {
  inner_->close_pass(file, row);
  if (network_ != nullptr) {
    const tutoring::ChannelConditions& n = network_->channel;
    const record::NetworkRow network{row,    network_->name, n.delay,      n.jitter,
                                     n.loss, n.duplication,  n.reordering, n.bandwidth};
    file.add(std::span(&network, 1));
  }
  const record::PartnerState& s = hand_.state();
  const tutoring::WireCounts c = link_.wire->counts();
  file.event("link",
             fmt::format("round trip {:.1f} ms, jitter {:.1f} ms, {:.1f} % lost, lost link {} "
                         "times; clock offset {:.3f} ms, drift {:.1f} ppm; {} sent, {} accepted, "
                         "{} foreign, {} forged, {} repeated, {} dropped",
                         1e3 * s.round_trip, 1e3 * s.jitter, 1e2 * s.loss, s.losses,
                         1e3 * s.clock_offset, 1e6 * s.clock_drift, c.sent, c.accepted, c.foreign,
                         c.forged, c.repeated, c.dropped));
}

std::string LinkedTrials::why_aborted() const {
  switch (pass_ ? pass_->why() : PassBarrier::Step::kRun) {
    case PassBarrier::Step::kBreak:
      return "the other side aborted it";
    case PassBarrier::Step::kAgain:
      return "the other side presents the trial again";
    case PassBarrier::Step::kSkip:
      return "the other side has left the trial";
    default:
      return inner_->why_aborted();
  }
}

/// On a simulated clock nobody attends to either side, and both do the same by themselves.
AfterAbort LinkedTrials::after_abort() const {
  switch (pass_ ? pass_->why() : PassBarrier::Step::kRun) {
    case PassBarrier::Step::kBreak:
      return !real_ ? AfterAbort::kAsAsked
                    : (attempts_ <= kMostAgain ? AfterAbort::kAgain : AfterAbort::kSkip);
    case PassBarrier::Step::kAgain:
      return attempts_ <= kMostAgain ? AfterAbort::kAgain : AfterAbort::kSkip;
    case PassBarrier::Step::kSkip:
      return AfterAbort::kSkip;
    default:
      return real_ && hand_.stopped_by_partner() ? AfterAbort::kAgain : AfterAbort::kAsAsked;
  }
}

std::vector<std::string> LinkedTrials::notices() const {
  std::vector<std::string> all = inner_->notices();
  if (real_ && !options_.networks.empty()) {
    all.emplace_back(
        "the networks of the definition are those of a dry run; this link was a real one");
  }
  all.push_back(fmt::format("this side {} over the link", name_of(link_.role)));
  return all;
}

}  // namespace

const char* name_of(LinkRole role) noexcept {
  return role == LinkRole::kTeaches ? "teaches" : "learns";
}

std::unique_ptr<Trials> linked(std::unique_ptr<Trials> trials, const TutoringOptions& options,
                               const LinkChoice& link, const SessionPlace& place) {
  return std::make_unique<LinkedTrials>(std::move(trials), options, link, place);
}

std::size_t network_of_trial(std::size_t trial, std::size_t count, std::uint64_t seed) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  RandomStream random(seed, fmt::format("networks {}", trial / count));
  for (std::size_t i = count - 1; i > 0; --i) {
    std::swap(order[i], order[static_cast<std::size_t>(random.below(i + 1))]);
  }
  return order[trial % count];
}

using tutoring::PassBarrier;

bool LinkedPass::may_begin() noexcept {
  if (!awaited_) {
    awaited_ = true;
    hand_->await(item_);
  }
  return hand_->decided();
}

void LinkedPass::begin(std::uint64_t sequence) noexcept {
  may_begin();  // it may not have been asked
  hand_->begin_pass();
  inner_->begin(sequence);
}

/// Holds the last view, without force.
PassOutput LinkedPass::hold(const Readings& readings) const noexcept {
  PassOutput out = last_;
  static_cast<Drive&>(out) = {};
  out.stage = record::Stage::kIdle;
  out.onsets = {};
  out.shown.tool = readings[0].tool.position;
  return out;
}

/// A world that both work on is compared before the pass is over.
bool LinkedPass::own_done() const noexcept {
  return inner_->state() == PassState::kCompleted &&
         (world_ == nullptr || world_->settled() || hand_->alone());
}

PassOutput LinkedPass::tick(const Readings& readings, double dt) noexcept {
  const bool done = inner_->state() == PassState::kCompleted;
  const PassBarrier::Step step = hand_->begin_tick(own_done(), holds_);
  ticked_ = !done && state_ == PassState::kRunning;
  if (ticked_) {  // also on the tick with which it is aborted: the file has that tick
    last_ = inner_->tick(readings, dt);
  }
  PassOutput out = ticked_ ? last_ : hold(readings);
  if (step == PassBarrier::Step::kComplete) {
    state_ = PassState::kCompleted;
  } else if (step == PassBarrier::Step::kAgain || step == PassBarrier::Step::kSkip ||
             step == PassBarrier::Step::kBreak) {
    state_ = PassState::kAborted;
    why_ = step;
  } else if (inner_->state() == PassState::kAborted) {
    state_ = PassState::kAborted;
    hand_->abort();
  }
  hand_->couple(out, readings[0], dt);
  return out;
}

std::span<const Drive> LinkedPass::others() const noexcept {
  return ticked_ ? inner_->others() : std::span<const Drive>{};
}

bool LinkedPass::wants_attention() noexcept {
  return inner_->wants_attention() || (world_ != nullptr && world_->wants_attention()) ||
         hand_->waiting_rows() > hand_->room() / 2;
}

}  // namespace haptrial::protocols
