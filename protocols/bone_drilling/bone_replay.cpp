#include "protocols/bone_drilling/bone_replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/bone/record/recorded_bone.h"
#include "core/record/read/tick_rows.h"
#include "core/record/table/schema.h"
#include "protocols/bone_drilling/display/bone_display.h"
#include "protocols/bone_drilling/drilling_pass.h"
#include "protocols/bone_drilling/live_tuning.h"
#include "protocols/bone_drilling/replay_difference.h"
#include "protocols/bone_drilling/replayed_handpiece.h"
#include "protocols/interface/recorded_definition.h"

namespace haptrial::protocols {
namespace {

constexpr std::uint64_t kPiece = 65536;  // rows read at once

BoneDefinition definition_of(const record::SessionReader& reader) {
  if (!record::drills(reader)) {
    throw InputError(
        fmt::format("{}: is not a drilling session; choose one with protocol = \"bone_drilling\"",
                    reader.path().string()));
  }
  try {
    Table root = recorded_definition(reader, 0);
    BoneDefinition d = read_bone_definition(root, reader.info().definition_name, nullptr);
    root.finish();
    show_as_recorded(reader, d);
    return d;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: its definition is not one of this version of haptrial: {}",
                                 reader.path().string(), error.what()));
  }
}

/// Reading of the second device, as it is recorded. @param rows  of it, on one tick
device::DeviceReading second_of(std::span<const record::DeviceRow> rows,
                                const record::SecondHandRow& hand) {
  device::DeviceReading reading;
  if (!rows.empty()) {
    reading.tool = {rows.front().position, rows.front().velocity};
    reading.buttons = static_cast<std::uint32_t>(rows.front().buttons);
  }
  reading.orientation = hand.orientation;
  return reading;
}

/// Rows of one table by tick, in order.
template <class Row>
class Cursor {
 public:
  Cursor(const std::vector<Row>& rows, std::uint64_t from)
      : rows_(rows),
        at_(static_cast<std::size_t>(
            std::lower_bound(rows.begin(), rows.end(), from,
                             [](const Row& row, std::uint64_t s) { return row.sequence < s; }) -
            rows.begin())) {}
  /// Rows of a tick.
  std::span<const Row> take(std::uint64_t sequence) {
    const std::size_t first = at_;
    while (at_ < rows_.size() && rows_[at_].sequence == sequence) {
      ++at_;
    }
    return std::span(rows_).subspan(first, at_ - first);
  }

 private:
  const std::vector<Row>& rows_;
  std::size_t at_;
};

std::vector<bone::RecordedSplit> splits_of(std::span<const record::SplitRow> rows) {
  std::vector<bone::RecordedSplit> splits;
  for (const record::SplitRow& row : rows) {
    const bool more = row.to >= 0 && !splits.empty() && splits.back().to == row.to;
    if (!more) {
      splits.push_back({row.from, row.to, {}});
    }
    splits.back().seeds.emplace_back(row.voxel[0], row.voxel[1], row.voxel[2]);
  }
  return splits;
}

}  // namespace

BoneReplay::BoneReplay(const std::filesystem::path& session)
    : reader_(session),
      definition_(definition_of(reader_)),
      passes_(reader_.passes()),
      procedures_(reader_.rows<record::ProcedureRow>()),
      removals_(reader_.rows<record::RemovalRow>()),
      splits_(reader_.rows<record::SplitRow>()),
      tears_(reader_.rows<record::TearRow>()),
      second_(reader_.rows<record::DeviceRow>()),
      field_(reader_.rows<record::FieldRow>()),
      pieces_(reader_.rows<record::PieceRow>()),
      screws_(reader_.rows<record::ScrewRow>()),
      led_(reader_.rows<record::LedRow>()),
      tuning_(reader_.rows<record::TuningRow>()) {
  for (const record::BoneRecord& bone : record::recorded_bones(reader_)) {
    bones_.push_back(std::make_shared<const bone::BoneModel>(bone::model_of(bone)));
  }
  if (bones_.empty()) {
    throw InputError(fmt::format("{}: holds no bone", session.string()));
  }
}

std::vector<int> BoneReplay::trials() const {
  std::set<int> trials;
  for (const record::PassRow& pass : passes_) {
    if (pass.trial > 0) {
      trials.insert(pass.trial);
    }
  }
  return {trials.begin(), trials.end()};
}

