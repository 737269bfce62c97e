#include "protocols/psychophysics/trials_replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/questions/question_kind.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/tick_rows.h"
#include "core/record/rows/device_rows.h"
#include "core/record/rows/object_rows.h"
#include "core/record/rows/trial_rows.h"
#include "core/render/gl/offscreen.h"
#include "protocols/interface/protocol.h"
#include "protocols/interface/recorded_definition.h"
#include "protocols/interface/session_file.h"
#include "protocols/psychophysics/defined_trials.h"

namespace haptrial::protocols {
namespace {

/// Takes the variables that a pass would write, to compare them with those that are written.
class Variables final : public SessionFile {
 public:
  std::vector<record::VariableRow> rows;

  void keep_stimulus(std::int32_t, std::span<const record::StimulusRow>) override {}
  bool holds_stimulus(std::int32_t) const override { return true; }
  void event(const std::string&, const std::string&) override {}
  const std::vector<record::PassRow>& earlier_passes() const override { return none_; }
  bool was_cut_short(const PlannedTrial&) const override { return false; }

 protected:
  void put(const record::Rows& batch) override {
    const auto taken = batch.as<record::VariableRow>();
    rows.insert(rows.end(), taken.begin(), taken.end());
  }

 private:
  std::vector<record::PassRow> none_;
};

bool same(const record::VariableRow& a, const record::VariableRow& b) {
  const bool value = a.value == b.value || (std::isnan(a.value) && std::isnan(b.value));
  return a.interval == b.interval && a.name == b.name && a.word == b.word && value;
}

class TrialReplay {
 public:
  TrialReplay(const Protocol& protocol, const ReplayRequest& request)
      : protocol_(protocol),
        request_(request),
        reader_(request.file),
        passes_(reader_.passes()),
        responses_(reader_.responses()),
        skipped_(reader_.rows<record::SkippedRow>()),
        taken_back_(reader_.rows<record::TakenBackRow>()),
        variables_(reader_.rows<record::VariableRow>()),
        definition_(read_definition()),
        place_(place()),
        trials_(*definition_, place_) {}

  void run() {
    find_pass();
    const record::PassRow& pass = passes_[row_];
    const std::vector<record::Sample> samples = record::samples_of_pass(reader_, pass);
    const int width = definition_->display.width;
    const int height = definition_->display.height;
    render::OffscreenContext context(width, height);
    const auto drawing = trials_.drawing()(context.gl(), width, height);
    const double duration = static_cast<double>(samples.size() - 1) / definition_->rate;
    const int count = static_cast<int>(std::floor(duration * request_.fps + 1e-9)) + 1;
    std::size_t felt = 0;  // samples
    for (int i = 0; i < count; ++i) {
      request_.progress(i, count, fmt::format("{} of {} pictures", i, count), request_.fps);
      const auto at =
          std::min(static_cast<std::size_t>(std::lround(i * definition_->rate / request_.fps)),
                   samples.size() - 1);
      for (; felt <= at; ++felt) {
        feel(samples[felt]);
      }
      context.make_current();
      drawing->draw(stimulus::Shown(view_at(samples[at])));
      request_.picture(context.read());
    }
    request_.tell(
        fmt::format("{} pictures, {:.1f} s at {} a second", count, duration, request_.fps));
  }

 private:
  std::unique_ptr<StudiedDefinition> read_definition() const {
    try {
      Table root = recorded_definition(reader_, request_.trial);
      auto read = protocol_.read(root, reader_.info().definition_name, nullptr);
      show_as_recorded(reader_, *read);
      return std::unique_ptr<StudiedDefinition>(dynamic_cast<StudiedDefinition*>(read.release()));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: its definition is not one of this version of haptrial: {}",
                                   reader_.path().string(), error.what()));
    }
  }

  SessionPlace place() const {
    SessionPlace place;
    place.subject = reader_.info().subject;
    place.seed = reader_.info().seed;
    place.session = static_cast<int>(reader_.info().session);
    give_seeds(place);
    const auto number = std::ranges::find(variables_, "participant", &record::VariableRow::name);
    if (number == variables_.end()) {
      throw InputError(fmt::format("{}: holds no trials", reader_.path().string()));
    }
    place.participant = static_cast<int>(std::lround(number->value)) - 1;
    place.real = true;
    return place;
  }

