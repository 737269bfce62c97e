#pragma once

#include <map>
#include <string>
#include <vector>

namespace haptrial::protocols {

struct Presented;
struct TrialsDefinition;

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
