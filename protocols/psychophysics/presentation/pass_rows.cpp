#include "protocols/psychophysics/presentation/pass_rows.h"

#include <cmath>
#include <limits>
#include <utility>

namespace haptrial::protocols {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

record::StageEnding ending_of(StageEnd how) {
  return how == StageEnd::kReached     ? record::StageEnding::kReached
         : how == StageEnd::kLate      ? record::StageEnding::kLate
         : how == StageEnd::kTooLittle ? record::StageEnding::kTooLittle
                                       : record::StageEnding::kBrokenOff;
}

}  // namespace

std::vector<record::ResponseRow> response_rows(const TrialPass& pass,
                                               const std::vector<TrialQuestion>& questions,
                                               const std::vector<int>& right) {
  std::vector<record::ResponseRow> rows;
  for (std::size_t i = 0; i < pass.answers().size(); ++i) {
    const Answer& answer = pass.answers()[i];
    const TrialQuestion& question = questions[i];
    if (!answer.given) {
      continue;
    }
    record::ResponseRow row;
    row.question = question.name;
    row.interval = static_cast<std::int32_t>(pass.intervals_begun());
    const questions::Answer given = given_answer(question, answer.choice, answer.draft);
    row.value = given.value;
    row.text = given.text;
    row.correct = right[i] < 0 ? -1 : answer.choice == right[i] ? 1 : 0;
    row.source = answer.source;
    row.code = answer.code;
    row.reaction_time = answer.reaction_time;
    row.sequence = answer.sequence;
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<record::ResponseRow> measure_rows(const TrialPass& pass) {
  std::vector<record::ResponseRow> rows;
  for (std::size_t i = 0; i < pass.measures().size(); ++i) {
    const std::size_t interval = pass.measures()[i].interval;
    const Measurement& taken = pass.measurement(i);
    const Measure& measure = taken.measure();
    const StageTimes& stage = pass.machine(interval).times()[measure.stage];
    if (interval >= pass.intervals_begun() || stage.end < 0 || !std::isfinite(taken.value())) {
      continue;
    }
    record::ResponseRow row;
    row.question = measure.name;
    row.interval = static_cast<std::int32_t>(interval + 1);
    row.value = taken.value();
    row.correct = !measure.judged ? -1 : measure.is_right(row.value) ? 1 : 0;
    row.source = record::ResponseSource::kMeasured;
    row.sequence = pass.first_tick(interval) + static_cast<std::uint64_t>(stage.end);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<record::OutOfTimeRow> out_of_time_rows(const TrialPass& pass,
                                                   const std::vector<TrialQuestion>& questions,
                                                   std::int32_t row) {
  std::vector<record::OutOfTimeRow> rows;
  for (std::size_t i = 0; i < pass.answers().size(); ++i) {
    const Answer& answer = pass.answers()[i];
    const TrialQuestion& question = questions[i];
    if (answer.given && answer.pace != Pace::kInTime) {
      const bool fast = answer.pace == Pace::kTooFast;
      rows.push_back({row, question.name,
                      fast ? record::OutOfTime::kTooFast : record::OutOfTime::kTooSlow,
                      answer.reaction_time, fast ? question.too_fast : question.too_slow,
                      question.again && pass.state() == PassState::kCompleted});
    }
  }
  return rows;
}

std::vector<record::StageRow> stage_rows(const TrialPass& pass,
                                         const std::vector<std::vector<NamedStage>>& stages,
                                         std::int32_t row) {
  std::vector<record::StageRow> rows;
  for (std::size_t i = 0; i < pass.intervals_begun(); ++i) {
    const std::span<const StageTimes> times = pass.machine(i).times();
    const std::uint64_t first = pass.first_tick(i);
    for (std::size_t k = 0; k < times.size() && times[k].begin >= 0; ++k) {
      const NamedStage& stage = stages[i][k];
      record::StageRow each;
      each.pass = row;
      each.interval = static_cast<std::int32_t>(i + 1);
      each.stage = stage.name;
      each.first_sample = first + static_cast<std::uint64_t>(times[k].begin);
      each.last_sample =
          times[k].end >= 0 ? first + static_cast<std::uint64_t>(times[k].end) : pass.last_tick();
      each.onset_sample =
          times[k].onset >= 0 ? static_cast<std::int64_t>(first) + times[k].onset : -1;
      each.ending = ending_of(times[k].how);
      each.most = stage.stage.require ? times[k].most : kNone;
      rows.push_back(std::move(each));
    }
  }
  return rows;
}

}  // namespace haptrial::protocols
