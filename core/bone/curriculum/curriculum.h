#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/definition/schema_forward.h"

namespace haptrial::bone {

/// A procedure passes if this quantity is at least, or at most, so much.
struct Criterion {
  std::string quantity;  // of metrics.csv without its unit, or kScoreQuantity
  bool least{true};      // else at most
  double value{0.0};     // in the quantity's unit
  std::string title{};   // of the quantity, for people; empty: its name
  std::string unit{};    // of it; empty: none, or not known
};
/// The quantity that the score of a rated study predicts (haptrial bone score).
inline constexpr const char* kScoreQuantity = "score";

/// One case of a curriculum.
struct CurriculumCase {
  std::string name;
  std::string bone;             // one of bone.bones
  std::vector<Criterion> pass;  // all of them
  int in_a_row{1};              // procedures that must pass, one after the other, >= 1
  std::string repeat{};         // earlier case that must be passed anew; empty: none
  int after{3};                 // procedures in a row that fail, until `repeat` comes >= 1
};

/// Cases in the order in which a trainee does them. Source: Morris 2006, §8.3.2.2 and §8.3.3.3.
struct Curriculum {
  std::vector<CurriculumCase> cases;  // at least one, names of their own

  /// The case of a trial by its condition, "NAME" or "NAME, hints on"; null: none.
  const CurriculumCase* case_of(std::string_view condition) const noexcept;
};

/// Reads [curriculum]; problems are noted. @param bones  of the definition
Curriculum read_curriculum(Table& table, const std::vector<std::string>& bones);

/// A procedure that a trainee did, from its start to its end.
struct CaseAttempt {
  std::string name;  // of the case
  std::string date;  // for people
  /// Values of the quantities that its case asks for; infinity: more than is measured.
  std::map<std::string, double> values{};
};

/// A criterion beside what a procedure reached.
struct CheckedCriterion {
  Criterion criterion;
  std::optional<double> value;  // nothing: the procedure has none, and so misses it
  bool met{false};
};
std::vector<CheckedCriterion> check(const CurriculumCase& of, const CaseAttempt& attempt);
bool passes(const CurriculumCase& of, const CaseAttempt& attempt);

/// How a trainee stands in one case.
struct CaseStanding {
  std::size_t attempts{0};
  std::size_t passed{0};  // of them
  int in_a_row{0};        // passed last
  bool done{false};
  std::string date{};                 // when it was done, or tried last
  std::optional<CaseAttempt> last{};  // attempt
};

/// How a trainee stands in the whole.
struct CurriculumStanding {
  std::vector<CaseStanding> cases;  // (cases)
  std::optional<std::size_t> next;  // nothing: all are done
  bool repeats{false};              // `next` comes again since a later case failed too often
};

/// Goes through a trainee's procedures in their order. A procedure of a case that is not the next
/// one counts as an attempt at its case and moves nothing on.
CurriculumStanding standing(const Curriculum& curriculum, std::span<const CaseAttempt> attempts);

/// "planned cavity removed at least 80 %".
std::string words_of(const Criterion& criterion);
/// "planned cavity removed 72.1 % (at least 80)"; "no score (at least 3)"; "bone left over facial
/// nerve beyond what is measured (at most 3)".
std::string words_of(const CheckedCriterion& checked);
/// Why a case comes: what was missed the last time, or how many passes are left; empty for a case
/// that begins.
std::string why_next(const Curriculum& curriculum, const CurriculumStanding& standing);

}  // namespace haptrial::bone
