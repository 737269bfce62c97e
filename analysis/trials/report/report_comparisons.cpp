#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "analysis/statistics/words/wording.h"
#include "analysis/trials/report/trials_report.h"
#include "analysis/trials/report/trials_words.h"

namespace haptrial::analysis::trials {
namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr std::size_t kMostTracks = 4;

std::string sides_of(const SideTest& test) {
  return test.sides.tail == Tail::kTwoSided ? test.sides.a + " and " + test.sides.b
                                            : text_of(test.sides);
}

void add_family(Document& document, const TestFamily& family) {
  Rows rows;
  for (const SideTest& test : family.tests) {
    rows.push_back(
        {sides_of(test),
         test.paired ? counted(test.count_a, "pair")
                     : fmt::format("{} and {}", test.count_a, test.count_b),
         test.t ? fmt::format("{} [{}, {}]", number(test.t->difference), number(test.t->low),
                              number(test.t->high))
                : "–",
         test.t ? (test.paired ? "paired " : "Welch's ") + t_result(test.t) : t_result(test.t),
         p_result(test.holm), effect(test.size), p_result(test.ranks_holm),
         p_result(test.permutation_holm)});
  }
  if (!rows.empty()) {
    document.table(
        {capitalized(family.name), "participants", "difference [95 %]", "t-test, not adjusted",
         "p after Holm", "d_z or d", "ranks, p after Holm", "permutation, p after Holm"},
        rows);
  }
}

void add_quantity(Document& document, const Quantity& q) {
  document.subheading(capitalized(q.title));
  document.paragraph(fmt::format("Varied {}.{}", q.tests.design,
                                 q.unit.empty() ? "" : " Differences are in " + q.unit + "."));
  Rows rows;
  for (const auto& effect : q.tests.effects) {
    if (effect) {
      rows.push_back({effect->factor, effect_result(*effect)});
    } else {
      document.paragraph("Whether conditions differ is not defined, because " + effect.because() +
                         ".");
    }
  }
  if (!rows.empty()) {
    document.table({"effect", "test"}, rows);
  }
  if (q.table.factors.size() == 1) {
    document.paragraph(fmt::format("On ranks ({}): {}.",
                                   q.table.factors[0].within ? "Friedman" : "Kruskal–Wallis",
                                   rank_result(q.tests.ranks)));
  }
  if (!q.tests.incomplete.empty()) {
    document.paragraph(fmt::format("Left out for lack of a value in some condition: {}.",
                                   fmt::join(q.tests.incomplete, ", ")));
  }
  add_family(document, q.tests.planned);
  for (const TestFamily& family : q.tests.families) {
    add_family(document, family);
  }
}

void add_tracks(Document& document, const TrialsResult& result,
                const std::vector<Drawing>& drawings) {
  if (result.tracks.empty()) {
    return;
  }
  add_section(document, result, "Tracks of the procedure");
  add_pictures(document, drawings, "tracks-", kMostTracks);
  Rows rows;
  for (const TrackEstimate& track : result.tracks) {
    std::vector<std::string> estimates;
    for (const auto& e : track.estimates) {
      estimates.push_back(fmt::format("{} {}{}", e.name, number(e.value),
                                      e.deviation ? " ± " + number(*e.deviation) : ""));
    }
    const auto reversals = std::count_if(track.steps.begin(), track.steps.end(),
                                         [](const TrackStep& step) { return step.reversal; });
    rows.push_back({track.participant, track.track, std::to_string(track.steps.size()),
                    std::to_string(reversals),
                    estimates.empty() ? "none: " + track.because
                                      : fmt::format("{}", fmt::join(estimates, "; "))});
  }
  document.table({"participant", "track", "trials", "turns", "estimate of the procedure"}, rows,
                 "Every track");
}

void add_serial(Document& document, const TrialsResult& result) {
  if (result.serial.empty()) {
    return;
  }
  Rows rows;
  for (const SerialEffects& s : result.serial) {
    rows.push_back({s.participant, fmt::format("{} of {}", s.easy_wrong, s.easy),
                    s.drift ? number(*s.drift) : "–", s.repetition ? number(*s.repetition) : "–",
                    std::to_string(s.limited)});
  }
  document.table({"participant", "answers 0 where the function is above 99 %",
                  "drift (log odds, first to last trial)", "repetition (log odds)",
                  "trials with another level than asked for"},
                 rows);
  document.paragraph(fmt::format(
      "Drift: how the log odds of an answer 1 change over the session beside the function. "
      "Repetition: how much the answer before moves the log odds of giving it again. Over "
      "participants against 0: drift {}; repetition {}.",
      t_result(result.drift), t_result(result.repetition)));
}

}  // namespace

void add_comparisons(Document& document, const TrialsResult& result) {
  const bool any = std::any_of(result.quantities.begin(), result.quantities.end(),
                               [](const Quantity& q) { return q.compared; });
  if (!any) {
    return;
  }
  add_section(document, result, "Comparison of conditions");
  for (const Quantity& q : result.quantities) {
    if (q.compared) {
      add_quantity(document, q);
    }
  }
}

/// How soon those who listened were told what began.
static void add_markers(Document& document, const TrialsResult& result) {
  std::vector<std::string> sentences;
  for (const markers::MarkerTimes& times : result.data.markers.times()) {
    sentences.push_back(sentence_of(times));
  }
  if (!sentences.empty()) {
    document.paragraph(fmt::format("Markers: {}.", fmt::join(sentences, "; ")));
  }
}

void add_trial_quality(Document& document, const TrialsResult& result,
                       const std::vector<Drawing>& drawings) {
  add_tracks(document, result, drawings);
  add_section(document, result, "Quality");
  add_serial(document, result);
  add_reach_quality(document, result);
  std::vector<std::string> limited;
  for (const ParticipantTrials& p : result.participants) {
    if (p.saturated > 0.0) {
      limited.push_back(fmt::format("{} in {} of the trials", p.participant, percent(p.saturated)));
    }
  }
  document.paragraph(limited.empty() ? std::string("The device never came to its force limit.")
                                     : fmt::format("The force limit was reached by {}.",
                                                   fmt::join(limited, ", ")));
  add_markers(document, result);
  add_pictures(document, drawings, "reaction-times", 1);
}

}  // namespace haptrial::analysis::trials
