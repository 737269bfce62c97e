#include "analysis/psychophysics/exchange/imported_definition.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

#include "analysis/psychophysics/exchange/trial_columns.h"
#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/base/toml_text.h"

namespace haptrial::analysis::trials {
namespace {

constexpr std::size_t kMostChoices = 64;

/// The kinds that need nothing but columns; others need procedures, items or movements, which a
/// definition of one's own states.
const std::vector<std::string>& column_kinds() {
  static const std::vector<std::string> kinds{"psychometric", "detection", "identification",
                                              "magnitude",    "times",     "none"};
  return kinds;
}

std::string kind_of(const ImportedStudy& study, const ImportedAnalysis& analysis) {
  const TrialColumns& columns = study.columns;
  if (!analysis.kind.empty()) {
    if (std::ranges::find(column_kinds(), analysis.kind) == column_kinds().end()) {
      throw InputError(
          not_allowed("--kind", fmt::format("'{}'", analysis.kind), column_kinds()) +
          "; a kind that needs more than columns is stated by a definition, for --definition");
    }
    return analysis.kind;
  }
  const bool judged = !columns.correct.empty() || !analysis.yes.empty();
  if (!columns.level.empty() && !judged && !columns.answer.empty()) {
    throw InputError(fmt::format(
        "no column says whether answers are right; add --column correct=COLUMN, or --yes ANSWER "
        "for the answer that counts 1; allowed: {}",
        fmt::join(answers_of(study), ", ")));
  }
  return !columns.level.empty() && judged ? "psychometric"
         : !columns.time.empty()          ? "times"
                                          : "none";
}

/// The words of a factor in a definition: numbers, or quoted words.
/// @throws InputError if it has one level
std::string factor_levels(const ImportedStudy& study, std::size_t factor) {
  std::set<double> numbers;
  std::set<std::string> words;
  for (const ImportedTrial& trial : study.trials) {
    const ImportedValue& value = trial.factors[factor];
    value.word.empty() ? static_cast<void>(numbers.insert(value.number))
                       : static_cast<void>(words.insert(toml_text(value.word)));
  }
  const std::string levels = words.empty() ? fmt::format("{}", fmt::join(numbers, ", "))
                                           : fmt::format("{}", fmt::join(words, ", "));
  if (std::max(words.size(), numbers.size()) < 2) {
    const std::string& column = study.columns.factors[factor].column;
    throw InputError(
        fmt::format("{}: the column {} has one level, {}; allowed: two or more levels of a factor",
                    study.sources.front().name, column, levels));
  }
  return levels;
}

std::string factors_table(const ImportedStudy& study) {
  if (study.columns.factors.empty()) {
    return "";
  }
  std::string text = "\n[factors]\n";
  for (std::size_t i = 0; i < study.columns.factors.size(); ++i) {
    text += fmt::format("{} = [{}]\n", study.columns.factors[i].variable, factor_levels(study, i));
  }
  return text;
}

std::string choices_of(const std::vector<std::string>& words) {
  std::vector<std::string> entries;
  for (const std::string& word : words) {
    entries.push_back(fmt::format("  {{ value = {} }},\n", toml_text(word)));
  }
  return fmt::format("choices = [\n{}]\n", fmt::join(entries, ""));
}

std::string first_response(const ImportedStudy& study, const std::string& kind) {
  const std::vector<std::string> answers = answers_of(study);
  if (answers.empty() && study.columns.time.empty()) {
    return "";
  }
  std::string text =
      fmt::format("\n[[responses]]\nname = \"{0}\"\nquestion = \"{0}\"\n", kImportedAnswer);
  if (kind == "magnitude" || answers.empty()) {
    const auto word = std::ranges::find_if_not(
        answers, [](const std::string& each) { return number_in(each).has_value(); });
    if (word != answers.end()) {
      throw InputError(fmt::format("{} has the answer '{}'; allowed: numbers, as --kind {} needs",
                                   study.columns.answer, *word, kind));
    }
    return text + "number = [-1000000000.0, 1000000000.0]\n";
  }
  if (answers.size() > kMostChoices) {
    throw InputError(
        fmt::format("{} has {} different answers; allowed: at most {} choices, or numbers with "
                    "--kind magnitude",
                    study.columns.answer, answers.size(), kMostChoices));
  }
  return text + choices_of(answers.size() == 1 ? std::vector<std::string>{answers.front(), "other"}
                                               : answers);
}

/// A second question of whole numbers in the table's range.
std::string rating_response(const ImportedStudy& study) {
  if (study.columns.rating.empty()) {
    return "";
  }
  int low = 0, high = 0;
  bool first = true;
  for (const ImportedTrial& trial : study.trials) {
    if (trial.rating.empty()) {
      continue;
    }
    int value = 0;
    const char* end = trial.rating.data() + trial.rating.size();
    const auto [at, error] = std::from_chars(trial.rating.data(), end, value);
    if (error != std::errc() || at != end) {
      throw InputError(fmt::format("{}:{}: {} is '{}'; allowed: a whole number",
                                   study.sources[trial.source].name, trial.line,
                                   study.columns.rating, trial.rating));
    }
    low = first ? value : std::min(low, value);
    high = first ? value : std::max(high, value);
    first = false;
  }
  return fmt::format("\n[[responses]]\nname = \"{0}\"\nquestion = \"{0}\"\nscale = [{1}, {2}]\n",
                     kImportedRating, low, std::max(high, low + 1));
}

/// The factor that says which stimulus was presented: the first whose levels are answers, else the
/// first; the number of factors if there is none.
std::size_t stimulus_of(const ImportedStudy& study) {
  const std::vector<std::string> answers = answers_of(study);
  const std::size_t factors = study.columns.factors.size();
  for (std::size_t factor = 0; factor < factors; ++factor) {
    if (std::ranges::all_of(study.trials, [&](const ImportedTrial& trial) {
          const ImportedValue& value = trial.factors[factor];
          const std::string word =
              value.word.empty() ? fmt::format("{}", value.number) : value.word;
          return std::ranges::find(answers, word) != answers.end();
        })) {
      return factor;
    }
  }
  return 0;
}

/// The keys of factors for kinds that compare none by themselves.
std::string factor_lines(const ImportedStudy& study, const std::string& kind) {
  const bool identifies = kind == "identification";
  const bool by_itself =
      !identifies && kind != "detection" && (kind != "times" || study.columns.level.empty());
  if (study.columns.factors.empty() || by_itself) {
    return "";
  }
  const std::size_t stimulus = identifies ? stimulus_of(study) : study.columns.factors.size();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < study.columns.factors.size(); ++i) {
    if (i != stimulus) {
      names.push_back(toml_text(study.columns.factors[i].variable));
    }
  }
  return (identifies
              ? fmt::format("stimulus = {}\n", toml_text(study.columns.factors[stimulus].variable))
              : std::string()) +
         (names.empty() ? std::string() : fmt::format("by = [{}]\n", fmt::join(names, ", ")));
}

/// @throws InputError if answers do not say whether there was a signal
void check_signal_word(const ImportedStudy& study, const ImportedAnalysis& analysis) {
  const std::vector<std::string> answers = answers_of(study);
  if (study.columns.answer.empty()) {
    throw InputError(
        "no column has the answers, which --kind detection counts; add --column answer=COLUMN");
  }
  if (analysis.yes.empty() && std::ranges::find(answers, "yes") == answers.end()) {
    throw InputError(fmt::format(
        "--yes is missing, and no answer is 'yes'; add the one that says that there was a signal; "
        "allowed: {}",
        fmt::join(answers, ", ")));
  }
}

/// Whether the distance of two stimuli depends on how many of them a trial presented.
bool identifies_two(const ImportedStudy& study, const std::string& kind) {
  const std::size_t answers = answers_of(study).size();
  return kind == "identification" && answers > 0 && answers <= 2;
}

std::string analysis_table(const ImportedStudy& study, const ImportedAnalysis& analysis,
                           const std::string& kind) {
  std::string text = fmt::format("\n[analysis]\nkind = {}\n", toml_text(kind));
  if (!study.columns.level.empty()) {
    text += fmt::format("level = \"{}\"\n", kImportedLevel);
  }
  if (!analysis.yes.empty()) {
    text += fmt::format("yes = {}\n", toml_text(analysis.yes));
  }
  text += factor_lines(study, kind);
  if (identifies_two(study, kind)) {
    text += "task = \"one interval\"  # \"forced choice\" if a trial presented both stimuli\n";
  }
  if (kind != "psychometric") {
    return text;
  }
  if (analysis.guess) {
    text += fmt::format("guess = {}\n", *analysis.guess);
  } else if (analysis.yes.empty() && study.columns.answer.empty()) {
    throw InputError(
        "no column has the answers, so that nobody knows how often guessing is right; add --guess "
        "RATE, as 0.5 of two alternatives");
  } else if (const std::size_t answers = answers_of(study).size();
             analysis.yes.empty() && answers > 1) {
    text += fmt::format("guess = {}\n", 1.0 / static_cast<double>(answers));
  }
  return text;
}

/// The most trials that a session has.
std::size_t most_trials(const ImportedStudy& study) {
  std::map<std::pair<std::string, int>, std::size_t> counts;
  std::size_t most = 0;
  for (const ImportedTrial& trial : study.trials) {
    most = std::max(most, ++counts[{trial.participant, trial.session}]);
  }
  return most;
}

std::string design_table(const ImportedStudy& study) {
  std::set<std::string> people;
  int sessions = 1;
  for (const ImportedTrial& trial : study.trials) {
    people.insert(trial.participant);
    sessions = std::max(sessions, trial.session);
  }
  std::string text = fmt::format("\n[design]\nparticipants = {}\n", people.size());
  return sessions > 1 ? text + fmt::format("sessions = {}\n", sessions) : text;
}

}  // namespace

