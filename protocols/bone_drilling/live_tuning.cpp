#include "protocols/bone_drilling/live_tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/definition/given_values.h"
#include "core/base/definition/removed_keys.h"
#include "core/base/error.h"
#include "protocols/bone_drilling/definition/contact_margin.h"
#include "protocols/definition/lab_file.h"

namespace haptrial::protocols {

TunedValues tuned_values(const BoneDefinition& d) noexcept {
  return {bone::tuning_of(d.simulator), d.vibration_gain, d.thin_bone};
}

std::string tuned_text(std::string_view text, std::string_view file_name, const std::string& key,
                       double value) {
  std::string written = fmt::format("{}", value);  // the shortest with the same bits
  if (written.find_first_of(".en") == std::string::npos) {
    written += ".0";
  }
  const GivenKey given{key, written};
  return with_values(text, file_name, {&given, 1});
}

LiveTuning::LiveTuning(const BoneDefinition& d) : file_name_(d.file_name), text_(d.text) {
  read(d);
  at_first_ = now_;
  taken_.values = tuned_values(d);
}

void LiveTuning::read(const BoneDefinition& d) {
  now_ = d.tunable;
  const std::optional<ContactMargin> margin = contact_margin(d);
  contact_ = margin ? describe(*margin) : "";
}

void LiveTuning::change(const std::string& key, double value) {
  const std::lock_guard lock(mutex_);
  const auto at = std::ranges::find(now_, key, &TunableKey::key);
  if (at == now_.end()) {
    throw InputError(fmt::format("{}: {} cannot be tuned while a pilot runs", file_name_, key));
  }
  const double before = at->value;
  if (before == value) {
    return;
  }
  std::string text = tuned_text(text_, file_name_, key, value);
  const BoneDefinition d = parse_bone_definition(text, file_name_);
  text_ = std::move(text);
  changes_.push_back({key, before, value});
  read(d);
  latest_.write({changes_.size(), tuned_values(d)});
}

LiveTuning::View LiveTuning::view() const {
  const std::lock_guard lock(mutex_);
  const std::string text =
      lab_of(text_).empty() ? text_ : without_key(text_, file_name_, "lab");  // its tables are here
  return {changes_.size(),
          taken_number_.load(std::memory_order_relaxed),
          at_first_,
          now_,
          contact_,
          file_name_,
          text};
}

std::uint64_t LiveTuning::take(bone::Simulator& simulator,
                               sound::DrillVibration* vibration) noexcept {
  if (simulator.is_in_transition() || !latest_.read(taken_)) {
    return 0;
  }
  begin(simulator, vibration);
  taken_number_.store(taken_.number, std::memory_order_relaxed);
  return taken_.number;
}

void LiveTuning::begin(bone::Simulator& simulator, sound::DrillVibration* vibration) noexcept {
  if (taken_.number == 0) {
    return;
  }
  simulator.tune(taken_.values.simulator);
  if (vibration != nullptr) {
    vibration->set_gain(taken_.values.vibration_gain);
  }
}

std::vector<record::TuningRow> LiveTuning::rows_of(std::span<const TakenTuning> taken) {
  const std::lock_guard lock(mutex_);
  std::vector<record::TuningRow> rows;
  for (const TakenTuning& each : taken) {
    for (; recorded_ < each.number; ++recorded_) {
      const Change& change = changes_[recorded_];
      rows.push_back({each.sequence, change.key, change.before, change.after});
    }
  }
  return rows;
}

RecordedTuning::RecordedTuning(const BoneDefinition& d, std::span<const record::TuningRow> rows,
                               std::uint64_t first)
    : file_name_(d.file_name), text_(d.text), rows_(rows) {
  apply_until(first);
}

void RecordedTuning::begin(bone::Simulator& simulator) const {
  if (next_ > 0) {
    simulator.tune(tuned_values(parse_bone_definition(text_, file_name_)).simulator);
  }
}

void RecordedTuning::step(bone::Simulator& simulator, std::uint64_t sequence) {
  if (apply_until(sequence + 1)) {
    begin(simulator);
  }
}

/// Takes the rows before a tick. @returns whether there are any
bool RecordedTuning::apply_until(std::uint64_t end) {
  const std::size_t before = next_;
  for (; next_ < rows_.size() && rows_[next_].sequence < end; ++next_) {
    text_ = tuned_text(text_, file_name_, rows_[next_].key, rows_[next_].after);
  }
  return next_ > before;
}

}  // namespace haptrial::protocols
