#include "core/record/run_codec.h"

#include <string>

#include "core/record/packed_row.h"
#include "core/record/row_codec.h"
#include "core/record/schema.h"

namespace haptrial::record {

void put_run(BytePlanes& planes, std::size_t at, const RunRow& run) {
  PackedRow row(planes.row_bytes());
  row.put(run.run);
  row.put(run.first_sample);
  row.put(run.counts.ticks);
  row.put(run.counts.overruns);
  row.put(run.counts.dropped);
  row.put(run.planned);
  row.put_text(name_of(run.state), kStatusBytes, "state");
  planes.put_row(at, row.bytes());
}

RunRow get_run(const BytePlanes& planes, std::size_t at) {
  PackedRow row(planes, at);
  RunRow run;
  run.run = row.get<std::int32_t>();
  run.first_sample = row.get<std::uint64_t>();
  run.counts.ticks = row.get<std::uint64_t>();
  run.counts.overruns = row.get<std::uint64_t>();
  run.counts.dropped = row.get<std::uint64_t>();
  run.planned = row.get<std::int32_t>();
  const std::string state = row.get_text(kStatusBytes);
  run.state = state == name_of(RunState::kEnded)     ? RunState::kEnded
              : state == name_of(RunState::kStopped) ? RunState::kStopped
                                                     : RunState::kRunning;
  return run;
}

void put_begun(BytePlanes& planes, std::size_t at, const BegunRow& begun) {
  PackedRow row(planes.row_bytes());
  row.put(begun.row);
  row.put(begun.pass.trial);
  row.put_text(begun.pass.condition, kConditionBytes, "condition");
  row.put_text(name_of(begun.pass.phase), kPhaseBytes, "phase");
  row.put(begun.pass.block);
  row.put(begun.pass.repetition);
  row.put(begun.pass.stimulus_seed);
  row.put(static_cast<std::uint8_t>(begun.pass.practice ? 1 : 0));
  row.put(begun.pass.attempt);
  planes.put_row(at, row.bytes());
}

BegunRow get_begun(const BytePlanes& planes, std::size_t at) {
  PackedRow row(planes, at);
  BegunRow begun;
  begun.row = row.get<std::int32_t>();
  begun.pass.trial = row.get<std::int32_t>();
  begun.pass.condition = row.get_text(kConditionBytes);
  begun.pass.phase = phase_of(row.get_text(kPhaseBytes));
  begun.pass.block = row.get<std::int32_t>();
  begun.pass.repetition = row.get<std::int32_t>();
  begun.pass.stimulus_seed = row.get<std::uint64_t>();
  begun.pass.practice = row.get<std::uint8_t>() != 0;
  begun.pass.attempt = row.get<std::int32_t>();
  begun.pass.status = PassStatus::kAborted;
  return begun;
}

}  // namespace haptrial::record
