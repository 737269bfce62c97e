#include "protocols/bone_drilling/bone_in_session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/subject/drilling/work_row.h"

namespace haptrial::protocols {
namespace {

/// When a virtual surgeon first began to work on something in a trial [s].
double start_of_phase(const record::SessionReader& reader, const BoneBeginning& beginning,
                      std::int32_t bone) {
  const std::vector<record::PassRow> passes = reader.passes();
  std::vector<std::string> known;
  for (const record::WorkRow& row : reader.rows<record::WorkRow>()) {
    const record::PassRow& pass = passes.at(static_cast<std::size_t>(row.pass));
    if (pass.trial != beginning.procedure || pass.repetition != bone) {
      continue;
    }
    if (record::word_of(row.work) == beginning.at_phase) {
      return row.time;
    }
    known.emplace_back(record::word_of(row.work));
  }
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  throw InputError(fmt::format("{}: procedure {} has no phase \"{}\"; allowed: {}",
                               reader.path().string(), beginning.procedure, beginning.at_phase,
                               known.empty() ? "a time (bone.at), as the session tells no phases"
                                             : fmt::format("{}", fmt::join(known, ", "))));
}

/// The number of ticks after which the bone is taken.
std::uint64_t ticks_until(const BoneReplay& replay, const BoneBeginning& beginning,
                          std::int32_t bone) {
  if (!beginning.at && beginning.at_phase.empty()) {
    return replay.ticks(beginning.procedure);
  }
  const double time =
      beginning.at ? *beginning.at : start_of_phase(replay.reader(), beginning, bone);
  return static_cast<std::uint64_t>(std::llround(time * replay.rate()));
}

}  // namespace

bone::BoneModel bone_left(const BoneStage& stage) {
  bone::BoneModel left = *stage.model;
  const bone::BoneWorld& world = std::as_const(*stage.simulator).world();
  const bone::BoneVolume& volume = world.volume(0);
  left.density.assign(left.labels.size(), 0.0F);
  std::size_t at = 0;
  for (int k = 0; k < left.grid.size[2]; ++k) {
    for (int j = 0; j < left.grid.size[1]; ++j) {
      for (int i = 0; i < left.grid.size[0]; ++i, ++at) {
        const bone::Voxel voxel(i, j, k);
        if (left.labels[at] != 0 && world.holder(voxel) == 0) {
          left.density[at] = volume.density(voxel);
        }
        left.labels[at] = left.density[at] > 0.0F ? left.labels[at] : 0;
      }
    }
  }
  return left;
}

bone::BoneModel bone_in_session(const std::filesystem::path& session,
                                const BoneBeginning& beginning) {
  const BoneReplay replay(session);
  const std::vector<int> trials = replay.trials();
  if (!std::binary_search(trials.begin(), trials.end(), beginning.procedure)) {
    throw InputError(fmt::format("{}: has no procedure {} (bone.procedure); allowed: {}",
                                 session.string(), beginning.procedure, fmt::join(trials, ", ")));
  }
  const std::int32_t bone = replay.last_bone(beginning.procedure);
  const std::uint64_t until = ticks_until(replay, beginning, bone);
  ReplayVerdict verdict;
  const auto stage = replay.restore_until(until, beginning.procedure, bone, verdict);
  if (!verdict.difference.empty()) {
    throw InputError(fmt::format("{}: procedure {} cannot be simulated again: {}", session.string(),
                                 beginning.procedure, verdict.difference));
  }
  const double end = static_cast<double>(verdict.ticks) / replay.rate();
  if (beginning.at && verdict.ticks < until) {
    throw InputError(
        fmt::format("{}: procedure {} ends after {:.3f} s; bone.at is {:g}, allowed: "
                    "0 to {:.3f} [s]",
                    session.string(), beginning.procedure, end, *beginning.at, end));
  }
  bone::BoneModel left = bone_left(*stage);
  left.source += fmt::format("; as procedure {} of {} left it after {:.3f} s", beginning.procedure,
                             session.filename().string(), end);
  return left;
}

}  // namespace haptrial::protocols
