#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/psychophysics/data/page_scores.h"
#include "analysis/psychophysics/fit/function_fit.h"
#include "analysis/psychophysics/fit/reaching_study.h"
#include "analysis/psychophysics/fit/serial.h"
#include "analysis/psychophysics/fit/surface_study.h"
#include "analysis/psychophysics/fit/track_estimate.h"
#include "analysis/psychophysics/study/cue_study.h"
#include "analysis/psychophysics/study/detected.h"
#include "analysis/psychophysics/study/magnitudes.h"
#include "analysis/psychophysics/study/population.h"
#include "analysis/psychophysics/study/quantity.h"
#include "analysis/psychophysics/study/timed.h"
#include "analysis/psychophysics/study/unused_trials.h"

namespace haptrial::analysis::trials {

/// How the trials of one participant went, whatever was asked.
struct ParticipantTrials {
  std::string participant;
  std::string group;
  std::size_t sessions{0};
  std::size_t planned{0};  // trials, at most; 0: the files do not say it
  std::size_t counted{0};
  std::size_t practice{0};
  std::size_t aborted{0};                                           // or damaged passes
  Defined<double> reaction_time{Undefined{"it was not measured"}};  // median [s]
  /// Share of the counted trials that reached the force limit, by stage.
  std::map<std::string, double> at_limit;
};

/// Results of a study's sessions.
struct TrialsResult {
  std::string title;
  TrialsPlan plan;
  TrialsData data;
  std::vector<ParticipantTrials> participants;  // by name
  std::vector<UnusedTrials> unused;             // trials that enter no estimate
  std::vector<AnsweredSeries> series;           // whose functions are fitted
  std::vector<FunctionFit> fits;                // (series)
  std::vector<SurfaceCondition> surfaces;       // functions of several variables
  std::vector<TrackEstimate> tracks;
  std::vector<SerialEffects> serial;
  Defined<TTest> drift{Undefined{"nothing was fitted"}};  // mean over participants against 0
  Defined<TTest> repetition{Undefined{"nothing was fitted"}};
  Defined<PopulationModel> population{Undefined{"nothing was fitted"}};
  std::optional<Defined<HierarchicalFunctions>> hierarchical;  // if the plan asks for them
  std::vector<DetectedCondition> detected;
  std::vector<IdentifiedCondition> identified;
  std::vector<MagnitudeCondition> magnitudes;
  std::vector<TimedCondition> timed;
  std::vector<Quantity> quantities;  // what is compared over participants
  std::optional<CueStudy> cues;      // if the plan asks for them
  std::optional<ReachingResult> reaching;
  std::vector<PageScore> page_scores;  // of questionnaires
  std::vector<std::string> remarks;    // sentences about the files, for the report
  std::string definition, definition_name;

  bool simulated() const { return data.simulated(); }
};

/// Every test that the report prints with a p value, by name.
std::vector<NamedTest> tests_of(const TrialsResult& result);

}  // namespace haptrial::analysis::trials
