#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "protocols/bone_drilling/live_tuning.h"
#include "protocols/interface/auxiliary_page.h"

namespace haptrial::protocols {

/// tuning.html as it stands in the source; built in.
std::string_view tuning_html();

/// The page on which a surgeon's teacher and an experimenter tune feel, sound and removal while a
/// pilot runs: a slider for each tunable key. Source: Morris 2006, §8.2.1.
class TuningPage final : public AuxiliaryPage {
 public:
  explicit TuningPage(const BoneDefinition& definition)
      : tuning_(std::make_shared<LiveTuning>(definition)) {}

  std::string_view name() const override { return "tuning"; }
  std::string_view title() const override { return "tuning of this pilot"; }
  std::string_view html() const override { return tuning_html(); }
  bool is_for_pilots() const override { return true; }
  /// Each event has the counts of changes; keys and the definition's text only if they changed.
  Events events() override;
  /// {"key": "tools.cutting.feel.second_gain", "value": 3e9}
  void ask(const std::string& json) override;

  const std::shared_ptr<LiveTuning>& tuning() const { return tuning_; }

 private:
  std::shared_ptr<LiveTuning> tuning_;
};

}  // namespace haptrial::protocols
