#include "analysis/bone_drilling/feedback/curriculum_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "analysis/bone_drilling/feedback/page_frame.h"
#include "analysis/bone_drilling/metrics/quantities.h"
#include "analysis/document/html.h"

namespace haptrial::analysis::drilling {
namespace {

using bone::CaseStanding;
using bone::CheckedCriterion;
using bone::Curriculum;
using bone::CurriculumCase;
using bone::CurriculumStanding;
using Rows = std::vector<std::vector<std::string>>;

/// "done 2026-03-02, 3 procedures", "next, 2 procedures, 1 passed", "–".
std::string state_of(const CurriculumStanding& standing, std::size_t place) {
  const CaseStanding& own = standing.cases[place];
  const bool next = standing.next == place;
  if (own.attempts == 0) {
    return next ? "next" : "–";
  }
  const std::string tried = fmt::format("{} {}, {} passed", own.attempts,
                                        own.attempts == 1 ? "procedure" : "procedures", own.passed);
  return own.done ? fmt::format("done {}, {}", own.date, tried)
         : next   ? fmt::format("next, {}", tried)
                  : fmt::format("open, {}", tried);
}

std::string asked_of(const CurriculumCase& of) {
  std::vector<std::string> asked;
  for (const bone::Criterion& criterion : of.pass) {
    asked.push_back(words_of(criterion));
  }
  return fmt::format("{}{}", fmt::join(asked, "; "),
                     of.in_a_row > 1 ? fmt::format("; {} procedures in a row", of.in_a_row) : "");
}

std::string last_of(const CurriculumCase& of, const CaseStanding& standing) {
  if (!standing.last) {
    return "–";
  }
  std::vector<std::string> values;
  for (const CheckedCriterion& each : check(of, *standing.last)) {
    values.push_back(fmt::format("{}: {}", words_of(each), each.met ? "met" : "missed"));
  }
  return fmt::format("{}", fmt::join(values, "; "));
}

std::string next_of(const Curriculum& curriculum, const ClassTrainee& trainee) {
  if (!trainee.standing.next) {
    return "every case is done";
  }
  const std::string& name = curriculum.cases[*trainee.standing.next].name;
  if (!trainee.has_session_left) {
    return fmt::format("no session is left; {} is not done", name);
  }
  const std::string why = why_next(curriculum, trainee.standing);
  return name + (why.empty() ? "" : ": " + why);
}

Rows trainee_rows(const CurriculumClass& of) {
  Rows rows;
  for (const ClassTrainee& trainee : of.trainees) {
    CurriculumStanding standing = trainee.standing;
    const std::string next = next_of(of.curriculum, trainee);
    if (!trainee.has_session_left) {
      standing.next.reset();
    }
    std::vector<std::string> row{trainee.name, trainee.group.empty() ? "–" : trainee.group};
    for (std::size_t place = 0; place < of.curriculum.cases.size(); ++place) {
      row.push_back(state_of(standing, place));
    }
    row.push_back(next);
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Trainees whose last procedure of a case misses a criterion, of those who tried it.
Rows missed_rows(const CurriculumClass& of) {
  Rows rows;
  for (std::size_t place = 0; place < of.curriculum.cases.size(); ++place) {
    const CurriculumCase& own = of.curriculum.cases[place];
    for (std::size_t i = 0; i < own.pass.size(); ++i) {
      int tried = 0, missed = 0;
      for (const ClassTrainee& trainee : of.trainees) {
        if (const auto& last = trainee.standing.cases[place].last) {
          ++tried;
          missed += check(own, *last)[i].met ? 0 : 1;
        }
      }
      rows.push_back(
          {own.name, words_of(own.pass[i]), std::to_string(tried), std::to_string(missed)});
    }
  }
  return rows;
}

}  // namespace

Curriculum with_titles(Curriculum curriculum) {
  for (CurriculumCase& each : curriculum.cases) {
    for (bone::Criterion& criterion : each.pass) {
      if (criterion.quantity != bone::kScoreQuantity) {
        const QuantityWords words = words_of_quantity(criterion.quantity);
        criterion.title = words.title;
        criterion.unit = words.unit == "1" ? "" : words.unit;
      }
    }
  }
  return curriculum;
}

std::string curriculum_section(const Curriculum& stated, const CurriculumStanding& standing,
                               bool has_session_left) {
  const Curriculum curriculum = with_titles(stated);
  CurriculumStanding shown = standing;
  if (!has_session_left) {
    shown.next.reset();
  }
  Rows rows;
  for (std::size_t place = 0; place < curriculum.cases.size(); ++place) {
    const CurriculumCase& own = curriculum.cases[place];
    rows.push_back(
        {own.name, state_of(shown, place), asked_of(own), last_of(own, standing.cases[place])});
  }
  const std::string why = why_next(curriculum, standing);
  const std::string name = standing.next ? curriculum.cases[*standing.next].name : "";
  const std::string next =
      !standing.next      ? "Every case is done."
      : !has_session_left ? fmt::format("No session is left; {} is not done.", name)
                          : fmt::format("Next: {}{}.", name, why.empty() ? "" : " (" + why + ")");
  return heading("Curriculum") + paragraph(next) +
         html_table({"case", "state", "to pass", "last procedure"}, rows);
}

std::string class_page(const CurriculumClass& stated) {
  CurriculumClass of = stated;
  of.curriculum = with_titles(of.curriculum);
  const bool simulated = std::ranges::any_of(of.trainees, &ClassTrainee::simulated);
  std::vector<std::string> names{"trainee", "group"};
  for (const CurriculumCase& each : of.curriculum.cases) {
    names.push_back(each.name);
  }
  names.emplace_back("next");
  std::string body = simulated ? banner(
                                     "SIMULATED: some trainees are programs. This page proves "
                                     "nothing about people.")
                               : "";
  body += html_table(names, trainee_rows(of));
  body += heading("What is missed") +
          paragraph(
              "Trainees who tried a case, and how many of them missed each criterion in "
              "their last procedure of it.") +
          html_table({"case", "to pass", "tried", "missed last"}, missed_rows(of));
  return whole_page("Class of " + of.name, simulated, body);
}

}  // namespace haptrial::analysis::drilling
