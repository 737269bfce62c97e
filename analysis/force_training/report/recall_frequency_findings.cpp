#include "analysis/force_training/report/recall_frequency_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "analysis/document/palette.h"
#include "analysis/force_training/report/study_figures.h"
#include "analysis/statistics/design/wording.h"

namespace haptrial::analysis {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// A number of the recall: how it is called, and where it stands.
struct Shown {
  const char* name;
  const char* title;
  const char* unit;
  double scale;
  Defined<MeanInterval> RecallAtFrequency::*value;
  RecallTest RecallBand::*test;
};

constexpr std::array<Shown, 3> kShown{
    Shown{"gain", "gain", "", 1.0, &RecallAtFrequency::gain, &RecallBand::gain},
    Shown{"phase", "phase", "°", kDegrees, &RecallAtFrequency::phase, &RecallBand::phase},
    Shown{"coherence", "coherence", "", 1.0, &RecallAtFrequency::coherence,
          &RecallBand::coherence}};

Finding frequency_of(const RecallBand& band) {
  return plain_finding("frequency", "frequency", band.frequency, "Hz");
}

Finding value_finding(const Shown& shown, const RecallAtFrequency& at) {
  Finding finding{shown.name, shown.title};
  finding.unit = shown.unit;
  finding.n = at.people;
  finding.csv = shown.name;
  finding.form = JsonForm::kEstimate;
  if (const auto& value = at.*shown.value) {
    finding.value = shown.scale * value->mean;
    finding.low = shown.scale * value->low;
    finding.high = shown.scale * value->high;
  } else {
    finding.why_not = value.because();
  }
  return finding;
}

/// The frequency stands as a word, too: tables of CSV tell rows apart by words.
FindingRow frequency_row(const RecallBand& band, const RecallAtFrequency& at) {
  Finding label{"at", "", fmt::format("{:.4g} Hz", band.frequency)};
  label.form = JsonForm::kAbsent;
  FindingRow row{label, frequency_of(band), plain_finding("condition", "condition", at.condition),
                 plain_finding("participants", "participants", at.people)};
  for (const Shown& shown : kShown) {
    row.push_back(value_finding(shown, at));
  }
  row.push_back(plain_finding("chance_coherence", "coherence by chance",
                              at.trials > 0.0 ? 1.0 / at.trials : Finding::kNone));
  return row;
}

Finding test_finding(const Shown& shown, const RecallTest& test) {
  Finding finding{fmt::format("{}/p", shown.name), fmt::format("{}: p (Holm)", shown.title)};
  finding.form = JsonForm::kPlain;
  if (test.p_adjusted) {
    finding.value = *test.p_adjusted;
  } else {
    finding.why_not = test.p_adjusted.because();
  }
  return finding;
}

Finding statistic_finding(const Shown& shown, const RecallTest& test) {
  Finding finding{fmt::format("{}/test", shown.name), fmt::format("{}: test", shown.title)};
  finding.form = JsonForm::kPlain;
  if (const auto& a = test.anova) {
    finding.value = fmt::format("F({:.4g}, {:.4g}) = {:.3g}", a->epsilon * a->df_condition,
                                a->epsilon * a->df_error, a->f);
  } else {
    finding.why_not = a.because();
  }
  return finding;
}

FindingRow tests_of(const RecallBand& band) {
  FindingRow row{frequency_of(band)};
  for (const Shown& shown : kShown) {
    row.push_back(statistic_finding(shown, band.*shown.test));
    row.push_back(test_finding(shown, band.*shown.test));
  }
  return row;
}

Series series_of(const std::vector<RecallBand>& bands, std::size_t condition, const Shown& shown) {
  Series series{capitalized(bands.front().conditions[condition].condition), Mark::kLinkedBars,
                condition_look(condition)};
  for (const RecallBand& band : bands) {
    if (const auto& value = band.conditions[condition].*shown.value) {
      constexpr double kAside = 0.015;  // of the highest frequency
      series.x.push_back(band.frequency +
                         kAside * bands.back().frequency * (static_cast<double>(condition) - 1.0));
      series.y.push_back(shown.scale * value->mean);
      series.low.push_back(shown.scale * value->low);
      series.high.push_back(shown.scale * value->high);
    }
  }
  return series;
}

Figure frequency_figure(const std::vector<RecallBand>& bands, const Shown& shown, bool simulated) {
  Figure figure;
  figure.name = fmt::format("recall-{}", shown.name);
  figure.title = fmt::format("{} of the recalled force by frequency", capitalized(shown.title));
  figure.x_label = "Frequency [Hz]";
  figure.y_label = fmt::format("{}{}", capitalized(shown.title),
                               *shown.unit == '\0' ? "" : fmt::format(" [{}]", shown.unit));
  figure.caption = "Means of participants with 95 % confidence intervals over participants.";
  figure.alt = fmt::format("{} by condition:", figure.title);
  figure.simulated = simulated;
  for (std::size_t c = 0; c < bands.front().conditions.size(); ++c) {
    Series series = series_of(bands, c, shown);
    if (series.x.empty()) {
      continue;  // too few trials for this number
    }
    figure.series.push_back(std::move(series));
    for (std::size_t i = 0; i < figure.series.back().x.size(); ++i) {
      figure.alt += fmt::format("{} {} {:.3g}", i == 0 ? " " + figure.series.back().label : ",",
                                i == 0 ? "from" : "then", figure.series.back().y[i]);
    }
    figure.alt += ";";
  }
  return figure;
}

}  // namespace

