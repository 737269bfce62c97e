#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/subject/perceiver/probing.h"

namespace haptrial::protocols {

struct TrialDevice;

/// Action of a hand in a stage.
struct StageAction {
  std::string stage;
  std::size_t device{0};  // whose hand
  subject::Probe probe;
  bool to_mark{false};  // a reach to, or a pursuit of, the first mark for this device
};

/// Reads [observer.actions]: `STAGE = { do = "press", … }`; with [devices] also
/// `STAGE = { DEVICE = { do = "press", … }, … }`. Problems are noted.
std::vector<StageAction> read_actions(Table& actions, const std::vector<std::string>& stages,
                                      const std::vector<TrialDevice>& devices);

/// Notes that `name`, the value of `key`, is no stage.
void check_stage(Table& table, const std::string& key, const std::string& name,
                 const std::vector<std::string>& stages);

}  // namespace haptrial::protocols