  /// Leads the definition to the trial that is asked for, and makes its pass.
  void find_pass() {
    const record::Phase last = trials_.phases().back();
    std::set<int> known;
    std::optional<PlannedTrial> trial = trials_.next(nullptr);
    while (trial) {
      if (const auto row = row_of(*trial); row && !trial->practice) {
        known.insert(trial->trial);
        if (trial->trial == request_.trial) {
          row_ = *row;
          trials_.repeat(late_windows(row_));
          trials_.make_pass(*trial, last);
          take_rows();
          return;
        }
      }
      const auto outcome =
          recorded_outcome({passes_, responses_, skipped_, taken_back_}, *trial, last);
      trial = outcome ? trials_.next(&*outcome) : std::nullopt;
    }
    if (known.empty()) {
      throw InputError(fmt::format("{}: holds no trials", reader_.path().string()));
    }
    throw InputError(fmt::format("--trial is {}; allowed: {} to {}, the trials of {}",
                                 request_.trial, *known.begin(), *known.rbegin(),
                                 reader_.path().string()));
  }

  /// The last attempt at a trial.
  std::optional<std::size_t> row_of(const PlannedTrial& trial) const {
    std::optional<std::size_t> row;
    for (std::size_t i = 0; i < passes_.size(); ++i) {
      row = is_of(passes_[i], trial) ? i : row;
    }
    return row;
  }

  std::vector<record::LateWindowRow> late_windows(std::size_t pass) {
    std::vector<record::LateWindowRow> late = reader_.rows<record::LateWindowRow>();
    std::erase_if(late, [pass](const auto& row) { return std::cmp_not_equal(row.pass, pass); });
    return late;
  }

  void take_rows() {
    const auto of_another = [this](const auto& row) { return std::cmp_not_equal(row.pass, row_); };
    Variables now;
    trials_.close_pass(now, static_cast<std::int32_t>(row_));
    std::erase_if(variables_, of_another);
    if (!std::ranges::equal(now.rows, variables_, same)) {
      throw RunError(
          fmt::format("{}: trial {} had other values than this version of haptrial would present; "
                      "replay it with the version that recorded it, {}",
                      reader_.path().string(), request_.trial, reader_.info().program_version));
    }
    stages_ = reader_.rows<record::StageRow>();
    std::erase_if(stages_, of_another);
    std::erase_if(responses_, of_another);
    if (definition_->devices() > 1) {
      others_ = reader_.rows<record::DeviceRow>();
    }
  }

  /// Null between the intervals and while something is asked.
  const record::StageRow* stage_at(std::uint64_t sequence) const {
    const auto at = std::ranges::find_if(stages_, [sequence](const record::StageRow& stage) {
      return sequence >= stage.first_sample && sequence <= stage.last_sample;
    });
    return at == stages_.end() ? nullptr : &*at;
  }

  /// A tick: what presses the bodies that are seen follows from the hands alone.
  void feel(const record::Sample& sample) {
    const record::StageRow* stage = stage_at(sample.sequence);
    if (stage == nullptr) {
      return;
    }
    if (stage != std::exchange(felt_, stage)) {
      trials_.pass().enter_again(static_cast<std::size_t>(stage->interval - 1), number_of(*stage));
    }
    std::vector<PointState> hands{{sample.position, sample.velocity}};
    each_other(sample.sequence, [&hands](const record::DeviceRow& row) {
      hands.push_back({row.position, row.velocity});
    });
    pressed_ = trials_.pass().feel_again(hands);
  }

  TrialView view_at(const record::Sample& sample) const {
    TrialView view;
    view.trial = trials_.pass().trial();
    view.tool = sample.position;
    add_others(sample.sequence, view);
    if (const record::StageRow* stage = stage_at(sample.sequence)) {
      show(*stage, view);
      view.pressed = pressed_;
      return view;
    }
    std::size_t answered = 0;  // the question that is open is the first one without an answer
    for (const record::ResponseRow& row : responses_) {
      answered += row.sequence < sample.sequence ? 1 : 0;
    }
    const std::size_t questions = definition_->questions.size();
    view.question = static_cast<std::uint8_t>(std::min(answered + 1, questions));
    if (view.question > 0) {
      const StageSight& sight = trials_.pass().question_sight(view.question - 1U);
      view.show(sight.marks, sight.objects, sight.hand, false, {});
      show_mark(definition_->questions[view.question - 1U], sample, view);
    }
    return view;
  }

