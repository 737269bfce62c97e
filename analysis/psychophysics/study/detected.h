#pragma once

#include <string>
#include <utility>
#include <vector>

#include "analysis/psychometric/models/detection.h"
#include "analysis/psychometric/models/meta_d.h"
#include "analysis/psychometric/models/rating.h"
#include "analysis/psychophysics/data/trials_data.h"
#include "analysis/psychophysics/fit/trials_plan.h"

namespace haptrial::analysis::trials {

/// Detections of a participant under a condition.
struct DetectedCondition {
  std::string participant;
  std::vector<std::string> levels;  // of the plan's factors
  std::string condition;
  DetectionCounts counts;
  Defined<Detection> detection{Undefined{"nothing was counted"}};  // log-linear correction
  RatingCounts ratings;                                            // empty: none were asked for
  Defined<Roc> roc{Undefined{"there are no ratings"}};
  Defined<BinormalRoc> binormal{Undefined{"there are no ratings"}};
  Defined<MetaD> meta{Undefined{"there are no ratings"}};
};

/// Yes/no detection. Signal is every trial in which "yes" is right. If the definition does not say
/// what is right: one with a level above 0 and no probe; noise is then one with a probe (a catch
/// trial) or the level 0. A rating goes from "surely no" to "surely yes": with
/// the answer "no" it counts downwards.
std::vector<DetectedCondition> detected(const TrialsData& data, const TrialsPlan& plan);

/// How often each answer was given to each stimulus.
struct Confusions {
  std::vector<std::string> stimuli;       // rows: those that were presented, by name
  std::vector<std::vector<int>> answers;  // (stimuli x choices of the question)
};

/// Identifications of a participant under a condition.
struct IdentifiedCondition {
  std::string participant;
  std::vector<std::string> levels;  // of the plan's factors
  std::string condition;
  Confusions confusions;
  int trials{0}, right{0};
  double share{0.0}, low{0.0}, high{0.0};  // of right answers, with Wilson's 95 % interval
  /// d' of the plan's task, computed from the share and the ends of its interval. A share of 0 or 1
  /// is moved by half an answer (Macmillan and Kaplan 1985). Low and high may be infinite.
  Defined<double> d_prime{Undefined{"nothing was counted"}};
  double d_low{0.0}, d_high{0.0};
  Defined<double> information{Undefined{"there are fewer than three stimuli"}};  // [bit]
  Defined<double> sure_right{Undefined{"there are no ratings"}};  // mean rating of right answers
  Defined<double> sure_wrong{Undefined{"there are no ratings"}};
  Defined<Roc> sureness{Undefined{"there are no ratings"}};  // of ratings: right against wrong
  Defined<MetaD> meta{Undefined{"there are no ratings"}};    // the second choice is the signal
};

/// Which of several things was presented. The factor `stimulus` of the plan says what it was, the
/// question what it was taken for, and whether that was right. An observer without bias to whom all
/// alternatives are equally alike has the d' of the plan's task (task_d_prime); the confusions show
/// where this does not hold.
/// Source of the interval: Wilson 1927, Journal of the American Statistical Association 22.
std::vector<IdentifiedCondition> identified(const TrialsData& data, const TrialsPlan& plan);

/// Sums over the participants of each condition, in order.
std::vector<std::pair<std::string, Confusions>> pooled_confusions(
    const std::vector<IdentifiedCondition>& all);

/// Wilson's interval of a share. @param trials > 0
struct ShareInterval {
  double low, high;
};
ShareInterval wilson_interval(int right, int trials) noexcept;

}  // namespace haptrial::analysis::trials
