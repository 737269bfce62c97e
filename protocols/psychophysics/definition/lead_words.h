#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace haptrial::protocols {

struct Presented;
struct TrialsDefinition;

/// Gathers stages that wait until the hand is in a region to which it is not led, so that a hand
/// that lets itself be led never arrives, and the trial is aborted for ever: a field leads it to a
/// place beside the region, or nothing leads the hand of a virtual participant.
class LeadReport {
 public:
  explicit LeadReport(const TrialsDefinition& definition);

  void add(const Presented& presented);
  /// A sentence for each such stage.
  std::vector<std::string> warnings() const;

 private:
  bool simulated_{false};                      // the definition says what virtual hands do
  std::set<std::string> moving_;               // stages in which they move by themselves
  std::map<std::string, std::string> beside_;  // by stage: the sentence
};

}  // namespace haptrial::protocols