std::uint64_t BoneReplay::ticks(int trial) const {
  std::uint64_t ticks = 0;
  for (const record::PassRow& pass : passes_) {
    ticks += pass.trial == trial ? pass.last_sample - pass.first_sample + 1 : 0;
  }
  return ticks;
}

void BoneReplay::refuse_trial(int trial) const {
  const std::vector<int> known = trials();
  throw InputError(known.empty()
                       ? fmt::format("{}: holds no trials", reader_.path().string())
                       : fmt::format("--trial is {}; allowed: {} to {}, the trials of {}", trial,
                                     known.front(), known.back(), reader_.path().string()));
}

std::int32_t BoneReplay::last_bone(int trial) const {
  std::int32_t last = -1;
  for (const record::PassRow& pass : passes_) {
    last = pass.trial == trial ? std::max(last, pass.repetition) : last;
  }
  if (last < 0) {
    refuse_trial(trial);
  }
  return last;
}

/// @param first  tick that is simulated with it
std::shared_ptr<BoneStage> BoneReplay::make_stage(int trial, std::uint64_t first,
                                                  bool drawn) const {
  auto stage = std::make_shared<BoneStage>();
  stage->model = bones_[static_cast<std::size_t>(std::max(trial, 1) - 1) % bones_.size()];
  const geometry::VoxelGrid& grid = stage->model->grid;
  stage->start_view = definition_.simulator.camera.start;
  stage->simulator =
      std::make_unique<bone::Simulator>(*stage->model, simulator_for(definition_, grid));
  RecordedTuning(definition_, tuning_, first).begin(*stage->simulator);
  if (drawn) {
    stage->companions = std::make_unique<bone::SteppedCompanions>(
        *stage->simulator, companions_for(definition_, grid), rate(), false);
    stage->depths = depths_of(*stage->model);
  }
  return stage;
}

ReplayVerdict BoneReplay::run(int trial, const Watch& watch) const {
  ReplayVerdict verdict;
  verdict.trial = trial;
  std::shared_ptr<BoneStage> stage;
  std::int32_t bone = -1;
  for (std::size_t row = 0; row < passes_.size(); ++row) {
    const record::PassRow& pass = passes_[row];
    if (pass.trial != trial) {
      continue;
    }
    if (!stage || pass.repetition != bone) {
      stage.reset();  // before there is another one
      stage = make_stage(trial, pass.first_sample, static_cast<bool>(watch));
      bone = pass.repetition;
    }
    ++verdict.passes;
    run_pass(static_cast<std::int32_t>(row), pass, stage, {watch, {}}, verdict);
    if (!verdict.difference.empty()) {
      break;
    }
  }
  if (verdict.passes == 0) {
    refuse_trial(trial);
  }
  return verdict;
}

std::shared_ptr<BoneStage> BoneReplay::restore_until(std::uint64_t ticks, int trial,
                                                     std::int32_t bone, ReplayVerdict& verdict,
                                                     const Pulse& pulse) const {
  verdict = {};
  verdict.trial = trial;
  std::shared_ptr<BoneStage> stage;
  for (std::size_t row = 0; row < passes_.size() && verdict.difference.empty(); ++row) {
    const bool own = passes_[row].trial == trial && passes_[row].repetition == bone;
    if (own && (!stage || verdict.ticks < ticks)) {
      stage = stage ? stage : make_stage(trial, passes_[row].first_sample, false);
      ++verdict.passes;
      run_pass(static_cast<std::int32_t>(row), passes_[row], stage, {{}, pulse, ticks}, verdict);
    }
  }
  return stage;
}

/// State with which the ticks of a pass are simulated and compared.
struct BoneReplay::Work {
  const std::shared_ptr<BoneStage>& stage;
  const Onlookers& onlookers;
  ReplayVerdict& verdict;
  double dt;
  Cursor<record::RemovalRow> removals;
  Cursor<record::SplitRow> splits;
  Cursor<record::TearRow> tears;
  Cursor<record::PieceRow> pieces;
  Cursor<record::ScrewRow> screws;
  RecordedTuning tuning;
  std::vector<bone::EmptiedIn> emptied;  // on one tick of the session
  std::vector<bone::Tear> torn;