std::string answer_word(const ImportedStudy& study, const ImportedTrial& trial) {
  if (!study.columns.answer.empty()) {
    return trial.answer;
  }
  return trial.correct < 0 ? "" : trial.correct == 1 ? "right" : "wrong";
}

std::vector<std::string> answers_of(const ImportedStudy& study) {
  std::set<std::string> answers;
  if (study.columns.answer.empty() && !study.columns.correct.empty()) {
    answers = {"right", "wrong"};
  }
  for (const ImportedTrial& trial : study.trials) {
    answers.insert(answer_word(study, trial));
  }
  answers.erase("");
  return {answers.begin(), answers.end()};
}

std::string guess_note(const ImportedStudy& study, const ImportedAnalysis& analysis) {
  const bool of_answers = !analysis.guess && analysis.yes.empty() && !study.columns.answer.empty();
  if (!of_answers || kind_of(study, analysis) != "psychometric") {
    return "";
  }
  std::map<std::string, std::size_t> counts;
  for (const ImportedTrial& trial : study.trials) {
    ++counts[trial.answer];
  }
  counts.erase("");
  if (counts.size() < 2) {
    return "";
  }
  std::vector<std::string> answers;
  for (const auto& [answer, count] : counts) {
    answers.push_back(fmt::format("{} ({})", answer, count));
  }
  return fmt::format("guess rate {:.3g}, one in the {} answers {}; --guess RATE states another",
                     1.0 / static_cast<double>(counts.size()), counts.size(),
                     fmt::join(answers, ", "));
}