  /// A mark that the hand moves is where the hand was; nothing says where others were.
  void show_mark(const TrialQuestion& question, const record::Sample& sample,
                 TrialView& view) const {
    if (question.mark.by == MarkedBy::kHand) {
      const double rightwards = definition_->display.mirrored ? -1.0 : 1.0;
      questions::AnswerDraft draft;
      question.kind->move_mark(question, question.mark.share_at(rightwards * sample.position.x()),
                               draft);
      view.show(draft);
    }
  }

  template <class Visit>
  void each_other(std::uint64_t sequence, Visit&& visit) const {
    auto row = std::ranges::lower_bound(others_, sequence, {}, &record::DeviceRow::sequence);
    for (; row != others_.end() && row->sequence == sequence; ++row) {
      if (row->device >= 1 && std::cmp_less(row->device, kMostDevices)) {
        visit(*row);
      }
    }
  }

  void add_others(std::uint64_t sequence, TrialView& view) const {
    each_other(sequence, [&view](const record::DeviceRow& row) {
      const Eigen::Vector3f p = row.position.cast<float>();
      view.others[static_cast<std::size_t>(row.device) - 1] = {p.x(), p.y(), p.z()};
      view.other_count = std::max(view.other_count, static_cast<std::uint8_t>(row.device));
    });
  }

  /// Number of a row's stage in its interval.
  std::size_t number_of(const record::StageRow& row) const {
    const std::vector<NamedStage>& stages =
        trials_.stages().at(static_cast<std::size_t>(row.interval - 1));
    const auto at = std::ranges::find(stages, row.stage, &NamedStage::name);
    if (at == stages.end()) {
      throw InputError(fmt::format("{}: /stages names \"{}\", which the definition does not have",
                                   reader_.path().string(), row.stage));
    }
    return static_cast<std::size_t>(at - stages.begin());
  }

  void show(const record::StageRow& row, TrialView& view) const {
    const auto interval = static_cast<std::size_t>(row.interval - 1);
    const std::size_t stage = number_of(row);
    const StageSight& sight = trials_.pass().sight(interval, stage);
    view.interval = static_cast<std::uint8_t>(row.interval);
    view.stage = static_cast<std::uint8_t>(stage);
    view.show(sight.marks, sight.objects, sight.hand, sight.interval_number, sight.dots);
  }

  const Protocol& protocol_;
  const ReplayRequest& request_;
  record::SessionReader reader_;
  std::vector<record::PassRow> passes_;
  std::vector<record::ResponseRow> responses_;
  std::vector<record::SkippedRow> skipped_;
  std::vector<record::TakenBackRow> taken_back_;
  std::vector<record::VariableRow> variables_;
  std::unique_ptr<StudiedDefinition> definition_;
  SessionPlace place_;
  DefinedTrials trials_;
  std::size_t row_{0};  // of /trials
  std::vector<record::StageRow> stages_;
  std::vector<record::DeviceRow> others_;
  const record::StageRow* felt_{nullptr};  // stage of the last sample that was felt again
  SeenForces pressed_;                     // on its tick
};

}  // namespace

void replay_trials(const Protocol& protocol, const ReplayRequest& request) {
  if (request.trial == 0) {
    throw InputError("--trial is missing; give the number of the trial to show");
  }
  if (!request.phase.empty() && request.phase != record::kPresentedPhase) {
    throw InputError(
        fmt::format("--phase is '{}'; allowed: {}", request.phase, record::kPresentedPhase));
  }
  if (!request.sound.empty()) {
    throw InputError("--sound is given for a session without drilling; leave it out");
  }
  if (!request.pictures) {
    throw InputError("neither --video nor --frames is given; add one to write to");
  }
  TrialReplay(protocol, request).run();
}

}  // namespace haptrial::protocols
