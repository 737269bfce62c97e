#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/document/document.h"
#include "analysis/force_training/judge/skill_fit.h"
#include "analysis/force_training/score/score.h"
#include "analysis/statistics/relation/intraclass.h"

namespace haptrial::analysis {

inline constexpr int kLowestJudgement = 1, kHighestJudgement = 7;

/// Recall of a test pass that may be judged.
struct JudgedRecall {
  std::string session;  // name of the file
  std::string subject;
  int trial{0};
  RecallDetail detail;
};

/// Place of a curve on the sheets.
struct SheetCurve {
  std::string sheet;  // its name, which no other preparation has
  int curve{1};       // from 1, over all sheets
  std::string session;
  std::string subject;
  int trial{0};
  int first{0};  // curve that this one repeats; 0: none
  double alignment_cost{0.0}, rms_force{0.0}, rms_slope{0.0};
};

/// Choice of what judges get.
struct SheetOptions {
  std::size_t curves{60};  // without repeated ones; fewer if there are fewer recalls
  double repeated{0.2};    // share of them that comes twice
  int each{12};            // curves on a sheet
  std::uint64_t seed{1};
};

/// Draws recalls and shuffles them with those that come twice.
/// @returns (curves) places of the recalls in their order on the sheets, repeated ones twice
std::vector<std::size_t> shuffled_recalls(std::size_t recalls, const SheetOptions& options);

/// A page for each sheet without condition or participant: the presented force and the recalled
/// one.
/// @param recalls  in the order of shuffled_recalls(). @throws RunError without gnuplot
std::vector<std::string> judging_sheets(const std::vector<JudgedRecall>& recalls,
                                        const SheetOptions& options, bool simulated);
/// The key: places, sessions and parts of the scores; it stays with the study.
std::string judging_key(const std::vector<JudgedRecall>& recalls, const SheetOptions& options);
/// The table that a judge fills in: sheet, curve, judgement.
std::string judging_table(const std::vector<JudgedRecall>& recalls, const SheetOptions& options);

/// @throws InputError for what judging_key() does not write
std::vector<SheetCurve> read_judging_key(const std::filesystem::path& file);
/// Judgements of one judge in the order of the key.
/// @throws InputError for sheets that the key is not of, for a curve that is unknown, missing or
/// there twice, and for a judgement that is no whole number from 1 to 7
std::vector<double> read_judgements(const std::filesystem::path& file,
                                    const std::vector<SheetCurve>& key);

/// A judge and how alike the two judgements of repeated curves are.
struct JudgeConsistency {
  std::string judge;
  std::size_t repeated{0};
  double difference{0.0};                            // mean size of the difference
  Defined<IntraclassForm> agreement{Undefined{""}};  // one-way, of a single judgement
};

/// Judgements of a study's curves and what follows from them.
struct Judging {
  std::vector<JudgeConsistency> judges;
  Defined<Intraclass> agreement{Undefined{"there is one judge"}};  // first presentations
  Defined<SkillFit> skill{Undefined{""}};
};

/// @param judgements  (judges)(curves of the key)
Judging judging_of(const std::vector<SheetCurve>& key, const std::vector<std::string>& judges,
                   const std::vector<std::vector<double>>& judgements, std::uint64_t seed);

/// The report on it. @param simulated  a participant was
Document judging_report(const Judging& judging, bool simulated);
/// Keys of [analysis] with the shares, and what they rest on as comments.
/// @param skill  that predicts
std::string judged_weights(const SkillFit& skill);

}  // namespace haptrial::analysis
