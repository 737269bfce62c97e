#include "protocols/force_training/force_protocol.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/force_training/force_replay.h"
#include "protocols/force_training/force_trials.h"

namespace haptrial::protocols {
namespace {

std::optional<record::Phase> phase_of(const std::string& name) {
  if (name.empty()) {
    return std::nullopt;
  }
  if (name != "training" && name != "test") {
    throw InputError(not_allowed("--phase", fmt::format("'{}'", name), {"training", "test"}));
  }
  return record::Phase(name);
}

class ForceTraining final : public Protocol {
 public:
  std::string_view name() const override { return kForceTraining; }
  std::vector<std::string> virtual_tables() const override {
    return {"subject", "pace", "path_memory"};
  }
  std::unique_ptr<Definition> read(Table& root, std::string_view file_name,
                                   const std::filesystem::path* folder) const override {
    return std::make_unique<ForceDefinition>(read_force_definition(root, file_name, folder));
  }
  std::vector<std::string> margins() const override { return margins_of({}); }
  std::vector<std::pair<record::Phase, std::string>> phases() const override {
    return {{record::Phase::kTraining, "the pattern is presented"},
            {record::Phase::kTest, "the pattern is recalled"}};
  }
  std::unique_ptr<Trials> trials(const Definition& definition,
                                 const SessionPlace& place) const override {
    return std::make_unique<ForceTrials>(dynamic_cast<const ForceDefinition&>(definition), place);
  }
  void replay(const ReplayRequest& request) const override;
};

void ForceTraining::replay(const ReplayRequest& request) const {
  const auto phase = phase_of(request.phase);
  if (request.trial == 0) {
    throw InputError("--trial is missing; give the number of the trial to show");
  }
  if (!request.sound.empty()) {
    throw InputError("--sound is given for a session without drilling; leave it out");
  }
  if (!request.pictures) {
    throw InputError("neither --video nor --frames is given; add one to write to");
  }
  ForceReplay replay(request.file, request.trial, phase);
  if (!replay.notice().empty()) {
    request.tell(replay.notice());
  }
  const auto count = static_cast<int>(std::floor(replay.duration() * request.fps + 1e-9)) + 1;
  for (int i = 0; i < count; ++i) {
    request.progress(i, count, fmt::format("{} of {} pictures", i, count), request.fps);
    request.picture(replay.draw(static_cast<double>(i) / request.fps));
  }
  request.tell(
      fmt::format("{} pictures, {:.1f} s at {} a second", count, replay.duration(), request.fps));
}

}  // namespace

const Protocol& force_training() {
  static const ForceTraining protocol;
  return protocol;
}

}  // namespace haptrial::protocols
