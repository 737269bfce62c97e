#include "protocols/psychophysics/session_scripts.h"

#include <fmt/format.h>

#include <utility>

#include "core/base/random.h"
#include "core/record/read/session_reader.h"
#include "protocols/interface/recorded_definition.h"
#include "protocols/interface/session_file.h"
#include "protocols/psychophysics/sequence/script_process.h"

namespace haptrial::protocols {

SessionScripts::SessionScripts(const StudiedDefinition& definition, const SessionPlace& place)
    : d_(definition), place_(place) {
  if (d_.script) {
    start_levels(*d_.script);
  }
  if (d_.observer.script) {
    start_decisions(*d_.observer.script);
  }
}

std::function<void()> SessionScripts::pulse(const char* text) const {
  if (!place_.pulse) {
    return {};
  }
  return [this, text] { place_.pulse(text, 0.0); };
}

void SessionScripts::start_levels(const ScriptPlan& plan) {
  levels_ = std::make_unique<ScriptedLevels>(plan, place_.subject, place_.real,
                                             pulse("waiting for the script of levels"));
  if (!place_.resumed.empty()) {
    levels_->recall(record::SessionReader(place_.resumed));
    levels_kept_ = levels_->recalled();
  }
  if (place_.real) {
    levels_->start_early();
  }
}

void SessionScripts::start_decisions(const ScriptPlan& plan) {
  decisions_ = std::make_unique<ScriptedDecisions>(
      plan, place_.subject, derived_seed(place_.hand_session_seed, "subject"),
      pulse("waiting for the script of decisions"));
  if (!place_.resumed.empty()) {
    decisions_kept_ =
        kept_before(plan, kDecisionScriptEvent, record::SessionReader(place_.resumed));
  }
}

void SessionScripts::direct(TrialSequence& sequence) {
  if (levels_ != nullptr) {
    sequence.choose_by(*levels_);
  }
}

void SessionScripts::write(SessionFile& file, bool simulated) {
  if (simulated && decisions_ != nullptr && !std::exchange(decisions_kept_, true)) {
    file.event(kDecisionScriptEvent, d_.observer.script->text);
  }
  if (levels_ == nullptr) {
    return;
  }
  if (!std::exchange(levels_kept_, true)) {
    file.event(kLevelScriptEvent, d_.script->text);
  }
  const bool first = levels_->left() == 1;
  for (const std::string& trouble : levels_->take_troubles()) {
    file.event(kScriptTrouble, trouble);
    warning_ = first ? trouble : "";
  }
}

std::vector<std::string> SessionScripts::take_warnings() {
  const std::string warning = std::exchange(warning_, "");
  return warning.empty() ? std::vector<std::string>{} : std::vector{warning};
}

std::vector<std::string> SessionScripts::notices() const {
  if (levels_ == nullptr || levels_->left() == 0) {
    return {};
  }
  return {fmt::format("{}: in {} of {} trials the level was the procedure's own (events {})",
                      d_.script->file.filename().string(), levels_->left(), levels_->asked(),
                      kScriptTrouble)};
}

}  // namespace haptrial::protocols
