#pragma once

#include <string>
#include <vector>

#include "protocols/psychophysics/definition/read_definition.h"
#include "protocols/psychophysics/subject/observer_plan.h"

namespace haptrial::protocols {

/// A definition of trials with those who stand in for people.
struct StudiedDefinition final : TrialsDefinition {
  ObserverPlan observer;

  std::vector<std::string> description() const override;
  std::string presenting_script() const override;
  std::string scripts() const override;
};

}  // namespace haptrial::protocols
