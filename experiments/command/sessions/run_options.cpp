#include "experiments/command/sessions/run_options.h"

#include "core/base/definition/table.h"
#include "experiments/study/session_name.h"
#include "protocols/definition/definition.h"
#include "protocols/definition/room.h"

namespace haptrial::experiments {

std::string session_folder(const RunOptions& options) {
  return !options.out.empty() ? options.out : options.teach ? "out/teaching" : "out/sessions";
}

std::filesystem::path session_file(const RunOptions& options, const protocols::Definition& setup) {
  return std::filesystem::path(session_folder(options)) /
         session_file_name(options.subject, options.session.value_or(1), setup.sessions());
}

std::string backup_folder(const RunOptions& options, const protocols::Definition& setup) {
  return options.backup.empty() ? protocols::room_of(setup.root()).backup : options.backup;
}

}  // namespace haptrial::experiments