  /// @param first  of a tick of the session, which has its splits
  void step(std::uint64_t sequence, const bone::SimulatorInput& now, bool first) {
    bone::Simulator& simulator = *stage->simulator;
    tuning.step(simulator, sequence);
    if (first) {
      emptied.clear();
      torn.clear();
      simulator.tick(now, splits_of(splits.take(sequence)));
    } else {
      simulator.tick(now);
    }
    emptied.insert(emptied.end(), simulator.emptied().begin(), simulator.emptied().end());
    torn.insert(torn.end(), simulator.tears().begin(), simulator.tears().end());
    if (onlookers.watch) {
      stage->companions->after_tick(simulator, dt);
    }
  }
  /// @returns whether a tick of the session is as it was recorded.
  bool check(std::uint64_t sequence) {
    verdict.difference = difference(sequence, removals.take(sequence), emptied);
    if (verdict.difference.empty()) {
      verdict.difference = difference(sequence, tears.take(sequence), torn);
    }
    if (verdict.difference.empty()) {
      verdict.difference = difference(sequence, pieces.take(sequence), *stage->simulator);
    }
    if (verdict.difference.empty()) {
      verdict.difference = difference(sequence, screws.take(sequence), stage->simulator->screws());
    }
    verdict.emptied += emptied.size();
    verdict.tears += torn.size();
    return verdict.difference.empty();
  }
  void show(std::uint64_t sequence, const bone::SimulatorInput& seen) {
    constexpr std::uint64_t kBetweenPulses = 500;  // ticks
    if (onlookers.watch) {
      onlookers.watch(verdict.ticks, sequence, protocols::view_of(*stage->simulator, seen), stage);
    }
    if (onlookers.pulse && verdict.ticks % kBetweenPulses == 0) {
      onlookers.pulse(verdict.ticks);
    }
    ++verdict.ticks;
  }
  bool reached() const { return verdict.ticks >= onlookers.until; }
};

void BoneReplay::run_pass(std::int32_t row, const record::PassRow& pass,
                          const std::shared_ptr<BoneStage>& stage, const Onlookers& onlookers,
                          ReplayVerdict& verdict) const {
  Work work{stage,
            onlookers,
            verdict,
            1.0 / rate(),
            Cursor<record::RemovalRow>(removals_, pass.first_sample),
            Cursor<record::SplitRow>(splits_, pass.first_sample),
            Cursor<record::TearRow>(tears_, pass.first_sample),
            Cursor<record::PieceRow>(pieces_, pass.first_sample),
            Cursor<record::ScrewRow>(screws_, pass.first_sample),
            RecordedTuning(definition_, tuning_, pass.first_sample),
            {},
            {}};
  if (work.reached()) {
    return;
  }
  if (led_.empty()) {
    run_own(pass, work);
  } else {
    run_led(pass, work);
  }
  if (verdict.difference.empty() && !work.reached()) {
    verdict.checksum = stage->simulator->checksum();
    check_end(row, *stage->simulator, verdict);
  }
}

