#pragma once

#include "analysis/exchange/own_findings.h"
#include "analysis/exchange/score.h"
#include "core/record/read/session_reader.h"

/// A score and a finding: how far the hand went in each pass, and on average.
namespace own {

using namespace haptrial;

class WayOfHand final : public analysis::Score {
 public:
  std::string_view name() const override { return "way"; }
  std::string_view unit() const override { return "m"; }
  std::vector<analysis::ScoreValue> values(const record::SessionReader& session) const override {
    std::vector<analysis::ScoreValue> found;
    int number = 0;
    for (const record::PassRow& pass : session.passes()) {
      const auto columns =
          session.columns(pass.first_sample, pass.last_sample - pass.first_sample + 1);
      double way = 0.0;
      for (Eigen::Index i = 1; i < columns.position.cols(); ++i) {
        way += (columns.position.col(i) - columns.position.col(i - 1)).norm();
      }
      found.push_back({number++, way});
    }
    return found;
  }
};

inline const WayOfHand kWay;

/// The mean over all passes, and a table with the mean of each session.
inline analysis::FindingList mean_way(const std::vector<std::filesystem::path>& sessions) {
  analysis::FindingList list;
  list.heading = "Way of the hand";
  analysis::FindingTable table{"sessions", "Way of each session"};
  double sum = 0.0;
  std::size_t passes = 0;
  for (const std::filesystem::path& file : sessions) {
    const record::SessionReader session(file);
    double own = 0.0;
    const auto values = kWay.values(session);
    for (const analysis::ScoreValue& each : values) {
      own += each.value;
    }
    sum += own;
    passes += values.size();
    const auto count = static_cast<double>(values.size());
    table.rows.push_back(
        {{.name = "participant", .title = "participant", .value = session.info().subject},
         {.name = "way", .title = "mean way", .value = own / count, .unit = "m"}});
  }
  list.findings.push_back({.name = "way",
                           .title = "Mean way of the hand in a pass",
                           .value = sum / static_cast<double>(passes),
                           .unit = "m",
                           .n = passes});
  list.tables.push_back(table);
  return list;
}

inline void add_way_of_hand() {
  analysis::add_score(kWay);
  analysis::add_finding_source({"way", mean_way});
}

}  // namespace own
