#include "core/bone/curriculum/curriculum.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptrial::bone {
namespace {

std::size_t place_of(const Curriculum& curriculum, std::string_view name) {
  const auto at = std::ranges::find(curriculum.cases, name, &CurriculumCase::name);
  return static_cast<std::size_t>(at - curriculum.cases.begin());
}

/// Goes along with a trainee.
class Walk {
 public:
  explicit Walk(const Curriculum& curriculum) : curriculum_(curriculum) {
    found_.cases.resize(curriculum.cases.size());
    found_.next = 0;
    failed_.resize(curriculum.cases.size());
  }

  void add(const CaseAttempt& attempt) {
    const std::size_t place = place_of(curriculum_, attempt.name);
    if (place == curriculum_.cases.size()) {
      return;  // of a case that the curriculum no longer has
    }
    const bool passed = note(place, attempt);
    if (found_.next != place) {
      return;
    }
    passed ? pass(place) : fail(place);
  }

  CurriculumStanding found() { return std::move(found_); }

 private:
  bool note(std::size_t place, const CaseAttempt& attempt) {
    CaseStanding& own = found_.cases[place];
    const bool passed = passes(curriculum_.cases[place], attempt);
    ++own.attempts;
    own.passed += passed ? 1 : 0;
    own.last = attempt;
    own.date = own.done ? own.date : attempt.date;
    return passed;
  }

  void pass(std::size_t place) {
    CaseStanding& own = found_.cases[place];
    failed_[place] = 0;
    if (++own.in_a_row >= curriculum_.cases[place].in_a_row) {
      own.done = true;
      found_.repeats = false;
      const auto open = std::ranges::find(found_.cases, false, &CaseStanding::done);
      found_.next = open == found_.cases.end()
                        ? std::nullopt
                        : std::optional(static_cast<std::size_t>(open - found_.cases.begin()));
    }
  }

  void fail(std::size_t place) {
    const CurriculumCase& of = curriculum_.cases[place];
    found_.cases[place].in_a_row = 0;
    if (++failed_[place] >= of.after && !of.repeat.empty()) {
      failed_[place] = 0;
      const std::size_t again = place_of(curriculum_, of.repeat);
      found_.cases[again].done = false;
      found_.cases[again].in_a_row = 0;
      found_.next = again;
      found_.repeats = true;
    }
  }

  const Curriculum& curriculum_;
  CurriculumStanding found_;
  std::vector<int> failed_;  // (cases) in a row
};

}  // namespace

const CurriculumCase* Curriculum::case_of(std::string_view condition) const noexcept {
  const auto at =
      std::ranges::find(cases, condition.substr(0, condition.find(", ")), &CurriculumCase::name);
  return at != cases.end() ? &*at : nullptr;
}

std::vector<CheckedCriterion> check(const CurriculumCase& of, const CaseAttempt& attempt) {
  std::vector<CheckedCriterion> all;
  for (const Criterion& criterion : of.pass) {
    CheckedCriterion checked{criterion, std::nullopt, false};
    if (const auto at = attempt.values.find(criterion.quantity); at != attempt.values.end()) {
      checked.value = at->second;
      checked.met = criterion.least ? at->second >= criterion.value : at->second <= criterion.value;
    }
    all.push_back(std::move(checked));
  }
  return all;
}

bool passes(const CurriculumCase& of, const CaseAttempt& attempt) {
  return std::ranges::all_of(check(of, attempt), &CheckedCriterion::met);
}

CurriculumStanding standing(const Curriculum& curriculum, std::span<const CaseAttempt> attempts) {
  Walk walk(curriculum);
  for (const CaseAttempt& attempt : attempts) {
    walk.add(attempt);
  }
  return walk.found();
}

namespace {

std::string wanted(const Criterion& c) {
  return fmt::format("{} {:g}", c.least ? "at least" : "at most", c.value);
}

const std::string& title_of(const Criterion& c) { return c.title.empty() ? c.quantity : c.title; }

std::string unit_of(const Criterion& c) { return c.unit.empty() ? "" : " " + c.unit; }

}  // namespace

std::string words_of(const Criterion& c) {
  return fmt::format("{} {}{}", title_of(c), wanted(c), unit_of(c));
}

std::string words_of(const CheckedCriterion& checked) {
  const Criterion& c = checked.criterion;
  if (checked.value && std::isinf(*checked.value)) {
    return fmt::format("{} beyond what is measured ({})", title_of(c), wanted(c));
  }
  return checked.value
             ? fmt::format("{} {:.4g}{} ({})", title_of(c), *checked.value, unit_of(c), wanted(c))
             : fmt::format("no {} ({})", title_of(c), wanted(c));
}

std::string why_next(const Curriculum& curriculum, const CurriculumStanding& standing) {
  if (!standing.next) {
    return "";
  }
  const CurriculumCase& of = curriculum.cases[*standing.next];
  const CaseStanding& own = standing.cases[*standing.next];
  if (standing.repeats && own.in_a_row == 0) {
    return "again, since a later case was missed too often";
  }
  if (!own.last) {
    return "";
  }
  std::vector<std::string> missed;
  for (const CheckedCriterion& each : check(of, *own.last)) {
    if (!each.met) {
      missed.push_back(words_of(each));
    }
  }
  return missed.empty() ? fmt::format("passed {} of {} in a row", own.in_a_row, of.in_a_row)
                        : fmt::format("missed last: {}", fmt::join(missed, "; "));
}

}  // namespace haptrial::bone
