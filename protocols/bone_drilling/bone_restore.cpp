#include "protocols/bone_drilling/bone_restore.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace haptrial::protocols {
namespace {

std::string refusal(int trial, const std::string& why) {
  return fmt::format(
      "trial {} begins anew with a new bone: the one that was under way cannot be made again ({})",
      trial, why);
}

}  // namespace

RestoredBone restore_bone(const std::filesystem::path& session, int trial, std::int32_t bone,
                          const BoneReplay::Pulse& pulse) {
  RestoredBone restored;
  try {
    const BoneReplay replay(session);
    ReplayVerdict verdict;
    restored.stage = replay.restore(trial, bone, verdict, pulse);
    if (!restored.stage) {
      verdict.difference = "nothing is recorded of it";
    }
    if (!verdict.difference.empty()) {
      restored.stage.reset();
      restored.told = refusal(trial, verdict.difference);
      return restored;
    }
    restored.ticks = verdict.ticks;
    restored.told = fmt::format(
        "trial {} continues with the bone as it was after {:.3f} s of drilling: {} voxels emptied",
        trial, static_cast<double>(verdict.ticks) / replay.rate(), verdict.emptied);
  } catch (const InputError& error) {
    restored.stage.reset();
    restored.told = refusal(trial, error.what());
  }
  return restored;
}

}  // namespace haptrial::protocols
