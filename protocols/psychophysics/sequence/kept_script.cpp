#include "protocols/psychophysics/sequence/kept_script.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "protocols/psychophysics/definition/script_plan.h"

namespace haptrial::protocols {

bool kept_before(const ScriptPlan& plan, const char* event, const record::SessionReader& earlier) {
  bool kept = false;
  for (const record::EventRow& row : earlier.events()) {
    if (row.kind == event && row.text != plan.text) {
      throw InputError(fmt::format(
          "{}: began with another {}; put that one back (the file keeps it in /events), or begin a "
          "new session",
          earlier.path().string(), plan.file.filename().string()));
    }
    kept = kept || row.kind == event;
  }
  return kept;
}

}  // namespace haptrial::protocols
