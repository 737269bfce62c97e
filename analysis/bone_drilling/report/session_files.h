#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/bone/hint/hint_rows.h"
#include "core/bone/model/bone_model.h"

namespace haptrial::analysis::drilling {

/// Data that a session took from files which its definition only names: another file of the same
/// name may have been in its place when another session was recorded.
struct SessionFiles {
  std::string session;  // name of the file
  /// Bones by condition and number of the procedure; equal bones are one (StudyBones).
  std::map<std::pair<std::string, int>, std::shared_ptr<const bone::BoneModel>> bones;
  std::vector<record::HintLimitRow> limits;  // of hints; none: it gives none, or of sight alone
};

/// A sentence for the bones and one for the safe values in which sessions differ from the first
/// session that has them; none if they do not.
std::vector<std::string> remarks_on_files(std::span<const SessionFiles> sessions);

}  // namespace haptrial::analysis::drilling
