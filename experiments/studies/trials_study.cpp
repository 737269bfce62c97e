#include "experiments/studies/trials_study.h"

#include "protocols/trials/trials_protocol.h"

namespace haptrial::experiments {
namespace {

class TrialsStudy final : public Study {
 public:
  const protocols::Protocol& protocol() const override { return protocols::trials_protocol(); }
  std::vector<std::string> analyze(const AnalysisRequest&) const override { return {}; }
};

}  // namespace

const Study& trials_study() {
  static const TrialsStudy study;
  return study;
}

}  // namespace haptrial::experiments
