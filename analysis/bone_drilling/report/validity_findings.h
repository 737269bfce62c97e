#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/bone_drilling/metrics/metrics.h"
#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/relation/correlation.h"
#include "analysis/statistics/relation/cross_validated.h"
#include "analysis/statistics/relation/intraclass.h"
#include "analysis/statistics/relation/mixed_model.h"
#include "analysis/statistics/relation/regression.h"
#include "analysis/statistics/relation/roc.h"
#include "analysis/statistics/tests/t_tests.h"
#include "analysis/statistics/variance/effect_size.h"

namespace haptrial::analysis::drilling {

/// Groups that are compared. Groups that are not among the experts are novices.
struct ValidityPlan {
  std::vector<std::string> groups;         // in the order of reports
  std::vector<std::string> expert_groups;  // with surgical experience
};

/// A quantity in one group.
struct GroupValues {
  std::string group;
  std::size_t participants{0};
  std::size_t procedures{0};
  Defined<MeanInterval> pooled{Undefined{""}};  // over procedures, as the source
  Defined<MeanInterval> participant_means{Undefined{""}};
  std::optional<double> mean{};  // of participants' means, also of one that has no interval
};

/// Experts against novices in one quantity. The tail is that of the expectation.
struct Contrast {
  /// Student's over procedures, as the source: takes a participant's procedures as independent.
  Defined<TTest> pooled{Undefined{""}};
  /// Welch's over participants' means.
  Defined<TTest> means{Undefined{""}};
  Defined<EffectSize> g{Undefined{""}};  // Hedges', of participants' means
  /// value ~ expert + (procedure's number, less its mean), a random intercept for each participant;
  /// the number is left out where all have the same.
  Defined<MixedModel> mixed{Undefined{""}};
  Defined<double> mixed_p{Undefined{""}};  // of expert, for the tail
  /// How well experts are where they are expected; clusters are participants. Higher if nothing is
  /// expected.
  Defined<Roc> roc{Undefined{""}};
};

/// A quantity beside the ratings.
struct RatingRelation {
  Defined<Correlation> pooled{Undefined{""}};  // over procedures, as the source
  Defined<Regression> line{Undefined{""}};     // quantity = a + b rating, the same points
  Defined<Correlation> means{Undefined{""}};   // over participants' means
  Defined<Correlation> ranks{Undefined{""}};   // Spearman's, of the same means
};

/// One metric of the study.
struct MetricValidity {
  MetricKind kind;
  std::size_t defined{0};           // procedures that have a value
  std::vector<GroupValues> groups;  // (groups), then all experts, all novices
  Contrast contrast;
  /// contrast.means.p; of the region's score, that of permuted labels (region_label_test()),
  /// because its values share their training.
  Defined<double> contrast_p{Undefined{""}};
  Defined<double> contrast_holm{Undefined{""}};  // contrast_p among all metrics
  RatingRelation relation;
  Defined<double> relation_holm{Undefined{""}};  // relation.means.p among all metrics
  Defined<double> ranks_holm{Undefined{""}};     // relation.ranks.p among all metrics
};

/// All metrics together, onto the ratings.
struct Combined {
  std::vector<std::string> metrics;   // used, in order
  std::vector<std::string> left_out;  // not defined for some procedure, or equal for all
  std::vector<std::size_t> rows;      // procedures used
  Defined<CrossValidated> fit{Undefined{""}};
  Defined<Roc> roc{Undefined{""}};  // of the cross-validated prediction
  Defined<Roc> resubstitution_roc{Undefined{""}};
};

/// One way of training and counting of the region's score (region_likelihood.h).
struct RegionWay {
  std::string name;
  Defined<Correlation> pooled{Undefined{""}};  // with the ratings
  Defined<Correlation> means{Undefined{""}};
  Defined<Roc> roc{Undefined{""}};
};

/// Results of the study.
struct Validity {
  ValidityPlan plan;
  std::vector<bool> expert;                   // (procedures)
  std::vector<std::size_t> participant;       // (procedures) number, in order of first appearance
  std::vector<std::optional<double>> rating;  // (procedures) mean over raters
  std::vector<std::string> raters;            // by name
  std::vector<std::size_t> scored;            // (raters) procedures that each scored
  std::size_t rated{0};                       // procedures with a rating
  bool simulated{false};                      // a participant or a rater
  bool simulated_raters{false};
  Defined<Intraclass> agreement{Undefined{"no rater rated yet"}};
  std::vector<GroupValues> rating_groups;  // (groups), then all experts, all novices
  Contrast rating_contrast;
  std::vector<MetricValidity> metrics;  // (metric_kinds())
  Combined combined;
  std::vector<RegionWay> regions;
};

}  // namespace haptrial::analysis::drilling
