#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace haptrial::protocols {

struct Presented;
struct TrialsDefinition;

/// Gathers stages whose trial is aborted for ever, if a hand lets itself be led: they wait until it
/// is in a region, and a field leads it to a place beside that, or nothing leads the hand of a
/// virtual participant; or a field leads it out of the workspace.
class LeadReport {
 public:
  explicit LeadReport(const TrialsDefinition& definition);

  void add(const Presented& presented);
  /// A sentence for each such stage.
  std::vector<std::string> warnings() const;

 private:
  void add_way_out(const Presented& presented, const std::string& stage, std::uint64_t fields);

  double workspace_{0.0};                      // radius about the origin, of tips [m]
  std::vector<bool> tips_;                     // (devices) whose tip it is
  bool simulated_{false};                      // the definition says what virtual hands do
  std::set<std::string> moving_;               // stages in which they move by themselves
  std::map<std::string, std::string> beside_;  // by stage: the sentence
};

/// Gathers what acts in first stages while the force grows, so that less than stated is felt.
class RampReport {
 public:
  explicit RampReport(const TrialsDefinition& definition);
  void add(const Presented& presented);
  /// A sentence for each field.
  std::vector<std::string> warnings() const;

 private:
  std::vector<double> ramps_;                 // (devices) [s]
  std::map<std::string, std::string> early_;  // by field: the sentence
};

/// Gathers the regions that stages show outside of the participant's picture.
class PictureReport {
 public:
  explicit PictureReport(const TrialsDefinition& definition) : d_(definition) {}
  void add(const Presented& presented);
  /// A sentence for each region.
  std::vector<std::string> warnings() const;

 private:
  const TrialsDefinition& d_;
  std::map<std::string, double> outside_;  // by region: the extent that shows all of it [m]
};

}  // namespace haptrial::protocols