void BoneReplay::run_own(const record::PassRow& pass, Work& work) const {
  const protocols::DrillingInput input(definition_.drilling);
  const record::RowSpan rows = record::span_of_pass(reader_, pass);
  const std::uint64_t end = rows.first + rows.count;
  const bool two = definition_.drilling.second.has_value();
  Cursor<record::DeviceRow> devices(second_, pass.first_sample);
  bool begun = false;
  for (std::uint64_t at = rows.first; at < end; at += kPiece) {
    const std::uint64_t count = std::min(kPiece, end - at);
    const std::vector<record::Sample> samples = reader_.samples(at, count);
    const std::vector<record::ToolRow> tool = reader_.rows<record::ToolRow>(at, count);
    const auto hand =
        two ? reader_.rows<record::SecondHandRow>(at, count) : std::vector<record::SecondHandRow>{};
    if (two && hand.size() != samples.size()) {
      throw InputError(
          fmt::format("{}: lacks rows of /second_hand; the drilling of two hands cannot "
                      "be simulated again without them",
                      reader_.path().string()));
    }
    const auto held = definition_.has_handpiece() ? reader_.rows<record::HandpieceRow>(at, count)
                                                  : std::vector<record::HandpieceRow>{};
    const auto met = definition_.tools_meet() ? reader_.rows<record::ToolContactRow>(at, count)
                                              : std::vector<record::ToolContactRow>{};
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const std::span<const record::DeviceRow> other = devices.take(samples[i].sequence);
      if (!tool[i].active) {
        continue;
      }
      const device::DeviceReading second =
          two ? second_of(other, hand[i]) : device::DeviceReading{};
      const bone::SimulatorInput now =
          input.of(reading_of(samples[i], tool[i]), work.dt, two ? &second : nullptr);
      if (!std::exchange(begun, true)) {
        work.stage->simulator->begin(now.functions);
      }
      work.step(samples[i].sequence, now, true);
      if (!work.check(samples[i].sequence)) {
        return;
      }
      if (two) {
        const Eigen::Vector3d& force = work.stage->simulator->output().tube.force;
        work.verdict.difference =
            difference(hand[i].sequence, "the tube of the second hand", hand[i].contact, force);
      }
      if (i < met.size() && work.verdict.difference.empty()) {
        work.verdict.difference = difference(met[i].sequence, "the tool that the tube meets",
                                             met[i].force, work.stage->simulator->output().pushed);
      }
      if (i < held.size() && work.verdict.difference.empty()) {
        work.verdict.difference =
            difference(held[i], *work.stage->simulator, work.stage->simulator->output().shaft);
      }
      if (!work.verdict.difference.empty()) {
        return;
      }
      work.show(samples[i].sequence, now);
      if (work.reached()) {
        return;
      }
    }
  }
}

/// The bone followed what another session's device gave.
void BoneReplay::run_led(const record::PassRow& pass, Work& work) const {
  const protocols::DrillingInput input(definition_.drilling);
  Cursor<record::LedRow> led(led_, pass.first_sample);
  std::optional<ReplayedHandpiece> handpiece;
  if (definition_.has_handpiece()) {
    handpiece.emplace(reader_, input, *work.stage->simulator);
  }
  for (std::uint64_t sequence = pass.first_sample; sequence <= pass.last_sample; ++sequence) {
    const std::span<const record::LedRow> steps = led.take(sequence);
    bone::SimulatorInput now;
    for (const record::LedRow& row : steps) {
      device::DeviceReading reading;
      reading.tool = row.tool;
      reading.orientation = row.orientation;
      reading.buttons = row.buttons;
      reading.keys = row.keys;
      reading.pedal = row.pedal;
      now = input.of(reading, work.dt);
      if (row.begins) {
        work.stage->simulator->begin(now.functions);
      }
      work.step(sequence, now, &row == steps.data());
    }
    if (!steps.empty() && !work.check(sequence)) {
      return;
    }
    if (handpiece) {
      work.verdict.difference = handpiece->check(sequence);
      if (!work.verdict.difference.empty()) {
        return;
      }
    }
    if (!steps.empty()) {
      work.show(sequence, now);
    }
    if (work.reached()) {
      return;
    }
  }
}

/// Whether the bone at the end of a pass is that of the record.
void BoneReplay::check_end(std::int32_t row, const bone::Simulator& simulator,
                           ReplayVerdict& verdict) const {
  const auto procedure =
      std::find_if(procedures_.begin(), procedures_.end(),
                   [row](const record::ProcedureRow& each) { return each.pass == row; });
  if (procedure == procedures_.end()) {
    verdict.whole = false;
  } else if (procedure->checksum != verdict.checksum) {
    verdict.difference = fmt::format(
        "pass {} ends with another bone: its checksum is {:016x}, and the record has {:016x}, "
        "though the same voxels were emptied",
        row, verdict.checksum, procedure->checksum);
  }
  const auto field = std::ranges::find_if(
      field_, [row](const record::FieldRow& each) { return each.pass == row; });
  if (verdict.difference.empty() && simulator.heat() != nullptr && field != field_.end() &&
      field->hottest != simulator.heat()->hottest()) {
    verdict.difference =
        fmt::format("pass {} comes to {} degrees at the burr, and the record has {}", row,
                    simulator.heat()->hottest(), field->hottest);
  }
}

}  // namespace haptrial::protocols
