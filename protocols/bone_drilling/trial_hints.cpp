#include "protocols/bone_drilling/trial_hints.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"

namespace haptrial::protocols {
namespace {

/// Tells the watch the bone that was drilled away before.
void tell_gone(const bone::BoneWorld& world, const geometry::VoxelGrid& grid,
               hint::HintWatch& watch) {
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        if (world.holder({i, j, k}) < 0) {
          watch.gone({i, j, k});
        }
      }
    }
  }
}

}  // namespace

TrialHints::TrialHints(const BoneDefinition& definition, bool real,
                       std::shared_ptr<hint::Chime> chime)
    : d_(definition), limits_(record::limit_rows(definition.hints->limits)) {
  if (real) {
    beside_ = std::make_unique<hint::ThreadedHints>(std::move(chime));
  } else {
    beside_ = std::make_unique<hint::SteppedHints>(std::move(chime));
  }
}

void TrialHints::check_resumed(const record::SessionReader& file) const {
  if (file.rows<record::HintLimitRow>() != limits_) {
    throw InputError(fmt::format(
        "{}: its hints went by other safe values than {} has now; resume it with the same file",
        file.path().string(), d_.hints->file));
  }
}

void TrialHints::watch(std::size_t bone, const bone::Simulator& simulator) {
  const std::shared_ptr<const bone::BoneModel>& model = d_.bones[bone];
  auto watch = std::make_unique<hint::HintWatch>(*d_.hints, d_.hint_maps[bone], model,
                                                 pose_of(d_.placement, model->grid), d_.rate);
  if (simulator.emptied_so_far() > 0) {
    tell_gone(simulator.world(), model->grid, *watch);
  }
  beside_->begin(std::move(watch));
}

}  // namespace haptrial::protocols
