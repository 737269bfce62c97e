#include "protocols/psychophysics/definition/check_definition.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <string>

#include "core/base/definition/table.h"
#include "core/record/rows/trial_rows.h"

namespace haptrial::protocols {
namespace {

const char* table_of_tracks(const Table& root) {
  return root.has("procedure") ? "procedure" : "procedures";
}

std::set<std::string> factor_names(const TrialsDefinition& d) {
  std::set<std::string> names;
  for (const Factor& factor : d.order.factors) {
    names.insert(factor.name);
  }
  return names;
}

void check_track_factors(Table& root, const Track& track, const std::set<std::string>& factors) {
  for (const std::string& factor : track.by) {
    if (!factors.contains(factor)) {
      root.reject(table_of_tracks(root),
                  fmt::format("names the factor \"{}\" in `by`; allowed: {}", factor,
                              factors.empty() ? "none, the definition has no [factors]"
                                              : fmt::format("{}", fmt::join(factors, ", "))));
    }
  }
}

/// The longest name of a track with its levels in a block.
std::string longest_name(const TrialsDefinition& d, const Track& track, const Block& block) {
  std::string longest = track.name;
  for (const Factor* factor : d.varied_by(track, block)) {
    const auto size = [](const std::string& level) { return shown_level(level).size(); };
    longest += ", " + shown_level(*std::ranges::max_element(factor->levels, {}, size));
  }
  return longest;
}

/// A file tells tracks apart by name and levels, and has so much room for them. A factor to which
/// a block gives a value is no part of the name there.
void check_track_name(Table& root, const TrialsDefinition& d, const Track& track) {
  std::string longest;
  for (const Block& block : d.order.blocks) {
    const std::vector<const Track*> asked = d.tracks_in(block);
    if (std::ranges::find(asked, &track) != asked.end()) {
      longest = std::max(longest, longest_name(d, track, block),
                         [](const auto& a, const auto& b) { return a.size() < b.size(); });
    }
  }
  if (longest.size() > record::kTrialWordBytes) {
    root.reject(
        table_of_tracks(root),
        fmt::format("has a track \"{}\", which is over {} bytes long; choose shorter levels "
                    "of its factors or a shorter name",
                    longest, record::kTrialWordBytes));
  }
}

/// A word that varies is recorded whole.
void check_level_words(Table& root, const Factor& factor) {
  for (const std::string& level : factor.levels) {
    const std::string word = shown_level(level);
    if (word.size() < level.size() && word.size() > record::kTrialWordBytes) {
      root.table("factors").reject(
          factor.name, fmt::format("a list with \"{}\"", word),
          fmt::format("words of at most {} bytes", record::kTrialWordBytes));
    }
  }
}

/// A track may not set what a factor or an interval gives.
void check_track_variable(Table& root, const TrialsDefinition& d, const std::string& variable,
                          const std::set<std::string>& factors) {
  if (factors.contains(variable)) {
    root.reject(table_of_tracks(root),
                fmt::format("sets \"{}\", which is a factor; let one of the two have another name",
                            variable));
  }
  for (const Interval& interval : d.intervals) {
    if (std::ranges::find(interval.values, variable, &GivenValue::name) != interval.values.end()) {
      root.reject(table_of_tracks(root),
                  fmt::format("sets \"{}\", which the interval {} gives a value as well; "
                              "keep one of the two",
                              variable, interval.name));
    }
  }
}

void check_tracks(Table& root, const TrialsDefinition& d) {
  const std::set<std::string> factors = factor_names(d);
  std::set<std::string> names;
  for (const Track& track : d.tracks) {
    if (!names.insert(track.name).second) {
      root.reject(table_of_tracks(root),
                  fmt::format("has two tracks \"{}\"; give each a name of its own", track.name));
    }
    check_track_factors(root, track, factors);
    for (const std::string& variable : track.variables()) {
      check_track_variable(root, d, variable, factors);
    }
  }
}

/// Tracks of several procedures may set one variable only if no block asks them both.
void check_own_variables(Table& root, const Block& block, const std::vector<const Track*>& asked) {
  for (std::size_t i = 0; i < asked.size(); ++i) {
    for (std::size_t before = 0; before < i; ++before) {
      const std::vector<std::string> variables = asked[i]->variables();
      const auto shared = std::ranges::find_if(
          variables, [&](const std::string& each) { return asked[before]->sets(each); });
      if (asked[i]->procedure != asked[before]->procedure && shared != variables.end()) {
        root.reject("procedures",
                    fmt::format("set {} twice in the block {}, by {} and by {}; name the "
                                "procedures of each block (procedures = [...]), or make them "
                                "[[procedures.tracks]] of one",
                                *shared, block.name, asked[before]->name, asked[i]->name));
        return;
      }
    }
  }
}

void check_named_procedures(Table& root, const TrialsDefinition& d, const Block& block) {
  std::vector<std::string> names;
  for (const Track& track : d.tracks) {
    names.push_back(track.name);
  }
  for (const std::string& name : block.procedures) {
    const auto track = std::ranges::find(d.tracks, name, &Track::name);
    if (track == d.tracks.end()) {
      root.reject("blocks", fmt::format("names the procedure \"{}\" in the block {}; allowed: {}",
                                        name, block.name,
                                        names.empty() ? "none, the definition has no procedure"
                                                      : fmt::format("{}", fmt::join(names, ", "))));
      continue;
    }
    const auto given = std::ranges::find_if(
        block.values, [&](const GivenValue& value) { return track->sets(value.name); });
    if (given != block.values.end()) {
      root.reject("blocks", fmt::format("gives {} a value in the block {}, where {} is to set it; "
                                        "keep one of the two",
                                        given->name, block.name, name));
    }
  }
}

void check_blocks(Table& root, const TrialsDefinition& d) {
  for (const Block& block : d.order.blocks) {
    check_named_procedures(root, d, block);
    const std::vector<const Track*> asked = d.tracks_in(block);
    check_own_variables(root, block, asked);
    if (asked.empty() && block.trials == 0) {
      root.reject("blocks", fmt::format("asks no procedure in the block {}, which then needs its "
                                        "number of trials; add trials = ...",
                                        block.name));
    }
  }
}

/// A rule about a factor that no order keeps would be broken without a word.
void check_run_limits(Table& root, const TrialsDefinition& d) {
  for (const RunLimit& limit : d.order.most_in_a_row) {
    if (limit.factor.empty()) {
      continue;
    }
    if (!factor_names(d).contains(limit.factor)) {
      root.reject("design", fmt::format("names the factor \"{}\" in most_in_a_row; allowed: {}",
                                        limit.factor, fmt::join(factor_names(d), ", ")));
    }
    for (const Track& track : d.tracks) {
      if (std::ranges::find(track.by, limit.factor) == track.by.end()) {
        root.reject("design", fmt::format("limits {} in a row, but {} does not go by it, so that "
                                          "its levels come in cycles; add it to `by`, or leave it "
                                          "out of most_in_a_row",
                                          limit.factor, track.name));
        break;
      }
    }
  }
}

/// A track that settles where guessing leads would go nowhere.
void check_balance(Table& root, const Track& track, const TrialQuestion& question) {
  const double guess = 1.0 / static_cast<double>(question.choices.size());
  if (track.balance && *track.balance <= guess) {
    root.reject(table_of_tracks(root),
                fmt::format("is in balance at {:.3g} % right answers (\"{}\"), which guessing "
                            "gives; let more right answers make a step down, or steps up be "
                            "larger",
                            100.0 * *track.balance, track.name));
  }
}

/// Whether the first measure says which trials are right, for trials in which nothing is asked.
bool has_judged_measure(Table& root) {
  if (!root.has("measures")) {
    return false;
  }
  Table measures = root.table("measures");
  const std::vector<std::string> names = measures.keys_as_written();
  return !names.empty() && measures.table(names.front()).has("within");
}

/// Checks the answers that a track learns from, and the best that it could learn.
void check_learning(Table& root, const TrialsDefinition& d, const Track& track) {
  if (!track.counts.empty()) {
    return;
  }
  if (track.learns_from == psychometric::OutcomeForm::kAdjustment) {
    root.reject(table_of_tracks(root),
                fmt::format("does not say which answer raises the level (\"{}\"); add "
                            "`counts`, a formula that is 1, -1 or 0: \"$answer == 1 ? 1 "
                            ": $answer == 2 ? -1 : 0\"",
                            track.name));
  } else if (d.questions.empty() && has_judged_measure(root)) {
    return;
  } else if (d.questions.empty() || d.questions.front().correct.empty()) {
    root.reject(table_of_tracks(root),
                fmt::format("learns from right answers (\"{}\"), and no response says which "
                            "is right; add `correct` to [response], `within` to the first of "
                            "[measures] where nothing is asked, or `counts` to the procedure",
                            track.name));
  } else {
    check_balance(root, track, d.questions.front());
  }
}

/// The variables of the tracks of a block that some of them do not set.
std::set<std::string> set_by_some(const std::vector<const Track*>& asked) {
  std::set<std::string> some;
  for (const Track* track : asked) {
    for (const std::string& variable : track->variables()) {
      if (!std::ranges::all_of(asked, [&](const Track* each) { return each->sets(variable); })) {
        some.insert(variable);
      }
    }
  }
  return some;
}

/// In the trials of one procedure the variables of the others have what [variables] says.
void check_variables(Table& root, const TrialsDefinition& d) {
  if (!root.has("procedures")) {
    return;
  }
  std::set<std::string> variables;
  for (const Block& block : d.order.blocks) {
    variables.merge(set_by_some(d.tracks_in(block)));
  }
  Table stated = root.has("variables") ? root.table("variables") : root;
  for (const std::string& variable : variables) {
    if (!root.has("variables") || !stated.has(variable)) {
      root.reject("procedures",
                  fmt::format("set {} in some trials only; add its value in the others to "
                              "[variables]",
                              variable));
    }
  }
}

void check_seen_objects(Table& root, const TrialsDefinition& d,
                        const std::vector<NamedStage>& stages) {
  for (const NamedStage& stage : stages) {
    const auto seen = std::ranges::count_if(stage.show, [&](const std::string& name) {
      return std::ranges::find(d.objects, name, &TrialObject::name) != d.objects.end();
    });
    if (seen > static_cast<std::ptrdiff_t>(kMostSeenObjects)) {
      root.reject("stages", fmt::format("show {} objects in the stage \"{}\"; show at most {}",
                                        seen, stage.name, kMostSeenObjects));
    }
  }
}

void check_questions(Table& root, const TrialsDefinition& d,
                     const std::vector<NamedStage>& stages) {
  for (const TrialQuestion& question : d.questions) {
    const auto named = [&](const NamedStage& stage) { return stage.name == question.onset; };
    if (!question.onset.empty() && std::none_of(stages.begin(), stages.end(), named)) {
      root.reject(root.has("response") ? "response" : "responses",
                  fmt::format("counts the reaction from the stage \"{}\", which is not there",
                              question.onset));
    }
  }
}

void check_mark(Table& table, const TrialsDefinition& d, const MarkMeans& mark) {
  constexpr double kMostOfScreen = 0.8;  // beside it stand the words of the ends
  const double fits = kMostOfScreen * d.view.width;
  const double reached = 2.0 * d.envelope.workspace_radius;
  const char* key = table.has("length") ? "length" : "by";
  if (mark.length > fits) {
    table.reject(key, fmt::format("a line of {:g} m", mark.length),
                 fmt::format("at most {:g} m, {:g} of display.extent; state a shorter length", fits,
                             kMostOfScreen));
  } else if (mark.by == MarkedBy::kHand && mark.length > reached) {
    table.reject(key, fmt::format("a line of {:g} m", mark.length),
                 fmt::format("at most {:g} m, which the hand reaches within "
                             "envelope.workspace_radius; state a shorter length",
                             reached));
  }
  if (mark.by == MarkedBy::kMouse && d.view.stereo) {
    table.reject("by", "\"mouse\" with display.stereo, where no pointer is on the line",
                 "\"hand\" or \"keys\"");
  }
}

/// Masking noise in stages that are not there would never be heard.
void check_masking(Table& root, const TrialsDefinition& d) {
  if (!d.cues.masking) {
    return;
  }
  for (const std::string& stage : d.cues.masking->stages) {
    if (std::ranges::find(d.stages, stage) == d.stages.end()) {
      root.reject("sounds", fmt::format("masking names the stage \"{}\"; allowed: {}", stage,
                                        fmt::join(d.stages, ", ")));
    }
  }
}

}  // namespace

void check_procedures(Table& root, const TrialsDefinition& d) {
  check_tracks(root, d);
  check_blocks(root, d);
  check_run_limits(root, d);
  for (const Track& track : d.tracks) {
    check_learning(root, d, track);
  }
  check_variables(root, d);
}

std::vector<std::string> TrialsDefinition::block_names() const {
  std::vector<std::string> names;
  for (const Block& block : order.blocks) {
    names.push_back(block.name);
  }
  return names;
}

void TrialsDefinition::check_new_session(Table& root) const {
  for (const Factor& factor : order.factors) {
    check_level_words(root, factor);
  }
  for (const Track& track : tracks) {
    check_track_name(root, *this, track);
  }
}

/// The name of a measure has its value after the trial alone.
void check_measure_names(Table& root, const TrialsDefinition& d) {
  const std::set<std::string> factors = factor_names(d);
  for (const Measure& measure : d.measures) {
    const bool asked =
        std::ranges::find(d.questions, measure.name, &TrialQuestion::name) != d.questions.end();
    const bool set =
        std::ranges::any_of(d.tracks, [&](const Track& track) { return track.sets(measure.name); });
    const bool stated = root.has("variables") && root.table("variables").has(measure.name);
    if (asked || set || stated || factors.contains(measure.name)) {
      root.table("measures")
          .reject(measure.name,
                  "is the name of a response, a factor, a variable or what a procedure sets, "
                  "too; give the measure another name");
    }
  }
}

void check_stages(Table& root, const TrialsDefinition& d, const std::vector<NamedStage>& stages) {
  check_measure_names(root, d);
  check_seen_objects(root, d, stages);
  check_questions(root, d, stages);
  check_masking(root, d);
}

void check_marks(Table& root, const TrialsDefinition& d) {
  std::vector<Table> tables;
  if (root.has("response")) {
    tables.push_back(root.table("response"));
  } else if (root.has("responses")) {
    tables = root.tables("responses");
  }
  for (std::size_t i = 0; i < std::min(tables.size(), d.questions.size()); ++i) {
    if (d.questions[i].mark.by != MarkedBy::kKeys) {
      check_mark(tables[i], d, d.questions[i].mark);
    }
  }
}

void check_object_names(Table& root) {
  Table objects = root.table("objects");
  for (const char* other : {"fields", "regions", "looks"}) {
    const std::vector<std::string> taken =
        root.has(other) ? root.table(other).keys() : std::vector<std::string>{};
    for (const std::string& name : objects.keys_as_written()) {
      if (std::ranges::find(taken, name) != taken.end()) {
        objects.reject(name, fmt::format("is the name of a table of [{}] as well; give one of the "
                                         "two another name",
                                         other));
      }
    }
  }
}

}  // namespace haptrial::protocols
