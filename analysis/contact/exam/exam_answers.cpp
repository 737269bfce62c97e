#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "analysis/contact/evaluation/rendering_error.h"
#include "analysis/contact/exam/answer_tables.h"
#include "analysis/contact/exam/exam.h"
#include "analysis/contact/exam/soft_body.h"
#include "analysis/files/new_folder.h"
#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::evaluation {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

ExamAnswers sit_exam(Candidate& candidate, const std::string& renderer,
                     const std::vector<ExamCase>& exam) {
  ExamAnswers answers{.renderer = renderer};
  for (const ExamCase& one : exam) {
    ExamAnswers::Case answer;
    const Clock::time_point start = Clock::now();
    candidate.begin(one.task);
    answer.preparation = seconds_since(start);
    candidate.start(one.tool.front());
    std::vector<double> ticks;
    auto asked = one.shape_samples.begin();
    for (std::size_t i = 0; i < one.tool.size(); ++i) {
      if (!one.load.empty()) {
        candidate.set_load(one.load[i]);
      }
      const Clock::time_point tick = Clock::now();
      answer.answer.push_back(candidate.tick(static_cast<double>(i) / one.task.rate, one.tool[i]));
      ticks.push_back(seconds_since(tick));
      if (asked != one.shape_samples.end() && *asked == i) {
        answer.answer.back().shape = candidate.shape();
        ++asked;
      }
    }
    const TickTimes times = tick_times(ticks);
    answer.median_tick = times.median;
    answer.worst_tick = times.worst;
    answers.cases.push_back(std::move(answer));
  }
  return answers;
}

void write_answers(const ExamAnswers& answers, const std::optional<FailureMap>& ridges,
                   const std::vector<ExamCase>& exam, const fs::path& folder) {
  exchange::NewFolder out(folder);
  Json costs = Json::object();
  for (std::size_t i = 0; i < exam.size(); ++i) {
    const ExamAnswers::Case& answer = answers.cases[i];
    out.write(exam[i].name + ".csv", answer_csv(answer.answer, exam[i].task.is_rigid()));
    if (exam[i].task.is_soft()) {
      out.write(exam[i].name + "-shape.csv", shape_csv(exam[i].shape_samples, answer.answer));
    }
    costs[exam[i].name] = {{"preparation_s", answer.preparation},
                           {"median_tick_s", answer.median_tick},
                           {"worst_tick_s", answer.worst_tick}};
  }
  if (!answers.stability.empty()) {
    out.write("stability.csv", stability_csv(answers.stability));
  }
  if (ridges) {
    out.write("failures.csv", failure_csv({*ridges}));
  }
  out.write("answers.json", Json{{"renderer", answers.renderer}, {"costs", costs}}.dump(2) + "\n");
  out.publish();
}

ExamAnswers read_answers(const fs::path& folder, const std::vector<ExamCase>& exam) {
  ExamAnswers answers{.renderer = fs::weakly_canonical(folder).filename().string(),
                      .costs_known = false};
  const fs::path file = folder / "answers.json";
  nlohmann::json said;
  try {
    if (fs::exists(file)) {
      said = nlohmann::json::parse(file_text(file));
      answers.renderer = said.at("renderer");
      answers.costs_known = true;
    }
    for (const ExamCase& one : exam) {
      const fs::path path = folder / (one.name + ".csv");
      ExamAnswers::Case answer;
      answer.answer = answers_of(analysis::CsvTable::load(path), one.task.is_rigid());
      if (answer.answer.size() != one.tool.size()) {
        throw InputError(fmt::format("{}: {} forces; allowed: {}, one for each row of the path",
                                     path.string(), answer.answer.size(), one.tool.size()));
      }
      if (one.task.is_soft()) {
        read_shapes(folder / (one.name + "-shape.csv"), one.shape_samples,
                    read_soft_body(one.task.body).mesh.vertices.size(), answer.answer);
      }
      if (answers.costs_known) {
        const auto& cost = said.at("costs").at(one.name);
        answer.preparation = cost.at("preparation_s");
        answer.median_tick = cost.at("median_tick_s");
        answer.worst_tick = cost.at("worst_tick_s");
      }
      answers.cases.push_back(std::move(answer));
    }
    if (const fs::path stability = folder / "stability.csv"; fs::exists(stability)) {
      answers.stability = read_stability(stability);
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError(
        fmt::format("{}: {}; allowed: what haptrial exam run writes", file.string(), error.what()));
  }
  return answers;
}

}  // namespace haptrial::evaluation