std::string task_note(const ImportedStudy& study, const ImportedAnalysis& analysis) {
  if (!identifies_two(study, kind_of(study, analysis))) {
    return "";
  }
  return "task \"one interval\": d' is that of one of two stimuli in each trial; if a trial "
         "presented both, state task = \"forced choice\" in study.toml, whose d' is 1.41 times "
         "smaller, and import again with --definition";
}

std::string imported_definition(const ImportedStudy& study, const ImportedAnalysis& analysis) {
  const std::string kind = kind_of(study, analysis);
  if (const auto answers = answers_of(study);
      !analysis.yes.empty() && std::ranges::find(answers, analysis.yes) == answers.end()) {
    throw InputError(fmt::format("--yes is '{}', which is no answer; allowed: {}", analysis.yes,
                                 fmt::join(answers, ", ")));
  }
  if (kind == "detection") {
    check_signal_word(study, analysis);
  }
  std::string text = fmt::format(
      "# Trials that another program presented and `haptrial import` read from {}.\n"
      "# They are analysed as [analysis] says; after a change, import them again with\n"
      "# --definition.\n\n"
      "[experiment]\nprotocol = \"trials\"\nname = {}\n",
      study.columns.origin == TableOrigin::kPlain
          ? "a table"
          : fmt::format("a table of {}", name_of(study.columns.origin)),
      toml_text(analysis.name));
  text += design_table(study);
  if (!study.columns.level.empty()) {
    text += fmt::format("\n[variables]\n{} = 0.0  # of each trial\n", kImportedLevel);
  }
  text += factors_table(study);
  text += fmt::format("\n[[blocks]]\nname = \"trials\"\ntrials = {}\n", most_trials(study));
  text += "\n[[stages]]\nname = \"presented\"\nuntil = { time = 0.0 }\n";
  return text + first_response(study, kind) + rating_response(study) +
         analysis_table(study, analysis, kind);
}

}  // namespace haptrial::analysis::trials