FindingList recall_frequency_findings(const Defined<std::vector<RecallBand>>& frequencies,
                                      bool simulated) {
  FindingList list{"recall_by_frequency", "Recall by frequency"};
  if (!frequencies) {
    Document why;
    why.paragraph(fmt::format("Recall by frequency is not defined: {}.", frequencies.because()));
    list.blocks = why.blocks;
  }
  if (!frequencies || frequencies->empty()) {
    return list;
  }
  const std::vector<RecallBand>& bands = *frequencies;
  FindingTable values{"conditions", "Recalled against taught force by condition"};
  FindingTable tests{"tests", "Tests by condition"};
  for (const RecallBand& band : bands) {
    for (const RecallAtFrequency& at : band.conditions) {
      values.rows.push_back(frequency_row(band, at));
    }
    tests.rows.push_back(tests_of(band));
  }
  list.tables = {values};
  if (bands.front().conditions.size() > 1) {
    list.tables.push_back(tests);
  }
  for (const Shown& shown : kShown) {
    Figure figure = frequency_figure(bands, shown, simulated);
    if (!figure.series.empty()) {
      list.figures.push_back(std::move(figure));
    }
  }
  Document notes;
  notes.paragraph(
      "Frequencies are whole cycles of a run that hold at least 1 % of the power of the taught "
      "patterns. Both curves, not aligned, are taken less their means under a Hann window as long "
      "as the run; spectra are summed over a participant's trials under a condition. The gain is 1 "
      "where as much force came back as was taught, the phase is below 0 where it came late, and "
      "the coherence is the share of the recalled force that follows the taught one linearly; "
      "without any relation it would still be about one over the number of trials (by chance). "
      "Participants with one trial under a condition, or who recalled nothing at a frequency, are "
      "left out of it. Means and 95 % intervals "
      "are over participants, of the gain's logarithm and of Fisher's z of the coherence; a phase "
      "has none where participants' phases have no common direction (Rayleigh's test). Conditions "
      "are compared within participants, with the correction of Greenhouse and Geisser and Holm's "
      "adjustment over the frequencies of a column.");
  list.blocks = notes.blocks;
  return list;
}

namespace {

constexpr std::size_t kPairs = 60;  // drawn of the path

constexpr Look kTarget{palette::kOrange, palette::kSolid, 0, 2.5};
constexpr Look kApplied{palette::kGrey, palette::kShort, 0, 2.0};
constexpr Look kWarped{palette::kBlue, palette::kLong, 0, 2.5};
constexpr Look kPairing{palette::kPale, palette::kSolid, 0, 0.8};

std::vector<double> instants(const TimeBase& base) {
  std::vector<double> times(base.samples);
  for (std::size_t k = 0; k < base.samples; ++k) {
    times[k] = base.step() * static_cast<double>(k);
  }
  return times;
}

}  // namespace

Figure recall_figure(const RecallDetail& recall, const std::string& unit) {
  Figure figure;
  figure.name = "alignment";
  figure.title = "Alignment of the applied curve with the target";
  figure.x_label = "Time [s]";
  figure.y_label = unit.empty() ? "Value" : "Value [" + unit + "]";
  figure.x_range = Range{0.0, recall.time.duration};
  const std::vector<double> times = instants(recall.time);
  Series pairs{"paired samples", Mark::kSegments, kPairing};
  const std::size_t stride = std::max<std::size_t>(1, recall.path.size() / kPairs);
  for (std::size_t k = 0; k < recall.path.size(); k += stride) {
    const auto [target, applied] = recall.path[k];
    pairs.x.push_back(times[target]);
    pairs.y.push_back(recall.target[target]);
    pairs.x2.push_back(times[applied]);
    pairs.y2.push_back(recall.applied[applied]);
  }
  figure.series = {pairs,
                   {"target", Mark::kLine, kTarget, times, recall.target},
                   {"applied", Mark::kLine, kApplied, times, recall.applied},
                   {"applied, warped", Mark::kLine, kWarped, times, recall.warped}};
  figure.alt =
      "Target and applied curve over time, joined by the lines of the alignment, and the "
      "applied curve after warping.";
  return figure;
}

}  // namespace haptrial::analysis
