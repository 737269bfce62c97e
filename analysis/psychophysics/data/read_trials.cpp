#include "analysis/psychophysics/data/read_trials.h"

#include <algorithm>
#include <set>

#include "core/base/parallel.h"
#include "core/record/read/marked_trials.h"
#include "core/record/read/session_facts.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/tick_rows.h"
#include "core/record/rows/object_rows.h"
#include "core/record/rows/session_tables.h"
#include "core/record/rows/trial_rows.h"

namespace haptrial::analysis::trials {
namespace {

/// Puts rows that name their pass with the pass; rows of no pass are left out.
class SessionTrials {
 public:
  explicit SessionTrials(const record::SessionReader& reader)
      : reader_(reader),
        left_out_(record::trials_left_out(reader)),
        passes_(reader.passes()),
        trials_(passes_.size()) {
    for (std::size_t i = 0; i < passes_.size(); ++i) {
      add_pass(i);
    }
    for (const record::VariableRow& row : reader.rows<record::VariableRow>()) {
      add(row);
    }
    for (const record::LevelRow& row : reader.rows<record::LevelRow>()) {
      if (StudyTrial* trial = of(row.pass)) {
        trial->levels.push_back({row.track, row.variable, row.asked, row.applied, row.outcome});
      }
    }
    for (const record::ResponseRow& row : reader.responses()) {
      if (StudyTrial* trial = of(row.pass)) {
        trial->answers.push_back(
            {row.question, row.value, row.text, row.correct, row.reaction_time, {}});
      }
    }
    for (const record::StageRow& row : reader.rows<record::StageRow>()) {
      add(row);
    }
    for (const record::OutOfTimeRow& row : reader.rows<record::OutOfTimeRow>()) {
      add(row);
    }
    for (const record::TouchedBodyRow& row : reader.rows<record::TouchedBodyRow>()) {
      if (StudyTrial* trial = of(row.pass)) {
        trial->touched.push_back({row.object, row.contact, row.inverted, row.crowded});
      }
    }
    for (const record::MovingBodyRow& row : reader.rows<record::MovingBodyRow>()) {
      if (StudyTrial* trial = of(row.pass)) {
        trial->moving.push_back({row.object, row.limited, row.flown_apart});
      }
    }
  }

  std::vector<StudyTrial> take() {
    for (StudyTrial& trial : trials_) {  // a study of thousands is kept whole
      trial.levels.shrink_to_fit();
      trial.answers.shrink_to_fit();
      trial.variables.shrink_to_fit();
      trial.stages.shrink_to_fit();
      trial.touched.shrink_to_fit();
      trial.moving.shrink_to_fit();
    }
    return std::move(trials_);
  }

 private:
  StudyTrial* of(std::int32_t pass) {
    const auto at = static_cast<std::size_t>(pass);
    return pass >= 0 && at < trials_.size() ? &trials_[at] : nullptr;
  }

  void add_pass(std::size_t i) {
    const record::PassRow& pass = passes_[i];
    StudyTrial& trial = trials_[i];
    trial.trial = pass.trial;
    trial.attempt = pass.attempt;
    trial.block = pass.block;
    trial.condition = pass.condition;
    trial.practice = pass.practice;
    trial.left_out = !pass.practice && left_out_.contains(pass.trial);
    trial.completed = pass.status != record::PassStatus::kAborted;
    trial.damaged = pass.status == record::PassStatus::kDamaged;
    trial.start = static_cast<double>(pass.first_sample) / reader_.info().rate;
    trial.first_sample = pass.first_sample;
    trial.saturated = at_limit(pass.first_sample, pass.last_sample);
  }

  /// The share of the ticks at the force limit.
  double at_limit(std::uint64_t first, std::uint64_t last) {
    const record::RowSpan rows =
        first > last
            ? record::RowSpan{}
            : record::span_of_ticks(reader_, record::samples_table(), first, last - first + 1);
    if (rows.count == 0) {
      return 0.0;
    }
    const auto saturated =
        reader_.integers(record::samples_table(), "saturated", rows.first, rows.count);
    return static_cast<double>(std::count(saturated.begin(), saturated.end(), 1)) /
           static_cast<double>(rows.count);
  }

  void add(const record::VariableRow& row) {
    StudyTrial* trial = of(row.pass);
    if (trial == nullptr) {
      return;
    }
    if (row.name == "probe" && row.interval == 0) {
      trial->probe = row.word == "no" ? std::string() : row.word;
      return;
    }
    const bool known = row.name == "trial" || row.name == "group" || row.name == "interval" ||
                       row.name == "session";
    if (!known) {
      trial->variables.push_back({row.name, row.interval, row.value, row.word});
    }
  }

  void add(const record::StageRow& row) {
    if (StudyTrial* trial = of(row.pass)) {
      trial->stages.push_back(
          {row.stage, static_cast<std::int16_t>(row.interval),
           row.ending == record::StageEnding::kReached,
           trial->saturated > 0.0 && at_limit(row.first_sample, row.last_sample) > 0.0,
           static_cast<std::uint32_t>(row.last_sample - row.first_sample + 1),
           static_cast<std::uint32_t>(row.first_sample - trial->first_sample)});
    }
  }

  void add(const record::OutOfTimeRow& row) {
    StudyTrial* trial = of(row.pass);
    if (trial == nullptr) {
      return;
    }
    trial->again = trial->again || row.again;
    for (GivenAnswer& answer : trial->answers) {
      if (answer.question == row.question) {
        answer.out_of_time = row.how == record::OutOfTime::kTooFast ? "too fast" : "too slow";
      }
    }
  }

  const record::SessionReader& reader_;
  std::set<int> left_out_;
  std::vector<record::PassRow> passes_;
  std::vector<StudyTrial> trials_;
};

}  // namespace

TrialsData read_trials(const std::vector<std::filesystem::path>& files, const GroupOf& group_of,
                       int threads) {
  TrialsData data;
  data.sessions.resize(files.size());
  std::vector<std::vector<StudyTrial>> by_file(files.size());
  std::vector<markers::MarkerLatencies> markers(files.size());
  in_groups(files.size(), 1, threads, [&] {
    return [&](std::size_t first, std::size_t) {
      const record::SessionReader reader(files[first]);
      const record::SessionInfo& info = reader.info();
      data.sessions[first] = {files[first].filename().string(),
                              info.subject,
                              group_of ? group_of(info.subject) : std::string(),
                              info.clock,
                              info.simulated,
                              info.pilot,
                              static_cast<int>(info.session),
                              reader.rows<record::ObjectFileRow>(),
                              info.rate};
      record::TrialProgress progress = record::trial_progress(reader);
      data.sessions[first].planned = static_cast<std::size_t>(progress.planned.value_or(0));
      data.sessions[first].ended_early = std::move(progress.ended_early);
      by_file[first] = SessionTrials(reader).take();
      const std::vector<record::MarkerRow> rows = reader.rows<record::MarkerRow>();
      markers[first].add(rows);
    };
  });
  std::size_t count = 0;
  for (const std::vector<StudyTrial>& trials : by_file) {
    count += trials.size();
  }
  data.trials.reserve(count);
  for (std::size_t session = 0; session < by_file.size(); ++session) {
    data.markers.add(markers[session]);
    for (StudyTrial& trial : by_file[session]) {
      trial.session = session;
      data.trials.push_back(std::move(trial));
    }
    by_file[session] = {};
  }
  return data;
}

}  // namespace haptrial::analysis::trials
